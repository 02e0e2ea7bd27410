// `palpate sweep plan`: which cases there are, checked one by one and written down.
#include "cli/program.h"
#include "cli/sweep_verbs.h"

namespace palpate::cli {

int sweep_plan(const Sweep& command, const Talk& talk) {
  study::SweepOrder order{.scenario = command.subject,
                          .settings = command.settings,
                          .out = command.out,
                          .workers = worker_count(0),
                          .program = program_identity()};
  if (command.curves) order.curves = study::SweepOrder::Curves::kept;
  if (command.yes) order.ceiling = study::SweepOrder::Ceiling::lifted;
  const study::Planned planned = study::plan_sweep(order);
  for (const Problem& note : planned.notes) talk.say("note: " + note.text());
  const std::string cases = cases_text(planned.cases);
  if (planned.there_already)
    talk.say(planned.folder + ": this very plan of " + cases + " is there already");
  else
    talk.say(planned.folder + ": " + cases + " planned" +
             (planned.forecast.empty() ? "" : ", " + planned.forecast));
  talk.event("plan", {{"folder", planned.folder},
                      {"cases", std::to_string(planned.cases)},
                      {"there_already", planned.there_already ? "true" : "false"}});
  return exit_good;
}

}  // namespace palpate::cli
