// Lines of CSV, each written whole or not at all.
#include "study/chart_journal.h"

#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "record/csv.h"

namespace palpate::study {
namespace {

namespace fs = std::filesystem;
using record::Cell;

// Of journal.csv; seconds and ratios.
const std::vector<std::string> columns{
    "case",        "variant",  "status",         "note",      "model",       "coupling",
    "integrator",  "rings",    "substep_s",      "substeps",  "nodes",       "tetrahedra",
    "simulated_s", "first_s",  "greatest_error", "end_error", "rms_error",   "time_greatest",
    "time_end",    "time_rms", "time_floor",     "build_s",   "first_row_s", "whole_s"};

double number(const Cell& cell) {
  const auto* value = std::get_if<double>(&cell);
  return value != nullptr ? *value : 0.0;
}
std::string word(const Cell& cell) {
  const auto* value = std::get_if<std::string>(&cell);
  return value != nullptr ? *value : "";
}

void put(std::vector<Cell>& row, const std::optional<Deviation>& deviation) {
  for (const auto part : {&Deviation::greatest, &Deviation::at_end, &Deviation::rms})
    if (deviation)
      row.emplace_back((*deviation).*part);
    else
      row.emplace_back();
}

std::optional<Deviation> get(const std::vector<Cell>& row, std::size_t at) {
  if (std::holds_alternative<std::monostate>(row[at])) return std::nullopt;
  return Deviation{number(row[at]), number(row[at + 1]), number(row[at + 2])};
}

std::vector<Cell> line_of(const Measurement& one) {
  std::vector<Cell> row{static_cast<double>(one.variant.of_case),
                        one.variant.name,
                        status_word(one.status),
                        one.note,
                        one.model,
                        one.coupling,
                        one.integrator,
                        one.rings,
                        one.substep,
                        static_cast<double>(one.substeps),
                        static_cast<double>(one.nodes),
                        static_cast<double>(one.tetrahedra),
                        one.simulated,
                        one.first_simulated};
  put(row, one.error);
  put(row, one.time_error);
  row.emplace_back(one.time_floor);
  if (one.timings.empty())
    row.resize(row.size() + 3);
  else
    for (const auto part : {&Timing::build, &Timing::first_row, &Timing::whole})
      row.emplace_back(one.timings.back().*part);
  return row;
}

Measurement of_line(const std::vector<Cell>& row) {
  Measurement one;
  one.variant.of_case = static_cast<std::size_t>(number(row[0]));
  one.variant.name = word(row[1]);
  for (const Status status : {Status::measured, Status::diverged, Status::cannot, Status::not_run})
    if (word(row[2]) == status_word(status)) one.status = status;
  one.note = word(row[3]);
  one.model = word(row[4]);
  one.coupling = word(row[5]);
  one.integrator = word(row[6]);
  one.rings = word(row[7]);
  one.substep = number(row[8]);
  one.substeps = static_cast<int>(number(row[9]));
  one.nodes = static_cast<int>(number(row[10]));
  one.tetrahedra = static_cast<int>(number(row[11]));
  one.simulated = number(row[12]);
  one.first_simulated = number(row[13]);
  one.error = get(row, 14);
  one.time_error = get(row, 17);
  one.time_floor = number(row[20]);
  if (!std::holds_alternative<std::monostate>(row[23]))
    one.timings.push_back({number(row[21]), number(row[22]), number(row[23])});
  return one;
}

}  // namespace

Journal::Journal(std::string folder, const std::string& identity, bool afresh)
    : folder_(std::move(folder)) {
  std::error_code error;
  if (afresh) fs::remove_all(folder_, error);
  const std::string named = (fs::path(folder_) / "identity.txt").string();
  if (fs::exists(folder_)) {
    if (!fs::exists(named) || read_text(named) != identity)
      throw InputError({folder_, 0, 0},
                       "holds the beginning of a chart of another scenario, other settings or "
                       "another version; give another `--out`, or begin afresh with `--force`");
    read();
    return;
  }
  fs::create_directories(folder_, error);
  if (error) throw SystemError("`" + folder_ + "` cannot be made: " + error.message());
  write_atomically(named, identity);
}

void Journal::read() {
  const std::string path = (fs::path(folder_) / "journal.csv").string();
  if (!fs::exists(path)) return;
  std::string text = read_text(path);
  text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);
  write_atomically(path, text);  // what is appended next begins a line
  if (text.empty()) return;
  const record::Table table = record::parse_csv(text, path);
  if (table.columns != columns)
    throw InputError({path, 1, 0}, "has other columns; begin afresh with `--force`");
  for (const std::vector<Cell>& row : table.rows) {
    Measurement one = of_line(row);
    const auto key = std::make_pair(one.variant.of_case, one.variant.name);
    const auto known = kept_.find(key);
    if (known == kept_.end())
      kept_.emplace(key, std::move(one));
    else
      known->second.timings.insert(known->second.timings.end(), one.timings.begin(),
                                   one.timings.end());
  }
}

std::optional<Measurement> Journal::find(const Variant& variant) const {
  const auto known = kept_.find({variant.of_case, variant.name});
  if (known == kept_.end()) return std::nullopt;
  Measurement one = known->second;
  one.variant = variant;
  return one;
}

void Journal::add(const Measurement& measurement) {
  const std::string path = (fs::path(folder_) / "journal.csv").string();
  std::string text = record::csv_text({columns, {line_of(measurement)}});
  const bool begun = fs::exists(path) && fs::file_size(path) > 0;
  if (begun) text.erase(0, text.find('\n') + 1);
  std::FILE* file = std::fopen(path.c_str(), "ab");
  if (file == nullptr) throw SystemError("`" + path + "` cannot be written");
  const bool good = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  if ((std::fclose(file) != 0) || !good) throw SystemError("`" + path + "` cannot be written");
  kept_[{measurement.variant.of_case, measurement.variant.name}] = measurement;
}

std::optional<record::Table> Journal::find_reference(const std::string& name) const {
  const std::string path = (fs::path(folder_) / (name + ".csv")).string();
  if (!fs::exists(path)) return std::nullopt;
  return record::read_csv(path);
}

void Journal::add_reference(const std::string& name, const record::Table& table) const {
  write_atomically((fs::path(folder_) / (name + ".csv")).string(), record::csv_text(table));
}

void Journal::finish(const std::string& place) const {
  std::error_code error;
  for (const char* name : {"identity.txt", "journal.csv"})
    fs::remove(fs::path(folder_) / name, error);
  fs::remove_all(place, error);
  fs::rename(folder_, place, error);
  if (error) throw SystemError("`" + place + "` cannot be made: " + error.message());
}

record::Table history_table(const Truth& truth) {
  record::Table table{{"step", "time_s", "value", "own_error", "kind", "sentence"}, {}};
  for (const Moment& moment : truth.moments)
    table.rows.push_back({static_cast<double>(moment.step), moment.time, moment.value, moment.error,
                          truth.kind, truth.sentence});
  return table;
}

Truth truth_of(const record::Table& table) {
  Truth truth;
  for (const std::vector<Cell>& row : table.rows) {
    truth.moments.push_back(
        {static_cast<int>(number(row[0])), number(row[1]), number(row[2]), number(row[3])});
    truth.kind = word(row[4]);
    truth.sentence = word(row[5]);
  }
  return truth;
}

}  // namespace palpate::study
