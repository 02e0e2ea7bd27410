// The bodies that steps are timed and counted on, and their steps as the formulas are written.
#pragma once

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <string>

#include "elastic_elongations.h"
#include "geometry/cuboid.h"
#include "integrate/body.h"
#include "meshing/tetgen.h"
#include "plain_springs.h"
#include "tissue/coupled.h"
#include "tissue/network.h"
#include "tissue/stiffness.h"
#include "tissue/viscous.h"

namespace palpate {

using tissue::Kinematics;
using tissue::Vector;
using tissue::Viscosity;

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
    test::elongations(network, form_.kinematics, state.displacement, elongation_);
    test::elastic_elongations(form_.law, state.memory, elongation_, effective_);
    tissue::tensions(network, effective_, tension_);
    test::gather_forces(network, form_.kinematics, state.displacement, tension_, force_);
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
    test::elongations(network, form_.kinematics, state.displacement, elongation_);
    tissue::remember(form_.law, steps_, elongation_, state.memory);
  }

 private:
  void clear(Vector& vector) const {
    for (std::size_t d = 0; d < held_.size(); ++d)
      if (held_[d] != 0) vector[static_cast<Eigen::Index>(d)] = 0.0;
  }
  void factor(const Vector& displacement) {
    std::fill(tension_.begin(), tension_.end(), 0.0);
    dashpots_ =
        tissue::tangent(*form_.network, form_.kinematics, displacement, form_.law.time, tension_)
            .split(held_)
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

inline integrate::State at_rest(const tissue::Network& network, const tissue::ViscousLaw& law) {
  integrate::State state;
  state.displacement = Vector::Zero(3 * network.nodes());
  state.velocity = state.displacement;
  state.memory.assign(tissue::memory_size(law) * network.ends.size(), 0.0);
  return state;
}

// A press by an even load on the top, N.
inline Vector press(const geometry::TetMesh& mesh) {
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

// Held where it stands.
inline std::vector<char> held_base(const geometry::TetMesh& mesh) {
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  for (std::size_t d = 0; d < held.size(); ++d) held[d] = mesh.nodes[d / 3].z() < 1e-9 ? 1 : 0;
  return held;
}

// 60 x 60 x 30 mm of a tissue of 15 kPa, nu 0.45, 1060 kg/m^3: springs alone, and coupled with
// nodal volumes.
struct Networks {
  tissue::Network springs, coupled;
};
inline Networks make_networks(const geometry::TetMesh& mesh) {
  Networks made{.springs = tissue::make_network(
                    mesh, std::array{1060.0}, tissue::van_gelder_stiffness(mesh, std::array{15e3})),
                .coupled = {}};
  made.coupled = made.springs;
  const std::vector<tissue::Isotropic> tissues{{15e3, 0.45}};
  tissue::couple(made.coupled, mesh, tissues, tissue::Volume::nodal, 1.0);
  return made;
}
inline Vec3 block_size() { return {0.06, 0.06, 0.03}; }  // m

}  // namespace palpate
