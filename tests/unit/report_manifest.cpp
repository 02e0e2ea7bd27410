// run.json, letter by letter; the clock that a build farm sets.
#include "report/manifest.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/error.h"

namespace palpate::report {
namespace {

TEST(Manifest, Text) {
  Manifest manifest;
  manifest.build = {"0.1.0", "Debug", "GCC 12", "-O1"};
  manifest.libraries = {{"eigen", "3.4.0"}, {"ceres", "2.1.0"}};
  manifest.machine = {"a \"CPU\"", 2, "Linux 6"};
  manifest.argv = {"palpate", "run", "a\nb", "bad \xFF byte"};
  manifest.started = "2026-01-31T12:00:00Z";
  manifest.ended = "2026-01-31T12:00:01Z";
  manifest.inputs = {{"a.toml", "12"}};
  manifest.cases = {{.name = "skin", .timings = {{"run", 0.25}}},
                    {.name = "leg", .state = CaseEntry::State::failed, .why = "diverged"}};
  EXPECT_EQ(manifest_text(manifest),
            R"({
  "program": {
    "name": "palpate",
    "version": "0.1.0",
    "build_type": "Debug",
    "compiler": "GCC 12",
    "flags": "-O1",
    "libraries": {
      "ceres": "2.1.0",
      "eigen": "3.4.0"
    }
  },
  "machine": {
    "cpu": "a \"CPU\"",
    "cores": 2,
    "kernel": "Linux 6"
  },
  "argv": [
    "palpate",
    "run",
    "a\nb",
    "bad )"
            "\xEF\xBF\xBD"
            R"( byte"
  ],
  "started": "2026-01-31T12:00:00Z",
  "ended": "2026-01-31T12:00:01Z",
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
      "timings_s": {}
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

TEST(Manifest, LibrariesKnowTheirVersions) {
  const auto versions = library_versions("1.5.0");
  for (const char* name : {"eigen", "ceres", "openexr", "nlohmann_json", "tetgen"}) {
    ASSERT_TRUE(versions.contains(name)) << name;
    EXPECT_NE(versions.at(name).find('.'), std::string::npos) << name;
  }
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

TEST(Machine, IsDescribed) {
  EXPECT_FALSE(this_machine().cpu.empty());
  EXPECT_GE(this_machine().cores, 1);
  EXPECT_NE(this_machine().kernel.find("Linux"), std::string::npos);
  EXPECT_NE(this_build().compiler, "unknown");
}

}  // namespace
}  // namespace palpate::report
