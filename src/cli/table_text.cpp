// Tables as text; whole numbers have no decimal point in JSON.
#include "cli/table_text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "base/written.h"
#include "record/csv.h"

namespace palpate::cli {
namespace {

using Json = nlohmann::ordered_json;

Json json_value(const record::Cell& cell) {
  if (const auto* word = std::get_if<std::string>(&cell)) return *word;
  const auto* number = std::get_if<double>(&cell);
  if (number == nullptr) return nullptr;
  constexpr double exact = 9007199254740992.0;  // 2^53
  if (std::abs(*number) < exact && *number == std::trunc(*number))
    return static_cast<std::int64_t>(*number);
  return *number;
}

}  // namespace

std::string json_lines(const record::Table& table) {
  std::string text;
  for (const auto& row : table.rows) {
    Json object = Json::object();
    for (std::size_t i = 0; i < row.size(); ++i) object[table.columns[i]] = json_value(row[i]);
    text += object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  }
  return text;
}

record::Table names_and_values(const record::Table& table) {
  record::Table turned{{"name", "value"}, {}};
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    turned.rows.push_back({table.columns[i], table.rows.front()[i]});
  return turned;
}

std::string aligned(const record::Table& table) {
  std::vector<std::vector<std::string>> lines{table.columns};
  std::vector<std::size_t> widths(table.columns.size(), 0);
  std::vector<bool> numeric(table.columns.size(), false);
  for (const auto& row : table.rows) {
    std::vector<std::string>& line = lines.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto* number = std::get_if<double>(&row[i]);
      const auto* word = std::get_if<std::string>(&row[i]);
      constexpr double whole = 1e9;
      if (number != nullptr) {
        numeric[i] = true;
        const bool all = *number == std::trunc(*number) && std::abs(*number) < whole;
        line.push_back(all ? number_text(*number) : rounded_text(*number, 4));
      } else {
        line.push_back(word == nullptr ? "-" : *word);
      }
    }
  }
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i)
      widths[i] = std::max(widths[i], letter_count(line[i]));
  std::string text;
  for (const auto& line : lines) {
    std::string one;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::string blanks(widths[i] - letter_count(line[i]), ' ');
      one += (i == 0 ? "" : "  ") + (numeric[i] ? blanks + line[i] : line[i] + blanks);
    }
    text += one.substr(0, one.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

void print_result(const record::Table& table, const record::Table& for_eyes, const Talk& talk) {
  if (talk.json())
    print(json_lines(table));
  else if (talk.csv())
    print_text(record::csv_text(table));
  else
    print_text(aligned(for_eyes));
}

}  // namespace palpate::cli
