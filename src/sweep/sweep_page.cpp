// report.html of a merged sweep.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "page/page.h"
#include "sweep/labels.h"
#include "sweep/response.h"

namespace palpate::sweep {
namespace {

// `case 3 (Young's modulus 5 kPa)`, by the number in results.csv
std::string case_text(const SweepColumns& columns, std::size_t at) {
  std::string text;
  for (const FactorColumn& factor : columns.factors) {
    const std::string label = factor_label(factor.choice);
    const std::size_t unit = std::min(label.find(" ("), label.size());
    const double value = factor.values[at];
    text += (text.empty() ? "" : ", ") + within_sentence(label.substr(0, unit)) + " " +
            (factor.is_number() ? rounded_text(value, 4)
                                : factor.words[static_cast<std::size_t>(value)]);
    if (unit < label.size()) text += " " + label.substr(unit + 2, label.size() - unit - 3);
  }
  return "case " + std::to_string(at + 1) + (text.empty() ? "" : " (" + text + ")");
}

// Which cases have the smallest and the largest value.
std::string extremes(const SweepColumns& columns, const OutputColumn& output) {
  const Ends range = ends(output.values);
  if (!(range.low < range.high)) return {};
  const auto at = [&](double value) {
    return static_cast<std::size_t>(std::find(output.values.begin(), output.values.end(), value) -
                                    output.values.begin());
  };
  return "Least in " + case_text(columns, at(range.low)) + ", largest in " +
         case_text(columns, at(range.high)) + ".";
}

// For each output its range, and the factor on which it depends most. The first range is above.
std::vector<std::string> sentences(const SweepColumns& columns, const Sensitivity& found) {
  std::vector<std::string> all;
  for (const OutputColumn& output : columns.outputs) {
    const Ends range = ends(output.values);
    if (!(range.low <= range.high)) continue;
    std::string sentence = &output == columns.outputs.data() ? "" : range_text(output);
    const SensitivityRow* strongest = nullptr;
    for (const SensitivityRow& row : found.indices)
      if (row.output == output.name && std::isfinite(row.indices.total.value) &&
          (strongest == nullptr || row.indices.total.value > strongest->indices.total.value))
        strongest = &row;
    if (strongest != nullptr)
      sentence += (sentence.empty() ? "" : ": ") + percent_text(strongest->indices.total.value) +
                  " of the variance follows `" + strongest->factor + "`";
    if (!sentence.empty()) all.push_back(sentence + ".");
  }
  return all;
}

std::string figure_words(const std::string& name) {
  if (name == "sensitivity")
    return "Share of the variance of each output that follows each swept key.";
  return output_label(name.substr(name.find('_') + 1)) + " over the swept keys.";
}

}  // namespace

std::string range_text(const OutputColumn& output) {
  const Ends range = ends(output.values);
  const std::string label = output_label(output.name);
  const std::size_t unit = std::min(label.find(" ("), label.size());
  std::string text = label.substr(0, unit) + " " + rounded_text(range.low, 3) + " to " +
                     rounded_text(range.high, 3);
  if (unit < label.size()) text += " " + label.substr(unit + 2, label.size() - unit - 3);
  return text;
}

void write_sweep_page(const SweepShown& shown, WholeFolder& folder) {
  const Sensitivity& found = shown.found;
  page::Page page(shown.title, "sweep");
  if (!shown.columns.outputs.empty()) {
    const OutputColumn& first = shown.columns.outputs.front();
    page.headline(range_text(first), shown.answer.error());
    if (const std::string cases = extremes(shown.columns, first); !cases.empty())
      page.answer({cases});
  }
  page.answer(shown.answer.lines());
  page.answer(sentences(shown.columns, found));
  page.answer({shown.totals});
  page.section("Figures", page::all_figures(folder, figure_words));
  constexpr std::size_t most = 100;
  page::Markup tables;
  if (!found.indices.empty())
    tables += page::table_of_file(
        "Shares of the variance",
        page::columns_of(sensitivity_table(found),
                         {"output", "factor", "first_order", "total", "total_low", "total_high"}),
        "sensitivity.csv", most);
  if (!found.correlations.empty())
    tables +=
        page::table_of_file("Rank correlations", correlation_table(found), "correlation.csv", most);
  page.section("Sensitivity", tables);
  page.section("Warnings", page::paragraphs(shown.warnings));
  constexpr auto folded = page::Page::Shown::folded;
  page.section("Scenario", page::folded("The scenario as written", shown.scenario), folded);
  page.section("How it was made", page::making({.command = shown.command}, {}, folder), folded);
  page::write(std::move(page), folder);
}

}  // namespace palpate::sweep
