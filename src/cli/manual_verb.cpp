// `palpate manual`: prints the reference of all scenario keys.
#include "cli/program.h"
#include "cli/verbs.h"
#include "scenario/family.h"

namespace palpate::cli {

int perform(const Manual&, const Arguments&, const Talk&) {
  print(scenario::manual());
  return exit_good;
}

}  // namespace palpate::cli
