// `palpate identify`: the properties behind a measured curve.
#include "base/error.h"
#include "cli/verbs.h"

namespace palpate::cli {

int identify(const Identify&, const Arguments&, const Talk&) {
  throw InputError({}, "palpate: this verb is not built yet");
}

}  // namespace palpate::cli
