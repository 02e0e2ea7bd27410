// The models without a mesh, from a scenario to its rows: layers, deep presses, viscous contact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cases.h"
#include "contact/depth_ratio.h"
#include "contact/hertz.h"
#include "run/family.h"
#include "run_text.h"

namespace palpate {
namespace {

using test::find_case;
using test::run_text;

double force_at(const record::CaseRecord& record, double time) {
  for (const auto& row : record.contact)
    if (std::abs(row.time - time) < 1e-9) return row.force;
  ADD_FAILURE() << "no row at " << time << " s";
  return 0.0;
}

const std::string layer =
    "[tissue]\nshape = { kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", \"10 mm\"] }\n"
    "[finger]\nmaterial = \"rigid\"\n[contact]\ndepth = \"hertz\"\n[solver]\nmodel = \"layer\"\n"
    "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"1 mm/s\"\n";

TEST(ClosedForms, LayersOfThreeTissues) {
  const std::pair<const char*, const char*> rows[] = {
      {"skin", "layer-25"}, {"ligament", "layer-27"}, {"upper_leg", "layer-28"}};
  for (const auto& [material, id] : rows) {
    const auto record = run_text(layer, {std::string("tissue.material=") + material});
    const auto& last = record.contact.back();
    const auto one =
        scenario::parse(layer, "test.toml", {std::string("tissue.material=") + material})
            .cases.front()
            .materials.tissue;
    const double modulus =
        one.young_modulus.value / (1.0 - one.poisson_ratio.value * one.poisson_ratio.value);
    const auto expected = find_case(id);
    EXPECT_NEAR(last.force / contact::hertz::force(1e-3, 0.011, modulus), expected.value,
                (expected.rel_tol + 1e-7) * expected.value)  // the table's own 1e-7
        << id;
    // The map of the layer's own pressure integrates to the force.
    for (const auto& finding : record.findings)
      if (finding.name == "pressure_map_imbalance") {
        EXPECT_LT(std::get<double>(finding.value), 2e-3);  // 128 pixels a side
      }
  }
}

TEST(ClosedForms, ALayerTooThinIsSaid) {
  const auto record = run_text(
      layer, {"tissue.shape.size=[\"60 mm\",\"60 mm\",\"0.5 mm\"]", "step.1.to=\"0.4 mm\""});
  EXPECT_EQ(record.outcome, record::Outcome::diverged);
  EXPECT_NE(record.reason.find("too thin"), std::string::npos) << record.reason;
}

TEST(ClosedForms, DeepPressesTakeTheFactor) {
  const std::string deep =
      "[tissue]\nshape = { kind = \"half_space\" }\n[finger]\nmaterial = \"rigid\"\n"
      "[contact]\ndepth = \"neo_hookean\"\n[solver]\nmodel = \"hertz\"\n"
      "[[step]]\nkind = \"indent\"\nto = \"5.5 mm\"\nrate = \"1 mm/s\"\n";
  const auto record = run_text(deep, {"tissue.poisson_ratio=0.45"});
  const double modulus = 72.4e3 / (1.0 - 0.45 * 0.45);
  const auto expected = find_case("large-12");
  EXPECT_NEAR(record.contact.back().force / contact::hertz::force(5.5e-3, 0.011, modulus),
              expected.value, (expected.rel_tol + 0.002) * expected.value);  // and the fit's
}

// The force of a named layer is that of the layer that `auto` takes, where large strains matter and
// where they do not.
TEST(ClosedForms, ANamedLayerIsTheLayerOfAuto) {
  const std::string press =
      "[tissue]\nyoung_modulus = \"20 kPa\"\npoisson_ratio = 0.45\nviscosity = \"none\"\n"
      "base = \"bonded\"\nshape = { kind = \"cuboid\", size = [\"100 mm\", \"100 mm\", \"5 mm\"] "
      "}\n"
      "[finger]\nmaterial = \"rigid\"\nradius = \"5 mm\"\n"
      "[[step]]\nkind = \"indent\"\nto = \"0.6 mm\"\nrate = \"1 mm/s\"\n";
  for (const char* to : {"step.1.to=\"0.6 mm\"", "step.1.to=\"0.1 mm\""}) {
    const auto chosen = run_text(press, {to});
    const auto named = run_text(press, {to, "solver.model=layer"});
    EXPECT_GT(named.contact.back().force, 0.0);
    EXPECT_EQ(named.contact.back().force, chosen.contact.back().force) << to;
  }
  const auto linear = run_text(press, {"solver.model=layer", "contact.depth=hertz"});
  const auto named = run_text(press, {"solver.model=layer"});
  EXPECT_LT(named.contact.back().force, 0.99 * linear.contact.back().force);
}

// The mesh is linear, so that its force is multiplied as that of a closed form.
TEST(DeepPress, OnAMeshHasTheFactorOfItsPlace) {
  const std::string press =
      "[tissue]\nyoung_modulus = \"10 kPa\"\npoisson_ratio = 0.45\nbase = \"bonded\"\n"
      "shape = { kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", \"30 mm\"] }\n[finger]\n"
      "material = \"rigid\"\nradius = \"11 mm\"\n[contact]\nviscosity = \"none\"\n"
      "[output]\npressure_maps = false\n[[step]]\nkind = \"indent\"\nto = \"5 mm\"\n"
      "rate = \"1 mm/s\"\n";
  const auto force = [&](const char* model, const char* depth) {
    const auto record =
        run_text(press, {std::string("solver.model=") + model,
                         std::string("contact.depth=") + depth, "solver.integrator=quasi_static"});
    EXPECT_EQ(record.outcome, record::Outcome::completed) << record.reason;
    return record.contact.back().contact_force;
  };
  const auto ratio =
      contact::depth_ratio({.radius = 0.011, .thickness = 0.030, .poisson_ratio = 0.45});
  const double factor = ratio.value().value(5e-3);
  EXPECT_LT(factor, 0.95);
  for (const char* model : {"layer", "mass_spring", "coupled_springs"}) {
    const double linear = force(model, "hertz");
    EXPECT_NEAR(force(model, "neo_hookean"), factor * linear, 1e-9 * linear) << model;
  }
}

// E_inf 1 kPa and E_0 3 kPa would be rows of their own; the cases' solid is given by them here.
const std::string solid =
    "[tissue]\nshape = { kind = \"half_space\" }\nyoung_modulus = \"10 kPa\"\npoisson_ratio = "
    "0.49\nviscosity = \"standard_linear_solid\"\nrelaxation_time = \"0.5 s\"\n"
    "instantaneous_ratio = 3\n[finger]\nmaterial = \"rigid\"\n[solver]\nmodel = \"hertz\"\n"
    "[output]\ninterval = \"50 ms\"\npressure_maps = false\n"
    "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = \"1 mm/s\"\n"
    "[[step]]\nkind = \"hold\"\ntime = \"4 s\"\n";

// F = phi(h_m) + branch, which fades by exp(-t/tau) while the depth is held.
TEST(ClosedForms, AHeldPressRelaxesToTheElasticForce) {
  const auto record = run_text(solid, {});
  const double relaxed = contact::hertz::force(2e-3, 0.011, 10e3 / (1.0 - 0.49 * 0.49));
  const double extra = force_at(record, 2.0) - relaxed;
  EXPECT_GT(extra, 0.3 * relaxed);  // 2 s against 0.5 s: x = 1/4 of the branch of 2, some 0.6
  EXPECT_NEAR(force_at(record, 3.0) - relaxed, extra * std::exp(-2.0), 1e-9 * relaxed);
  EXPECT_NEAR(force_at(record, 5.0) - relaxed, extra * std::exp(-6.0), 1e-9 * relaxed);
}

// Lee and Radok's integral by a fine sum of its own.
TEST(ClosedForms, ARampPressesHarderTheFasterItIs) {
  for (const double rate : {1.0, 10.0}) {
    const auto record = run_text(solid, {"step.1.rate=\"" + std::to_string(rate) + " mm/s\""});
    const double end = 2.0 / rate;
    const double plane = 10e3 / (1.0 - 0.49 * 0.49);
    double sum = 0.0;
    constexpr int parts = 200000;
    for (int i = 0; i < parts; ++i) {
      const auto phi = [&](double time) {
        return contact::hertz::force(1e-3 * rate * time, 0.011, plane);
      };
      const double begin = end * i / parts;
      const double stop = end * (i + 1) / parts;
      sum += (1.0 + 2.0 * std::exp(-(end - 0.5 * (begin + stop)) / 0.5)) * (phi(stop) - phi(begin));
    }
    EXPECT_NEAR(force_at(record, end), sum, 1e-3 * sum) << rate;  // parts of a fiftieth of tau
  }
}

// However far the rows stand apart, between them steps are short against the tissue's times.
TEST(ClosedForms, TheIntervalDoesNotChangeTheForce) {
  const auto coarse = run_text(solid, {"output.interval=\"500 ms\""});
  const auto fine = run_text(solid, {"output.interval=\"5 ms\""});
  for (const double time : {1.0, 2.0, 3.0})
    EXPECT_NEAR(force_at(coarse, time), force_at(fine, time), 2e-3 * force_at(fine, time)) << time;
}

// The same tissue on a mesh: its elastic force is another, what viscosity makes of it is not.
TEST(ClosedForms, AMeshesPressRelaxesByTheSameRatio) {
  const auto layered = run_text(solid, {"tissue.shape={kind=\"cuboid\"}", "solver.model=layer"});
  const auto meshed =
      run_text(solid, {"tissue.shape={kind=\"cuboid\"}", "solver.model=coupled_springs",
                       "solver.integrator=quasi_static"});
  const double peak = force_at(layered, 2.0) / force_at(layered, 6.0);
  EXPECT_GT(peak, 1.3);
  EXPECT_NEAR(force_at(meshed, 2.0) / force_at(meshed, 6.0), peak, 0.01 * peak);
}

}  // namespace
}  // namespace palpate
