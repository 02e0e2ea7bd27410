// Prints comparisons, and writes them for build servers.
#include "cli/checks.h"

#include <string>

#include "base/files.h"
#include "base/text.h"
#include "cli/table_text.h"

namespace palpate::cli {
namespace {

// The comparison in a line, then its differences; of several checks, those that differ only.
std::string text_of(const compare::Check& check, bool headed, const Talk& talk) {
  if (!check.error.empty()) return "";  // said on stderr
  if (check.equal() && (headed || talk.quiet())) return "";
  return (headed ? one_line(check.name) + ": " : "") +
         (headed || !talk.quiet() ? compare::headline(check.comparison) + "\n" : "") +
         compare::difference_lines(check.comparison);
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
  for (const compare::Check& check : checks) {
    if (!check.error.empty()) Talk::error(check.error);
    if (talk.json())
      print(json_lines(table_of(check, options.headed)));
    else
      print_text(text_of(check, options.headed, talk));
  }
  if (!options.junit.empty()) write_atomically(options.junit, compare::junit_text(checks));
  // GitHub reads commands on both streams; stdout may be JSON.
  if (options.annotations == "github") Talk::annotate(compare::github_annotations(checks));
}

}  // namespace palpate::cli
