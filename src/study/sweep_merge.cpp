// Three passes, none of which holds more than a row: swept values, names of results, the table.
#include "study/sweep_merge.h"

#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "base/error.h"
#include "base/files.h"
#include "record/csv.h"
#include "record/record.h"
#include "study/sweep_slurm.h"
#include "study/swept_columns.h"

namespace palpate::study {
namespace {

namespace fs = std::filesystem;

// A table that is written while it grows.
class TableFile {
 public:
  TableFile(const std::string& folder, const std::string& name, std::vector<std::string> columns)
      : name_(name), file_((fs::path(folder) / name).string()), held_{std::move(columns), {}} {}

  void add(std::vector<record::Cell> row) {
    held_.rows.push_back(std::move(row));
    if (held_.rows.size() >= 2000) flush();
  }
  // The file's name and hash.
  std::pair<std::string, std::string> finish() {
    flush();
    file_.sync();
    return {name_, hash_.digits()};
  }

 private:
  void flush() {
    std::string text = record::csv_text(held_);
    if (begun_) text.erase(0, text.find('\n') + 1);
    begun_ = true;
    hash_.add(text);
    file_.append(text);
    held_.rows.clear();
  }

  std::string name_;
  GrowingFile file_;
  record::Table held_;
  Sha256 hash_;
  bool begun_ = false;
};

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

// The names of results, in the order of their first appearance in the plan.
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

// What is written, file by file.
using Written = std::vector<std::pair<std::string, std::string>>;

class Merge {
 public:
  Merge(const SweepPlan& plan, const SweepResults& results, std::string folder)
      : plan_(plan), results_(results), folder_(std::move(folder)) {}

  Written write() {
    for (const std::string& key : plan_.family.design.keys()) swept_.emplace_back(key);
    for_each_case(plan_, [&](std::size_t, std::vector<record::Cell>&& values) {
      for (std::size_t i = 0; i < swept_.size(); ++i) swept_[i].see(values[i]);
    });
    for (std::size_t i = 0; i < plan_.count(); ++i)
      if (results_.at(i).known()) found_.see(results_.row(i));
    Written written{write_results()};
    if (plan_.curves) written.push_back(write_curves());
    return written;
  }

 private:
  std::pair<std::string, std::string> write_results() {
    std::vector<std::string> columns{"number", "id"};
    for (const SweptColumn& one : swept_) columns.push_back(one.name());
    columns.insert(columns.end(), {"outcome", "reason"});
    const std::size_t fixed = columns.size();
    columns.insert(columns.end(), found_.names().begin(), found_.names().end());
    const std::size_t width = columns.size();
    TableFile file(folder_, "results.csv", std::move(columns));
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
    return file.finish();
  }

  std::pair<std::string, std::string> write_curves() {
    const bool uniform = plan_.family.base.uniform();
    TableFile file(folder_, uniform ? "strain_time.csv" : "force_indentation.csv",
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
    return file.finish();
  }

  const SweepPlan& plan_;
  const SweepResults& results_;
  std::string folder_;
  std::vector<SweptColumn> swept_;
  ResultColumns found_;
};

std::string merged_text(const SweepPlan& plan, const SweepTotals& totals, const Written& written) {
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
  for (const auto& [name, hash] : written)
    json["files"].push_back({{"name", name}, {"sha256", hash}});
  return json.dump(2) + "\n";
}

bool is_complete(const fs::path& folder) {
  return fs::exists(folder / "merged.json") &&
         read_text((folder / "merged.json").string()).find("\"complete\": true") !=
             std::string::npos;
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error)
    throw SystemError(from.string() + " cannot be renamed to " + to.string() + ": " +
                      error.message());
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

std::string merge_sweep(const SweepPlan& plan, const SweepResults& results,
                        const SweepTotals& totals, Replace replace) {
  const fs::path place = fs::path(plan.folder) / "merged";
  if (replace == Replace::incomplete && is_complete(place))
    throw InputError({place.string(), 0, 0}, "is complete already; give `--force` to replace it");
  const std::string suffix = ".partial-" + std::to_string(::getpid());
  const fs::path beside = place.string() + suffix;
  std::error_code error;
  fs::remove_all(beside, error);
  fs::create_directories(beside, error);
  if (error) throw SystemError(beside.string() + " cannot be made: " + error.message());
  try {
    const Written written = Merge(plan, results, beside.string()).write();
    write_atomically((beside / "merged.json").string(), merged_text(plan, totals, written));
  } catch (...) {
    fs::remove_all(beside, error);
    throw;
  }
  if (fs::exists(place)) {
    const fs::path aside = place.string() + ".old" + suffix;
    move(place, aside);
    move(beside, place);
    fs::remove_all(aside, error);
  } else {
    move(beside, place);
  }
  return place.string();
}

}  // namespace palpate::study
