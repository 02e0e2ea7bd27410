// The solid against an independent program: tests/cases/solid.csv. docs/accuracy.md has the table,
// which PALPATE_SOLID_TABLE=1 prints.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>

#include "solid_scenes.h"

namespace palpate {
namespace {

struct Witness {
  std::string id;
  double force = 0.0;  // N
};

// The rows that are forces at rest at the end of one press.
std::vector<Witness> witnesses() {
  std::ifstream file(PALPATE_SOURCE_DIR "/tests/cases/solid.csv");
  std::vector<Witness> found;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string id, scene, force;
    std::getline(cells, id, ',');
    std::getline(cells, scene, ',');
    std::getline(cells, force, ',');
    if (id == "tap" || id == "shaft_creep" || id == "short_relax" || id == "visc_dome_kv") continue;
    found.push_back({id, 1e-3 * std::stod(force)});
  }
  return found;
}

class Cases : public testing::TestWithParam<Witness> {};
INSTANTIATE_TEST_SUITE_P(Solid, Cases, testing::ValuesIn(witnesses()),
                         [](const auto& info) { return info.param.id; });

TEST_P(Cases, AreWithinWhatOneMeshStates) {
  const Witness& witness = GetParam();
  const auto scene =
      test::solid_scene(PALPATE_SOURCE_DIR "/tests/cases/scenes/" + witness.id + ".toml");
  const auto start = std::chrono::steady_clock::now();
  solid::FingerPress press(scene->order);
  const auto found = press.at_travel(scene->order.deepest);
  ASSERT_TRUE(found) << press.reason();
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (std::getenv("PALPATE_SOLID_TABLE") != nullptr)
    std::cout << "| " << witness.id << " | " << 1e3 * witness.force << " | " << 1e3 * found->force
              << " | " << 100.0 * (found->force / witness.force - 1.0) << " | "
              << press.press().body().mesh.nodes.size() << " | " << press.press().body().copies
              << " | " << press.press().factorisations() << " | " << seconds << " |\n";
  EXPECT_NEAR(found->force, witness.force, solid::error_of_one_mesh * witness.force);
}

}  // namespace
}  // namespace palpate
