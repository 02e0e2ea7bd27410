// `palpate sweep plan`: checks all cases of a sweep and writes the plan.
#include "cli/program.h"
#include "cli/sweep_verbs.h"

namespace palpate::cli {

int sweep_plan(const Sweep& command, const Talk& talk) {
  sweep::SweepOrder order{.scenario = command.subject,
                          .settings = command.settings,
                          .out = command.out,
                          .workers = worker_count(0),
                          .program = program_identity()};
  if (command.curves) order.curves = sweep::SweepOrder::Curves::kept;
  if (command.yes) order.ceiling = sweep::SweepOrder::Ceiling::lifted;
  const sweep::Planned planned = sweep::plan_sweep(order);
  for (const Problem& note : planned.notes) talk.say("note: " + note.text());
  const std::string cases = cases_text(planned.cases);
  if (planned.there_already)
    talk.say(planned.folder + ": the same plan of " + cases + " is there already");
  else
    talk.say(planned.folder + ": " + cases + " planned" +
             (planned.forecast.empty() ? "" : ", " + planned.forecast));
  talk.event("plan", {{"folder", planned.folder},
                      {"cases", std::to_string(planned.cases)},
                      {"there_already", planned.there_already ? "true" : "false"}});
  return exit_good;
}

}  // namespace palpate::cli
