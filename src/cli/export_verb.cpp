// `palpate export`: results as other tools read them.
#include "base/error.h"
#include "cli/verbs.h"

namespace palpate::cli {

int export_results(const Export&, const Talk&) {
  throw InputError({}, "palpate: this verb is not built yet");
}

}  // namespace palpate::cli
