// `palpate stability`: measures limits of the time step and failures, and compares with theory.
#include <filesystem>
#include <optional>

#include "base/stop_scope.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "record/csv.h"
#include "report/results.h"
#include "stability/stability.h"

namespace palpate::cli {

int perform(const Stability& command, const Arguments&, const Talk& talk) {
  const scenario::Family family = scenario::read(command.scenario, command.settings);
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  WholeFolder folder((std::filesystem::path(command.out) / (family.name + "_stability")).string(),
                     "stability map", command.force ? Replace::any : Replace::incomplete,
                     report::origin_of(family));
  folder.refuse_what_is_there();
  const scenario::Case& one = family.cases.front();
  if (family.cases.size() > 1)
    talk.say("note: only the first of " + std::to_string(family.cases.size()) +
             " cases is mapped, " + one.name);
  const StopScope scope(listen_for_interrupts(exit_interrupted));
  std::optional<ProgressLine> ticker(std::in_place, talk, [&](double) { return family.name; });
  const stability::StabilityMap map =
      stability::map_stability(one, family, [](const std::string& what, double share) {
        set_doing({what, static_cast<std::size_t>(100.0 * share), 100});
      });
  ticker.reset();
  const std::string missing = warn_all(stability::write_map(map, family.name, folder), talk);
  if (talk.json()) {
    print(json_lines(stability::limit_table(map)) + json_lines(stability::failure_table(map)));
  } else {
    for (const std::string& sentence : map.sentences) print(sentence + "\n");
  }
  talk.say(folder.path() + ": stability.csv, failures.csv, stability.svg" + missing);
  talk.next("open", folder.path());
  return StopScope::stopped() ? exit_interrupted : exit_good;
}

}  // namespace palpate::cli
