// A live frame takes no memory, on meshes neither: while contact grows, moves, ends and begins
// again.
#include <gtest/gtest.h>

#include <string>

#include "base/text.h"
#include "counted_memory.h"
#include "every.h"
#include "live/loop.h"
#include "run/pace.h"
#include "scenario/words.h"
#include "scene/first_touch.h"
#include "scene_text.h"

namespace palpate::live {
namespace {

const std::string programme =
    "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = \"20 mm/s\"\n"
    "[[step]]\nkind = \"hold\"\ntime = \"20 ms\"\n"
    "[[step]]\nkind = \"slide\"\nby = \"5 mm\"\nrate = \"100 mm/s\"\n"
    "[[step]]\nkind = \"retract\"\nto = \"0 mm\"\nrate = \"20 mm/s\"\n"
    "[output]\npressure_maps = false\n";

// Skin 60 x 60 x 30 mm; and a limb of skin, muscle and bone.
const std::string block = "mesh = { kind = \"kuhn\", cells = [3, 4, 6] }\n";
const std::string limb =
    "shape = { kind = \"layered_limb\" }\nmesh = { kind = \"tetgen\", nodes = 200 }\n";

scene::Scene build(const std::string& settings, const std::string& body = block) {
  const std::vector<std::string> words =
      settings.empty() ? std::vector<std::string>() : split(settings, ' ');
  return test::scene_of("schema = 1\n[tissue]\nmaterial = \"skin\"\n" + body + programme, words);
}

// Where the finger is, m from its first touch: 2 mm down, there for a while, 5 mm aside, off the
// skin, 3 mm down at another place, and off again.
constexpr int frames = 400;
Vec3 way(int frame) {
  struct Stop {
    int frame;
    Vec3 place;
  };
  const std::array<Stop, 8> stops{{{0, {0.0, 0.0, 0.0}},
                                   {100, {0.0, 0.0, -2e-3}},
                                   {120, {0.0, 0.0, -2e-3}},
                                   {170, {4e-3, 3e-3, -2e-3}},
                                   {230, {4e-3, 3e-3, 1e-3}},
                                   {250, {-7e-3, 8e-3, 1e-3}},
                                   {370, {-7e-3, 8e-3, -3e-3}},
                                   {400, {-7e-3, 8e-3, 1e-3}}}};
  std::size_t next = 1;
  while (stops[next].frame < frame) ++next;
  const Stop& from = stops[next - 1];
  const Stop& to = stops[next];
  return from.place + static_cast<double>(frame - from.frame) / (to.frame - from.frame) *
                          (to.place - from.place);
}

struct Followed {
  std::size_t blocks = 0;  // taken in frames
  std::size_t worst = 0;   // in one of them
  std::size_t taking = 0;  // frames that took any
  double most = 0.0;       // N
  int presses = 0;         // contact began
  int guided = 0;          // the last step of the guide
};

// As the arm's loop goes: the model, its row, what the hand is asked to do, the log.
Followed follow(const scene::Scene& scene) {
  LiveModel model(scene);
  Guide guide(scene.scenario.steps);
  LiveLog log([](int) {});
  Followed followed;
  bool touched = false;
  for (int i = 0; i <= frames; ++i) {
    const Vec3 offset = way(i);
    const double time = 1e-3 * i;
    const std::size_t before = test::blocks_taken;
    const bool wrong = model.follow(offset, time).has_value();
    const double force = model.force().z();
    LogRow row;
    row.contact = run::contact_row(scene, model.touch());
    guide.pass({.time = time, .offset = offset, .force = force});
    row.contact.step = guide.step();
    log.push(row);
    const std::size_t taken = test::blocks_taken - before;
    EXPECT_FALSE(wrong) << "frame " << i;
    followed.blocks += taken;
    followed.worst = std::max(followed.worst, taken);
    followed.taking += taken > 0 ? 1 : 0;
    followed.most = std::max(followed.most, force);
    if (force > 0.0 && !touched) ++followed.presses;
    touched = force > 0.0;
  }
  EXPECT_EQ(log.finish().size(), static_cast<std::size_t>(frames + 1));
  followed.guided = guide.step();
  return followed;
}

struct Model {
  std::string name;
  std::string settings;
  std::string body = block;
};
void PrintTo(const Model& model, std::ostream* out) { *out << model.name; }

class Meshes : public testing::TestWithParam<Model> {};

TEST_P(Meshes, TakeNoMemoryInTheirFrames) {
  if (!test::memory_is_counted) GTEST_SKIP() << "blocks cannot be counted here";
  const Followed followed = follow(build(GetParam().settings, GetParam().body));
  EXPECT_EQ(followed.blocks, 0U);
  EXPECT_GT(followed.most, 0.1);
  EXPECT_GE(followed.presses, 2);
  EXPECT_EQ(followed.guided, 4);
}

// What is done beforehand changes no force by a bit.
TEST_P(Meshes, GoAsThoseThatAreNotMadeReady) {
  const scene::Scene scene = build(GetParam().settings, GetParam().body);
  LiveModel model(scene);
  mechanics::PressedMesh mesh(scene);
  mechanics::ContactHistory history(scene);
  mesh.set_step(model.step());
  const Vec3 first = scene::first_touch(scene).finger;
  mechanics::Touch touch;
  touch.finger = first;
  long long steps = 0;
  double most = 0.0;
  for (int i = 0; i <= 250; ++i) {
    const Vec3 from = way(std::max(0, i - 1));
    const double start = 1e-3 * std::max(0, i - 1);
    const double time = 1e-3 * i;
    // As LiveModel: straight on between two frames.
    while ((static_cast<double>(steps + 1) - 1e-6) * model.step() <= time) {
      const double now = static_cast<double>(++steps) * model.step();
      const double share = std::clamp((now - start) / (time - start), 0.0, 1.0);
      const Vec3 place = from + share * (way(i) - from);
      touch.travel = -place.z();
      ASSERT_FALSE(mesh.step(first + place, now, history, touch));
    }
    ASSERT_FALSE(model.follow(way(i), time));
    ASSERT_EQ(model.touch().force(), touch.force()) << "frame " << i;
    ASSERT_EQ(model.touch().contacts.size(), touch.contacts.size());
    most = std::max(most, touch.force());
  }
  EXPECT_GT(most, 0.1);
}

std::vector<Model> every_integrator() {
  std::vector<Model> models;
  for (const std::string& word : test::every(scenario::words::integrators))
    models.push_back({word, "solver.model=mass_spring solver.integrator=" + word});
  return models;
}
INSTANTIATE_TEST_SUITE_P(EveryIntegrator, Meshes, testing::ValuesIn(every_integrator()),
                         [](const auto& one) { return one.param.name; });

const Model models[] = {
    {"coupled_springs", "solver.model=coupled_springs solver.integrator=central_difference"},
    {"one_way", "solver.model=mass_spring contact.coupling=one_way contact.friction=0.3"},
    {"friction", "solver.model=mass_spring solver.integrator=modal contact.friction=0.3"},
    {"eight_spheres", "solver.model=mass_spring solver.integrator=modal finger.spheres=8"},
    {"deformed_curvature", "solver.model=mass_spring contact.curvature_on=deformed"},
    {"one_node", "solver.model=mass_spring contact.coupling=one_way contact.spread=nearest_node"},
    {"nonlinear", "solver.model=mass_spring solver.kinematics=nonlinear tissue.viscosity=none"},
    {"limb", "solver.model=mass_spring solver.integrator=quasi_static", limb},
    {"series_explicit", "solver.model=mass_spring contact.coupling=series"},
    {"series_modal", "solver.model=mass_spring contact.coupling=series solver.integrator=modal"},
    {"series_implicit",
     "solver.model=mass_spring contact.coupling=series solver.integrator=quasi_static"},
    {"inertia_explicit", "solver.model=mass_spring tissue.viscosity=none"},
    {"inertia_modal", "solver.model=mass_spring tissue.viscosity=none solver.integrator=modal"},
    {"inertia_implicit",
     "solver.model=mass_spring tissue.viscosity=none solver.integrator=backward_difference"},
    {"inertia_staged", "solver.model=mass_spring tissue.viscosity=none solver.integrator=tr_bdf2"},
    {"inertia_eight_spheres",
     "solver.model=mass_spring tissue.viscosity=none finger.spheres=8 "
     "solver.integrator=backward_difference"},
    {"drag", "solver.model=mass_spring tissue.viscosity=nodal_drag"},
    {"viscous_contact",
     "solver.model=mass_spring tissue.viscosity=standard_linear_solid "
     "contact.viscosity=tissue"},
    {"viscous_contact_staged",
     "solver.model=mass_spring tissue.viscosity=standard_linear_solid "
     "contact.viscosity=tissue solver.integrator=tr_bdf2"},
    {"viscous_contact_modal",
     "solver.model=mass_spring tissue.viscosity=standard_linear_solid "
     "contact.viscosity=tissue solver.integrator=modal"},
    {"viscous_coupled",
     "solver.model=coupled_springs tissue.viscosity=standard_linear_solid "
     "contact.viscosity=tissue"},
};
INSTANTIATE_TEST_SUITE_P(All, Meshes, testing::ValuesIn(models),
                         [](const auto& one) { return one.param.name; });

// What still takes memory, as PressedMesh::make_ready() says: no more frames and blocks than these.
struct Exception {
  const char* name;
  const char* settings;
  std::size_t taking;  // frames
  std::size_t worst;   // blocks in one
  std::string body = block;
};
void PrintTo(const Exception& one, std::ostream* out) { *out << one.name; }

class Exceptions : public testing::TestWithParam<Exception> {};

TEST_P(Exceptions, TakeMemoryOnlyWhereItIsSaid) {
  if (!test::memory_is_counted) GTEST_SKIP() << "blocks cannot be counted here";
  const Followed followed = follow(build(GetParam().settings, GetParam().body));
  EXPECT_GT(followed.blocks, 0U) << "no exception any more: add it to the models above";
  EXPECT_LE(followed.taking, GetParam().taking);
  EXPECT_LE(followed.worst, GetParam().worst);
  EXPECT_GT(followed.most, 0.1);
  EXPECT_GE(followed.presses, 2);
}

const Exception exceptions[] = {
    {"rings", "solver.model=mass_spring solver.rings=2", 12, 6000},
    {"turning_dashpots",
     "solver.model=mass_spring solver.kinematics=nonlinear tissue.viscosity=kelvin_voigt "
     "contact.friction=0.5",
     8, 350, ""},
    {"nonlinear_implicit",
     "solver.model=mass_spring solver.kinematics=nonlinear solver.integrator=backward_difference "
     "tissue.mesh.cells=[2,2,3]",
     401, 800},
};
INSTANTIATE_TEST_SUITE_P(All, Exceptions, testing::ValuesIn(exceptions),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(CountedMemory, CountsWhatListsAndMatricesTake) {
  if (!test::memory_is_counted) GTEST_SKIP() << "blocks cannot be counted here";
  const std::size_t before = test::blocks_taken;
  const std::vector<int> list(1000);
  EXPECT_EQ(test::blocks_taken - before, 1U);
  const Eigen::VectorXd vector = Eigen::VectorXd::Zero(1000);
  EXPECT_EQ(test::blocks_taken - before, 2U);
}

}  // namespace
}  // namespace palpate::live
