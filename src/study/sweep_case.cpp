// A case by what it computes, not by what it is called.
#include <algorithm>

#include "base/files.h"
#include "study/sweep_plan.h"
#include "study/sweep_row.h"

namespace palpate::study {
HashedNames hashed_inputs(const scenario::Family& family) {
  HashedNames names;
  for (const scenario::InputFile& input : family.inputs)
    names.emplace_back(input.name, sha256(input.content));
  return names;
}

Meetings meetings(const scenario::Design& design) {
  using Kind = scenario::Design::Kind;
  const Kind kind = design.kind();
  return kind == Kind::lhs || kind == Kind::sobol || kind == Kind::saltelli ? Meetings::told_apart
                                                                            : Meetings::refused;
}

std::uint64_t case_id(const scenario::Case& one, const HashedNames& files, Meetings meetings) {
  std::string text = scenario::spelled_out(one);
  for (const auto& [name, hash] : files)
    if (std::find(one.files.begin(), one.files.end(), name) != one.files.end())
      text += name + " " + hash + "\n";
  if (meetings == Meetings::told_apart) text += one.name + "\n";
  return id_of(sha256(text).substr(0, 16)).value_or(0);
}

}  // namespace palpate::study
