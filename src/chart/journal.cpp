// Writes measurements as rows of a journal and reads them.
#include "chart/journal.h"

#include <filesystem>
#include <type_traits>

#include "base/error.h"
#include "record/csv.h"

namespace palpate::chart {
namespace {

namespace fs = std::filesystem;

// Calls `see` with every column and its value, except those that identify a row: one list for
// writing and reading. A missing timing or deviation has no columns.
template <class One, class See>
void for_each_column(One& one, const See& see) {
  see("note", one.note);
  see("model", one.model);
  see("coupling", one.coupling);
  see("integrator", one.integrator);
  see("rings", one.rings);
  see("substep_s", one.substep);
  see("substeps", one.substeps);
  see("nodes", one.nodes);
  see("tetrahedra", one.tetrahedra);
  see("simulated_s", one.simulated);
  see("first_s", one.first_simulated);
  see("time_floor", one.time_floor);
  const auto deviation = [&](const std::string& name, auto& from) {
    if (!from) return;
    see("greatest_" + name, from->greatest);
    see("end_" + name, from->at_end);
    see("rms_" + name, from->rms);
  };
  deviation("error", one.error);
  deviation("time_error", one.time_error);
  if (one.surface_error) see("surface_error", *one.surface_error);
  if (one.timings.empty()) return;
  see("build_s", one.timings.back().build);
  see("first_row_s", one.timings.back().first_row);
  see("whole_s", one.timings.back().whole);
}

record::Table row_of(const Measurement& one) {
  record::Table row{
      {"case", "variant", "status"},
      {{static_cast<double>(one.variant.of_case), one.variant.name, status_word(one.status)}}};
  for_each_column(one, [&](const std::string& column, const auto& value) {
    row.columns.push_back(column);
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>)
      row.rows.front().emplace_back(static_cast<double>(value));
    else
      row.rows.front().emplace_back(value);
  });
  return row;
}

// Nothing if a column is missing or invalid.
std::optional<Measurement> measurement_of(const record::Table& row) {
  Measurement one;
  const auto has = [&](const char* column) { return row.find(column) >= 0; };
  if (has("greatest_error")) one.error.emplace();
  if (has("greatest_time_error")) one.time_error.emplace();
  if (has("surface_error")) one.surface_error.emplace();
  if (has("whole_s")) one.timings.emplace_back();
  bool good = true;
  const auto read = [&](const std::string& column, auto& value) {
    using Value = std::decay_t<decltype(value)>;
    using InRow = std::conditional_t<std::is_arithmetic_v<Value>, double, std::string>;
    const auto* found = record::value_in<InRow>(row, column);
    good = good && found != nullptr;
    if (found != nullptr) value = static_cast<Value>(*found);
  };
  for_each_column(one, read);
  read("case", one.variant.of_case);
  read("variant", one.variant.name);
  std::string status;
  read("status", status);
  for (const Status each : {Status::measured, Status::diverged, Status::cannot, Status::not_run})
    if (status == status_word(each)) {
      one.status = each;
      if (good) return one;
    }
  return std::nullopt;
}

}  // namespace

Journal::Journal(const std::string& folder, const std::string& identity, Replace replace)
    : folder_(folder), files_(record::journal_files(folder)) {
  using Whose = record::JournalFile::Whose;
  const std::string hash = sha256(identity);
  if (fs::exists(fs::path(folder) / "identity.txt"))
    throw InputError({folder, 0, 0},
                     "holds the beginning of a chart of an earlier version of palpate, which this "
                     "one cannot read; remove it, or give another `--out`");
  if (replace == Replace::any) remove();
  for (const std::string& path : record::journal_files(folder)) {
    const record::JournalFile file = record::read_journal(
        path, hash, [&](const record::Table& row, const FileLine&) { return read(row); });
    if (file.whose == Whose::another)
      throw InputError({folder, 0, 0},
                       "holds the beginning of a chart of another scenario, other settings or "
                       "another version; give another `--out`, or begin afresh with `--force`");
    for (std::string& warning : file.warnings()) warnings_.push_back(std::move(warning));
  }
  file_.emplace(folder, "chart", hash);
  files_.push_back(file_->path());
}

bool Journal::read(const record::Table& row) {
  if (const auto* name = record::value_in<std::string>(row, "reference")) {
    const auto* moments = record::value_in<std::string>(row, "moments");
    if (moments != nullptr) references_[*name] = record::parse_csv(*moments, *name);
    return moments != nullptr;
  }
  auto one = measurement_of(row);
  if (!one) return false;
  const auto [known, is_new] =
      kept_.try_emplace(std::pair(one->variant.of_case, one->variant.name), *one);
  if (!is_new)
    known->second.timings.insert(known->second.timings.end(), one->timings.begin(),
                                 one->timings.end());
  return true;
}

std::optional<Measurement> Journal::find(const Variant& variant) const {
  const auto known = kept_.find({variant.of_case, variant.name});
  if (known == kept_.end()) return std::nullopt;
  Measurement one = known->second;
  one.variant = variant;
  return one;
}

void Journal::add(const Measurement& measurement) {
  file_->add(row_of(measurement));
  kept_[{measurement.variant.of_case, measurement.variant.name}] = measurement;
}

void Journal::add_reference(const std::string& name, const record::Table& table) {
  file_->add({{"reference", "moments"}, {{name, record::csv_text(table)}}});
  references_[name] = table;
}

Journal::~Journal() {
  if (kept_.empty() && references_.empty()) remove();
}

void Journal::remove() const {
  std::error_code ignored;
  for (const std::string& path : files_) fs::remove(path, ignored);
  fs::remove(folder_, ignored);
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
  for (const std::vector<record::Cell>& row : table.rows) {
    truth.moments.push_back({static_cast<int>(std::get<double>(row[0])), std::get<double>(row[1]),
                             std::get<double>(row[2]), std::get<double>(row[3])});
    truth.kind = std::get<std::string>(row[4]);
    truth.sentence = std::get<std::string>(row[5]);
  }
  return truth;
}

record::Table surface_table(const run::SurfaceReference& surface) {
  record::Table table{{"x_m", "y_m", "z_m", "displacement_x_m", "displacement_y_m",
                       "displacement_z_m", "area_m2", "own_error"},
                      {}};
  for (const run::DisplacedPiece& piece : surface.pieces) {
    auto& row = table.rows.emplace_back(piece.place.begin(), piece.place.end());
    row.insert(row.end(), piece.displacement.begin(), piece.displacement.end());
    row.insert(row.end(), {piece.area, surface.error});
  }
  return table;
}

run::SurfaceReference surface_of(const record::Table& table) {
  run::SurfaceReference surface;
  for (const std::vector<record::Cell>& row : table.rows) {
    const auto number = [&](std::size_t column) { return std::get<double>(row[column]); };
    surface.pieces.push_back(
        {{number(0), number(1), number(2)}, {number(3), number(4), number(5)}, number(6)});
    surface.error = number(7);
  }
  return surface;
}

}  // namespace palpate::chart
