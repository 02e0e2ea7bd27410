// `palpate sweep plan`: checks all cases of a sweep and writes the plan.
#include "base/text.h"
#include "cli/program.h"
#include "cli/sweep_verbs.h"

namespace palpate::cli {

int sweep_plan(const Sweep& command, const Talk& talk) {
  sweep::SweepOrder order{.scenario = command.subject,
                          .settings = command.settings,
                          .out = command.out,
                          .workers = worker_count(0),
                          .program = program_identity()};
  order.reuse = command.reuse;
  if (command.curves) order.curves = sweep::SweepOrder::Curves::kept;
  if (command.yes) order.ceiling = sweep::SweepOrder::Ceiling::lifted;
  const sweep::Planned planned = sweep::plan_sweep(order);
  for (const Problem& note : planned.notes) talk.say("note: " + note.text());
  const std::string cases = cases_text(planned.cases);
  if (planned.there_already)
    talk.say(planned.folder + ": the same plan of " + cases + " is there already");
  else
    talk.say(planned.folder + ": " + cases + " planned" +
             (planned.forecast ? ", " + planned.forecast->text() : ""));
  if (!command.reuse.empty())
    talk.say(planned.folder + ": " + std::to_string(planned.reused) + " of " + cases +
             " taken over from " + command.reuse);
  std::vector<std::pair<std::string, std::string>> details{
      {"folder", planned.folder},
      {"cases", std::to_string(planned.cases)},
      {"there_already", planned.there_already ? "true" : "false"}};
  if (planned.forecast) {
    details.emplace_back("seconds", rounded_text(planned.forecast->seconds, 3));
    details.emplace_back("row_bytes", rounded_text(planned.forecast->bytes, 3));
    details.emplace_back("memory_bytes", rounded_text(planned.forecast->memory, 3));
  }
  talk.event("plan", details);
  return exit_good;
}

}  // namespace palpate::cli
