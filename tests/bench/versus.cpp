// What an explicit step costs here and in CHAI3D and VegaFEM: the same springs in one process, in
// turns. No test: it prints a table. `palpate-versus [MESHES]` takes 1 to 3 meshes, small to large.
// docs/speed.md says how the peers are given and which of their versions were measured.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/peers.h"
#include "bench/plain_step.h"
#include "integrate/central_difference.h"
#include "scene/spring_body.h"
#include "tissue/network.h"

namespace palpate {
namespace {

constexpr double drag = 20.0;  // 1/s, of each node against the ground

tissue::ViscousLaw nodal_drag() { return {.kind = Viscosity::nodal_drag, .drag = drag}; }

// The springs that all contestants get.
struct Block {
  tissue::Network network;
  std::vector<char> held;
  Vector load;             // N
  double time_step = 0.0;  // s, 0.9 of the limit of central differences
  int rounds = 0;
  int calls = 0;  // steps between two looks at the clock
};

Block make_block(int which) {
  const geometry::TetMesh mesh =
      which == 0 ? geometry::cuboid(block_size(), {3, 4, 6}, geometry::CellPattern::kuhn)
                 : meshing::tetgen_cuboid(block_size(), which == 1 ? 728 : 20000, 600.0);
  Block block{.network = tissue::make_network(mesh, std::array{1060.0},
                                              tissue::van_gelder_stiffness(mesh, std::array{15e3})),
              .held = held_base(mesh),
              .load = press(mesh),
              .rounds = which == 0 ? 1001 : (which == 1 ? 501 : 61),
              .calls = which == 0 ? 50 : (which == 1 ? 10 : 1)};
  block.time_step =
      0.9 * 2.0 / std::sqrt(tissue::largest_frequency_squared(block.network, block.held));
  return block;
}

// A body of ours with its integrator.
class Ours {
 public:
  Ours(const Block& block, Kinematics kinematics, const tissue::ViscousLaw& law,
       integrate::Start start = integrate::Start::consistent,
       integrate::DampingVelocity velocity = integrate::DampingVelocity::centred)
      : load_(block.load),
        body_(block.network, kinematics, law, block.held),
        method_(body_, block.time_step, start, velocity),
        state_(at_rest(block.network, law)) {}

  void step() { method_.step(state_, load_); }
  [[nodiscard]] const Vector& displacement() const { return state_.displacement; }
  [[nodiscard]] Vector force(const Vector& displacement) const {
    Vector force;
    body_.force(displacement, state_.memory, force);
    return force;
  }

 private:
  Vector load_;
  scene::SpringBody body_;
  integrate::CentralDifference method_;
  integrate::State state_;
};

struct Opponent {
  std::string name;
  std::unique_ptr<versus::Peer> peer;
  bool one_stiffness = false;
};

versus::Model plain_numbers(const Block& block) {
  versus::Model model{.rest = {},
                      .mass = block.network.node_mass,
                      .held = {},
                      .load = {block.load.begin(), block.load.end()},
                      .ends = block.network.ends,
                      .stiffness = block.network.stiffness,
                      .drag = drag,
                      .time_step = block.time_step};
  for (std::size_t i = 0; i < block.network.rest.size(); ++i) {
    for (const double x : block.network.rest[i]) model.rest.push_back(x);
    model.held.push_back(block.held[3 * i]);
  }
  return model;
}

std::vector<Opponent> make_opponents([[maybe_unused]] const versus::Model& model) {
  std::vector<Opponent> opponents;
#ifdef PALPATE_WITH_CHAI3D
  opponents.push_back({"CHAI3D, step with drag", versus::make_chai3d(model)});
#endif
#ifdef PALPATE_WITH_VEGAFEM
  opponents.push_back({"VegaFEM, forces alone", versus::make_vegafem(model, versus::Groups::each)});
  opponents.push_back({"VegaFEM, forces alone, one stiffness",
                       versus::make_vegafem(model, versus::Groups::one), true});
#endif
  return opponents;
}

void name_the_missing() {
#ifndef PALPATE_WITH_CHAI3D
  std::fputs(
      "CHAI3D is not timed: configure with `-DPALPATE_CHAI3D=FOLDER`, the folder of its sources.\n",
      stderr);
#endif
#ifndef PALPATE_WITH_VEGAFEM
  std::fputs(
      "VegaFEM is not timed: configure with `-DPALPATE_VEGAFEM=FOLDER`, the folder of its "
      "sources.\n",
      stderr);
#endif
}

// Each entry is between -1e-5 and 1e-5 m: strains of a hundredth.
Vector random_displacement(Eigen::Index size) {
  std::mt19937 bits(18);
  Vector displacement(size);
  for (double& x : displacement) x = 1e-5 * (2.0 * static_cast<double>(bits()) / 0xffffffff - 1.0);
  return displacement;
}

double difference(const Vector& one, const Vector& other) {
  return (one - other).cwiseAbs().maxCoeff() / other.cwiseAbs().maxCoeff();
}

bool within(double tolerance, double difference, const std::string& what) {
  const bool same = difference <= tolerance;  // false if the difference is not a number
  std::fprintf(stderr, "%s differ from ours by %.1e of the largest, %s than %.0e.\n", what.c_str(),
               difference, same ? "less" : "MORE", tolerance);
  return same;
}

std::span<double> entries(Vector& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}

// Whether the opponent computes the forces of our non-linear springs and, if it steps in time, goes
// where they go from rest with CHAI3D's rule, symplectic Euler with the drag of the step before.
bool same_springs(const Opponent& opponent, const Block& block) {
  Block even = block;
  if (opponent.one_stiffness)
    std::fill(even.network.stiffness.begin(), even.network.stiffness.end(),
              block.network.stiffness.front());
  Ours ours(even, Kinematics::nonlinear, nodal_drag(), integrate::Start::paper,
            integrate::DampingVelocity::lagged);
  Vector moved = random_displacement(block.load.size());
  Vector theirs = moved;
  opponent.peer->force(entries(moved), entries(theirs));
  const std::string name = std::to_string(block.network.nodes()) + " nodes, " + opponent.name;
  // Positions of 0.1 m are rounded by 1e-17 m, elongations are 1e-5 m.
  bool same = within(1e-10, difference(theirs, ours.force(moved)), name + ": forces");
  if (!opponent.peer->steps_in_time()) return same;
  constexpr int steps = 200;
  for (int i = 0; i < steps; ++i) {
    opponent.peer->step();
    ours.step();
  }
  opponent.peer->displacement(entries(theirs));
  // The same rounding, summed over the steps.
  same &= within(1e-10, difference(theirs, ours.displacement()),
                 name + ": displacements after " + std::to_string(steps) + " steps");
  return same;
}

struct Contestant {
  std::string name;
  std::function<void()> step;
  double least = 1e9;  // s, of a step
};

// A contestant's turn of a round: the first steps bring its arrays back into the caches. Whatever
// else the machine does only ever adds, so that the least of all times counts.
void take_turn(Contestant& contestant, int calls) {
  using Clock = std::chrono::steady_clock;
  for (int look = 0; look < 8; ++look) {
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < calls; ++i) contestant.step();
    const double time = std::chrono::duration<double>(Clock::now() - start).count();
    contestant.least = std::min(contestant.least, time / calls);
  }
}

bool report(const Block& block) {
  Ours linear(block, Kinematics::linear, {});
  Ours nonlinear(block, Kinematics::nonlinear, nodal_drag());
  const std::vector<Opponent> opponents = make_opponents(plain_numbers(block));
  bool same = true;
  std::vector<Contestant> contestants{{"ours, linear", [&] { linear.step(); }},
                                      {"ours, non-linear with drag", [&] { nonlinear.step(); }}};
  for (const Opponent& opponent : opponents) {
    same &= same_springs(opponent, block);
    contestants.push_back({opponent.name, [&opponent] { opponent.peer->step(); }});
  }
  for (int round = 0; round < block.rounds; ++round)
    for (Contestant& contestant : contestants) take_turn(contestant, block.calls);
  for (const Contestant& contestant : contestants)
    std::printf("| %d | %d | %s | %.2f | %.2f | %.2f |\n", block.network.nodes(),
                block.network.springs(), contestant.name.c_str(), 1e6 * contestant.least,
                contestant.least / contestants[0].least, contestant.least / contestants[1].least);
  std::fflush(stdout);
  return same;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::name_the_missing();
  const int meshes = argc > 1 ? std::atoi(argv[1]) : 3;
  std::printf(
      "| nodes | springs | contestant | step, us | by ours, linear | by ours, non-linear with drag "
      "|\n|---|---|---|---|---|---|\n");
  bool same = true;
  for (int which = 0; which < meshes; ++which) same &= palpate::report(palpate::make_block(which));
  return same ? 0 : 1;
}
