// Errors as text: one line per problem, starting with its place.
#include "base/error.h"

#include <algorithm>
#include <tuple>

#include "base/text.h"

namespace palpate {

std::string Place::text() const {
  std::string text = one_line(file);
  if (line > 0) text += ":" + std::to_string(line);
  if (line > 0 && column > 0) text += ":" + std::to_string(column);
  return text;
}

std::string Problem::text() const {
  const std::string where = place.text();
  return where.empty() ? message : where + ": " + message;
}

namespace {

std::string joined_problems(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += "\n";
    text += problem.text();
  }
  return text;
}

}  // namespace

void sort_by_place(std::vector<Problem>& problems) {
  std::vector<std::string> files;  // in the order of their first problems
  for (const Problem& problem : problems) files.push_back(problem.place.file);
  const auto rank = [&](const Problem& problem) {
    const auto file = std::ranges::find(files, problem.place.file) - files.begin();
    const Place& place = problem.place;
    return std::tuple(place.line == 0, file, place.line, place.column);
  };
  std::ranges::stable_sort(problems,
                           [&](const Problem& a, const Problem& b) { return rank(a) < rank(b); });
}

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(joined_problems(problems)), problems_(std::move(problems)) {}

InputError::InputError(Place place, std::string message)
    : InputError(std::vector<Problem>{{std::move(place), std::move(message)}}) {}

void refuse(const std::string& sentence) { throw InputError({}, "palpate: " + sentence); }

}  // namespace palpate
