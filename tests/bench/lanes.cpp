// What a step of one body costs alone, and in lanes beside others on the same mesh, watched for its
// energy as runs are. No test: it prints a table. `palpate-lanes NODES...` takes
// numbers of nodes; 140 is the lattice of the paper's cube, all others are TetGen's.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "geometry/cuboid.h"
#include "geometry/tetgen.h"
#include "integrate/central_difference.h"
#include "run/monitor.h"
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
  Kinematics kinematics;
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

  const scene::SpringBody body(network, form.kinematics, form.law, held);
  integrate::CentralDifference method(body, dt, integrate::Start::consistent);
  run::EnergyMonitor monitor(body);
  integrate::State state;
  state.displacement = Vector::Zero(load.size());
  state.velocity = state.displacement;
  state.memory = body.memory_at(state.displacement);
  integrate::State before = state;

  LaneSprings lanes(network, form.kinematics, form.law);
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
                   : geometry::tetgen_cuboid(size, nodes, 600.0);
  const tissue::Network springs = tissue::make_network(
      mesh, std::array{1060.0}, tissue::van_gelder_stiffness(mesh, std::array{15e3}));
  tissue::Network coupled = springs;
  tissue::couple(coupled, mesh, std::vector<tissue::Isotropic>{{15e3, 0.45}}, tissue::Volume::nodal,
                 1.0);
  const tissue::ViscousLaw none;
  const tissue::ViscousLaw solid{.kind = Viscosity::standard_linear_solid,
                                 .branches = {{0.1, 0.5}}};
  report(mesh, {"linear", &springs, Kinematics::linear, none});
  report(mesh, {"non-linear", &springs, Kinematics::nonlinear, none});
  report(mesh, {"linear, standard linear solid", &springs, Kinematics::linear, solid});
  report(mesh, {"coupled, nodal volumes", &coupled, Kinematics::linear, none});
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  std::printf(
      "| nodes | springs | form | step alone, us | with its energies, us | step of eight lanes, us "
      "| a lane, us | a lane / alone |\n|---|---|---|---|---|---|---|---|\n");
  for (int i = 1; i < argc; ++i) palpate::report_mesh(std::atoi(argv[i]));
  return 0;
}
