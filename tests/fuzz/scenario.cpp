// Any text as a scenario: it is read or refused with words, and the echo of what was read is read
// again.
#include "fuzzing.h"
#include "scenario/family.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  const std::string text(fuzz::text_of(data, size));
  scenario::Family family;
  if (!fuzz::reads([&] { family = scenario::parse(text, "/nowhere/fuzz.toml", {}); })) return 0;
  fuzz::require(!family.cases.empty());
  const std::string echo = scenario::echo(family);
  fuzz::require(fuzz::reads([&] { (void)scenario::parse(echo, "/nowhere/fuzz.toml", {}); }));
  for (const scenario::Case& one : family.cases) fuzz::require(!scenario::spelled_out(one).empty());
  return 0;
}
