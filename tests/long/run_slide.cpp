// A finger that slides: forces without jumps over meshes, stick and slip, a force that is kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cases.h"
#include "contact/friction.h"
#include "contact/hertz.h"
#include "every.h"
#include "mechanics/pressed_mesh.h"
#include "mindlin.h"
#include "run/family.h"
#include "run_text.h"
#include "scenario/words.h"
#include "scene/first_touch.h"

namespace palpate {
namespace {

using test::Settings;

const std::string slide =
    "schema = 1\n[tissue]\nmaterial = \"skin\"\nviscosity = \"none\"\n[solver]\n"
    "model = \"mass_spring\"\nintegrator = \"quasi_static\"\n[output]\ninterval = \"5 ms\"\n"
    "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"20 mm/s\"\n"
    "[[step]]\nkind = \"slide\"\nby = \"2 mm\"\nrate = \"5 mm/s\"\n";

const std::string slid_ellipsoid =
    "tissue.shape={ kind = \"ellipsoid\", size = [\"60 mm\", \"90 mm\", \"50 mm\"] }";
const std::string slid_cylinder =
    "tissue.shape={ kind = \"cylinder\", radius = \"30 mm\", length = \"80 mm\" }";
const std::string tetgen_mesh = "tissue.mesh={ kind = \"tetgen\", nodes = 800 }";

// Without what only a mesh can honour.
const std::string slide_closed_form =
    "schema = 1\n[tissue]\nmaterial = \"skin\"\n[solver]\nmodel = \"hertz\"\n"
    "[output]\ninterval = \"5 ms\"\n"
    "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"20 mm/s\"\n"
    "[[step]]\nkind = \"slide\"\nby = \"1 mm\"\nrate = \"5 mm/s\"\n";

// Couplings whose forces follow from the finger alone.
const std::vector<std::string> slid_couplings =
    test::every(scenario::words::couplings, {"series", "resolved"});

scene::Scene build_slide(const Settings& settings, const std::string& text = slide) {
  return test::scene_of(text, settings);
}

record::CaseRecord run_slide(const Settings& settings, const std::string& text = slide) {
  return test::run_text(text, settings);
}

// Along a straight way of the finger, from one offset of the first touch to another, m.
struct Way {
  const char* name;
  Settings settings;
  Vec3 from, to;
};

const Way ways[] = {{"across an ellipsoid",
                     {slid_ellipsoid, tetgen_mesh},
                     {-0.012, -0.01, -1.5e-3},
                     {0.012, 0.013, -1.5e-3}},
                    {"across a cylinder",
                     {slid_cylinder, tetgen_mesh},
                     {-0.012, -0.01, -1.5e-3},
                     {0.012, 0.0, -1.5e-3}},
                    {"along a cylinder and off its end",
                     {slid_cylinder, tetgen_mesh},
                     {0.001, 0.02, -1.5e-3},
                     {0.003, 0.05, -1.5e-3}},
                    {"off the rim of a cuboid",
                     {"tissue.mesh={ kind = \"mirrored\", cells = [10, 10, 5] }"},
                     {0.012, 0.0, -1.5e-3},
                     {0.042, 0.004, -1.5e-3}},
                    {"into an ellipsoid",
                     {slid_ellipsoid, tetgen_mesh, "finger.x=40 mm"},
                     {0, 0, 1e-4},
                     {0, 0, -2.5e-3}}};

// A jump stays as large when the step is cut; what is continuous and has slopes shrinks with it.
TEST(Slide, ForceHasNoJumps) {
  for (const std::string& coupling : slid_couplings) {
    for (const Way& way : ways) {
      Settings settings = way.settings;
      settings.push_back("contact.coupling=" + coupling);
      const scene::Scene scene = build_slide(settings);
      mechanics::PressedMesh mesh(scene);
      const Vec3 first = scene::first_touch(scene).finger;
      constexpr int steps = 4096;
      constexpr std::size_t coarse = 8;
      std::vector<double> forces;
      mechanics::Touch touch;
      touch.finger = first;
      for (int i = 0; i <= steps; ++i) {
        const Vec3 offset = way.from + (way.to - way.from) * (static_cast<double>(i) / steps);
        const auto wrong = mesh.try_out(first + offset, touch);
        ASSERT_FALSE(wrong.has_value())
            << coupling << " " << way.name << " " << i << ": " << *wrong;
        forces.push_back(touch.normal_force());
      }
      double most = 0.0;
      double fine_change = 0.0;
      double coarse_change = 0.0;
      for (std::size_t i = 0; i < forces.size(); ++i) {
        most = std::max(most, forces[i]);
        if (i > 0) fine_change = std::max(fine_change, std::abs(forces[i] - forces[i - 1]));
        if (i >= coarse)
          coarse_change = std::max(coarse_change, std::abs(forces[i] - forces[i - coarse]));
      }
      EXPECT_GT(most, 0.05) << way.name;
      // An eighth for what is smooth; a quarter more for slopes that change within 8 steps.
      EXPECT_LE(fine_change, 0.16 * coarse_change) << coupling << " " << way.name;
    }
  }
}

TEST(Slide, LeavesTheRimWithoutForce) {
  const auto record = run_slide({"step.2.by=45 mm", "step.2.rate=100 mm/s"});
  ASSERT_EQ(record.outcome, record::Outcome::completed) << record.reason;
  EXPECT_EQ(record.contact.back().contacts, 0);
  EXPECT_EQ(record.contact.back().force, 0.0);
  EXPECT_EQ(record.contact.back().tangential, 0.0);
}

TEST(Slide, SticksAsCattaneoAndMindlinSayAndThenSlips) {
  for (const char* traits :
       {"solver.model=hertz", "contact.coupling=one_way", "contact.coupling=consistent"}) {
    const Settings settings{"contact.friction=0.5", "step.2.by=1 mm", traits};
    const bool meshed = std::string(traits) != "solver.model=hertz";
    const scene::Scene scene = build_slide(settings, meshed ? slide : slide_closed_form);
    const auto record = run_slide(settings, meshed ? slide : slide_closed_form);
    ASSERT_EQ(record.outcome, record::Outcome::completed) << record.reason;
    std::optional<mechanics::PressedMesh> mesh;
    if (meshed) mesh.emplace(scene);
    int sticking = 0;
    int slipping = 0;
    for (const auto& row : record.contact) {
      if (row.step == 1) {
        EXPECT_EQ(row.tangential, 0.0);  // straight down on a flat nothing rubs
        continue;
      }
      const double limit = 0.5 * row.contact_force;
      double beyond = 0.0;  // m/N, of the body
      if (mesh) {
        mechanics::Touch touch;
        const Vec3 place = scene::first_touch(scene).finger + Vec3(row.slide, 0.0, -row.travel);
        ASSERT_FALSE(mesh->try_out(place, touch));
        beyond = touch.contacts.front().shear(0, 0);
        EXPECT_EQ(beyond != 0.0, scene.scenario.contact.coupling == contact::Coupling::consistent);
      }
      const double whole =
          3.0 * limit * scene.finger.shear_compliance / (16.0 * row.contact_radius) +
          beyond * limit;
      if (row.slide < 0.999 * whole) {
        ++sticking;
        const auto stick =
            test::stick(row.tangential, limit, row.contact_radius, scene.finger.shear_compliance);
        // The axes of a body beside its middle are not exactly along the slide.
        EXPECT_NEAR((stick.displacement + beyond * row.tangential) / row.slide, 1.0,
                    beyond == 0.0 ? 1e-9 : 1e-5)
            << traits << row.slide;
      } else if (row.slide > 1.001 * whole) {
        ++slipping;
        EXPECT_NEAR(row.tangential / limit, 1.0, 1e-9) << traits << row.slide;
      }
    }
    EXPECT_GT(sticking, 3) << traits;
    EXPECT_GT(slipping, 3) << traits;
  }
}

TEST(Slide, StickHasTheIndependentNumbers) {
  // Skin at 1 mm, mu 0.5, Q half of mu F.
  const scene::Scene scene = build_slide({"contact.friction=0.5"}, slide_closed_form);
  const double force =
      contact::hertz::force(1e-3, scene.finger.sphere_radius, scene.finger.sphere_modulus);
  const double a = contact::hertz::contact_radius(1e-3, scene.finger.sphere_radius);
  const auto stick = test::stick(0.25 * force, 0.5 * force, a, scene.finger.shear_compliance);
  test::expect_case("friction-01", stick.radius / a);
  test::expect_case("friction-02", stick.displacement);
}

// On a slope, where the sliding finger also rides up and down: the drag never exceeds mu F, and is
// mu F of every contact once it slips.
TEST(Slide, SlipsAtMuTimesTheNormalForceOnACurvedShape) {
  Settings settings{slid_ellipsoid, tetgen_mesh, "contact.friction=0.3",
                    "contact.coupling=one_way"};
  const scene::Scene scene = build_slide(settings);
  mechanics::PressedMesh mesh(scene);
  const Vec3 first = scene::first_touch(scene).finger;
  mechanics::Touch touch;
  touch.finger = first;
  for (int i = 0; i <= 400; ++i) {
    const auto wrong = mesh.try_out(first + Vec3(2e-5 * i, 1e-5 * i, -1e-3), touch);
    ASSERT_FALSE(wrong.has_value()) << *wrong;
    for (const auto& contact : touch.contacts) {
      EXPECT_LE(contact.drag.norm(), 0.3 * contact.force * (1.0 + 1e-12));
      EXPECT_NEAR(contact.drag.dot(contact.patch.normal), 0.0, 1e-12 * contact.force);
      if (i > 100) {
        EXPECT_NEAR(contact.drag.norm(), 0.3 * contact.force, 1e-9 * contact.force) << i;
      }
    }
  }
  EXPECT_GT(touch.drag().x(), 0.0);  // on the tissue, along with the finger
  EXPECT_GT(touch.drag().y(), 0.0);
}

TEST(Slide, KeepsTheForce) {
  for (const std::string& coupling : slid_couplings) {
    const auto record =
        run_slide({slid_ellipsoid, tetgen_mesh, "contact.friction=0.2", "step.2.by=6 mm",
                   "step.2.direction=30", "step.2.keep=force", "contact.coupling=" + coupling});
    ASSERT_EQ(record.outcome, record::Outcome::completed) << record.reason;
    double kept = 0.0;
    double lowest = 1.0;
    double highest = 0.0;
    for (const auto& row : record.contact) {
      if (row.step == 1) {
        kept = row.force;
        continue;
      }
      EXPECT_NEAR(row.force, kept, 1e-6 * kept) << coupling << " at " << row.slide;
      lowest = std::min(lowest, row.travel);
      highest = std::max(highest, row.travel);
    }
    EXPECT_GT(highest - lowest, 1e-4);  // the ellipsoid falls away: the finger must follow
  }
}

}  // namespace
}  // namespace palpate
