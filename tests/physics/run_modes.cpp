// `modal` with the lowest modes: the force with all modes within what the run states, and refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "run_text.h"

namespace palpate {
namespace {

using test::found;
using test::run_text;

std::string modal_press(const std::string& cells) {
  return "schema = 1\n[tissue]\nmaterial = \"skin\"\n"
         "shape = { kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", \"30 mm\"] }\n"
         "mesh = { kind = \"kuhn\", cells = " +
         cells +
         " }\n[solver]\nmodel = \"coupled_springs\"\nintegrator = \"modal\"\n"
         "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = \"100 mm/s\"\n"
         "[output]\ninterval = \"1 ms\"\npressure_maps = false\n";
}

// A row every 50 ms, the period of a low mode of this block: steps of that length excited it more
// and more, and the force was 9 % too high.
TEST(Modal, a_slow_force_does_not_depend_on_the_distance_of_rows) {
  const std::string block =
      "schema = 1\n[tissue]\nmaterial = \"muscle\"\nviscosity = \"none\"\n"
      "shape = { kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", \"30 mm\"] }\n"
      "[finger]\nmaterial = \"rigid\"\nradius = \"8 mm\"\n"
      "[solver]\nmodel = \"mass_spring\"\nintegrator = \"modal\"\n"
      "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = \"5 mm/s\"\n"
      "[output]\ninterval = \"50 ms\"\npressure_maps = false\n";
  const double still = found(run_text(block, {"solver.integrator=quasi_static"}), "peak_force_N");
  for (const char* interval : {"50 ms", "20 ms", "200 ms"})
    EXPECT_NEAR(
        found(run_text(block, {std::string("output.interval=") + interval}), "peak_force_N"), still,
        0.002 * still)
        << interval;
}

TEST(LowestModes, miss_no_more_than_the_inertia_that_is_stated_as_dropped) {
  const std::string block = modal_press("[6, 6, 3]");
  for (const char* viscosity : {"none", "standard_linear_solid"})
    for (const char* rate : {"20 mm/s", "100 mm/s", "1000 mm/s"}) {
      const std::vector<std::string> scene{std::string("tissue.viscosity=") + viscosity,
                                           std::string("step.1.rate=") + rate};
      auto of_all = scene;
      of_all.emplace_back("solver.modes=1000");
      const auto all = run_text(block, of_all);
      EXPECT_FALSE(test::has_finding(all, "dropped_inertia"));
      for (const int modes : {16, 128}) {
        auto of_few = scene;
        of_few.push_back("solver.modes=" + std::to_string(modes));
        const auto few = run_text(block, of_few);
        EXPECT_EQ(found(few, "kept_modes"), modes);
        const double share = found(few, "dropped_inertia");
        EXPECT_GT(share, 0.005);
        EXPECT_LT(share, 0.3);  // a quarter of the travel with 16 modes
        const double peak = found(all, "peak_force_N");
        double most = 0.0;
        ASSERT_EQ(few.contact.size(), all.contact.size());
        for (std::size_t i = 0; i < few.contact.size(); ++i)
          most = std::max(most, std::abs(few.contact[i].force - all.contact[i].force));
        EXPECT_LT(most, share * peak) << viscosity << " " << rate << " " << modes;
      }
    }
}

TEST(LowestModes, serve_bodies_of_more_than_a_thousand_nodes) {
  const std::string block = modal_press("[12, 12, 8]");
  const auto moving = run_text(block, {"solver.modes=16"});
  EXPECT_EQ(found(moving, "nodes"), 1521.0);
  EXPECT_EQ(found(moving, "kept_modes"), 16.0);
  // With Kelvin-Voigt's tissue the force follows from the finger alone.
  EXPECT_EQ(found(moving, "dropped_inertia"), 0.0);
  const auto still = run_text(block, {"solver.integrator=quasi_static"});
  EXPECT_NEAR(found(moving, "peak_force_N"), found(still, "peak_force_N"),
              1e-12 * found(still, "peak_force_N"));  // rounding
}

TEST(LowestModes, are_refused_where_the_force_needs_the_whole_motion) {
  const auto refusal = [](const std::string& cells, const std::vector<std::string>& settings) {
    try {
      (void)run_text(modal_press(cells), settings);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no refusal");
  };
  EXPECT_NE(refusal("[3, 4, 6]", {"contact.coupling=series", "solver.modes=16"})
                .find("read the mesh's motion; remove `modes`"),
            std::string::npos);
  EXPECT_NE(refusal("[12, 12, 8]", {"solver.rings=3"})
                .find("up to 1000 nodes, and this mesh has 1521; use fewer cells"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate
