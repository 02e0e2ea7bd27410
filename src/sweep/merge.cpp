// Merges in three passes with one row in memory: swept values, names of results, the table.
#include "sweep/merge.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "base/files.h"
#include "base/text.h"
#include "record/csv.h"
#include "record/record.h"
#include "record/table.h"
#include "sweep/slurm.h"

namespace palpate::sweep {
namespace {

namespace fs = std::filesystem;

// Calls `see` with the swept values of every case, in order.
void for_each_case(const SweepPlan& plan,
                   const std::function<void(std::size_t, std::vector<record::Cell>&&)>& see) {
  const std::string path = (fs::path(plan.folder) / "plan.csv").string();
  std::string header;
  std::size_t index = 0;
  for_each_line(path, [&](const FileLine& line) {
    if (header.empty()) {
      header = std::string(line.text) + "\n";
      return;
    }
    record::Table one = record::parse_csv(header + std::string(line.text) + "\n", path);
    std::vector<record::Cell>& row = one.rows.front();
    see(index++, {std::make_move_iterator(row.begin() + 2), std::make_move_iterator(row.end())});
  });
}

class Merge {
 public:
  Merge(const SweepPlan& plan, const SweepResults& results, WholeFolder& folder)
      : plan_(plan), results_(results), folder_(folder) {}

  SweepAnswer write() {
    SweepAnswer answer;
    for (const std::string& key : plan_.family.design.keys()) swept_.emplace_back(key);
    for_each_case(plan_, [&](std::size_t, std::vector<record::Cell>&& values) {
      for (std::size_t i = 0; i < swept_.size(); ++i) swept_[i].see(values[i]);
    });
    for (std::size_t i = 0; i < plan_.count(); ++i) {
      if (!results_.at(i).known()) continue;
      const SweepRow row = results_.row(i);
      for (const record::Finding& value : row.values)
        if (found_.emplace(value.name, names_.size()).second) names_.push_back(value.name);
      answer.see(row, i + 1);
    }
    write_results();
    if (plan_.curves) write_curves();
    return answer;
  }

 private:
  void write_results() {
    std::vector<std::string> columns{"number", "id"};
    for (const record::SweptColumn& one : swept_) columns.push_back(one.name());
    columns.insert(columns.end(), {"outcome", "reason"});
    const std::size_t fixed = columns.size();
    columns.insert(columns.end(), names_.begin(), names_.end());
    const std::size_t width = columns.size();
    record::CsvFile file(folder_.file("results.csv"), std::move(columns));
    for_each_case(plan_, [&](std::size_t index, std::vector<record::Cell>&& values) {
      std::vector<record::Cell> cells(width);
      cells[0] = static_cast<double>(index + 1);
      cells[1] = id_text(plan_.ids[index]);
      for (std::size_t i = 0; i < swept_.size(); ++i) cells[i + 2] = swept_[i].cell(values[i]);
      cells[fixed - 2] = "missing";
      if (results_.at(index).known()) {
        SweepRow row = results_.row(index);
        cells[fixed - 2] = outcome_word(row.outcome);
        if (!row.reason.empty()) cells[fixed - 1] = std::move(row.reason);
        for (record::Finding& value : row.values)
          cells[fixed + found_.at(value.name)] = std::move(value.value);
      }
      file.add(std::move(cells));
    });
    file.finish();
    folder_.add({"results.csv"});
  }

  void write_curves() {
    const bool uniform = plan_.family.base.uniform();
    const char* name = uniform ? "strain_time.csv" : "force_indentation.csv";
    record::CsvFile file(folder_.file(name),
                         (uniform ? record::strain_table({}) : record::contact_table({})).columns);
    for (std::size_t i = 0; i < plan_.count(); ++i) {
      if (!results_.at(i).known()) continue;
      const SweepRow row = results_.row(i);
      for (const auto& values : row.curve.rows) {
        std::vector<record::Cell> cells{row.name};
        cells.insert(cells.end(), values.begin(), values.end());
        file.add(std::move(cells));
      }
    }
    file.finish();
    folder_.add({name});
  }

  const SweepPlan& plan_;
  const SweepResults& results_;
  WholeFolder& folder_;
  std::vector<record::SweptColumn> swept_;
  std::vector<std::string> names_;  // of results, by first occurrence in the order of the plan
  std::unordered_map<std::string, std::size_t> found_;  // their places
};

std::string merged_text(const SweepPlan& plan, const SweepTotals& totals,
                        const std::vector<HashedFile>& written) {
  nlohmann::ordered_json json;
  json["program"] = plan.program;
  json["plan_sha256"] = plan.hash;
  json["complete"] = totals.missing == 0;
  json["cases"] = totals.cases;
  json["completed"] = totals.completed;
  json["diverged"] = totals.diverged;
  json["failed"] = totals.failed;
  json["missing"] = totals.missing;
  json["files"] = nlohmann::ordered_json::array();
  for (const HashedFile& file : written)
    json["files"].push_back({{"name", file.path}, {"sha256", file.sha256}});
  return json.dump(2) + "\n";
}

}  // namespace

SweepTotals count_results(const SweepPlan& plan, const SweepResults& results) {
  SweepTotals totals{.cases = plan.count()};
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < plan.count(); ++i) {
    if (!results.at(i).known()) {
      missing.push_back(i + 1);
      continue;
    }
    const SweepOutcome outcome = results.at(i).head.outcome;
    totals.completed += outcome == SweepOutcome::completed ? 1 : 0;
    totals.diverged += outcome == SweepOutcome::diverged ? 1 : 0;
    totals.failed += outcome == SweepOutcome::failed ? 1 : 0;
    if (outcome != SweepOutcome::completed) ++totals.reasons[results.row(i).reason];
  }
  totals.missing = missing.size();
  totals.missing_numbers = number_ranges(missing, 12);
  return totals;
}

SweepAnswer merge_sweep(const SweepPlan& plan, const SweepResults& results,
                        const SweepTotals& totals, WholeFolder& folder) {
  SweepAnswer answer = Merge(plan, results, folder).write();
  const std::vector<std::string>& swept = plan.family.design.keys();
  if (std::ranges::find(swept, "solver.tolerance") == swept.end())
    answer.tolerance = percent_text(plan.family.base.solver.tolerance);
  folder.write("merged.json", merged_text(plan, totals, folder.files()));
  return answer;
}

namespace {

std::string of_cases(std::size_t count, std::size_t all) {
  return std::to_string(count) + " of " + std::to_string(all) + (all == 1 ? " case" : " cases");
}

}  // namespace

void SweepAnswer::see(const SweepRow& row, std::size_t number) {
  if (row.outcome != SweepOutcome::completed) return;
  ++cases_;
  const double* error = nullptr;
  for (const record::Finding& value : row.values) {
    if (value.name == "model")
      if (const auto* word = std::get_if<std::string>(&value.value)) ++models_[*word];
    if (value.name == "stated_error") error = std::get_if<double>(&value.value);
  }
  if (error == nullptr) {
    ++unknown_;
  } else {
    errors_.low = std::min(errors_.low, *error);
    errors_.high = std::max(errors_.high, *error);
    const std::string uncounted = record::uncounted(row.neglected);
    if (!uncounted.empty()) ++uncounted_cases_;
    if (uncounted.size() > uncounted_.size()) uncounted_ = uncounted;
  }
  for (const record::Neglected& one : row.neglected) {
    auto effect = std::ranges::find(effects_, one.what, &Effect::what);
    if (effect == effects_.end()) effect = effects_.insert(effect, {.what = one.what});
    const double change = std::abs(one.change.value_or(0.0));
    if (effect->cases++ > 0 && change <= effect->largest) continue;
    effect->largest = change;
    effect->sentence = one.sentence();
    effect->number = number;
  }
}

std::string SweepAnswer::error() const {
  if (cases_ == 0) return {};
  if (unknown_ == cases_) return "error not known";
  const auto text = [](double error) {
    return error > 1.0 ? std::string("more than 100 %") : percent_text(error);
  };
  const std::string low = text(errors_.low), high = text(errors_.high);
  return "± " + low + (low == high ? "" : " to " + high) +
         (tolerance.empty() ? "" : " (tolerance " + tolerance + ")") +
         (unknown_ == 0 ? "" : ", not known in " + of_cases(unknown_, cases_)) +
         (uncounted_cases_ == 0 ? "" : ", not counting " + uncounted_) +
         (uncounted_cases_ % cases_ == 0 ? "" : " in " + of_cases(uncounted_cases_, cases_));
}

std::vector<std::string> SweepAnswer::lines() const {
  if (cases_ == 0) return {};
  std::string models;
  for (const auto& [model, count] : models_)
    models += (models.empty() ? "Model: " : ", ") + model + " in " + of_cases(count, cases_);
  std::vector<std::string> lines;
  if (!models.empty()) lines.push_back(models + ".");
  std::vector<Effect> effects = effects_;
  std::ranges::stable_sort(effects, std::ranges::greater(), &Effect::largest);
  for (const Effect& one : effects) {
    std::string line = "Neglected in " + of_cases(one.cases, cases_);
    if (one.cases > 1) line += ", most in case " + std::to_string(one.number);
    lines.push_back(line + ": " + one.sentence);
  }
  if (effects.empty())
    lines.emplace_back(
        "Neglected: nothing that would add more than a fifth of `solver.tolerance` to the error.");
  return lines;
}

}  // namespace palpate::sweep
