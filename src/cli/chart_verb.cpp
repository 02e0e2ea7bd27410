// `palpate chart`: speed against accuracy, into OUT/SCENARIO_chart.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "record/csv.h"
#include "report/machine.h"
#include "report/scatter.h"
#include "study/chart_journal.h"
#include "study/chart_table.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

// What two calls must share to go on with each other's measurements.
std::string identity(const scenario::Family& family) {
  const report::Build build = report::this_build();
  std::string text = "palpate " + build.version + ", " + build.type + ", " + build.compiler + ", " +
                     build.flags + "\n";
  for (const scenario::InputFile& input : family.inputs)
    text += input.name + " " + sha256(input.content) + "\n";
  return text + sha256(scenario::echo(family)) + "\n" + scenario::echo(family);
}

std::string bar(const study::ChartProgress& progress) {
  if (progress.all == 0) return progress.what;
  constexpr int width = 20;
  const int filled = width * progress.done / progress.all;
  std::string text = "[" + std::string(static_cast<std::size_t>(filled), '#') +
                     std::string(static_cast<std::size_t>(width - filled), '.') + "] " +
                     std::to_string(progress.done) + "/" + std::to_string(progress.all);
  if (progress.left) text += ", " + rounded_text(std::ceil(*progress.left), 2) + " s left";
  return text + ", " + progress.what;
}

// The words of a column's measured rows of a case, in their order of appearance.
std::vector<std::string> words_of(const study::CaseChart& chart,
                                  std::string study::Measurement::*column) {
  std::vector<std::string> words;
  for (const study::Measurement& one : chart.rows)
    if (one.status == study::Status::measured &&
        std::find(words.begin(), words.end(), one.*column) == words.end())
      words.push_back(one.*column);
  return words;
}

void set_series(const study::CaseChart& chart, const study::Verdict& verdict,
                report::Scatter& scatter) {
  const std::size_t any = verdict.front.front();
  scatter.least_cost = scatter.most_cost = verdict.cost[any];
  scatter.least_error = scatter.most_error = verdict.error[any];
  for (std::size_t i = 0; i < chart.rows.size(); ++i) {
    if (verdict.cost[i] <= 0.0) continue;
    const std::pair pair(chart.rows[i].model, chart.rows[i].integrator);
    if (std::find(scatter.series.begin(), scatter.series.end(), pair) == scatter.series.end())
      scatter.series.push_back(pair);
    for (const double cost : chart.rows[i].costs()) {
      scatter.least_cost = std::min(scatter.least_cost, cost);
      scatter.most_cost = std::max(scatter.most_cost, cost);
    }
    scatter.least_error = std::min(scatter.least_error, verdict.error[i]);
    scatter.most_error = std::max(scatter.most_error, verdict.error[i]);
  }
}

// chart.svg, or one a case.
void draw_all(const std::vector<study::CaseChart>& charts, const scenario::Family& family,
              const std::string& folder, const Talk& talk) {
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const study::CaseChart& chart = charts[i];
    const study::Verdict verdict = study::judge(chart);
    if (verdict.front.empty()) continue;
    const std::string title =
        family.title + (charts.size() > 1 ? ", " + chart.name : std::string());
    report::Scatter scatter{.name = charts.size() > 1 ? "chart_" + std::to_string(i + 1) : "chart",
                            .title = title,
                            .csv_file = "chart.csv",
                            .case_name = chart.name,
                            .models = words_of(chart, &study::Measurement::model),
                            .integrators = words_of(chart, &study::Measurement::integrator),
                            .floor = verdict.floor,
                            .tolerance = chart.tolerance};
    if (verdict.knee) scatter.marks.emplace_back("knee");
    if (verdict.taken) scatter.marks.emplace_back("auto");
    set_series(chart, verdict, scatter);
    const report::Drawing drawing = report::draw(report::scatter_sheet(scatter), folder);
    if (!drawing.warning.empty()) talk.warn(drawing.warning);
  }
}

}  // namespace

int chart(const Chart& command, const Arguments&, const Talk& talk) {
  const study::Asked asked = study::read_for_chart(command.scenario, command.settings);
  const scenario::Family& family = asked.family;
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  const fs::path folder = fs::path(command.out) / (family.name + "_chart");
  if (!command.force && fs::exists(folder))
    throw InputError({folder.string(), 0, 0},
                     "is there already; give another `--out`, or `--force` to replace it");
  study::Journal journal(folder.string() + ".partial", identity(family), command.force);
  if (journal.resumed()) talk.say("goes on with what " + journal.folder() + " holds");
  const std::atomic<bool>& stop = listen_for_interrupts(exit_resumable);
  const auto charts =
      study::measure(asked, {.repeats = command.repeats}, journal, stop,
                     [&](const study::ChartProgress& progress) { talk.progress(bar(progress)); });
  talk.progress("");
  if (!charts) {
    Talk::error("palpate: interrupted; " + journal.folder() +
                " keeps what was measured, and the same call goes on from there");
    return exit_resumable;
  }
  const std::string beside = journal.folder();
  const record::Table table = study::chart_table(*charts);
  const std::string text = "# " + family.title + "\n\n" + study::chart_text(*charts);
  write_atomically((fs::path(beside) / "chart.csv").string(), record::csv_text(table));
  write_atomically((fs::path(beside) / "chart.md").string(), text);
  draw_all(*charts, family, beside, talk);
  journal.finish(folder.string());
  print(talk.json() ? json_lines(table) : text);
  talk.say(folder.string() + ": chart.csv, chart.md and the figure");
  return exit_good;
}

}  // namespace palpate::cli
