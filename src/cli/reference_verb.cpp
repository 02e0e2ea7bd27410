// `palpate reference`: prints the forces of a scenario by mesh refinement and extrapolation.
#include <filesystem>

#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/whole_folder.h"
#include "chart/reference.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "record/csv.h"

namespace palpate::cli {

int perform(const Reference& command, const Arguments&, const Talk& talk) {
  namespace fs = std::filesystem;
  const chart::Asked asked = chart::read_asked(command.scenario, command.settings);
  const scenario::Family& family = asked.family;
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  const fs::path file = fs::path(command.out) / (family.name + "_reference.csv");
  std::vector<std::pair<std::string, chart::Reference>> found;
  bool diverged = false;
  for (std::size_t i = 0; i < family.cases.size(); ++i) {
    const scenario::Case& one = family.cases[i];
    std::optional<ProgressLine> ticker(std::in_place, talk, [&](double seconds) {
      return bar(i, family.cases.size(), seconds) + ", " + one.name;
    });
    chart::Reference reference = chart::refer(asked, i);
    ticker.reset();
    for (const std::string& warning : reference.warnings) talk.say(one.name + ": " + warning + ".");
    if (reference.diverged) {
      diverged = true;
      Talk::error(one.name + ": " + *reference.diverged);
      continue;
    }
    found.emplace_back(one.name, std::move(reference));
  }
  const record::Table table = chart::reference_table(found);
  print_result(table, table, talk);
  if (!command.out.empty()) {
    if (!command.force && fs::exists(file) && !holds(file.string(), record::csv_text(table)))
      throw InputError(
          {file.string(), 0, 0},
          "is there already and says something else; give another folder, or `--force`");
    make_folders(file.parent_path().string());
    write_atomically(file.string(), record::csv_text(table));
  }
  return diverged ? exit_diverged : exit_good;
}

}  // namespace palpate::cli
