// Broken scenarios by the thousand: each is read, or refused with words.
#include <gtest/gtest.h>

#include <random>

#include "base/files.h"
#include "base/text.h"
#include "scenario/family.h"

namespace palpate::scenario {
namespace {

const std::string source_folder = PALPATE_SOURCE_DIR;

std::string changed_byte(std::string text, std::mt19937& random) {
  const std::size_t at = random() % text.size();
  switch (random() % 4) {
    case 0: text[at] = static_cast<char>(random()); break;
    case 1: text.erase(at, 1 + random() % 8); break;
    case 2: text.insert(at, 1, "\"'[]{}=.,#\n\\0-e"[random() % 15]); break;
    default: text.resize(at);
  }
  return text;
}

std::string changed_line(const std::string& text, std::mt19937& random) {
  std::vector<std::string> lines = split(text, '\n');
  const std::size_t at = random() % lines.size();
  const std::size_t other = random() % lines.size();
  switch (random() % 3) {
    case 0: std::swap(lines[at], lines[other]); break;
    case 1: lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at)); break;
    default: lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), lines[other]);
  }
  return joined(lines, "\n");
}

TEST(Mutations, AreReadOrRefusedWithWords) {
  std::mt19937 random(2007);  // a fixed seed: the same texts everywhere
  int refused = 0;
  for (const char* name : {"quickstart", "figure6_force_indentation", "figure7_skin_ligament"}) {
    const std::string path = source_folder + "/scenarios/" + name + ".toml";
    const std::string original = read_text(path);
    for (int i = 0; i < 1000; ++i) {
      std::string text = original;
      const int changes = 1 + static_cast<int>(random() % 3);
      for (int j = 0; j < changes && !text.empty(); ++j) {
        const bool line = random() % 3 == 0;
        text = line ? changed_line(text, random) : changed_byte(text, random);
      }
      try {
        const Family family = parse(text, path, {});
        EXPECT_FALSE(family.cases.empty());
        EXPECT_NO_THROW((void)parse(echo(family), path, {})) << text << "\n---\n" << echo(family);
      } catch (const InputError& error) {
        ++refused;
        ASSERT_FALSE(error.problems().empty()) << text;
        for (const Problem& problem : error.problems()) {
          EXPECT_FALSE(problem.message.empty()) << text;
          EXPECT_GT(problem.place.line, 0) << text;
        }
      }
    }
  }
  EXPECT_GT(refused, 1000);  // most mutations are mistakes; none refused would mean none was made
}

TEST(Mutations, OfSettingsAreReadOrRefusedWithWords) {
  std::mt19937 random(2007);
  const std::string path = source_folder + "/scenarios/quickstart.toml";
  const std::string text = read_text(path);
  for (int i = 0; i < 1000; ++i) {
    const char* const whole[] = {"tissue.young_modulus=60 kPa", "step.1.to=1 mm",
                                 "tissue.mesh={ kind = \"kuhn\", cells = [1, 2, 3] }",
                                 "sweep.tissue.material=[\"skin\"]"};
    const std::string setting = changed_byte(whole[random() % 4], random);
    try {
      const Family family = parse(text, path, {setting});
      EXPECT_NO_THROW((void)parse(echo(family), path, {})) << setting;
    } catch (const InputError& error) {
      ASSERT_FALSE(error.problems().empty()) << setting;
      for (const Problem& problem : error.problems())
        EXPECT_FALSE(problem.message.empty()) << setting;
    }
  }
}

}  // namespace
}  // namespace palpate::scenario
