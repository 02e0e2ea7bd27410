// A stiff lump under the skin is felt, as strongly as a finer mesh says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "run/family.h"
#include "run_text.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

const std::string press_over_lump =
    "schema = 1\n[tissue]\nmaterial = \"skin\"\nyoung_modulus = \"20 kPa\"\n"
    "shape = { size = [\"60 mm\", \"40 mm\", \"25 mm\"] }\n"
    "mesh = { kind = \"tetgen\", nodes = 1500 }\n"
    "[[region]]\nkind = \"sphere\"\ncentre = [\"30 mm\", \"20 mm\", \"13 mm\"]\n"
    "radius = \"7 mm\"\nmaterial = \"skin\"\n"
    "[solver]\nmodel = \"mass_spring\"\nintegrator = \"quasi_static\"\n"
    "[output]\ninterval = \"200 ms\"\npressure_maps = false\n"
    "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"5 mm/s\"\n";

// The force at 1 mm with a lump so stiff, N.
double force(const std::string& lump_modulus, const std::vector<std::string>& more) {
  std::vector<std::string> settings = more;
  settings.push_back("region.1.young_modulus=" + lump_modulus);
  const auto record = test::run_text(press_over_lump, settings);
  EXPECT_EQ(record.outcome, record::Outcome::completed) << record.reason;
  return record.contact.back().contact_force;
}

double felt(const std::vector<std::string>& settings) {
  return force("1000 kPa", settings) / force("20 kPa", settings);
}

TEST(Lump, IsFeltAsAFinerMeshSays) {
  const double coarse = felt({});
  const double fine = felt({"tissue.mesh.nodes=3500"});
  EXPECT_GT(coarse, 1.2);
  // Measured over a slide on meshes of 2000, 4000 and 7000 nodes: 1.28, 1.32, 1.33.
  EXPECT_NEAR(coarse, fine, 0.08) << fine;
  EXPECT_NEAR(fine, 1.32, 0.05);
}

TEST(Lump, IsNotFeltFromAfar) {
  EXPECT_NEAR(felt({"finger.x=8 mm", "tissue.mesh.nodes=800"}), 1.0, 0.03);  // 22 mm off
}

// What a lump of the tissue's own stiffness changes is nothing but the mesh around it.
TEST(Lump, OfTheSameStiffnessIsNone) {
  EXPECT_EQ(force("20 kPa", {"tissue.mesh.nodes=500"}),
            force("20000 Pa", {"tissue.mesh.nodes=500"}));
}

// Springs with tetrahedra of one tissue alone around them do not know of the others; those between
// get the mean.
TEST(Lump, SpringsTakeTheModulusAroundThem) {
  const scene::Scene scene = test::scene_of(press_over_lump, {"tissue.mesh.nodes=500"});
  const geometry::TetMesh& mesh = scene.specimen->mesh;
  for (const auto rule : {tissue::StiffnessRule::van_gelder, tissue::StiffnessRule::fitted}) {
    const auto stiffness = [&](const std::array<double, 2>& moduli) {
      return rule == tissue::StiffnessRule::van_gelder
                 ? tissue::van_gelder_stiffness(mesh, moduli)
                 : tissue::fitted_stiffness(mesh, tissue::fit_springs(mesh), moduli);
    };
    const auto soft = stiffness({1.0, 1.0});
    const auto mixed = stiffness({1.0, 50.0});
    int alike = 0;
    int between = 0;
    int stiff = 0;
    for (std::size_t s = 0; s < soft.size(); ++s) {
      const double ratio = mixed[s] / soft[s];
      EXPECT_GE(ratio, 1.0 - 1e-12);   // rounding of a quotient
      EXPECT_LE(ratio, 50.0 + 1e-10);  // likewise
      alike += std::abs(ratio - 1.0) < 1e-12 ? 1 : 0;
      stiff += std::abs(ratio - 50.0) < 1e-10 ? 1 : 0;
      between += ratio > 1.01 && ratio < 49.9 ? 1 : 0;
    }
    EXPECT_GT(alike, 500);
    EXPECT_GT(stiff, 10);
    EXPECT_GT(between, 50);
  }
}

}  // namespace
}  // namespace palpate
