// `palpate fit`: one regression on two columns of any table in text.
#include "base/error.h"
#include "base/text.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "fit/fit_table.h"
#include "record/csv.h"
#include "record/measured.h"

namespace palpate::cli {
int fit_columns(const Fit& command) {
  const auto model = fit::find_model(command.model);
  if (!model) {
    std::vector<std::string> known;
    for (const fit::ModelInfo& one : fit::models()) known.emplace_back(one.name);
    const auto near = nearest(command.model, known);
    throw InputError({}, "palpate: `--model` does not know `" + command.model + "`" +
                             (near ? "; did you mean `" + *near + "`?"
                                   : "; it is one of " + joined(known, ", ")));
  }
  DataOptions columns = command.columns;
  columns.blanks = DataOptions::Blanks::keep;  // the fit counts them with what else it leaves out
  const record::MeasuredCurve curve = record::read_measured(command.data, columns);
  for (const std::string& note : curve.notes) Talk::error("note: " + note);
  fit::Fit result;
  try {
    result = fit::regress(
        curve.x_written, curve.y_written, *model,
        {.x_unit = curve.x_axis.unit, .y_unit = curve.y_axis.unit, .x_origin = command.x_origin});
  } catch (const InputError& error) {
    throw InputError({command.data, 0, 0}, error.problems().front().message);
  }
  const std::vector<fit::NamedFit> named{
      {columns.case_name, curve.y_axis.column + " over " + curve.x_axis.column, result}};
  print(record::csv_text(fit::fit_table(named)));
  if (result.left_out > 0)
    Talk::error("note: " + std::to_string(result.left_out) +
                (result.left_out == 1 ? " point is" : " points are") +
                " left out: not finite, or x <= 0 where its logarithm is needed");
  return exit_good;
}

}  // namespace palpate::cli
