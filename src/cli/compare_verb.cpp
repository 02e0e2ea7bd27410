// `palpate compare`: compares two files or two folders.
#include <array>
#include <filesystem>

#include "base/error.h"
#include "cli/checks.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "record/csv.h"

namespace palpate::cli {
namespace {

compare::Tables one_table(const std::string& name, const std::string& path) {
  return {{name, [path] { return record::read_csv(path); }}};
}

}  // namespace

int perform(const Compare& command, const Arguments&, const Talk& talk) {
  namespace fs = std::filesystem;
  compare::Tolerances tolerances;
  if (!command.tolerances.empty()) tolerances = compare::read_tolerances(command.tolerances);
  for (const std::string& path : {command.got, command.want})
    if (!fs::exists(path))
      throw InputError({path, 0, 0}, "is not there; give a CSV file or a result folder");
  const bool folders = fs::is_directory(command.want);
  if (folders != fs::is_directory(command.got))
    throw InputError(
        {command.got, 0, 0},
        "and " + command.want + " are a file and a folder; give two files or two folders");
  const std::string name = fs::path(command.want).filename().string();
  const std::array checks{compare::Check{
      .name = command.got,
      .want = command.want,
      .one_file = !folders,
      .comparison = folders ? compare::compare_folders(command.got, command.want, tolerances)
                            : compare::compare_tables(one_table(name, command.got),
                                                      one_table(name, command.want), tolerances)}};
  report_checks(checks, command.options, talk);
  return checks.front().equal() ? exit_good : exit_different;
}

}  // namespace palpate::cli
