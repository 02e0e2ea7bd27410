// `palpate sweep`: many cases, on many workers and machines.
#include "base/error.h"
#include "cli/verbs.h"

namespace palpate::cli {

int sweep(const Sweep&, const Arguments&, const Talk&) {
  throw InputError({}, "palpate: this verb is not built yet");
}

}  // namespace palpate::cli
