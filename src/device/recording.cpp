// Reads and replays a recording. This room may not include `measured`, and reads CSV by itself.
#include "device/recording.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"

namespace palpate::device {
namespace {

struct Columns {
  int time = -1;
  int position[3] = {-1, -1, -1};
  int travel = -1;
  int force = -1;
};

Columns columns_of(const std::vector<std::string>& header, const std::string& file) {
  const auto find = [&](std::string_view name) {
    const auto at = std::find(header.begin(), header.end(), name);
    return at == header.end() ? -1 : static_cast<int>(at - header.begin());
  };
  Columns columns;
  columns.time = find("time_s");
  columns.position[0] = find("position_x_m");
  columns.position[1] = find("position_y_m");
  columns.position[2] = find("position_z_m");
  // The file of a live run has the model's travel and force as well.
  columns.travel = find("measured_travel_mm");
  if (columns.travel < 0) columns.travel = find("travel_mm");
  columns.force = find("measured_force_N");
  if (columns.force < 0) columns.force = find("force_N");
  const bool whole = *std::min_element(columns.position, columns.position + 3) >= 0;
  if (columns.time < 0)
    throw InputError({file, 1, 0},
                     "a recording wants a column `time_s`; give the column of times this name");
  if (!whole && columns.travel < 0)
    throw InputError({file, 1, 0},
                     "a recording wants a position; name it `travel_mm`, or `position_x_m`, "
                     "`position_y_m` and `position_z_m`");
  if (!whole) columns.position[0] = columns.position[1] = columns.position[2] = -1;
  return columns;
}

}  // namespace

std::vector<Sample> parse_recording(std::string_view text, const std::string& file) {
  const std::vector<std::string> lines = split(text, '\n');
  const auto fields_of = [&](const std::string& line) {
    std::vector<std::string> fields = split(line, ',');
    for (std::string& field : fields) field = trimmed(field);
    return fields;
  };
  const Columns columns = columns_of(fields_of(lines.front()), file);
  const std::size_t width = fields_of(lines.front()).size();
  std::vector<Sample> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (trimmed(lines[i]).empty()) continue;
    const Place place{file, static_cast<int>(i) + 1, 0};
    const std::vector<std::string> fields = fields_of(lines[i]);
    if (fields.size() != width)
      throw InputError(place, "the row has " + std::to_string(fields.size()) +
                                  " fields, the header " + std::to_string(width) +
                                  "; give every row one field per column");
    const auto number = [&](int column) {
      const auto value = whole_number(fields[as_index(column)]);
      if (!value || !std::isfinite(*value))
        throw InputError(
            place, "`" + fields[as_index(column)] + "` is no finite number; leave such rows out");
      return *value;
    };
    Sample row;
    row.arrival = Arrival::fresh;
    row.device_time = number(columns.time);
    if (columns.position[0] >= 0) {
      for (int axis = 0; axis < 3; ++axis) row.position[axis] = number(columns.position[axis]);
    } else {
      row.position.z() = -1e-3 * number(columns.travel);
    }
    if (columns.force >= 0 && !fields[as_index(columns.force)].empty())
      row.force = number(columns.force);
    if (!rows.empty()) {
      const double dt = row.device_time - rows.back().device_time;
      if (dt < 0.0) throw InputError(place, "`time_s` goes back; sort the rows by time");
      if (dt > 0.0) row.velocity = (row.position - rows.back().position) / dt;
    }
    rows.push_back(row);
  }
  if (rows.empty()) throw InputError({file, 0, 0}, "the recording has no rows; record some");
  return rows;
}

Recording::Recording(const std::string& file, Clock& clock)
    : clock_(clock), rows_(parse_recording(read_text(file), file)) {
  identity_.kind = Kind::recording;
  identity_.id = file;
  identity_.dialect = "csv";
  limits_.measures_force = std::isfinite(rows_.front().force);
  const double span = rows_.back().device_time - rows_.front().device_time;
  limits_.period = rows_.size() > 1 ? span / static_cast<double>(rows_.size() - 1) : 0.0;
  double longest = 0.0;
  for (std::size_t i = 1; i < rows_.size(); ++i)
    longest = std::max(longest, rows_[i].device_time - rows_[i - 1].device_time);
  // Gaps that the recording contains do not count as a stale link.
  limits_.stale_after = std::max(3.0 * limits_.period, 1.5 * longest);
  limits_.lost_after = std::max(0.1, 2.0 * limits_.stale_after);
}

Sample Recording::sample(double wait) {
  Sample none;
  none.received = clock_.now();
  if (next_ == rows_.size()) {
    none.arrival = Arrival::lost;
    none.fault = Fault::recording_ended;
    return none;
  }
  if (next_ == 0) start_ = clock_.now() - rows_.front().device_time;
  const double due = start_ + rows_[next_].device_time;
  const double until = clock_.now() + std::max(0.0, wait);
  if (due > until) {
    if (wait > 0.0) clock_.sleep_until(until);
    none.received = clock_.now();
    return none;
  }
  if (due > clock_.now()) clock_.sleep_until(due);
  Sample row = rows_[next_++];
  row.received = clock_.now();
  ++traffic_.received;
  return row;
}

}  // namespace palpate::device
