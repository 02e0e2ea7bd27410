// The manual names every key, and docs/scenario.md is the manual.
#include <gtest/gtest.h>

#include "base/files.h"
#include "base/text.h"
#include "scenario/family.h"

namespace palpate::scenario {
namespace {

TEST(Manual, IsCurrentInDocs) {
  EXPECT_TRUE(read_text(PALPATE_SOURCE_DIR "/docs/scenario.md") == manual())
      << "renew it: palpate manual > docs/scenario.md";
}

TEST(Manual, NamesEveryKeyOfAnEcho) {
  // Between them these echoes hold every key that any choice brings in.
  const std::string press = "[[step]]\n[[step]]\nkind = \"hold\"\n[[step]]\nkind = \"retract\"\n";
  const std::string creep = "[[step]]\nkind = \"creep\"\n[[step]]\nkind = \"relax\"\n";
  const std::string text = manual();
  int keys = 0;
  for (const auto& [steps, settings] :
       {std::pair(press,
                  std::vector<std::string>{"finger.weight=apart", "tissue.mesh.kind=tetgen"}),
        std::pair(press, std::vector<std::string>{"tissue.viscosity=nodal_drag"}),
        std::pair(press, std::vector<std::string>{"tissue.viscosity=standard_linear_solid"}),
        std::pair(creep, std::vector<std::string>{})})
    for (const std::string& line : split(echo(parse(steps, "p.toml", settings)), '\n')) {
      const std::size_t equals = line.find(" = ");
      if (line.starts_with('#') || equals == std::string::npos) continue;
      ++keys;
      const std::string key = line.substr(0, equals);
      const bool table = text.find("." + key + "]`") != std::string::npos;
      if (key != "kind") {
        EXPECT_TRUE(table || text.find("\n| `" + key + "` |") != std::string::npos ||
                    text.find("." + key + "` |") != std::string::npos)
            << key;
      }
    }
  EXPECT_GT(keys, 100);
}

TEST(Manual, ShowsDefaultsRangesAndConditions) {
  const std::string text = manual();
  for (const char* part :
       {"| `radius` | length >= 1e-06 mm and <= 1e+06 mm | `11 mm` | Radius of the single sphere "
        "that has the finger's mass. |",
        "| `friction` | number >= 0 | `0` | Coulomb's coefficient mu. |",
        "| `schema` | whole number = 1 | `1` | Version of this format. |",
        "| `solver.rings` | `\"all\"` or whole number >= 1 and <= 1000 | `all` |",
        "Used only with `viscosity = \"nodal_drag\"`.",
        "\nThe contact law. Used only by steps with a finger (indent, hold, retract, slide).\n",
        "## `tissue.mesh`, `kind = \"mirrored\"` (default)", "## `[[step]]`"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

// The examples of [sweep] are scenarios but for their steps.
TEST(Manual, HasExamplesThatRun) {
  const std::string text = manual();
  const std::string open = "```toml\n";
  std::vector<std::size_t> cases;
  for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at + 1)) {
    const std::size_t from = at + open.size();
    const std::string example = text.substr(from, text.find("```", from) - from);
    SCOPED_TRACE(example);
    const Family family = parse("[[step]]\nto = \"1 mm\"\n" + example, "p.toml", {});
    cases.push_back(family.cases.size());
  }
  EXPECT_EQ(cases, (std::vector<std::size_t>{40, 200, 4}));
}

}  // namespace
}  // namespace palpate::scenario
