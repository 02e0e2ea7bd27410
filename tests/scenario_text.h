// What tests of scenarios ask of a text: what is read, refused, noted.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "refusal.h"
#include "scenario/resolved.h"

namespace palpate::scenario {

// Three lines each; what is tested starts on line 4.
inline const std::string press = "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\n";
inline const std::string small_press = "[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n";
inline const std::string creep = "[[step]]\nkind = \"creep\"\nstress = \"1 kPa\"\n";

inline Case read_case(const std::string& text) { return parse(text, "press.toml", {}).cases.at(0); }
inline Scenario read_one(const std::string& text) { return filled(read_case(text)); }

inline std::string refusal(const std::string& text, const std::vector<std::string>& settings = {},
                           const std::string& path = "press.toml") {
  return test::refusal([&] { return parse(text, path, settings); });
}

inline std::string notes(const std::string& text) {
  std::string all;
  for (const Problem& note : parse(text, "press.toml", {}).notes) all += note.text() + "\n";
  return all;
}

struct Refused {
  std::string text;
  std::string sentence;
};

inline void expect_refused(const std::vector<Refused>& cases, const std::string& before = press) {
  for (const Refused& one : cases) EXPECT_EQ(refusal(before + one.text), one.sentence) << one.text;
}

}  // namespace palpate::scenario
