// `palpate fit`: fits curves of text tables.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "base/whole_folder.h"
#include "cli/fit_models.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/talk.h"
#include "cli/verbs.h"
#include "fit/case_fits.h"
#include "plot/gnuplot.h"
#include "record/csv.h"
#include "record/table.h"
#include "report/finding_words.h"

namespace palpate::cli {
namespace {

struct Row {
  std::string file;
  std::string reason;  // of a failure; empty: there is a result
  fit::Fit fit;
};

std::vector<Row> fitted_rows(const Fit& command, const Talk& talk) {
  std::vector<Row> rows;
  for (const std::string& path : command.data) {
    Row row{path, {}, {}};
    try {
      row.fit = fit_curve(command, path).fit;
    } catch (const InputError& error) {
      const Problem& problem = error.problems().front();
      // An option that is wrong is wrong for every curve.
      if (problem.place.file.empty()) throw;
      row.reason = problem.message;
    }
    rows.push_back(std::move(row));
    talk.progress(bar(rows.size(), command.data.size()));
  }
  talk.progress("");
  return rows;
}

// `E_kPa`, `alpha`, and `E_low_kPa` of the end `_low`.
std::string column_of(const fit::Estimate& one, const char* end = "") {
  return one.name + end + (one.unit.empty() ? "" : "_" + record::unit_word(one.unit));
}

// The parameters of all results, in the order in which they first occur.
std::vector<fit::Estimate> parameters_of(const std::vector<Row>& rows) {
  std::vector<fit::Estimate> all;
  for (const Row& row : rows)
    for (const fit::Estimate& one : row.fit.parameters)
      if (std::ranges::none_of(
              all, [&](const fit::Estimate& known) { return column_of(known) == column_of(one); }))
        all.push_back(one);
  return all;
}

record::Table row_table(const std::vector<Row>& rows,
                        const std::vector<fit::Estimate>& parameters) {
  record::Table table;
  table.columns = {"number", "file", "status"};
  for (const fit::Estimate& parameter : parameters)
    for (const char* end : {"", "_low", "_high"})
      table.columns.push_back(column_of(parameter, end));
  for (const char* name : {"r2", "n", "excluded", "effective_n", "law", "warnings"})
    table.columns.emplace_back(name);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    std::vector<record::Cell> cells{static_cast<double>(i + 1), row.file,
                                    std::string(row.reason.empty() ? "fitted" : "failed")};
    for (const fit::Estimate& parameter : parameters) {
      const auto found = std::ranges::find_if(row.fit.parameters, [&](const auto& one) {
        return column_of(one) == column_of(parameter);
      });
      const fit::Estimate none;
      const fit::Estimate& one = found == row.fit.parameters.end() ? none : *found;
      for (const double value : {one.estimate, one.ci95_low, one.ci95_high})
        cells.push_back(record::known(value));
    }
    if (row.reason.empty()) {
      for (const double value : {row.fit.r2, static_cast<double>(row.fit.n),
                                 static_cast<double>(row.fit.excluded), row.fit.effective_size})
        cells.push_back(record::known(value));
      for (const std::string& text : {row.fit.law, joined(row.fit.warnings, "; ")})
        cells.push_back(record::known(text));
    } else {
      cells.resize(cells.size() + 5);
      cells.emplace_back(row.reason);
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

// The quantile by linear interpolation between order statistics (Hyndman and Fan 1996, type 7).
double quantile(const std::vector<double>& sorted, double part) {
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

struct Population {
  std::string name;
  std::vector<double> sorted;
  double mean = 0.0;
  double deviation = std::nan("");  // standard deviation, n - 1
};

std::vector<Population> populations(const std::vector<Row>& rows,
                                    const std::vector<fit::Estimate>& parameters) {
  std::vector<Population> all;
  for (const fit::Estimate& parameter : parameters) {
    const std::string name = column_of(parameter);
    Population one{.name = name, .sorted = {}};
    for (const Row& row : rows)
      for (const fit::Estimate& each : row.fit.parameters)
        if (column_of(each) == name && std::isfinite(each.estimate))
          one.sorted.push_back(each.estimate);
    if (one.sorted.empty()) continue;
    std::ranges::sort(one.sorted);
    const auto count = static_cast<double>(one.sorted.size());
    for (const double each : one.sorted) one.mean += each / count;
    double squares = 0.0;
    for (const double each : one.sorted) squares += (each - one.mean) * (each - one.mean);
    if (count > 1.0) one.deviation = std::sqrt(squares / (count - 1.0));
    all.push_back(std::move(one));
  }
  return all;
}

record::Table population_table(const std::vector<Population>& all) {
  record::Table table;
  table.columns = {"parameter",  "count", "mean", "standard_deviation", "quartile_1", "median",
                   "quartile_3", "least", "most"};
  for (const Population& one : all)
    table.rows.push_back({one.name, static_cast<double>(one.sorted.size()), one.mean,
                          record::known(one.deviation), quantile(one.sorted, 0.25),
                          quantile(one.sorted, 0.5), quantile(one.sorted, 0.75), one.sorted.front(),
                          one.sorted.back()});
  return table;
}

void say_population(const std::vector<Population>& all, const std::vector<Row>& rows,
                    const Talk& talk) {
  const auto failed =
      std::ranges::count_if(rows, [](const Row& row) { return !row.reason.empty(); });
  talk.say(std::to_string(rows.size() - static_cast<std::size_t>(failed)) + " of " +
           std::to_string(rows.size()) + " curves are fitted");
  std::map<std::string, int> reasons;
  for (const Row& row : rows)
    if (!row.reason.empty()) ++reasons[row.reason];
  for (const auto& [reason, count] : reasons) {
    const std::string text =
        std::to_string(count) + (count == 1 ? " curve fails: " : " curves fail: ") + reason;
    if (all.empty())
      Talk::error("palpate: " + text);
    else
      talk.warn(text);
  }
  if (all.empty() || all.front().sorted.size() < 2) return;
  const Population& first = all.front();
  talk.say(first.name + ": median " + rounded_text(quantile(first.sorted, 0.5)) + ", quartiles " +
           rounded_text(quantile(first.sorted, 0.25)) + " and " +
           rounded_text(quantile(first.sorted, 0.75)) + ", mean " + rounded_text(first.mean) +
           ", standard deviation " + rounded_text(first.deviation));
}

void write_folder(const Fit& command, const record::Table& rows, const record::Table& population,
                  const Talk& talk) {
  WholeFolder folder(command.out, "population of fits",
                     command.force ? Replace::any : Replace::incomplete,
                     record::csv_text(rows) + record::csv_text(population));
  folder.refuse_what_is_there();
  folder.open();
  folder.write("curves.csv", record::csv_text(rows));
  folder.write("population.csv", record::csv_text(population));
  std::vector<std::string> warnings;
  if (!population.rows.empty()) {
    const std::string name = rows.columns[3];
    plot::Figure figure;
    figure.name = "population";
    figure.title = name + " of " + std::to_string(rows.rows.size()) + " curves";
    figure.x_label = "number of the curve";
    figure.y_label = name;
    plot::Series series;
    series.csv_file = "curves.csv";
    series.case_name = "fitted";
    series.column = "status";
    series.x_column = "number";
    series.y_column = name;
    series.label = command.model;
    figure.series.push_back(series);
    plot::draw(plot::sheet_of(figure), folder, warnings);
  }
  const std::string missing = warn_all(folder.put(WholeFolder::State::complete, warnings), talk);
  talk.say(folder.path() + ": curves.csv, population.csv, population.svg" + missing);
  talk.next("open", folder.path());
}

// Fits every curve of the command, prints one row per curve (failures with their reasons) and says
// the population's mean, median and quartiles; with `--out` writes curves.csv, population.csv and a
// figure. Returns exit_good if at least one curve has a result.
int fit_many(const Fit& command, const Talk& talk) {
  const std::vector<Row> rows = fitted_rows(command, talk);
  const std::vector<fit::Estimate> parameters = parameters_of(rows);
  const std::vector<Population> all = populations(rows, parameters);
  const record::Table table = row_table(rows, parameters);
  print(talk.json() ? json_lines(table) : record::csv_text(table));
  say_population(all, rows, talk);
  if (!command.out.empty()) write_folder(command, table, population_table(all), talk);
  return all.empty() ? exit_input : exit_good;
}

// Residuals below a millionth of the curve are rounding, of the file's digits or the computation's.
bool is_exact(const fit::Fit& result) { return 1.0 - result.r2 < 1e-12; }

void say_what_is_odd(const fit::Fit& result, const Talk& talk) {
  if (is_exact(result))
    talk.say(
        "note: the curve is met exact to rounding, so that the intervals are no errors of a "
        "measurement");
  for (const std::string& note : result.notes) talk.say("note: " + note);
  for (const std::string& warning : result.warnings) talk.warn(warning);
  const bool told = std::ranges::any_of(
      result.notes, [](const auto& note) { return note.find("excluded") != std::string::npos; });
  if (result.excluded > 0 && !told)
    talk.say("note: " + std::to_string(result.excluded) +
             (result.excluded == 1 ? " point is" : " points are") +
             " excluded: not finite, or x <= 0 where its logarithm is needed");
  const bool creep = result.name == "prony_creep";
  if (!(creep || result.name == "prony")) return;
  // A load that is negative in compression turns the signs of all of them.
  double whole = 0.0;
  std::size_t terms = 0;
  for (const fit::Estimate& one : result.parameters) {
    if (one.name.starts_with("y_")) whole += one.estimate;
    if (one.name.starts_with("tau_")) ++terms;
  }
  for (const fit::Estimate& one : result.parameters)
    if (one.name.starts_with("y_") && one.name != "y_inf" && one.name != "y_0" &&
        one.estimate * whole < 0.0)
      talk.say("note: `" + one.name + "` is " + (whole > 0.0 ? "below" : "above") +
               " 0, which no passive tissue has; " +
               (terms > 1 ? "give fewer `--terms`"
                : creep   ? "fit `prony`, whose curve falls"
                          : "fit `prony_creep`, whose curve rises"));
}

// One line per parameter, then the formula and how well it fits.
std::string table_for_people(const fit::Fit& result) {
  std::size_t width = 0;
  for (const fit::Estimate& one : result.parameters) width = std::max(width, one.name.size());
  std::string text;
  for (const fit::Estimate& one : result.parameters) {
    text += one.name + std::string(width - one.name.size() + 2, ' ') +
            report::warranted_text(one.estimate, one.ci95_low, one.ci95_high) +
            (one.unit.empty() ? "" : " " + one.unit);
    if (std::isfinite(one.ci95_low) && is_exact(result))
      text += "  (exact to rounding)";
    else if (std::isfinite(one.ci95_low))
      text += "  (95 %: " + report::warranted_text(one.ci95_low, one.ci95_low, one.ci95_high) +
              " to " + report::warranted_text(one.ci95_high, one.ci95_low, one.ci95_high) + ")";
    text += "\n";
  }
  return text + fit::formula_of(result) + "\n" + std::to_string(result.n) + " points, R^2 " +
         rounded_text(result.r2) + "\n";
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
  if (command.model == "hertz" || command.model == "layer")
    talk.next("identify", command.data.front(),
              " SCENARIO --unknown \"tissue.young_modulus=LOW..HIGH kPa\"");
  return exit_good;
}

}  // namespace palpate::cli
