// `palpate fit`: one regression on two columns of any CSV file.
#include "base/error.h"
#include "base/text.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "fit/fit_table.h"
#include "record/csv.h"

namespace palpate::cli {
namespace {

std::size_t column_of(const record::Table& table, const std::string& name,
                      const std::string& file) {
  const int column = table.find(name);
  if (column >= 0) return static_cast<std::size_t>(column);
  const auto near = nearest(name, table.columns);
  throw InputError({file, 1, 0}, "has no column `" + name + "`" +
                                     (near ? "; did you mean `" + *near + "`?"
                                           : "; columns: " + joined(table.columns, ", ")));
}

double number_of(const record::Cell& cell, const std::string& file, std::size_t row,
                 const std::string& column) {
  if (const auto* number = std::get_if<double>(&cell)) return *number;
  if (std::holds_alternative<std::monostate>(cell)) return fit::Estimate::unknown;
  throw InputError({file, static_cast<int>(row) + 2, 0},
                   "`" + column + "` holds `" + std::get<std::string>(cell) +
                       "`, which is no number; name a column of numbers");
}

}  // namespace

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
  const record::Table table = record::read_csv(command.data);
  const std::size_t x = column_of(table, command.x, command.data);
  const std::size_t y = column_of(table, command.y, command.data);
  const bool filtered = !command.case_name.empty();
  const std::size_t name = filtered ? column_of(table, "case", command.data) : 0;
  std::vector<double> xs;
  std::vector<double> ys;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    if (filtered && row[name] != record::Cell(command.case_name)) continue;
    xs.push_back(number_of(row[x], command.data, i, command.x));
    ys.push_back(number_of(row[y], command.data, i, command.y));
  }
  fit::Fit result;
  try {
    result = fit::regress(xs, ys, *model,
                          {.x_unit = fit::column_unit(command.x),
                           .y_unit = fit::column_unit(command.y),
                           .x_origin = command.x_origin});
  } catch (const InputError& error) {
    throw InputError({command.data, 0, 0}, error.problems().front().message);
  }
  const std::vector<fit::NamedFit> named{
      {command.case_name, command.y + " over " + command.x, result}};
  print(record::csv_text(fit::fit_table(named)));
  if (result.left_out > 0)
    Talk::error("note: " + std::to_string(result.left_out) +
                (result.left_out == 1 ? " point is" : " points are") +
                " left out: not finite, or x <= 0 where its logarithm is needed");
  return exit_good;
}

}  // namespace palpate::cli
