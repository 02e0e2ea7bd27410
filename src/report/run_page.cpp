// Puts the page of a run together.
#include "report/run_page.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "page/page.h"
#include "report/answer_lines.h"
#include "report/finding_words.h"
#include "report/map_picture.h"
#include "report/paper_section.h"
#include "report/scene_view.h"

namespace palpate::report {
namespace {

using page::element;
using page::Markup;
using page::text;
using Records = std::vector<record::CaseRecord>;

constexpr std::size_t most_columns = 6;  // cases of a table with one column per case

std::string figure_words(const plot::Figure& figure) {
  std::string words = figure.y_label + " against " + figure.x_label;
  if (figure.series.size() > 1) words += ", " + std::to_string(figure.series.size()) + " curves";
  if (figure.bar) words += "; the colour is " + figure.bar->label;
  if (figure.y_axis == plot::Axis::logarithmic) words += "; logarithmic scale";
  return words + ".";
}

Markup figures(const RunShown& shown, const WholeFolder& folder) {
  std::vector<page::ShownFigure> all;
  for (const plot::Figure& figure : shown.figures) {
    std::vector<std::string> data;
    for (const plot::Series& series : figure.series)
      if (std::find(data.begin(), data.end(), series.csv_file) == data.end())
        data.push_back(series.csv_file);
    all.push_back({figure.name, figure_words(figure), data});
  }
  return page::figures(all, folder);
}

// One row per finding, one column per case.
Markup findings_by_case(const Records& records) {
  Markup all;
  for (std::size_t group = 0; group < finding_groups().size(); ++group) {
    record::Table table{{"finding"}, {}};
    std::vector<std::string> names;
    for (const record::CaseRecord& record : records) {
      table.columns.push_back(record.name);
      for (const record::Finding& finding : record.findings)
        if (words_of_finding(finding.name).group == group &&
            std::find(names.begin(), names.end(), finding.name) == names.end())
          names.push_back(finding.name);
    }
    if (names.empty()) continue;
    for (const std::string& name : names) {
      std::vector<record::Cell> row{words_of_finding(name).label};
      for (const record::CaseRecord& record : records) {
        const auto found =
            std::find_if(record.findings.begin(), record.findings.end(),
                         [&](const record::Finding& finding) { return finding.name == name; });
        row.push_back(found == record.findings.end() ? record::Cell()
                                                     : record::Cell(finding_text(*found)));
      }
      table.rows.push_back(row);
    }
    const FindingGroup& words = finding_groups()[group];
    all += element("h3", words.heading) + page::table(std::string(words.sentence), table);
  }
  return all + element("p", text("The names and all digits are in ") +
                                page::link("findings.csv", "findings.csv") + text("."));
}

// Of many cases the main findings, one row per case.
Markup findings_by_row(const Records& records) {
  record::Table table{{"case"}, {}};
  const std::vector<std::string> names{"outcome",        "model",       "peak_force_N",
                                       "peak_travel_mm", "peak_strain", "stated_error"};
  std::vector<std::string> used;
  for (const std::string& name : names)
    for (const record::CaseRecord& record : records)
      if (std::any_of(record.findings.begin(), record.findings.end(),
                      [&](const auto& finding) { return finding.name == name; })) {
        used.push_back(name);
        table.columns.push_back(words_of_finding(name).label);
        break;
      }
  for (const record::CaseRecord& record : records) {
    std::vector<record::Cell> row{record.name};
    for (const std::string& name : used) {
      record::Cell cell;
      for (const record::Finding& finding : record.findings)
        if (finding.name == name) cell = finding_text(finding);
      row.push_back(cell);
    }
    table.rows.push_back(row);
  }
  constexpr std::size_t most = 200;
  return page::table_of_file("The main findings of every case", table, "findings.csv", most);
}

// An estimate with the digits that its interval gives it.
std::string digits_of(double value, double low, double high) {
  const double half = 0.5 * (high - low);
  if (!std::isfinite(half) || half <= 0.0 || value == 0.0) return rounded_text(value);
  const int digits = static_cast<int>(std::floor(std::log10(std::abs(value)))) -
                     static_cast<int>(std::floor(std::log10(half))) + 2;
  return rounded_text(value, std::clamp(digits, 1, 6));
}

Markup fits(const std::vector<fit::NamedFit>& fits) {
  record::Table table{{"case", "curve", "law", "parameter", "estimate", "95 % interval", "R²"}, {}};
  for (const fit::NamedFit& named : fits)
    for (const fit::Estimate& one : named.fit.parameters) {
      const auto number = [&](double value) {
        return digits_of(value, one.ci95_low, one.ci95_high);
      };
      const std::string unit = one.unit.empty() ? "" : " " + one.unit;
      table.rows.push_back(
          {named.case_name, named.curve, std::string(fit::info(named.fit.model).name), one.name,
           number(one.estimate) + unit,
           std::isfinite(one.ci95_low) ? number(one.ci95_low) + " to " + number(one.ci95_high)
                                       : std::string("unknown"),
           rounded_text(named.fit.r2, 5)});
    }
  if (table.rows.empty()) return {};
  constexpr std::size_t most = 60;
  return element("p",
                 "Curves fitted to the computed rows. The interval holds if the law is right and "
                 "the residuals are independent; an R² below 0.99 says that the law is wrong.") +
         page::table_of_file("Fits", table, "fits.csv", most);
}

Markup remarks(const Records& records) {
  Markup items;
  for (const record::CaseRecord& record : records)
    for (const std::string& remark : record.remarks)
      items += element(
          "li", page::sentence((records.size() > 1 ? record.name + ": " : "") + remark + "."));
  return items.empty() ? items : element("ul", items);
}

Markup maps(const Records& records) {
  constexpr std::size_t most = 12;
  Markup pictures;
  std::size_t count = 0;
  for (const record::CaseRecord& record : records)
    for (const record::PressureMap& map : record.maps)
      if (count++ < most) pictures += map_picture(map, records.size() > 1 ? record.name : "");
  if (count == 0) return {};
  Markup all = element("p",
                       "Pressure of the finger on the tissue at the end of each step, seen "
                       "from above; without colour: no contact.") +
               element("div", pictures, {{"class", "maps"}});
  if (count > most)
    all += element("p", "The first " + std::to_string(most) + " of " + std::to_string(count) +
                            " maps; all of them are in the files pressure_NNN.exr.");
  return all;
}

Markup asked(const scenario::Family& family, const std::string& echo) {
  return page::folded("The scenario as written", family.inputs.front().content) +
         page::folded("The scenario with all defaults and choices, scenario.toml", echo);
}

}  // namespace

void write_run_page(const RunShown& shown, WholeFolder& folder) {
  const scenario::Family& family = shown.family;
  const Records& records = shown.records;
  page::Page page(family.title, "run");
  page.answer(answer_lines(records));
  for (const record::CaseRecord& record : records)
    if (!record.answer.verdict.empty())
      page.answer({"Beside the device: " + record.answer.verdict + "."});
  page.section("Figures", figures(shown, folder));
  page.section("Beside the paper", paper_section(family, records, shown.fits));
  page.section("Remarks", remarks(records));
  page.section("Findings", records.size() <= most_columns ? findings_by_case(records)
                                                          : findings_by_row(records));
  page.section("Fits", fits(shown.fits));
  page.section("Pressure maps", maps(records));
  if (!records.empty() && !records.front().picture.faces.empty()) {
    page.section("Scene", scene_view(records.front().picture, family.title));
    page.script(scene_script());
  }
  page.section("What was asked", asked(family, read_text(folder.file("scenario.toml"))));
  std::vector<HashedFile> inputs;
  for (const scenario::InputFile& input : family.inputs)
    inputs.push_back({input.name, sha256(input.content)});
  const bool live = std::any_of(records.begin(), records.end(),
                                [](const auto& record) { return !record.measured.empty(); });
  page.section(
      "How it was made",
      page::making({.command = "palpate run scenario.toml",
                    .remark = live ? "A live run follows its device, so that this command repeats "
                                     "the programme and not the motion of the device."
                                   : ""},
                   inputs, folder));
  page::write(std::move(page), folder);
}

}  // namespace palpate::report
