// `palpate sweep`: dispatches to its verbs.
#include "cli/program.h"
#include "cli/sweep_verbs.h"
#include "cli/verbs.h"

namespace palpate::cli {

std::string cases_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " case" : " cases");
}

int perform(const Sweep& command, const Arguments&, const Talk& talk) {
  switch (command.act) {
    case Sweep::Act::plan: return sweep_plan(command, talk);
    case Sweep::Act::run:
    case Sweep::Act::retry: return sweep_run(command, talk);
    case Sweep::Act::status: return sweep_status(command, talk);
    case Sweep::Act::merge: return sweep_merge(command, talk);
    case Sweep::Act::parts: return sweep_parts(command, talk);
    case Sweep::Act::slurm: return sweep_slurm(command, talk);
  }
  return exit_internal;
}

}  // namespace palpate::cli
