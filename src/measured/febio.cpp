// Reads FEBio's log data: for each time three lines of heading, then one row per item.
#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/text.h"
#include "measured/table.h"

namespace palpate::measured {
namespace {

// The value in a line `KEY = VALUE`, for example `0.1` in `*Time  = 0.1`.
std::optional<std::string> after(const Line& line, std::string_view key) {
  const std::string text = trimmed(line.text);
  if (!text.starts_with(key)) return std::nullopt;
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return std::nullopt;
  return trimmed(std::string_view(text).substr(equals + 1));
}

// The fields of a row, whose separator is the data record's `delim`.
std::vector<Piece> values(const Line& line, const std::string& file) {
  constexpr std::array separators{',', ';', '\t'};
  for (const char separator : separators)
    if (line.text.find(separator) != std::string::npos) return pieces_of(line, separator, file);
  return pieces_of(line, ' ', file);
}

}  // namespace

bool is_febio_log(const std::vector<Line>& lines) {
  bool time = false;
  for (const Line& line : lines) {
    if (after(line, "*Time")) time = true;
    if (time && after(line, "*Data")) return true;
  }
  return false;
}

RawTable febio_table(const std::vector<Line>& lines, const std::string& file) {
  RawTable table;
  table.file = file;
  table.kind = RawTable::Kind::febio_log;
  Piece step{"", 1};
  Piece time{"", 1};
  bool in_data = false;
  for (const Line& line : lines) {
    const auto refuse = [&](const std::string& message) {
      throw InputError({file, line.number, 0}, message);
    };
    if (trimmed(line.text).empty()) continue;
    if (const auto number = after(line, "*Step")) {
      step.text = *number;
      in_data = false;
    } else if (const auto moment = after(line, "*Time")) {
      time.text = *moment;
      in_data = false;
    } else if (const auto data = after(line, "*Data")) {
      std::vector<std::string> names{"step", "time_s", "item"};
      for (const std::string& name : split(*data, ';')) names.push_back(trimmed(name));
      if (!table.names.empty() && table.names != names)
        refuse("`*Data` names other data than before; write each record to a separate file");
      if (table.names.empty()) table.header_line = line.number;
      table.names = names;
      in_data = true;
    } else if (in_data && !line.text.starts_with("*")) {
      RawRow row{line.number, {step, time}};
      for (Piece& piece : values(line, file)) row.fields.push_back(std::move(piece));
      if (row.fields.size() != table.names.size())
        refuse("this row has " + std::to_string(row.fields.size() - 2) +
               " values with its item, `*Data` names " + std::to_string(table.names.size() - 3) +
               " and the item; give every row one value per name");
      table.rows.push_back(std::move(row));
    }
  }
  if (table.rows.empty()) throw InputError({file, 0, 0}, "holds no rows below `*Data`");
  return table;
}

}  // namespace palpate::measured
