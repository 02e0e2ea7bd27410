// `palpate stability`: limits of the time step and kinds of failure, measured beside theory.
#include "base/error.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "record/csv.h"
#include "report/stability_folder.h"
#include "study/stability.h"

namespace palpate::cli {

int stability(const Stability& command, const Arguments&, const Talk& talk) {
  const scenario::Family family = scenario::read(command.scenario, command.settings);
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  report::StabilityFolder folder(command.out, family.name, command.force);
  const scenario::Case& one = family.cases.front();
  if (family.cases.size() > 1)
    talk.say("note: of " + std::to_string(family.cases.size()) + " cases the first is mapped, " +
             one.name);
  const std::atomic<bool>& stop = listen_for_interrupts(exit_interrupted);
  const study::StabilityMap map =
      study::map_stability(one, family, stop, [&](const std::string& what, double share) {
        talk.progress(family.name + ": " + std::to_string(static_cast<int>(100.0 * share)) +
                      " %, " + what);
      });
  talk.progress("");
  if (map.interrupted) {
    Talk::error("palpate: interrupted; nothing was written");
    return exit_interrupted;
  }
  const std::string warning = folder.write(map);
  if (!warning.empty()) talk.warn(warning);
  if (talk.json()) {
    print(json_lines(study::limit_table(map)) + json_lines(study::failure_table(map)));
  } else {
    for (const std::string& sentence : map.sentences) print(sentence + "\n");
  }
  talk.say(folder.path() + ": stability.csv, failures.csv, stability.svg");
  return exit_good;
}

}  // namespace palpate::cli
