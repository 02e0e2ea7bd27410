// `palpate fit`: fits curves of text tables.
#include <algorithm>

#include "cli/fit_many.h"
#include "cli/fit_models.h"
#include "cli/program.h"
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

}  // namespace

int perform(const Fit& command, const Arguments&, const Talk& talk) {
  check_fit(command);
  if (command.data.size() > 1 || !command.out.empty()) return fit_many(command, talk);
  const FittedCurve fitted = fit_curve(command, command.data.front());
  const std::vector<fit::NamedFit> named{{command.columns.case_name, fitted.name, fitted.fit}};
  print(record::csv_text(fit::measured_fit_table(named)));
  say_what_is_odd(fitted.fit, talk);
  return exit_good;
}

}  // namespace palpate::cli
