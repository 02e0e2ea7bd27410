// `palpate compare`: compares two files or two folders.
#include <filesystem>

#include "base/error.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "compare/compare_folders.h"
#include "record/csv.h"

namespace palpate::cli {

int perform(const Compare& command, const Arguments&, const Talk&) {
  compare::Tolerances tolerances;
  if (!command.tolerances.empty()) tolerances = compare::read_tolerances(command.tolerances);
  for (const std::string& path : {command.got, command.want})
    if (!std::filesystem::exists(path))
      throw InputError({path, 0, 0}, "is not there; give a CSV file or a result folder");
  const bool folders = std::filesystem::is_directory(command.want);
  if (folders != std::filesystem::is_directory(command.got))
    throw InputError(
        {command.got, 0, 0},
        "and " + command.want + " are a file and a folder; give two files or two folders");
  if (folders) {
    const auto comparison = compare::compare_folders(command.got, command.want, tolerances);
    print(compare::comparison_text(comparison));
    return comparison.equal() ? exit_good : exit_different;
  }
  const auto comparison =
      compare::compare(record::read_csv(command.got), record::read_csv(command.want), tolerances);
  print(compare::comparison_text(comparison));
  return comparison.equal() ? exit_good : exit_different;
}

}  // namespace palpate::cli
