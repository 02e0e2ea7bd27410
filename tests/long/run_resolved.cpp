// Contact that the mesh resolves: unilateral node by node, in balance, in motion, with friction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "contact/hertz.h"
#include "mechanics/pressed_mesh.h"
#include "mechanics/resolved_contact.h"
#include "run/family.h"
#include "run_text.h"
#include "scene/first_touch.h"
#include "scene/scene.h"

namespace palpate {
namespace {

using integrate::Vector;

// 1183 nodes, 3.3 cells along the contact radius at 1.5 mm.
const std::string block =
    "schema = 1\n[tissue]\nmaterial = \"skin\"\nviscosity = \"none\"\n"
    "shape = { kind = \"cuboid\", size = [\"20 mm\", \"20 mm\", \"10 mm\"] }\n"
    "mesh = { kind = \"mirrored\", cells = [12, 12, 6], grading = 3 }\n"
    "[finger]\nmaterial = \"rigid\"\n[contact]\ncoupling = \"resolved\"\n"
    "[solver]\nmodel = \"coupled_springs\"\nintegrator = \"quasi_static\"\n"
    "[output]\ninterval = \"250 ms\"\n"
    "[[step]]\nkind = \"indent\"\nto = \"1.5 mm\"\nrate = \"1 mm/s\"\n";

// `steps` come after the press.
scene::Scene build_block(const std::vector<std::string>& settings, const std::string& steps = "") {
  return test::scene_of(block + steps, settings);
}

record::CaseRecord run_block(const std::vector<std::string>& settings,
                             const std::string& steps = "") {
  return test::run_text(block + steps, settings);
}

double last_force(const std::vector<std::string>& settings) {
  return run_block(settings).contact.back().contact_force;
}

// A scene pressed to a travel in one quasi-static step.
struct Pressed {
  scene::Scene scene;
  mechanics::PressedMesh mesh;
  mechanics::Touch touch;

  Pressed(const std::vector<std::string>& settings, double travel)
      : scene(build_block(settings)), mesh(scene) {
    mechanics::ContactHistory history(scene);
    mesh.set_step(1.0);
    touch.finger = scene::first_touch(scene).finger;
    touch.travel = travel;
    const Vec3 finger = touch.finger - travel * Vec3::UnitZ();
    const auto wrong = mesh.step(finger, 1.0, history, touch);
    EXPECT_FALSE(wrong) << *wrong;
  }

  // Of every node of the skin to the sphere along the vertical, m, as the skin has moved.
  [[nodiscard]] std::map<int, double> gaps() {
    std::map<int, double> all;
    const Vector moved = mesh.displacement();
    const Vec3 centre = touch.finger;
    const double radius = scene.finger.sphere_radius;
    const auto& vertices = scene.specimen->surface->surface().vertices;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const Vec3 away = vertices[v] - centre;
      const double square = away.head<2>().squaredNorm();
      if (away.z() < -2.0 * radius || square >= radius * radius) continue;
      if (vertices[v].z() < scene.specimen->high.z() - 1e-9) continue;
      const double bottom = centre.z() - std::sqrt(radius * radius - square);
      all[static_cast<int>(v)] =
          bottom - vertices[v].z() - moved[3 * scene.specimen->outer_surface[v] + 2];
    }
    return all;
  }
};

TEST(Resolved, nodes_touch_or_are_free_and_none_pulls_or_overlaps) {
  Pressed pressed({}, 1.5e-3);
  ASSERT_EQ(pressed.touch.contacts.size(), 1u);
  const mechanics::SphereContact& contact = pressed.touch.contacts.front();
  const mechanics::SurfaceNodes nodes(*pressed.scene.specimen->surface);
  std::map<int, double> share;
  for (std::size_t k = 0; k < contact.load.vertices.size(); ++k)
    share[contact.load.vertices[k]] = contact.load.shares[k];
  ASSERT_GT(share.size(), 20u);
  int free = 0;
  for (const auto& [vertex, gap] : pressed.gaps()) {
    // A sphere stands off the flat facets around a node by this in the mean.
    const double facets =
        nodes.facing(vertex, {pressed.touch.finger, pressed.scene.finger.sphere_radius})->facets;
    if (share.contains(vertex)) {
      EXPECT_GT(share[vertex], 0.0);
      EXPECT_NEAR(gap + facets, 0.0, 1e-13);  // rounding of 10 mm
    } else {
      EXPECT_GT(gap + facets, -1e-13);
      ++free;
    }
  }
  EXPECT_GT(free, 50);
}

TEST(Resolved, the_base_carries_what_the_finger_presses_with) {
  for (const char* direction : {"surface", "sphere"}) {
    Pressed pressed({std::string("contact.direction=") + direction}, 1.5e-3);
    const auto& body = pressed.mesh.body();
    Vector force;
    body.force(pressed.mesh.state().displacement, pressed.mesh.state().memory, force);
    Vec3 base = Vec3::Zero();
    Vec3 top = Vec3::Zero();
    for (Eigen::Index n = 0; n < force.size() / 3; ++n)
      (body.held()[static_cast<std::size_t>(3 * n)] != 0 ? base : top) += force.segment<3>(3 * n);
    const double pressing = pressed.touch.normal_force();
    EXPECT_GT(pressing, 0.5);
    EXPECT_NEAR(base.z(), pressing, 1e-9 * pressing) << direction;  // solved to rounding
    EXPECT_NEAR(base.head<2>().norm(), 0.0, 1e-9 * pressing) << direction;
    EXPECT_NEAR((base + top).norm(), 0.0, 1e-9 * pressing) << direction;
  }
}

// The force does not depend on how it was reached: in one step or in many, up or down.
TEST(Resolved, elastic_contact_forgets_its_way) {
  const double at_once = Pressed({}, 1.5e-3).touch.normal_force();
  EXPECT_NEAR(last_force({}), at_once, 1e-10 * at_once);  // two active sets meet in rounding
  const auto back = run_block({"step.1.to=2 mm"},
                              "[[step]]\nkind = \"retract\"\nto = \"1.5 mm\"\nrate = \"1 mm/s\"\n");
  EXPECT_NEAR(back.contact.back().contact_force, at_once, 1e-10 * at_once);
}

// Bone under a rubber finger: 99.985 % of the compliance is the finger's, a half-space's here, and
// the mesh matters only by its nodes. Hertz's own a = 2 mm on cells of half a millimetre.
TEST(Resolved, a_soft_finger_on_bone_is_hertz) {
  const auto scene = build_block({"tissue.material=bone", "finger.material=finger",
                                  "tissue.shape.size=[\"8 mm\",\"8 mm\",\"5 mm\"]",
                                  "tissue.mesh={kind=\"mirrored\",cells=[16,16,2]}",
                                  "step.1.to=0.36 mm", "output.interval=90 ms"});
  const auto record = test::run_scene(scene);
  const double depth = record.contact.back().travel;
  const double hertz = contact::hertz::force(depth, 0.011, scene.law().modulus);
  // Facets of 4 cells a radius, and neighbours as point loads.
  EXPECT_NEAR(record.contact.back().contact_force / hertz, 1.0, 0.02);
  EXPECT_NEAR(record.contact.back().contact_radius / std::sqrt(0.011 * depth), 1.0, 0.1);
  const double mean = hertz / (M_PI * 0.011 * depth);
  EXPECT_NEAR(record.contact.back().peak_pressure / (1.5 * mean), 1.0,
              0.1);  // a node's, of 4 or 8 triangles
}

// Both compliances in one: softer than each, and not by the formula for springs in a row.
TEST(Resolved, an_elastic_finger_gives_way_too) {
  const double rigid = last_force({});
  const double soft = last_force(
      {"finger.material=finger", "finger.young_modulus=72.4 kPa", "finger.poisson_ratio=0.33"});
  const double stiff = last_force({"finger.material=finger", "finger.young_modulus=1e9 kPa"});
  EXPECT_NEAR(stiff / rigid, 1.0, 1e-6);  // lambda_1 is 7e-8 of lambda_2
  // Equal halves would halve it on a half-space; a thin layer is the stiffer partner.
  EXPECT_LT(soft, 0.5 * rigid);
  EXPECT_GT(soft, 0.25 * rigid);
}

TEST(Resolved, both_directions_are_the_same_for_shallow_presses_and_differ_for_deep_ones) {
  const std::vector<std::string> fine{"tissue.mesh={kind=\"mirrored\",cells=[12,12,6],grading=20}"};
  const auto ratio = [&](const std::string& travel) {
    auto settings = fine;
    settings.push_back("step.1.to=" + travel);
    settings.emplace_back("contact.direction=surface");
    const double outer_surface = last_force(settings);
    settings.back() = "contact.direction=sphere";
    return last_force(settings) / outer_surface;
  };
  const double shallow = ratio("0.3 mm") - 1.0;
  const double deep = ratio("1.5 mm") - 1.0;
  // Of the order of h/R, at most.
  EXPECT_GT(std::abs(deep), 0.001);
  EXPECT_LT(std::abs(deep), 1.5 / 11.0);
  EXPECT_LT(std::abs(shallow), 0.3 / 11.0);
}

TEST(Resolved, nonlinear_springs_take_the_spheres_normals_and_agree_with_linear_ones_at_first) {
  const auto softening = [](const char* mesh, const char* travel) {
    std::vector<std::string> settings{std::string("tissue.mesh=") + mesh,
                                      std::string("step.1.to=") + travel, "output.interval=500 ms",
                                      "contact.direction=sphere"};
    const double linear = last_force(settings);
    settings.back() = "solver.kinematics=nonlinear";
    const double nonlinear = last_force(settings);
    settings.emplace_back("contact.direction=surface");
    EXPECT_NE(last_force(settings), nonlinear);
    return 1.0 - nonlinear / linear;
  };
  // St Venant-Kirchhoff's softening in compression goes with the strain, which goes with a/R: by
  // sqrt(0.04 / 0.15) = 0.52 of it.
  const double deeper = softening("{kind=\"mirrored\",cells=[10,10,5],grading=60}", "0.15 mm");
  const double first = softening("{kind=\"mirrored\",cells=[12,12,6],grading=200}", "0.04 mm");
  EXPECT_GT(first, 0.0);
  EXPECT_LT(first, 0.52 * deeper);
}

TEST(Resolved, a_slow_press_with_inertia_is_a_quasi_static_one) {
  const double still = last_force({});
  for (const char* integrator : {"backward_difference", "tr_bdf2"}) {
    const double moving =
        last_force({std::string("solver.integrator=") + integrator, "step.1.rate=5 mm/s",
                    "output.interval=10 ms", "solver.time_step=2 ms"});
    EXPECT_NEAR(moving / still, 1.0, 2e-3)
        << integrator;  // a wave's way through 10 mm: 1 of 300 ms
  }
}

// Thrown back at 5 m/s, as fast as its waves, the skin is left behind: contact ends before the
// travel does, and never pulls.
TEST(Resolved, contact_opens_in_motion) {
  const auto record = run_block({"solver.integrator=backward_difference", "step.1.rate=300 mm/s",
                                 "output.interval=0.1 ms", "output.pressure_maps=false"},
                                "[[step]]\nkind = \"retract\"\nto = \"0 mm\"\nrate = \"5 m/s\"\n");
  ASSERT_EQ(record.outcome, record::Outcome::completed) << record.reason;
  double open_at = 0.0;
  for (const auto& row : record.contact) {
    EXPECT_GE(row.contact_force, 0.0);
    if (row.step == 2 && row.contact_force == 0.0) open_at = std::max(open_at, row.travel);
  }
  EXPECT_GT(open_at, 0.1e-3);
}

// In Kelvin-Voigt tissue every velocity costs force, and at rest nothing is left of it.
TEST(Resolved, the_meshs_viscosity_reaches_the_force_by_itself) {
  const double elastic = last_force({});
  const auto record = run_block(
      {"tissue.viscosity=kelvin_voigt", "tissue.retardation_time=50 ms", "output.interval=25 ms"},
      "[[step]]\nkind = \"hold\"\ntime = \"1 s\"\n");
  double at_end = 0.0;
  for (const auto& row : record.contact)
    if (row.step == 1) at_end = row.contact_force;
  // tau F'/F = 1.5 tau / T on a half-space, T = 1.5 s: 5 %, more on a layer.
  EXPECT_GT(at_end / elastic, 1.03);
  EXPECT_LT(at_end / elastic, 1.10);
  EXPECT_NEAR(record.contact.back().contact_force / elastic, 1.0, 1e-6);  // e^-20
}

TEST(Resolved, a_slide_drags_with_mu_times_the_force) {
  const auto record = run_block({"contact.friction=0.3"},
                                "[[step]]\nkind = \"slide\"\nby = \"2 mm\"\nrate = \"2 mm/s\"\n");
  const auto& last = record.contact.back();
  EXPECT_EQ(last.step, 2);
  EXPECT_NEAR(last.tangential, 0.3 * last.contact_force, 1e-12);  // all of it slips
  EXPECT_NEAR(last.friction, last.tangential, 1e-12);
  EXPECT_NEAR(last.slide, 2e-3, 1e-15);
}

TEST(Resolved, several_spheres_press_each_its_own_nodes) {
  Pressed pressed({"finger.spheres=4", "finger.calibration=mass",
                   "tissue.mesh={kind=\"mirrored\",cells=[16,16,5],grading=2}"},
                  2e-3);
  ASSERT_GE(pressed.touch.contacts.size(), 2u);
  std::map<int, int> owners;
  double sum = 0.0;
  for (const auto& contact : pressed.touch.contacts) {
    EXPECT_GT(contact.force, 0.0);
    sum += contact.force;
    for (const int vertex : contact.load.vertices) ++owners[vertex];
  }
  for (const auto& [vertex, count] : owners) EXPECT_EQ(count, 1) << vertex;
  EXPECT_NEAR(pressed.touch.pressed(), sum, 1e-15);
}

TEST(Resolved, its_map_integrates_to_the_force_and_shows_the_gap) {
  const auto record = run_block({});
  ASSERT_EQ(record.maps.size(), 1u);
  const record::PressureMap& map = record.maps.front();
  // 64 samples a pixel along the rim
  EXPECT_NEAR(record::integral(map) / record.contact.back().contact_force, 1.0, 1e-4);
  const auto peak = *std::max_element(map.pressure.begin(), map.pressure.end());
  EXPECT_NEAR(peak / record.contact.back().peak_pressure, 1.0, 0.1);  // a pixel's mean of it
  for (std::size_t p = 0; p < map.gap.size(); ++p) {
    EXPECT_GE(map.pressure[p], 0.0F);
    if (map.pressure[p] > 0.0F) {
      EXPECT_EQ(map.gap[p], 0.0F);
    }
  }
  const auto edge = static_cast<std::size_t>(map.height / 2 * map.width);
  EXPECT_GT(map.gap[edge], 0.0F);
  EXPECT_LT(map.gap[edge], 1e-3F);
}

TEST(Resolved, a_mesh_that_cannot_carry_the_contact_is_refused) {
  // Cells of 1.04 mm under the finger and 1.6 mm at 4.06 mm: by asinh(10 / 3.54) / 6 a cell.
  EXPECT_NEAR(scene::cells_per_contact_radius(build_block({})), 3.5, 0.1);
  try {
    (void)build_block({"tissue.mesh={kind=\"mirrored\",cells=[8,8,4]}"});
    FAIL() << "no error";
  } catch (const MeshError& error) {
    EXPECT_STREQ(
        error.what(),
        "`resolved` needs 3 cells along the contact radius, and the mesh has 1.6 at the "
        "largest displacement of 1.5 mm; give `tissue.mesh` more cells or a `grading`, or set "
        "`contact.coupling = \"consistent\"`");
  }
  // Fine where it begins, coarse where the slide ends.
  EXPECT_THROW(
      (void)build_block({}, "[[step]]\nkind = \"slide\"\nby = \"6 mm\"\nrate = \"1 mm/s\"\n"),
      MeshError);
  for (const char* integrator : {"modal", "central_difference"}) {
    try {
      (void)build_block({std::string("solver.integrator=") + integrator});
      FAIL() << integrator;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what())
                    .find("an explicit method cannot do, and in `modal` steps "
                          "they oscillate"),
                std::string::npos)
          << error.what();
    }
  }
}

// Nodes beyond the rings stand; a finger that jumps onto them is told so, one that comes slowly
// takes its rings along.
TEST(Resolved, nodes_that_stand_are_not_pressed) {
  const auto jump = run_block({"solver.rings=1", "output.interval=1500 ms"});
  EXPECT_EQ(jump.outcome, record::Outcome::diverged);
  EXPECT_NE(jump.reason.find("presses nodes that cannot move"), std::string::npos) << jump.reason;
  EXPECT_EQ(run_block({"solver.rings=3", "output.interval=50 ms"}).outcome,
            record::Outcome::completed);
}

}  // namespace
}  // namespace palpate
