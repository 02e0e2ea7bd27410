// What one explicit step of a whole body costs, form by form, beside the plain loops in the same
// run. No test: it prints a table. `palpate-step [MESHES]` takes 1 to 3 meshes, small to large.
#include <Eigen/SparseCholesky>
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
#include "tissue/energy.h"
#include "tissue/stable_step.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using tissue::Kinematics;
using tissue::Vector;
using tissue::Viscosity;

// The least time of a call, s: other programs on the machine only ever add.
template <class Work>
double least(const Work& work) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::time_point from) {
    return std::chrono::duration<double>(Clock::now() - from).count();
  };
  const Clock::time_point start = Clock::now();
  work();
  const int calls = std::clamp(static_cast<int>(50e-6 / seconds(start)), 1, 1000);
  double best = 1e9;
  for (int round = 0; round < 3 || seconds(start) < 0.5; ++round) {
    const Clock::time_point now = Clock::now();
    for (int i = 0; i < calls; ++i) work();
    best = std::min(best, seconds(now) / calls);
    if (seconds(start) > 10.0) break;
  }
  return best;
}

struct Case {
  std::string name;
  const tissue::Network* network;
  Kinematics kinematics;
  tissue::ViscousLaw law;
};

// The step as the formulas are written: loop by loop, vectors of Eigen, a sparse solve.
class PlainStep {
 public:
  PlainStep(const Case& form, const std::vector<char>& held, double time_step)
      : form_(form), held_(held), dt_(time_step), elongation_(form.network->ends.size()) {
    effective_ = tension_ = elongation_;
    if (form.law.kind == Viscosity::kelvin_voigt)
      steps_.push_back(tissue::MemoryStep::exact(dt_, form.law.time));
    for (const tissue::Branch& branch : form.law.branches)
      steps_.push_back(tissue::MemoryStep::exact(dt_, branch.time));
    mass_.resize(3 * form.network->nodes());
    for (Eigen::Index d = 0; d < mass_.size(); ++d)
      mass_[d] = form.network->node_mass[static_cast<std::size_t>(d / 3)];
    moved_ = Vector::Zero(mass_.size());
  }

  void step(integrate::State& state, const Vector& load) {
    const tissue::Network& network = *form_.network;
    tissue::elongations(network, form_.kinematics, state.displacement, elongation_);
    tissue::elastic_elongations(form_.law, state.memory, elongation_, effective_);
    tissue::tensions(network, effective_, tension_);
    tissue::gather_forces(network, form_.kinematics, state.displacement, tension_, force_);
    Vector right = 2.0 * dt_ * dt_ * (load - force_);
    right += 2.0 * mass_.cwiseProduct(moved_);
    if (form_.law.kind == Viscosity::kelvin_voigt) {
      if (!factored_ || form_.kinematics != Kinematics::linear) factor(state.displacement);
      right -= dt_ * (dashpots_ * moved_);
      clear(right);
      moved_ = factors_.solve(right);
    } else {
      moved_ = right.cwiseQuotient(2.0 * mass_);
    }
    clear(moved_);
    state.displacement += moved_;
    state.velocity = moved_ / dt_;
    state.time += dt_;
    tissue::elongations(network, form_.kinematics, state.displacement, elongation_);
    tissue::remember(form_.law, steps_, elongation_, state.memory);
  }

 private:
  void clear(Vector& vector) const {
    for (std::size_t d = 0; d < held_.size(); ++d)
      if (held_[d] != 0) vector[static_cast<Eigen::Index>(d)] = 0.0;
  }
  void factor(const Vector& displacement) {
    std::fill(tension_.begin(), tension_.end(), 0.0);
    dashpots_ = tissue::tangent(*form_.network, form_.kinematics, displacement, form_.law.time,
                                tension_, held_)
                    .local;
    Eigen::SparseMatrix<double> left = dt_ * dashpots_;
    left.diagonal() += 2.0 * mass_;
    if (!factored_) factors_.analyzePattern(left);
    factors_.factorize(left);
    factored_ = true;
  }

  Case form_;
  const std::vector<char>& held_;
  double dt_;
  std::vector<double> elongation_, effective_, tension_;
  std::vector<tissue::MemoryStep> steps_;
  Vector mass_, moved_, force_;
  Eigen::SparseMatrix<double> dashpots_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factors_;
  bool factored_ = false;
};

integrate::State at_rest(const tissue::Network& network, const tissue::ViscousLaw& law) {
  integrate::State state;
  state.displacement = Vector::Zero(3 * network.nodes());
  state.velocity = state.displacement;
  state.memory.assign(tissue::memory_size(law) * network.ends.size(), 0.0);
  return state;
}

// A press by an even load on the top, N.
Vector press(const geometry::TetMesh& mesh) {
  Vector load = Vector::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  double top = 0.0;
  for (const Vec3& node : mesh.nodes) top = std::max(top, node.z());
  std::vector<Eigen::Index> loaded;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if (mesh.nodes[i].z() > top - 1e-9) loaded.push_back(static_cast<Eigen::Index>(i));
  for (const Eigen::Index node : loaded)
    load[3 * node + 2] = -0.5 / static_cast<double>(loaded.size());
  return load;
}

void report(const geometry::TetMesh& mesh, const Case& form, bool skip_plain) {
  const tissue::Network& network = *form.network;
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  for (std::size_t d = 0; d < held.size(); ++d) held[d] = mesh.nodes[d / 3].z() < 1e-9 ? 1 : 0;
  const double squared =
      form.law.instantaneous_ratio() * tissue::largest_frequency_squared(network, held);
  const double dt = 0.9 * 2.0 / std::sqrt(squared);
  const Vector load = press(mesh);

  integrate::State state = at_rest(network, form.law);
  const scene::SpringBody body(network, form.kinematics, form.law, held);
  integrate::CentralDifference method(body, dt, integrate::Start::consistent);
  const double step = least([&] { method.step(state, load); });
  run::EnergyMonitor monitor(body);
  integrate::State before = state;
  method.step(state, load);
  const double watched = least([&] { (void)monitor.step(before, state, load, load); });
  double plain = 0.0;
  if (!skip_plain) {
    state = at_rest(network, form.law);
    PlainStep reference(form, held, dt);
    plain = least([&] { reference.step(state, load); });
  }
  const double springs = static_cast<double>(network.ends.size());
  char ratio[64] = "-";
  if (!skip_plain) std::snprintf(ratio, sizeof ratio, "%.1f | %.1f", 1e6 * plain, plain / step);
  std::printf("| %d | %d | %s | %.2f | %.2f | %.2f | %s | %.0f |\n", network.nodes(),
              network.springs(), form.name.c_str(), 1e6 * step, 1e9 * step / springs, 1e6 * watched,
              skip_plain ? "- | -" : ratio, 1e6 * dt);
  std::fflush(stdout);
}

void report_mesh(int which) {
  const Vec3 size(0.06, 0.06, 0.03);  // m
  const geometry::TetMesh mesh =
      which == 0 ? geometry::cuboid(size, {3, 4, 6}, geometry::CellPattern::kuhn)
                 : geometry::tetgen_cuboid(size, which == 1 ? 728 : 20000, 600.0);
  const tissue::Network springs = tissue::make_network(
      mesh, std::array{1060.0}, tissue::van_gelder_stiffness(mesh, std::array{15e3}));
  const std::vector<tissue::Isotropic> tissues{{15e3, 0.45}};
  tissue::Network coupled = springs;
  tissue::couple(coupled, mesh, tissues, tissue::Volume::nodal, 1.0);
  const tissue::ViscousLaw none;
  const tissue::ViscousLaw solid{.kind = Viscosity::standard_linear_solid,
                                 .branches = {{0.1, 0.5}}};
  const tissue::ViscousLaw voigt{.kind = Viscosity::kelvin_voigt, .time = 0.1};
  report(mesh, {"linear", &springs, Kinematics::linear, none}, false);
  report(mesh, {"non-linear", &springs, Kinematics::nonlinear, none}, false);
  report(mesh, {"linear, standard linear solid", &springs, Kinematics::linear, solid}, false);
  report(mesh, {"coupled, nodal volumes", &coupled, Kinematics::linear, none}, false);
  report(mesh, {"coupled non-linear", &coupled, Kinematics::squared, none}, false);
  if (which == 2) return;  // factors of half a gigabyte
  report(mesh, {"linear Kelvin-Voigt", &springs, Kinematics::linear, voigt}, false);
  report(mesh, {"non-linear Kelvin-Voigt", &springs, Kinematics::nonlinear, voigt}, false);
  report(mesh, {"coupled Kelvin-Voigt", &coupled, Kinematics::linear, voigt}, true);
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  const int meshes = argc > 1 ? std::atoi(argv[1]) : 3;
  std::printf(
      "| nodes | springs | form | step, us | ns a spring | energy watch, us | plain, us | "
      "plain / step | dt, us |\n|---|---|---|---|---|---|---|---|---|\n");
  for (int which = 0; which < meshes; ++which) palpate::report_mesh(which);
  return 0;
}
