// `palpate sweep`: many cases, on many workers and machines.
#include <algorithm>
#include <csignal>
#include <thread>

#include "cli/program.h"
#include "cli/sweep_verbs.h"
#include "cli/verbs.h"
#include "report/machine.h"

namespace palpate::cli {

std::string program_identity() {
  const report::Build build = report::this_build();
  return "palpate " + build.version + ", " + build.type + ", " + build.compiler + ", " +
         build.flags;
}

int worker_count(int jobs) {
  return jobs > 0 ? jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

std::string cases_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " case" : " cases");
}

int sweep(const Sweep& command, const Arguments&, const Talk& talk) {
  // A file that may not grow is an error to be told of, as a full disk is.
  std::signal(SIGXFSZ, SIG_IGN);
  switch (command.act) {
    case Sweep::Act::plan: return sweep_plan(command, talk);
    case Sweep::Act::run:
    case Sweep::Act::retry: return sweep_run(command, talk);
    case Sweep::Act::status: return sweep_status(command, talk);
    case Sweep::Act::merge: return sweep_merge(command, talk);
    case Sweep::Act::slurm: return sweep_slurm(command, talk);
  }
  return exit_internal;
}

}  // namespace palpate::cli
