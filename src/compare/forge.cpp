// Writes JUnit XML and GitHub's workflow commands.
#include "compare/forge.h"

#include <filesystem>
#include <vector>

#include "base/written.h"

namespace palpate::compare {
namespace {

std::vector<Item> items_of(const Check& check) {
  if (!check.error.empty()) return {{Item::State::error, "", "run", check.error}};
  return items_of(check.comparison);
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
                     escaped(check.name + (item.file.empty() ? "" : "/" + item.file)) +
                     "\" name=\"" + escaped(item.name) + "\"";
  const std::string message = " message=\"" + escaped(item.sentence()) + "\"/></testcase>\n";
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

// The line of the worst row in the wanted file, whose header is line 1; 0 in a tube, whose rows are
// not those of the wanted file, and where there is none.
std::size_t line_of(const Check& check, const Item& item) {
  if (item.column == nullptr || !item.column->worst) return 0;
  for (const FileComparison& file : check.comparison.files)
    if (file.file == item.file && file.comparison.rows_compared) return item.column->worst->row + 1;
  return 0;
}

}  // namespace

std::string junit_text(std::span<const Check> checks) {
  std::vector<Item> all;
  std::string suites;
  for (const Check& check : checks) {
    const std::vector<Item> items = items_of(check);
    all.insert(all.end(), items.begin(), items.end());
    suites += "  <testsuite name=\"" + escaped(check.name) + "\"" + counts(items) + ">\n";
    for (const Item& item : items) suites += test_case(check, item);
    suites += "  </testsuite>\n";
  }
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"palpate\"" + counts(all) +
         ">\n" + suites + "</testsuites>\n";
}

std::string github_annotations(std::span<const Check> checks) {
  std::string text;
  for (const Check& check : checks) {
    if (check.equal()) continue;
    const std::vector<Item> bad =
        check.error.empty() ? differences(check.comparison) : items_of(check);
    const Item& item = bad.front();
    std::filesystem::path file(check.error.empty() ? check.want : check.name);
    if (!item.file.empty() && !check.one_file) file /= item.file;
    text += "::error file=" + command_text(file.generic_string(), Part::property);
    if (const std::size_t line = line_of(check, item); line > 0)
      text += ",line=" + std::to_string(line);
    const std::string more =
        bad.size() == 1 ? "" : " (" + std::to_string(bad.size()) + " differences in all)";
    text += ",title=" + command_text("palpate: " + check.name, Part::property) +
            "::" + command_text(item.sentence() + more, Part::message) + "\n";
  }
  return text;
}

}  // namespace palpate::compare
