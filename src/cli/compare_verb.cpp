// `palpate compare`: files or folders, equal or not.
#include <filesystem>

#include "base/error.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "record/csv.h"
#include "report/compare_folders.h"

namespace palpate::cli {

int compare(const Compare& command) {
  report::Tolerances tolerances;
  if (!command.tolerances.empty()) tolerances = report::read_tolerances(command.tolerances);
  for (const std::string& path : {command.got, command.want})
    if (!std::filesystem::exists(path))
      throw InputError({path, 0, 0}, "is not there; give a CSV file or a result folder");
  const bool folders = std::filesystem::is_directory(command.want);
  if (folders != std::filesystem::is_directory(command.got))
    throw InputError(
        {command.got, 0, 0},
        "and " + command.want + " are a file and a folder; give two files or two folders");
  if (folders) {
    const auto comparison = report::compare_folders(command.got, command.want, tolerances);
    print(report::comparison_text(comparison));
    return comparison.equal() ? exit_good : exit_different;
  }
  const auto comparison =
      report::compare(record::read_csv(command.got), record::read_csv(command.want), tolerances);
  print(report::comparison_text(comparison));
  return comparison.equal() ? exit_good : exit_different;
}

}  // namespace palpate::cli
