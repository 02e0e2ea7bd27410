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

// The names of results, by first occurrence in the order of the plan.
class ResultColumns {
 public:
  void see(const SweepRow& row) {
    for (const record::Finding& value : row.values)
      if (numbers_.emplace(value.name, names_.size()).second) names_.push_back(value.name);
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] std::size_t number(const std::string& name) const { return numbers_.at(name); }

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::size_t> numbers_;
};

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
      found_.see(row);
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
    columns.insert(columns.end(), found_.names().begin(), found_.names().end());
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
          cells[fixed + found_.number(value.name)] = std::move(value.value);
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
  ResultColumns found_;
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
  if (std::find(swept.begin(), swept.end(), "solver.tolerance") == swept.end())
    answer.tolerance = percent_text(plan.family.base.solver.tolerance);
  folder.write("merged.json", merged_text(plan, totals, folder.files()));
  return answer;
}

}  // namespace palpate::sweep
