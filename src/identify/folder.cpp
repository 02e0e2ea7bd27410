// Writes the files of an identification, run.json last.
#include "identify/folder.h"

#include <algorithm>
#include <filesystem>

#include "base/shell_word.h"
#include "base/text.h"
#include "identify/tables.h"
#include "page/page.h"
#include "record/csv.h"
#include "report/manifest.h"

namespace palpate::identify {
namespace {

// The text of scenario.toml, with which `palpate run` repeats the fitted curve.
std::string echo_of(const identify::Identification& found, const scenario::Family& family) {
  scenario::Family one = family;
  one.cases.resize(1);
  one.cases.front().scenario = found.scenario;
  one.design = {};
  std::string text = "# Fitted to a measurement: `palpate run` of this file repeats the curve.\n";
  for (const identify::Identified& each : found.unknowns) {
    const identify::Unknown& unknown = each.unknown;
    const std::string value = rounded_text(unknown.shown(each.estimate), 6) +
                              (unknown.unit ? " " + unknown.unit_text() : "");
    if (each.inseparable)
      text +=
          "# " + unknown.name() + " is not determined by itself: one of many values that fit.\n";
    if (unknown.what == identify::Unknown::What::contact_point)
      text += "# Displacement 0 is at " + value + " of the measurement.\n";
    if (unknown.what == identify::Unknown::What::force_offset)
      text += "# contact.ambient_force holds the measurement's offset of " + value + ".\n";
  }
  return text + scenario::echo(one);
}

// The ending of the names of pair k's files.
std::string suffix_of(const Identification& found, std::size_t k) {
  return found.pairs.empty() ? "" : "_" + std::to_string(k + 1);
}

std::string figure_words(const std::string& name) {
  if (name.starts_with("profile"))
    return "How much worse the fit becomes if one value is fixed and the others are fitted; below "
           "the line the value is within the 95 % interval of the noise. What is not known of "
           "model, body and given values makes the stated interval wider.";
  return "Measured and fitted curve, and below them the residuals, measured minus model.";
}

// The arguments without those that change no result, run where the files lie.
std::string command_of(const std::vector<std::string>& argv, std::span<const PairFiles> pairs) {
  const auto file_of = [&](const std::string& word) {
    const std::string name = std::filesystem::path(word).filename().string();
    const bool known = std::any_of(pairs.begin(), pairs.end(), [&](const PairFiles& pair) {
      return word == pair.measured || name == pair.family->inputs.front().name;
    });
    return known ? name : word;
  };
  std::string text = "palpate";
  for (std::size_t i = 0; i < argv.size(); ++i) {
    const std::string& word = argv[i];
    if (word == "--out") ++i;
    const bool idle = word == "--force" || word == "--quiet" || word == "-q" || word == "--json" ||
                      word.starts_with("--out");
    if (!idle) text += " " + shown_word(file_of(word));
  }
  return text;
}

// The page of an identification: what was found, how well it fits, and what it depends on.
void write_page(const identify::Identification& found, std::span<const PairFiles> pairs,
                const std::vector<HashedFile>& inputs, const std::string& command,
                WholeFolder& folder) {
  page::Page page(pairs.front().family->title, "identification");
  // The first unknown large, the others and what the fit is below.
  std::vector<std::string> lines = identified_sentences(found);
  const identify::Identified& first = found.unknowns.front();
  if (const auto [value, interval] = estimate_texts(found, first); !interval.empty()) {
    page.headline(first.unknown.name() + " " + value, interval);
    lines.erase(lines.begin());
  } else if (!found.combinations.empty()) {
    const auto [known, its_interval] = estimate_texts(found.combinations.front());
    page.headline(known, its_interval);
  }
  page.answer(lines);
  page.section("Figures", page::all_figures(folder, figure_words));
  constexpr std::size_t most = 60;
  const record::Table table = identified_table(found);
  page.section("Estimates",
               page::table_of_file(
                   "Estimates with 95 % intervals",
                   page::columns_of(table, {"unknown", "estimate", "unit", "ci95_low", "ci95_high",
                                            "std_error", "identifiable", "at_bound"}),
                   "identified.csv", most) +
                   page::table_of_file("Correlation of the estimates", correlation_table(found),
                                       "correlation.csv", most));
  constexpr auto folded = page::Page::Shown::folded;
  page.section("Every column",
               page::table_of_file("Estimates and both intervals", table, "identified.csv", most),
               folded);
  std::vector<std::string> notes = found.notes;
  notes.insert(notes.end(), found.warnings.begin(), found.warnings.end());
  page.section("Notes", page::paragraphs(notes));
  page::Markup asked;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::string name = "scenario" + suffix_of(found, k) + ".toml";
    asked += page::folded("The scenario as written", pairs[k].family->inputs.front().content) +
             page::folded("The scenario with the estimates, " + name, read_text(folder.file(name)));
  }
  page.section("Scenario", asked, folded);
  page.section("How it was made",
               page::making({.command = command,
                             .note = "It runs where the files below lie. Here, `palpate run "
                                     "scenario" +
                                     suffix_of(found, 0) + ".toml` computes the fitted curve."},
                            inputs, folder),
               folded);
  page::write(std::move(page), folder);
}

}  // namespace

std::vector<std::string> write_identification(const Identification& found,
                                              std::span<const PairFiles> pairs,
                                              const report::Origin& origin, WholeFolder& folder) {
  std::vector<std::string> warnings;
  folder.open();
  std::vector<scenario::InputFile> read;  // by the scenarios, each file once
  const std::string& title = pairs.front().family->title;
  const std::vector<const Identification*> all = views(found);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::string suffix = suffix_of(found, k);
    folder.write("scenario" + suffix + ".toml", echo_of(*all[k], *pairs[k].family));
    for (const scenario::InputFile& input : pairs[k].family->inputs) {
      const bool known = std::any_of(read.begin(), read.end(),
                                     [&](const auto& one) { return one.name == input.name; });
      if (known) continue;
      if (&input != &pairs[k].family->inputs.front()) folder.write(input.name, input.content);
      read.push_back(input);
    }
    folder.write("residuals" + suffix + ".csv", record::csv_text(residual_table(*all[k])));
  }
  folder.write("identified.csv", record::csv_text(identified_table(found)));
  folder.write("correlation.csv", record::csv_text(correlation_table(found)));
  for (std::size_t k = 0; k < pairs.size(); ++k)
    plot::draw(identified_sheet(title, *all[k], suffix_of(found, k)), folder, warnings);
  if (!found.profile.empty()) {
    folder.write("profile.csv", record::csv_text(profile_table(found)));
    if (!is_exact(found)) plot::draw(profile_sheet(title, found), folder, warnings);
  }

  report::Manifest manifest{.origin = origin, .complete = true};
  for (const scenario::InputFile& input : read)
    manifest.inputs.push_back({input.name, sha256(input.content)});
  std::vector<HashedFile> inputs = manifest.inputs;
  for (const PairFiles& pair : pairs) {
    const std::string hash = file_sha256(pair.measured);
    inputs.push_back({std::filesystem::path(pair.measured).filename().string(), hash});
    manifest.inputs.push_back({pair.measured, hash});
  }
  write_page(found, pairs, inputs, command_of(origin.argv, pairs), folder);
  manifest.outputs = folder.files();
  folder.write("run.json", report::manifest_text(manifest));
  return folder.put(WholeFolder::State::complete, warnings);
}

}  // namespace palpate::identify
