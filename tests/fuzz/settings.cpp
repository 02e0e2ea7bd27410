// Any lines as settings of the command line (`--set`), applied to a scenario.
#include <string>
#include <vector>

#include "base/text.h"
#include "fuzzing.h"
#include "scenario/family.h"

void palpate::fuzz::settings(const std::uint8_t* data, std::size_t size) {
  const std::string scenario =
      "[tissue]\nyoung_modulus = \"20 kPa\"\n[finger]\nmaterial = \"rigid\"\nradius = \"5 mm\"\n"
      "[[step]]\nkind = \"indent\"\nto = \"0.4 mm\"\n";
  const std::vector<std::string> settings = split(std::string(text_of(data, size)), '\n');
  scenario::Family family;
  if (!reads([&] { family = scenario::parse(scenario, "/nowhere/fuzz.toml", settings); })) return;
  const std::string echo = scenario::echo(family);
  require(reads([&] { (void)scenario::parse(echo, "/nowhere/fuzz.toml", {}); }));
}
