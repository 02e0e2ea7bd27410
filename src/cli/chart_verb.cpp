// `palpate chart`: measures speed against accuracy and writes OUT/SCENARIO_chart.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>

#include "base/index.h"
#include "base/stop_scope.h"
#include "base/text.h"
#include "base/whole_folder.h"
#include "chart/journal.h"
#include "chart/table.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "page/page.h"
#include "record/csv.h"
#include "report/results.h"
#include "scenario/tested.h"

namespace palpate::cli {
namespace {

// Fingerprint of a call, which continues with the measurements of one that has the same.
std::string identity(const scenario::Family& family) {
  return program_identity() + "\n" + report::origin_of(family);
}

std::string progress_text(const chart::ChartProgress& progress) {
  if (progress.all == 0) return progress.what;
  std::string text = bar(as_index(progress.done), as_index(progress.all));
  if (progress.left) text += ", " + duration_text(*progress.left) + " left";
  return text + ", " + progress.what;
}

// Draws chart.svg, or one figure per case. Returns warnings on figures that could not be drawn.
std::vector<std::string> draw_all(const std::vector<chart::CaseChart>& charts,
                                  const scenario::Family& family, WholeFolder& folder) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const chart::CaseChart& chart = charts[i];
    const bool several = charts.size() > 1;
    if (const auto sheet =
            chart::scatter_sheet(chart, several ? "chart_" + std::to_string(i + 1) : "chart",
                                 family.title + (several ? ", " + chart.name : "")))
      plot::draw(*sheet, folder, warnings);
  }
  return warnings;
}

// The cheapest variant that is good enough, or the nearest one.
void add_headline(page::Page& page, const chart::CaseChart& chart) {
  const chart::Verdict verdict = chart::judge(chart);
  const auto& best = verdict.cheapest_within ? verdict.cheapest_within : verdict.nearest;
  if (!best) return;
  const chart::Measurement& row = chart.rows[*best];
  const bool told = row.model.empty() || row.variant.name.find(row.model) != std::string::npos;
  page.headline(row.variant.name + (told ? "" : " (" + row.model + ")"),
                "± " + percent_text(verdict.error[*best]) + ", " +
                    rounded_text(verdict.cost[*best], 2) + " µs per simulated ms: " +
                    (verdict.cheapest_within ? "the cheapest within" : "the nearest to") +
                    " the tolerance of " + percent_text(chart.tolerance));
}

// `yes` and nothing for 1 and 0 in the columns that mark configurations.
record::Table with_words(record::Table table) {
  for (const char* mark : {"pareto", "knee", "auto"})
    if (const int at = table.find(mark); at >= 0)
      for (auto& row : table.rows)
        if (const auto* number = std::get_if<double>(&row[as_index(at)]))
          row[as_index(at)] = std::string(*number == 1.0 ? "yes" : "");
  return table;
}

// The page of a chart.
void write_page(const scenario::Family& family, const std::vector<chart::CaseChart>& charts,
                const record::Table& table, WholeFolder& folder) {
  page::Page page(family.title, "chart of speed and accuracy");
  std::vector<std::string> answer, more;
  const bool several = family.cases.size() > 1;
  if (charts.size() == 1) add_headline(page, charts.front());
  for (const chart::CaseChart& one : charts) {
    const chart::ChartSentences said = chart::chart_sentences(one);
    if (several)
      answer.insert(answer.end(), {one.name + ":", said.reference, said.result});
    else  // the headline says the configuration
      answer = {said.settings.empty() ? said.result : said.settings, said.reference};
    std::vector<std::string>& rest = several ? answer : more;
    rest.insert(rest.end(), said.more.begin(), said.more.end());
  }
  page.answer({joined(scenario::tested(family.cases.front(), family.design.keys()), "; ")});
  page.answer(answer);
  page.figures(page::all_figures(folder, [](const std::string&) {
    return "Error against cost of every configuration; the line joins those that no other beats in "
           "both.";
  }));
  constexpr std::size_t most = 200;
  page.section("In words", page::paragraphs(more), page::Page::Shown::folded);
  const bool displaced = std::ranges::any_of(
      charts, [](const chart::CaseChart& one) { return !one.surface.pieces.empty(); });
  std::vector<std::string> results{"configuration",
                                   "shown_error",
                                   "cost_us_per_ms",
                                   displaced ? "surface_error" : "total_s",
                                   "pareto",
                                   "knee",
                                   "auto"};
  if (several)
    results.insert(results.begin(), "case");
  else
    results.emplace_back("status");
  page.section("Configurations", page::table_of_file("Every configuration that was tried",
                                                     with_words(page::columns_of(table, results)),
                                                     "chart.csv", most));
  std::vector<std::string> rest = table.columns;  // each row is headed by its configuration
  std::erase_if(rest, [&](const std::string& name) {
    return name == "case" ? !several : std::ranges::find(results, name) != results.end();
  });
  rest.insert(rest.begin(), "configuration");
  page.section("Settings",
               page::table_of_file("Settings, and what else was measured",
                                   page::columns_of(table, rest), "chart.csv", most),
               page::Page::Shown::folded);
  page.section(
      "How it was made",
      page::making(
          {.command = "palpate chart " + family.name + ".toml",
           .note = "Costs are times of the machine that measured them: only the errors repeat."}),
      page::Page::Shown::folded);
  page::write(std::move(page), folder);
}

}  // namespace

int perform(const Chart& command, const Arguments&, const Talk& talk) {
  if (command.frames > 0) return time_frames(command, talk);
  if (command.scenario.empty())
    refuse(
        "`palpate chart` lacks `scenario`; name one, or give `--frames 1000` to time the paper's "
        "models");
  const chart::Asked asked = chart::read_for_chart(command.scenario, command.settings);
  const scenario::Family& family = asked.family;
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  const Replace replace = command.force ? Replace::any : Replace::incomplete;
  const std::string place =
      (std::filesystem::path(command.out) / (family.name + "_chart")).string();
  WholeFolder folder(place, "chart", replace, report::origin_of(family));
  folder.refuse_what_is_there();
  chart::Journal journal(place + ".partial", identity(family), replace);
  for (const std::string& warning : journal.warnings()) talk.warn(warning);
  if (journal.resumed()) talk.say("continues with the measurements in " + journal.folder());
  const StopScope scope(listen_for_interrupts(exit_resumable));
  std::vector<chart::CaseChart> charts;
  try {
    std::mutex telling;
    chart::ChartProgress now;
    const ProgressLine line(talk, [&](double) {
      const std::scoped_lock lock(telling);
      return progress_text(now);
    });
    charts = chart::measure(asked, {.repeats = command.repeats}, journal,
                            [&](const chart::ChartProgress& progress) {
                              const std::scoped_lock lock(telling);
                              now = progress;
                            });
  } catch (const Stopped&) {
    Talk::error("palpate: interrupted; " + journal.folder() +
                " keeps the measurements, and the same call continues from there");
    return exit_resumable;
  }
  const record::Table table = chart::chart_table(charts);
  const std::string text = "# " + family.title + "\n\n" + chart::chart_text(charts);
  folder.open();
  folder.write("chart.csv", record::csv_text(table));
  folder.write("chart.md", text);
  for (const auto& [name, moments] : journal.references())
    folder.write(name + ".csv", record::csv_text(moments));
  const std::vector<std::string> warnings = draw_all(charts, family, folder);
  write_page(family, charts, table, folder);
  const std::string missing = warn_all(folder.put(WholeFolder::State::complete, warnings), talk);
  journal.remove();
  print(talk.json() ? json_lines(table) : text);
  const std::string what = folder.path() + (missing.empty() ? ": chart.csv, chart.md and the figure"
                                                            : ": chart.csv and chart.md" + missing);
  if (!StopScope::stopped()) {
    talk.say(what);
    talk.next("open", folder.path());
    return exit_good;
  }
  Talk::error("palpate: interrupted; " + what);
  return exit_interrupted;
}

}  // namespace palpate::cli
