// Prints comparisons, and writes them for build servers.
#include "cli/checks.h"

#include <string>

#include "base/files.h"
#include "cli/table_text.h"

namespace palpate::cli {
namespace {

std::string text_of(const compare::Check& check, bool headed, compare::Show show) {
  if (!check.error.empty()) return "";  // said on stderr
  if (show == compare::Show::differing && check.equal()) return "";
  if (check.one_file)
    return compare::comparison_text(check.comparison.files.front().comparison, show);
  return (headed ? compare::one_line(check.name) + (check.equal() ? ": equal\n" : ": DIFFERS\n")
                 : "") +
         compare::comparison_text(check.comparison, show);
}

// The table of the check, with its name in a first column if there are several.
record::Table table_of(const compare::Check& check, bool headed) {
  record::Table table = compare::comparison_table(check.comparison);
  if (!headed) return table;
  table.columns.insert(table.columns.begin(), "golden");
  for (auto& row : table.rows) row.insert(row.begin(), check.name);
  return table;
}

}  // namespace

void report_checks(std::span<const compare::Check> checks, const CheckOptions& options,
                   const Talk& talk) {
  const auto show = talk.quiet() ? compare::Show::differing : compare::Show::all;
  for (const compare::Check& check : checks) {
    if (!check.error.empty()) Talk::error(check.error);
    if (talk.json())
      print(json_lines(table_of(check, options.headed)));
    else
      print_text(text_of(check, options.headed, show));
  }
  if (!options.junit.empty()) write_atomically(options.junit, compare::junit_text(checks));
  // GitHub reads commands on both streams; stdout may be JSON.
  if (options.annotations == "github") {
    std::string lines = compare::github_annotations(checks);
    if (!lines.empty()) lines.pop_back();
    if (!lines.empty()) Talk::error(lines);
  }
}

}  // namespace palpate::cli
