// `palpate fit`: fits curves of text tables.
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "cli/fit_many.h"
#include "cli/fit_models.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "fit/fit_table.h"
#include "record/csv.h"

namespace palpate::cli {
namespace {

void say_what_is_odd(const fit::Fit& result, const Talk& talk) {
  for (const std::string& note : result.notes) talk.say("note: " + note);
  for (const std::string& warning : result.warnings) talk.warn(warning);
  const bool told = std::any_of(result.notes.begin(), result.notes.end(), [](const auto& note) {
    return note.find("left out") != std::string::npos;
  });
  if (result.left_out > 0 && !told)
    talk.say("note: " + std::to_string(result.left_out) +
             (result.left_out == 1 ? " point is" : " points are") +
             " left out: not finite, or x <= 0 where its logarithm is needed");
  if (!(result.name == "prony" || result.name == "prony_creep")) return;
  for (std::size_t i = 1; i < result.parameters.size(); i += 2)
    if (result.parameters[i].estimate < 0.0)
      talk.say("note: `" + result.parameters[i].name +
               "` is below 0, which no passive tissue has; give fewer `--terms`");
}

// One line per parameter, then the formula and how well it fits.
std::string table_for_people(const fit::Fit& result) {
  std::size_t width = 0;
  for (const fit::Estimate& one : result.parameters) width = std::max(width, one.name.size());
  std::string text;
  for (const fit::Estimate& one : result.parameters) {
    text += one.name + std::string(width - one.name.size() + 2, ' ') +
            rounded_text(one.estimate, 5) + (one.unit.empty() ? "" : " " + one.unit);
    if (std::isfinite(one.ci95_low))
      text += "  (95 %: " + rounded_text(one.ci95_low, 5) + " to " +
              rounded_text(one.ci95_high, 5) + ")";
    text += "\n";
  }
  const std::string law =
      result.name.empty() ? std::string(fit::info(result.model).formula) : result.law;
  return text + law + "\n" + std::to_string(result.n) + " points, R^2 " +
         rounded_text(result.r2, 6) + "\n";
}

}  // namespace

int perform(const Fit& command, const Arguments&, const Talk& talk) {
  check_fit(command);
  if (command.data.size() > 1 || !command.out.empty()) return fit_many(command, talk);
  const FittedCurve fitted = fit_curve(command, command.data.front());
  const std::vector<fit::NamedFit> named{{command.columns.case_name, fitted.name, fitted.fit}};
  if (talk.json())
    print(json_lines(fit::measured_fit_table(named)));
  else if (command.csv || ::isatty(STDOUT_FILENO) == 0)
    print(record::csv_text(fit::measured_fit_table(named)));
  else
    print(table_for_people(fitted.fit));
  say_what_is_odd(fitted.fit, talk);
  return exit_good;
}

}  // namespace palpate::cli
