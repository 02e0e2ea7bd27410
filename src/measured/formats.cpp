// Reads formats that are no plain tables: FEBio's log data and JPK's text exports.
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

// Reads JPK's text exports: comments with names and units above each segment of a curve.

namespace {

// The text after `# KEY:`, or nothing.
std::optional<std::string> entry(const Line& line, std::string_view key) {
  if (!line.text.starts_with("#")) return std::nullopt;
  const std::string text = trimmed(std::string_view(line.text).substr(1));
  if (!text.starts_with(key) || text.size() == key.size() || text[key.size()] != ':')
    return std::nullopt;
  return trimmed(std::string_view(text).substr(key.size() + 1));
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  for (const Piece& piece : pieces_of({0, text}, ' ', "")) words.push_back(piece.text);
  return words;
}

class JpkReader {
 public:
  explicit JpkReader(const std::string& file) {
    table_.file = file;
    table_.kind = RawTable::Kind::jpk;
  }

  void take(const Line& line) {
    if (const auto columns = entry(line, "columns")) {
      std::vector<std::string> names = words_of(*columns);
      names.emplace_back("segment");
      if (!table_.names.empty() && table_.names != names)
        refuse(line, "the segments have different columns; export them with the same columns");
      table_.names = std::move(names);
      table_.header_line = line.number;
    } else if (const auto units = entry(line, "units")) {
      table_.units = words_of(*units);
    } else if (const auto segment = entry(line, "segment")) {
      segment_ = *segment;
    } else if (const auto constant = entry(line, "springConstant")) {
      spring_ = whole_number(*constant);
    } else if (!line.text.starts_with("#") && !trimmed(line.text).empty()) {
      RawRow row{line.number, pieces_of(line, ' ', table_.file)};
      if (row.fields.size() + 1 != table_.names.size())
        refuse(line, "this row has " + std::to_string(row.fields.size()) +
                         " values, and `# columns:` names " +
                         std::to_string(table_.names.size() - 1) +
                         "; give every row one value per column");
      row.fields.push_back({segment_, 1});
      table_.rows.push_back(std::move(row));
    }
  }

  RawTable table() {
    if (table_.rows.empty())
      throw InputError({table_.file, 0, 0}, "contains no rows below `# columns:`");
    table_.units.resize(table_.names.size());
    add_tip_position();
    return std::move(table_);
  }

 private:
  [[noreturn]] void refuse(const Line& line, const std::string& message) const {
    throw InputError({table_.file, line.number, 0}, message);
  }

  [[nodiscard]] std::size_t find(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names)
      for (std::size_t i = 0; i < table_.names.size(); ++i)
        if (table_.names[i] == name) return i;
    return table_.names.size();
  }

  // The tip is above the base of the cantilever's zero by its deflection, force / k.
  void add_tip_position() {
    const std::size_t width = table_.names.size();
    const std::size_t height = find({"measuredHeight", "capacitiveSensorHeight", "height"});
    const std::size_t force = find({"vDeflection"});
    if (find({"tipPosition", "verticalTipPosition"}) < width || height == width || force == width ||
        !spring_ || table_.units[force] != "N" || table_.units[height] != "m")
      return;
    for (RawRow& row : table_.rows) {
      const auto z = measured_number(row.fields[height].text, '.');
      const auto f = measured_number(row.fields[force].text, '.');
      row.fields.push_back({z && f ? number_text(*z + *f / *spring_) : "nan", 1});
    }
    table_.names.emplace_back("tip position");
    table_.units.emplace_back("m");
    table_.notes.push_back("`tip position` is `" + table_.names[height] + "` + `vDeflection` / " +
                           number_text(*spring_) + " N/m, the spring constant in the file");
  }

  RawTable table_;
  std::string segment_;
  std::optional<double> spring_;  // N/m
};

}  // namespace

bool is_jpk_text(const std::vector<Line>& lines) {
  bool columns = false;
  bool units = false;
  for (std::size_t i = 0; i < std::min<std::size_t>(lines.size(), 2000); ++i) {
    columns = columns || entry(lines[i], "columns").has_value();
    units = units || entry(lines[i], "units").has_value();
  }
  return columns && units;
}

RawTable jpk_table(const std::vector<Line>& lines, const std::string& file) {
  JpkReader reader(file);
  for (const Line& line : lines) reader.take(line);
  return reader.table();
}

}  // namespace palpate::measured
