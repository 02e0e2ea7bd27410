// Any text as a scenario: it is read or refused with words, and the echo of what was read is read
// again.
#include "fuzzing.h"
#include "scenario/family.h"

void palpate::fuzz::scenario(const std::uint8_t* data, std::size_t size) {
  const std::string text(text_of(data, size));
  scenario::Family family;
  if (!reads([&] { family = scenario::parse(text, "/nowhere/fuzz.toml", {}); })) return;
  require(!family.cases.empty());
  const std::string echo = scenario::echo(family);
  require(reads([&] { (void)scenario::parse(echo, "/nowhere/fuzz.toml", {}); }));
  for (const scenario::Case& one : family.cases) require(!scenario::spelled_out(one).empty());
}
