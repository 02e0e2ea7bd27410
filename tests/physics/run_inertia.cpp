// A fast press with inertia against contact that a fine mesh resolves by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "run/family.h"
#include "run_text.h"

namespace palpate {
namespace {

// Skin 60 x 60 x 30 mm without viscosity, rigid sphere of 11 mm, pressed by 1 mm at 100
// mm/s and held: `resolved` coupled springs on graded lattices of 2197, 4096 and 6859 nodes in
// implicit steps of 0.025 ms, mean of the three (they differ by 0.3 to 2 %), force in mN at every
// ms.
constexpr double resolved[] = {0,     13.2,  35.7,  66.3,  100.3, 138.8, 181.5, 227.4, 278.6,
                               333.1, 389.4, 365.8, 370.2, 375.5, 382.1, 388.8, 394.4};

TEST(Inertia, AFastPressMeetsWhatItsWavesTakeAway) {
  const std::string text =
      "[tissue]\nviscosity = \"none\"\nmesh = { kind = \"tetgen\", nodes = 728 }\n"
      "[finger]\nmaterial = \"rigid\"\n[solver]\nmodel = \"coupled_springs\"\nintegrator = "
      "\"central_difference\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"100 mm/s\"\n"
      "[[step]]\nkind = \"hold\"\ntime = \"6 ms\"\n[output]\ninterval = \"1 ms\"\npressure_maps = "
      "false\n";
  const auto scene = test::scene_of(text);
  const record::CaseRecord record = test::run_scene(scene);
  ASSERT_EQ(record.outcome, record::Outcome::completed);
  ASSERT_EQ(record.contact.size(), std::size(resolved));
  // From 3 ms on; before, the contact is a cell or less wide on either mesh.
  for (std::size_t i = 3; i < std::size(resolved); ++i)
    // Measured: 0.054 at 3 ms, where the contact is narrow and its radiation large, then 0.045.
    EXPECT_NEAR(1e3 * record.contact[i].force, resolved[i], (i == 3 ? 0.06 : 0.05) * resolved[i])
        << i << " ms";
  // The fall as the finger stops is the radiation, which statics knows nothing of.
  EXPECT_LT(record.contact[11].force, 0.96 * record.contact[10].force);
}

// A pillar of 20 x 20 x 80 mm that is held below: what inertia adds to the force of the press, mN
// at every 8 ms from 16 ms on, by CalculiX 2.20 (2406 nodes of Gmsh, C3D10, NLGEOM, the static
// force of its own mesh subtracted from *DYNAMIC with steps of 2 ms and without damping).
TEST(Inertia, APillarSwingsAsInAnotherProgram) {
  constexpr double swing[] = {0.1565, 0.2556, 0.3105, 0.2745, 0.1503};
  const auto forces = [](const char* integrator) {
    return test::run_text(
               "[tissue]\nyoung_modulus = \"10 kPa\"\npoisson_ratio = 0.33\ndensity = \"1100 "
               "kg/m^3\"\nviscosity = \"none\"\nshape = { kind = \"cuboid\", size = [\"20 mm\", "
               "\"20 mm\", \"80 mm\"] }\n[finger]\nmaterial = \"rigid\"\nradius = \"6 mm\"\n"
               "[solver]\nmodel = \"coupled_springs\"\n[output]\ninterval = \"4 ms\"\n"
               "pressure_maps = false\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\nrate = \"5 "
               "mm/s\"\n",
               {std::string("solver.integrator=") + integrator})
        .contact;
  };
  const auto moving = forces("modal");
  const auto still = forces("quasi_static");
  for (std::size_t i = 0; i < std::size(swing); ++i)
    EXPECT_NEAR(1e3 * (moving[2 * i + 4].force - still[2 * i + 4].force), swing[i], 0.05)
        << moving[2 * i + 4].time << " s";  // 0.6 % of the greatest force
}

// The wide patch is wider than this layer is thick: its waves come back in 5 ms, of a press of 50
// ms.
TEST(Inertia, ASlowPressOnAThinLayerIsThatAtRest) {
  const auto forces = [](const char* integrator) {
    return test::run_text(
               "[tissue]\nviscosity = \"none\"\npoisson_ratio = 0.45\nshape = { kind = "
               "\"cuboid\", size = [\"60 mm\", \"60 mm\", \"5 mm\"] }\nmesh = { kind = "
               "\"tetgen\", nodes = 500 }\n[finger]\nmaterial = \"rigid\"\nradius = \"100 "
               "mm\"\n[solver]\nmodel = \"coupled_springs\"\n[output]\ninterval = \"5 ms\"\n"
               "pressure_maps = false\n[[step]]\nkind = \"indent\"\nto = \"0.3 mm\"\nrate = "
               "\"2 mm/s\"\n",
               {std::string("solver.integrator=") + integrator})
        .contact;
  };
  const auto still = forces("quasi_static");
  const auto moving = forces("modal");
  ASSERT_EQ(moving.size(), still.size());
  for (std::size_t i = 5; i < still.size(); ++i)
    EXPECT_NEAR(moving[i].force, still[i].force, 3e-4 * still[i].force) << still[i].time << " s";
  // The contact is so wide that no part of the mesh's motion counts, nor of the dashpot.
  EXPECT_NEAR(moving.back().force, still.back().force, 1e-9 * still.back().force);
}

// Scenes 1, 12 and 0 of `tests/accuracy/fast_presses.py --seed 1`, and its forces in mN: the last
// digit of each is not known.
struct Fast {
  const char* shape;
  double youngs, poisson, density, radius, depth, rate, force, most;
};

void PrintTo(const Fast& fast, std::ostream* out) { *out << fast.force << " mN"; }

class FastPresses : public testing::TestWithParam<Fast> {};

TEST_P(FastPresses, StateWhatTheirMeshMissesOfTheWaves) {
  const Fast& fast = GetParam();
  const auto number = [](double value) { return std::to_string(value); };
  const record::CaseRecord record = test::run_text(
      "[tissue]\nyoung_modulus = \"" + number(fast.youngs) +
      " kPa\"\npoisson_ratio = " + number(fast.poisson) + "\ndensity = \"" + number(fast.density) +
      " kg/m^3\"\nviscosity = \"none\"\nshape = " + fast.shape +
      "\n[finger]\nmaterial = \"rigid\"\nradius = \"" + number(fast.radius) +
      " mm\"\n[[step]]\nkind = \"indent\"\nto = \"" + number(fast.depth) + " mm\"\nrate = \"" +
      number(fast.rate) + " mm/s\"\n[output]\ninterval = \"0.2 ms\"\npressure_maps = false\n");
  ASSERT_EQ(record.outcome, record::Outcome::completed);
  const double off = std::abs(1e3 * record.contact.back().force / fast.force - 1.0);
  EXPECT_LT(off, test::found(record, "stated_error") + 0.012);
  EXPECT_LT(off, fast.most);
}

// On the mesh of 140 nodes that statics asks for they were 9.1 and 13.4 % off, with 2.3 and 2.9 %
// stated. Under the last, the wide patch is as large as the disc: the effect of inertia is stated.
INSTANTIATE_TEST_SUITE_P(
    All, FastPresses,
    testing::Values(
        Fast{"{ kind = \"cuboid\", size = [\"41.7414 mm\", \"41.7414 mm\", \"16.0544 mm\"] }",
             51.9793, 0.3057, 1148.02, 7.9787, 0.9777, 185.2222, 251.4, 0.03},
        Fast{"{ kind = \"cuboid\", size = [\"43.3888 mm\", \"43.3888 mm\", \"16.688 mm\"] }",
             13.509, 0.3133, 1061.47, 7.4495, 1.1274, 164.4765, 82.74, 0.05},
        Fast{"{ kind = \"disc\", radius = \"16.1512 mm\", height = \"12.3908 mm\" }", 12.5538,
             0.4042, 1175.9, 13.592, 2.1325, 559.6017, 498.8, 0.5}));

}  // namespace
}  // namespace palpate
