// Finds the swept number that distinguishes the cases best.
#include "report/case_colours.h"

#include <algorithm>
#include <set>
#include <vector>

#include "base/text.h"

namespace palpate::report {
namespace {

constexpr std::size_t most_named_cases = 8;
constexpr std::size_t most_labels = 12;

struct Numbers {
  std::vector<double> values = {};  // one per case
  std::string unit = {};
};

// The values of swept key k as numbers with one unit; nothing if one of them is something else.
std::optional<Numbers> numbers_of(const scenario::Family& family, std::size_t k) {
  Numbers numbers;
  for (const scenario::Case& one : family.cases) {
    const std::string& word = one.swept[k].second;
    const auto number = leading_number(word);
    if (!number || number->out_of_range) return std::nullopt;
    const std::string unit = trimmed(number->rest);
    if (!numbers.values.empty() && unit != numbers.unit) return std::nullopt;
    numbers.unit = unit;
    numbers.values.push_back(number->value);
  }
  return numbers;
}

}  // namespace

std::optional<CaseColours> case_colours(const scenario::Family& family) {
  if (family.cases.size() <= most_named_cases) return std::nullopt;
  std::optional<Numbers> best;
  std::size_t key = 0, most = 2;
  for (std::size_t k = 0; k < family.cases.front().swept.size(); ++k) {
    std::optional<Numbers> numbers = numbers_of(family, k);
    if (!numbers) continue;
    const std::size_t count = std::set(numbers->values.begin(), numbers->values.end()).size();
    if (count <= most) continue;
    most = count;
    key = k;
    best = std::move(numbers);
  }
  if (!best) return std::nullopt;
  CaseColours colours;
  const auto [low, high] = std::minmax_element(best->values.begin(), best->values.end());
  colours.bar = {.label = family.cases.front().swept[key].first +
                          (best->unit.empty() ? "" : " (" + best->unit + ")"),
                 .low = *low,
                 .high = *high};
  constexpr double wide = 30.0;  // as for the axes of a figure
  if (*low > 0.0 && *high > wide * *low) colours.bar.scale = plot::Axis::logarithmic;
  std::set<std::string> labels;
  for (std::size_t i = 0; i < family.cases.size(); ++i) {
    std::vector<std::string> others;
    for (std::size_t k = 0; k < family.cases[i].swept.size(); ++k)
      if (k != key) others.push_back(family.cases[i].swept[k].second);
    const std::string label = others.empty() ? "all cases" : joined(others, ", ");
    labels.insert(label);
    colours.cases[family.cases[i].name] = {best->values[i], label};
  }
  if (labels.size() > most_labels) {
    for (auto& [name, one] : colours.cases) one.second = "all cases";
    colours.bar.label += "; other keys vary too";
  }
  return colours;
}

}  // namespace palpate::report
