// What a step of one body costs alone, and in lanes beside others on the same mesh, watched for its
// energy as runs are; and what a sweep costs a case. No test: it prints a table. `palpate-lanes
// NODES...` takes numbers of nodes; 140 is the lattice of the paper's cube, all others are
// TetGen's. `palpate-lanes SCENARIO.toml...` takes sweeps.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "geometry/cuboid.h"
#include "integrate/central_difference.h"
#include "mechanics/monitor.h"
#include "meshing/tetgen.h"
#include "run/family.h"
#include "scenario/family.h"
#include "scene/spring_body.h"
#include "tissue/coupled.h"
#include "tissue/lane_springs.h"
#include "tissue/stable_step.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using tissue::Kinematics;
using tissue::LaneSprings;
using tissue::Vector;
using tissue::Viscosity;

constexpr double time_step_of_limit = 0.9;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point from) {
  return std::chrono::duration<double>(Clock::now() - from).count();
}

struct Form {
  std::string name;
  const tissue::Network* network;
  tissue::ViscousLaw law;
};

// Both in turn, so that what else the machine does meets both: the least time of each.
void report(const geometry::TetMesh& mesh, const Form& form) {
  const tissue::Network& network = *form.network;
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  for (std::size_t d = 0; d < held.size(); ++d) held[d] = mesh.nodes[d / 3].z() < 1e-9 ? 1 : 0;
  const double squared =
      form.law.instantaneous_ratio() * tissue::largest_frequency_squared(network, held);
  const double dt = time_step_of_limit * 2.0 / std::sqrt(squared);
  Vector load = Vector::Zero(3 * network.nodes());
  for (int node = network.nodes() - 20; node < network.nodes(); ++node) load[3 * node + 2] = -0.01;
  const tissue::SparseLoad few = tissue::sparse(load);

  const scene::SpringBody body(network, Kinematics::linear, form.law, held);
  integrate::CentralDifference method(body, dt, integrate::Start::consistent);
  mechanics::EnergyMonitor monitor(body);
  integrate::State state;
  state.displacement = Vector::Zero(load.size());
  state.velocity = state.displacement;
  state.memory = body.memory_at(state.displacement);
  integrate::State before = state;

  LaneSprings lanes(network, form.law);
  Vector force;
  body.force(state.displacement, state.memory, force);
  for (std::size_t lane = 0; lane < LaneSprings::width; ++lane) {
    lanes.enter(lane, network, form.law, held);
    lanes.place(lane, {&state.displacement, &state.velocity, &force, state.memory});
    lanes.begin(lane, {dt});
  }
  double alone = 1e9;
  double bare = 1e9;
  double together = 1e9;
  const Clock::time_point start = Clock::now();
  // Short enough to be left alone by other programs now and then.
  const int steps = std::max(1, 40000 / network.springs());
  while (seconds_since(start) < 2.0) {
    Clock::time_point now = Clock::now();
    for (int i = 0; i < steps; ++i) {
      before.displacement = state.displacement;
      before.time = state.time;
      method.step(state, load);
      (void)monitor.step(before, state, load, load);
    }
    alone = std::min(alone, seconds_since(now) / steps);
    now = Clock::now();
    for (int i = 0; i < steps; ++i) method.step(state, load);
    bare = std::min(bare, seconds_since(now) / steps);
    now = Clock::now();
    for (int i = 0; i < steps; ++i) {
      for (std::size_t lane = 0; lane < LaneSprings::width; ++lane) lanes.load(lane, few, few);
      lanes.step();
    }
    together = std::min(together, seconds_since(now) / steps);
  }
  std::printf("| %d | %d | %s | %.2f | %.2f | %.2f | %.2f | %.2f |\n", network.nodes(),
              network.springs(), form.name.c_str(), 1e6 * bare, 1e6 * alone, 1e6 * together,
              1e6 * together / LaneSprings::width,
              together / (static_cast<double>(LaneSprings::width) * alone));
  std::fflush(stdout);
}

void report_mesh(int nodes) {
  const Vec3 size(0.06, 0.06, 0.03);  // m
  const geometry::TetMesh mesh =
      nodes == 140 ? geometry::cuboid(size, {3, 4, 6}, geometry::CellPattern::kuhn)
                   : meshing::tetgen_cuboid(size, nodes, 600.0);
  const tissue::Network springs = tissue::make_network(
      mesh, std::array{1060.0}, tissue::van_gelder_stiffness(mesh, std::array{15e3}));
  tissue::Network coupled = springs;
  tissue::couple(coupled, mesh, std::vector<tissue::Isotropic>{{15e3, 0.45}}, tissue::Volume::nodal,
                 1.0);
  const tissue::ViscousLaw none;
  const tissue::ViscousLaw solid{.kind = Viscosity::standard_linear_solid,
                                 .branches = {{0.1, 0.5}}};
  report(mesh, {"elastic", &springs, none});
  report(mesh, {"standard linear solid", &springs, solid});
  report(mesh, {"coupled, nodal volumes", &coupled, none});
}

// Processor time, s: what other programs take does not count, though they take from the caches.
template <class Work>
double least(const Work& work) {
  double best = 1e9;
  const Clock::time_point begun = Clock::now();
  for (int round = 0; round < 3 || seconds_since(begun) < 1.0; ++round) {
    const std::clock_t start = std::clock();
    work();
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    if (seconds_since(begun) > 8.0) break;
  }
  return best;
}

// Set-up and run of a sweep, nothing written, on one worker.
void report_sweep(const std::string& path) {
  const scenario::Family family = scenario::read(path, {});
  const double cases = static_cast<double>(family.cases.size());
  const double built_alone = least([&] {
    for (const scenario::Case& one : family.cases) (void)scene::build(one, family);
  });
  const double built = least([&] { (void)run::build_all(family, 1); });
  const auto scenes = run::build_all(family, 1);
  const std::atomic<bool> never = false;
  const auto run = [&](run::Lanes lanes) {
    return least([&] {
      (void)run::run_all(
          scenes, 1, never, [](std::size_t, const auto&) {}, lanes);
    });
  };
  const double alone = run(run::Lanes::none);
  const double together = run(run::Lanes::where_they_pay);
  const auto a_case = [&](double seconds) { return 1e3 * seconds / cases; };
  std::printf("| %s | %.0f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f |\n",
              family.name.c_str(), cases, a_case(built_alone), a_case(built), built / built_alone,
              a_case(alone), a_case(together), together / alone,
              (built + together) / (built_alone + alone));
  std::fflush(stdout);
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  const std::vector<std::string> wanted(argv + 1, argv + argc);
  const auto is_sweep = [](const std::string& text) { return text.ends_with(".toml"); };
  if (std::any_of(wanted.begin(), wanted.end(), is_sweep))
    std::printf(
        "| sweep | cases | set-up a case alone, ms | shared, ms | ratio | run a case alone, ms | "
        "in "
        "lanes, ms | ratio | both |\n|---|---|---|---|---|---|---|---|---|\n");
  else
    std::printf(
        "| nodes | springs | form | step alone, us | with its energies, us | step of eight lanes, "
        "us | a lane, us | a lane / alone |\n|---|---|---|---|---|---|---|---|\n");
  for (const std::string& one : wanted)
    is_sweep(one) ? palpate::report_sweep(one) : palpate::report_mesh(std::stoi(one));
  return 0;
}
