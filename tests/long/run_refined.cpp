// Presses on meshes that are refined where their error comes from.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "base/text.h"
#include "run_text.h"

namespace palpate {
namespace {

std::string refined_press(const std::string& tissue, const std::string& solver = "",
                          double travel = 0.5) {
  return "[tissue]\n" + tissue +
         "[finger]\nmaterial = \"rigid\"\n[solver]\nmodel = \"coupled_springs\"\nintegrator = "
         "\"quasi_static\"\n" +
         solver +
         "[output]\ninterval = \"100 ms\"\npressure_maps = false\n[[step]]\nkind = "
         "\"indent\"\nto = \"" +
         number_text(travel) + " mm\"\nrate = \"" + number_text(travel) + " mm/s\"\n";
}

struct Answer {
  double force = 0.0, error = 0.0, nodes = 0.0;
};

Answer answer(const std::string& text) {
  const record::CaseRecord record = test::run_text(text);
  EXPECT_EQ(record.outcome, record::Outcome::completed) << record.reason;
  return {std::get<double>(test::finding(record, "peak_force_N")),
          std::get<double>(test::finding(record, "mesh_error")),
          std::get<double>(test::finding(record, "nodes"))};
}

const std::string thin_plate =
    "poisson_ratio = 0.45\nshape = { kind = \"cuboid\", size = [\"70 mm\", \"70 mm\", \"8 mm\"] "
    "}\n";

// The default cells are 23 mm wide and see nothing of a press 2 mm wide.
TEST(Refined, AThinPlateIsPressedLikeTheExactLayer) {
  std::string exact = refined_press(thin_plate);
  exact.replace(exact.find("coupled_springs"), 15, "layer");
  exact.erase(exact.find("integrator"), std::string("integrator = \"quasi_static\"\n").size());
  const record::CaseRecord layer = test::run_text(exact);
  const double truth = std::get<double>(test::finding(layer, "peak_force_N"));
  const std::string given =
      refined_press(thin_plate + "mesh = { kind = \"mirrored\", cells = [3, 4, 6] }\n");
  const Answer coarse = answer(given);
  EXPECT_GT(std::abs(coarse.force / truth - 1.0), 0.05);
  EXPECT_LT(std::abs(coarse.force / truth - 1.0), coarse.error);
  const Answer found = answer(refined_press(thin_plate));
  EXPECT_LT(std::abs(found.force / truth - 1.0), found.error);
  EXPECT_LT(found.error, 0.025);
  const Answer finer = answer(refined_press(thin_plate, "tolerance = 0.02\n"));
  EXPECT_LT(std::abs(finer.force / truth - 1.0), finer.error);
  EXPECT_LT(finer.error, 0.01);
  EXPECT_GT(finer.nodes, found.nodes);
}

// On 140 nodes of blocks 0.6 to 1.5 times as thick as the finger's radius, the estimate alone sees
// a fifth to a half of the error.
TEST(Refined, MeshesThatAreTooWideForTheirEstimateStateMore) {
  struct Block {
    double side, thickness, ratio;  // mm, mm
  };
  for (const Block& block : {Block{50, 10, 0.42}, Block{62, 6.6, 0.17}, Block{80, 16, 0.3}}) {
    const std::string side = "\"" + number_text(block.side) + " mm\"";
    const std::string tissue = "poisson_ratio = " + number_text(block.ratio) +
                               "\nshape = { kind = \"cuboid\", size = [" + side + ", " + side +
                               ", \"" + number_text(block.thickness) + " mm\"] }\n";
    const Answer fine = answer(refined_press(tissue, "tolerance = 0.01\n"));
    const Answer coarse =
        answer(refined_press(tissue + "mesh = { kind = \"mirrored\", cells = [3, 4, 6] }\n"));
    const double off = std::abs(coarse.force / fine.force - 1.0);
    EXPECT_EQ(coarse.nodes, 140.0);
    EXPECT_LT(off, coarse.error + fine.error) << tissue;
    EXPECT_GT(off, 0.3 * coarse.error) << tissue;
    EXPECT_LT(fine.error, 0.007);
  }
}

TEST(Refined, StopsAtTheStatedNumberOfNodesAndSaysSo) {
  const record::CaseRecord record = test::run_text(refined_press(
      thin_plate + "mesh = { kind = \"mirrored\", refine = true, most_nodes = 250 }\n",
      "tolerance = 0.001\n"));
  EXPECT_LE(std::get<double>(test::finding(record, "nodes")), 250.0);
  EXPECT_EQ(std::get<double>(test::finding(record, "nodes_before_refining")), 140.0);
  EXPECT_TRUE(std::any_of(record.warnings.begin(), record.warnings.end(), [](const auto& warning) {
    return warning.find("raise `tissue.mesh.most_nodes`") != std::string::npos;
  }));
}

TEST(Refined, MeshesDependOnTheRatioOfModuliOnly) {
  const std::string lump =
      "shape = { kind = \"cuboid\", size = [\"50 mm\", \"50 mm\", \"30 mm\"] }\nyoung_modulus = "
      "\"$ kPa\"\nmesh = { kind = \"tetgen\", nodes = 250, refine = true }\n[[region]]\nkind = "
      "\"sphere\"\nmaterial = \"skin\"\ncentre = [\"25 mm\", \"25 "
      "mm\", \"21 mm\"]\nradius = \"5 mm\"\nyoung_modulus = \"@ kPa\"\n";
  const auto with = [&](const char* around, const char* inside) {
    std::string text = lump;
    text.replace(text.find('$'), 1, around);
    text.replace(text.find('@'), 1, inside);
    return answer(refined_press(text));
  };
  const Answer soft = with("16", "128");
  const Answer hard = with("64", "512");  // exact multiples in binary
  EXPECT_EQ(soft.nodes, hard.nodes);
  EXPECT_NEAR(hard.force / soft.force, 4.0, 1e-9);
  EXPECT_NE(with("16", "1280").nodes, soft.nodes);
}

// Two meshes of one body differ by no more than both state.
TEST(Refined, MeshesOfRandomBodiesAgreeWithinWhatTheyState) {
  std::mt19937 random(11);
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
  };
  for (int pair = 0; pair < 4; ++pair) {
    const auto mm = [&](double low, double high) {
      return "\"" + number_text(std::round(10.0 * within(low, high)) / 10.0) + " mm\"";
    };
    const std::string shape = pair % 4 == 0 ? "{ kind = \"cuboid\", size = [" + mm(40, 80) + ", " +
                                                  mm(40, 80) + ", " + mm(8, 40) + "] }"
                              : pair % 4 == 1 ? "{ kind = \"cylinder\", radius = " + mm(14, 40) +
                                                    ", length = " + mm(60, 120) + " }"
                                              : "{ kind = \"ellipsoid\", size = [" + mm(40, 90) +
                                                    ", " + mm(40, 90) + ", " + mm(20, 50) + "] }";
    const std::string tissue =
        "poisson_ratio = " + number_text(std::round(100.0 * within(0.2, 0.49)) / 100.0) +
        "\nshape = " + shape + "\n";
    const auto nodes = [](int count) {
      return "mesh = { kind = \"tetgen\", nodes = " + std::to_string(count) + ", refine = true }\n";
    };
    const Answer coarse = answer(refined_press(tissue + nodes(200)));
    const Answer fine = answer(refined_press(tissue + nodes(500)));
    EXPECT_LE(std::abs(coarse.force / fine.force - 1.0), coarse.error + fine.error)
        << tissue << coarse.force << " " << fine.force;
  }
}

// Slabs are cut out of any mesh.
TEST(Refined, ALumpKeepsItsVolume) {
  const std::string text = refined_press(
      "poisson_ratio = 0.45\nshape = { kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", \"40 "
      "mm\"] }\n[[region]]\nkind = \"sphere\"\ncentre = [\"30 mm\", \"30 mm\", \"30 "
      "mm\"]\nradius = \"5 mm\"\nmaterial = \"skin\"\nyoung_modulus = \"1448 kPa\"\n");
  const scenario::Family family = scenario::parse(text, "scene.toml", {});
  const scene::Scene scene = run::build_scene(family.cases.front(), family);
  const geometry::TetMesh& mesh = scene.specimen->mesh;
  double volume = 0.0;
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t)
    if (mesh.region(t) == 1) volume += geometry::signed_volume(mesh, t);
  ASSERT_GT(scene.specimen->refined->rounds, 0);
  EXPECT_NEAR(volume / (4.0 / 3.0 * std::numbers::pi * std::pow(0.005, 3)), 1.0, 1e-6);
}

TEST(Slabs, InMeshesByTetGenAreThoseOfLattices) {
  const std::string layers =
      "young_modulus = \"60 kPa\"\nshape = { kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", \"20 "
      "mm\"] }\nmesh = $\n[[region]]\nkind = \"slab\"\nmaterial = \"skin\"\nbottom = \"0 mm\"\ntop "
      "= \"13 mm\"\nyoung_modulus = \"10 kPa\"\n";
  const auto with = [&](const char* mesh) {
    std::string text = layers;
    text.replace(text.find('$'), 1, mesh);
    return answer(refined_press(text));
  };
  const Answer lattice = with("{ kind = \"mirrored\", cells = [8, 8, 6] }");
  const Answer unstructured = with("{ kind = \"tetgen\", nodes = 700 }");
  EXPECT_NEAR(unstructured.force / lattice.force, 1.0, 0.005);
}

// A slab in a round body, where no formula knows the layer: two meshes agree.
TEST(Slabs, LieInRoundBodies) {
  const auto with = [&](int nodes) {
    return answer(refined_press(
        "shape = { kind = \"cylinder\", radius = \"25 mm\", length = \"80 mm\" }\nmesh = { kind = "
        "\"tetgen\", refine = true, nodes = " +
        std::to_string(nodes) +
        " }\n[[region]]\nkind = \"slab\"\nmaterial = \"bone\"\nbottom = \"0 mm\"\ntop = \"30 "
        "mm\"\n"));
  };
  const Answer coarse = with(300);
  const Answer fine = with(900);
  EXPECT_LE(std::abs(coarse.force / fine.force - 1.0), coarse.error + fine.error);
}

}  // namespace
}  // namespace palpate
