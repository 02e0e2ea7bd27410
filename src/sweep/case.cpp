// The id of a case: a hash of what it computes, without its name.
#include <algorithm>
#include <array>
#include <string_view>

#include "base/files.h"
#include "base/text.h"
#include "sweep/plan.h"
#include "sweep/row.h"

namespace palpate::sweep {

HashedNames hashed_inputs(const scenario::Family& family) {
  HashedNames names;
  for (const scenario::InputFile& input : family.inputs)
    names.emplace_back(input.name, sha256(input.content));
  return names;
}

std::uint64_t case_id(const scenario::Case& one, const HashedNames& files) {
  // What only says how results are shown, or is left open, and did not exist when the first plans
  // were made, changes no id: a plan goes on with a newer version.
  constexpr std::array<std::string_view, 7> later{
      "paper = ",  "picture = ",   "png = ",         "regression = ",
      "report = ", "tissue_at = ", "size = \"auto\""};
  std::string text;
  for (const std::string& line : split(scenario::spelled_out(one), '\n'))
    if (std::none_of(later.begin(), later.end(),
                     [&](std::string_view key) { return line.starts_with(key); }))
      text += (text.empty() ? "" : "\n") + line;
  if (one.at_least && *one.at_least != scenario::Model::hertz && !one.scenario.solver.model)
    text += std::string("\nat_least = ") + scenario::traits(*one.at_least).word;
  for (const auto& [name, hash] : files)
    if (std::find(one.files.begin(), one.files.end(), name) != one.files.end())
      text += name + " " + hash + "\n";
  return id_of(sha256(text).substr(0, 16)).value_or(0);
}

std::uint64_t twin_id(std::uint64_t id, std::size_t number) {
  return id_of(sha256(id_text(id) + " " + std::to_string(number)).substr(0, 16)).value_or(0);
}

}  // namespace palpate::sweep
