// The map as tables, and the result folder.
#include <array>

#include "page/page.h"
#include "record/csv.h"
#include "stability/stability.h"

namespace palpate::stability {
namespace {

using record::Cell;

Cell cell(const std::optional<double>& number) { return number ? Cell(*number) : Cell(); }
Cell cell(const std::string& word) { return word.empty() ? Cell() : Cell(word); }

Cell microseconds(const std::optional<double>& seconds) {
  return seconds ? Cell(1e6 * *seconds) : Cell();
}

}  // namespace

const char* failure_word(Failure failure) {
  constexpr std::array words{"none",      "divergence",        "non_finite",
                             "inversion", "false_equilibrium", "locking",
                             "drift",     "chatter",           "tunnelling"};
  return words[as_index(failure)];
}

record::Table limit_table(const StabilityMap& map) {
  record::Table table;
  table.columns = {"rung",     "volume",    "integrator", "damping", "axis", "value",
                   "limit_us", "theory_us", "ratio",      "failure", "note"};
  for (const LimitRow& row : map.limits) {
    Cell ratio;
    if (row.measured && row.theory && *row.theory > 0.0) ratio = *row.measured / *row.theory;
    table.rows.push_back({row.rung, row.volume, row.integrator, row.damping, row.axis,
                          cell(row.value), microseconds(row.measured), microseconds(row.theory),
                          ratio, failure_word(row.failure), cell(row.note)});
  }
  return table;
}

record::Table failure_table(const StabilityMap& map) {
  record::Table table;
  table.columns = {"failure", "rung",     "integrator", "setting", "setting_unit",
                   "measure", "measured", "theory",     "seen",    "note"};
  for (const FailureRow& row : map.failures)
    table.rows.push_back({failure_word(row.failure), cell(row.rung), cell(row.integrator),
                          cell(row.setting), cell(row.setting_unit), row.measure,
                          cell(row.measured), cell(row.theory), row.reached ? "yes" : "not reached",
                          cell(row.note)});
  return table;
}

std::vector<std::string> write_map(const StabilityMap& map, const std::string& title,
                                   WholeFolder& folder) {
  std::vector<std::string> warnings;
  folder.open();
  folder.write("stability.csv", record::csv_text(limit_table(map)));
  folder.write("failures.csv", record::csv_text(failure_table(map)));
  plot::draw(stability_sheet(title, map), folder, warnings);
  page::Page page("Stability of " + title, "stability map");
  page.answer(map.sentences);
  page.section(
      "Figure", page::all_figures(folder, [](const std::string&) {
        return "Longest stable time step over the model, each quantity of the scenario, and which "
               "failures were seen: theory as lines, measurements as points.";
      }));
  constexpr std::size_t most = 60;
  page.section("Limits", page::table_of_file("Limits of the time step, measured and by theory",
                                             limit_table(map), "stability.csv", most));
  page.section("Failures", page::table_of_file("Kinds of failure and whether they were seen",
                                               failure_table(map), "failures.csv", most));
  page.section("How it was made",
               page::making({.command = "palpate stability " + title + ".toml"}, {}, folder));
  page::write(std::move(page), folder);
  return folder.put(WholeFolder::State::complete, warnings);
}

}  // namespace palpate::stability
