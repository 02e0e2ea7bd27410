// Tables as text; whole numbers have no decimal point in JSON.
#include "cli/table_text.h"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

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

std::string names_and_values(const record::Table& table) {
  record::Table turned{{"name", "value"}, {}};
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    turned.rows.push_back({table.columns[i], table.rows.front()[i]});
  return record::csv_text(turned);
}

}  // namespace palpate::cli
