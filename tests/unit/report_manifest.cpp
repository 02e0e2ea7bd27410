// run.json, letter by letter; the clock that a build farm sets.
#include "report/manifest.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace palpate::report {
namespace {

TEST(Manifest, Text) {
  ::setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
  const std::string text = manifest_text(
      {.origin = {{"palpate", "run", "a\nb", "bad \xFF byte"}, "2026-01-31T12:00:00Z"},
       .inputs = {{"a.toml", "12"}},
       .cases = {{.name = "skin", .seconds = 0.25}, {.name = "leg", .why = "diverged"}}});
  ::unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_EQ(text.substr(text.find("  \"argv\"")), R"(  "argv": [
    "palpate",
    "run",
    "a\nb",
    "bad )"
                                                  "\xEF\xBF\xBD"
                                                  R"( byte"
  ],
  "started": "2026-01-31T12:00:00Z",
  "ended": "2023-11-14T22:13:20Z",
  "complete": false,
  "finished": [
    {
      "name": "skin",
      "timings_s": {
        "run": 0.25
      }
    }
  ],
  "failed": [
    {
      "name": "leg",
      "why": "diverged",
      "timings_s": {
        "run": 0.0
      }
    }
  ],
  "inputs": [
    {
      "path": "a.toml",
      "sha256": "12"
    }
  ],
  "outputs": []
}
)");
}

TEST(Manifest, KnowsProgramLibrariesAndMachine) {
  const auto json = nlohmann::json::parse(manifest_text({}));
  const auto& program = json["program"];
  EXPECT_EQ(program["name"], "palpate");
  EXPECT_EQ(program["compiler"], this_build().compiler);
  EXPECT_NE(this_build().compiler, "unknown");
  for (const char* name : {"eigen", "ceres", "openexr", "nlohmann_json", "tetgen"})
    EXPECT_NE(program["libraries"][name].get<std::string>().find('.'), std::string::npos) << name;
  EXPECT_FALSE(json["machine"]["cpu"].get<std::string>().empty());
  EXPECT_GE(json["machine"]["cores"].get<int>(), 1);
  EXPECT_NE(json["machine"]["kernel"].get<std::string>().find("Linux"), std::string::npos);
}

TEST(Machine, Clock) {
  EXPECT_EQ(utc_text(0), "1970-01-01T00:00:00Z");
  EXPECT_EQ(utc_text(1700000000), "2023-11-14T22:13:20Z");
  ::setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
  EXPECT_EQ(utc_now(), "2023-11-14T22:13:20Z");
  ::setenv("SOURCE_DATE_EPOCH", "yesterday", 1);  // not a number: the clock itself
  EXPECT_GT(utc_now(), "2023-11-14T22:13:20Z");
  ::unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_GT(utc_now(), "2023-11-14T22:13:20Z");
}

}  // namespace
}  // namespace palpate::report
