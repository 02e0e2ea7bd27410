// Writes JUnit XML and GitHub's workflow commands.
#include "compare/forge.h"

#include <algorithm>
#include <filesystem>
#include <vector>

namespace palpate::compare {
namespace {

// One thing that was compared: a column, the number of rows, a whole file, or a whole check.
struct Item {
  enum class State { good, skipped, failed, error };

  State state = State::good;
  std::string file = {};  // relative to the folder; empty for a whole check
  std::string name = {};  // of the column
  std::string text = {};  // what is wrong
  std::size_t line = 0;   // in the wanted file; 0: unknown
  int rank = 2;           // among the differences
};

void add_columns(const FileComparison& file, std::vector<Item>& items) {
  if (!file.comparison.rows_equal())
    items.push_back({Item::State::failed, file.file, "rows", rows_text(file.comparison)});
  for (const ColumnComparison& column : file.comparison.columns) {
    Item item{column.equal() ? Item::State::good : Item::State::failed, file.file, column.name};
    if (column.state == ColumnComparison::State::ignored) item.state = Item::State::skipped;
    if (item.state == Item::State::failed) item.text = verdict_text(column);
    // The header is line 1. In a tube the rows are not those of the wanted file.
    if (column.worst && file.comparison.rows_compared) item.line = column.worst->row + 1;
    item.rank = rank_of(column);
    items.push_back(std::move(item));
  }
}

std::vector<Item> items_of(const Check& check) {
  if (!check.error.empty()) return {{Item::State::error, "", "run", check.error}};
  std::vector<Item> items;
  for (const FileComparison& file : check.comparison.files) {
    if (file.state == FileComparison::State::compared)
      add_columns(file, items);
    else
      items.push_back({Item::State::failed, file.file, "file", verdict_text(file.state)});
  }
  return items;
}

// Text for an XML attribute in double quotes. XML permits no control characters.
std::string xml(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
    switch (letter) {
      case '&': safe += "&amp;"; break;
      case '<': safe += "&lt;"; break;
      case '>': safe += "&gt;"; break;
      case '"': safe += "&quot;"; break;
      default: safe += static_cast<unsigned char>(letter) < 0x20 ? ' ' : letter;
    }
  }
  return safe;
}

std::string place_text(const Item& item) {
  return item.file.empty() ? item.text : item.file + ", " + item.name + ": " + item.text;
}

std::string counts(const std::vector<Item>& items) {
  const auto count = [&](Item::State state) {
    std::size_t number = 0;
    for (const Item& item : items) number += item.state == state ? 1U : 0U;
    return std::to_string(number);
  };
  return " tests=\"" + std::to_string(items.size()) + "\" failures=\"" +
         count(Item::State::failed) + "\" errors=\"" + count(Item::State::error) + "\" skipped=\"" +
         count(Item::State::skipped) + "\"";
}

std::string test_case(const Check& check, const Item& item) {
  std::string text = "    <testcase classname=\"" +
                     xml(check.name + (item.file.empty() ? "" : "/" + item.file)) + "\" name=\"" +
                     xml(item.name) + "\"";
  const std::string message = " message=\"" + xml(place_text(item)) + "\"/></testcase>\n";
  switch (item.state) {
    case Item::State::good: return text + "/>\n";
    case Item::State::skipped: return text + "><skipped/></testcase>\n";
    case Item::State::failed: return text + "><failure type=\"difference\"" + message;
    case Item::State::error: return text + "><error type=\"no result\"" + message;
  }
  return text;
}

enum class Part { property, message };

// Escapes as GitHub's own toolkit does; properties end at a comma or a colon.
std::string command_text(const std::string& text, Part part) {
  std::string safe;
  for (const char letter : text) {
    switch (letter) {
      case '%': safe += "%25"; break;
      case '\r': safe += "%0D"; break;
      case '\n': safe += "%0A"; break;
      case ':': safe += part == Part::property ? "%3A" : ":"; break;
      case ',': safe += part == Part::property ? "%2C" : ","; break;
      default: safe += letter;
    }
  }
  return safe;
}

}  // namespace

std::string junit_text(std::span<const Check> checks) {
  std::vector<Item> all;
  std::string suites;
  for (const Check& check : checks) {
    const std::vector<Item> items = items_of(check);
    all.insert(all.end(), items.begin(), items.end());
    suites += "  <testsuite name=\"" + xml(check.name) + "\"" + counts(items) + ">\n";
    for (const Item& item : items) suites += test_case(check, item);
    suites += "  </testsuite>\n";
  }
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"palpate\"" + counts(all) +
         ">\n" + suites + "</testsuites>\n";
}

std::string github_annotations(std::span<const Check> checks) {
  std::string text;
  for (const Check& check : checks) {
    std::vector<Item> bad = items_of(check);
    std::erase_if(bad, [](const Item& item) {
      return item.state == Item::State::good || item.state == Item::State::skipped;
    });
    if (bad.empty()) continue;
    const Item& item = *std::min_element(
        bad.begin(), bad.end(), [](const Item& a, const Item& b) { return a.rank < b.rank; });
    std::filesystem::path file(check.want);
    if (!item.file.empty() && !check.one_file) file /= item.file;
    text += "::error file=" + command_text(file.generic_string(), Part::property);
    if (item.line > 0) text += ",line=" + std::to_string(item.line);
    const std::string more =
        bad.size() == 1 ? "" : " (" + std::to_string(bad.size()) + " differences in all)";
    text += ",title=" + command_text("palpate: " + check.name, Part::property) +
            "::" + command_text(place_text(item) + more, Part::message) + "\n";
  }
  return text;
}

}  // namespace palpate::compare
