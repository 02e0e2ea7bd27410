// Coupled springs in time: creep, recovery and relaxation by their closed forms, energy that never
// grows unloaded, and the step limit.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "base/cholesky.h"
#include "base/dense.h"
#include "base/index.h"
#include "jittered_block.h"
#include "plain_energy.h"
#include "plain_springs.h"
#include "tissue/network.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using geometry::TetMesh;
using tissue::Isotropic;
using tissue::Kinematics;
using tissue::MemoryStep;
using tissue::Network;
using tissue::Vector;
using tissue::Viscosity;
using tissue::ViscousLaw;
using tissue::Volume;

constexpr double tau = 0.4;  // s
constexpr Isotropic soft{3e4, 0.45};

// Coupled either way, and independent springs with a volume term around nodes.
std::vector<Network> networks(const TetMesh& mesh) {
  std::vector<Network> all{
      test::coupled_network(mesh, {soft}, Volume::tetrahedron, 0.0),
      test::coupled_network(mesh, {soft}, Volume::nodal, 0.05),
      tissue::make_network(
          mesh, std::array{1000.0},
          tissue::van_gelder_stiffness(mesh, std::array{tissue::spring_modulus(soft)}))};
  tissue::add_volume(all.back(), mesh, std::array{soft}, Volume::nodal);
  return all;
}

// A block on three planes that it slides on, so that it widens freely.
std::vector<char> on_three_planes(const TetMesh& mesh) {
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  for (std::size_t d = 0; d < held.size(); ++d)
    held[d] = mesh.nodes[d / 3][static_cast<Eigen::Index>(d % 3)] < 1e-9 ? 1 : 0;
  return held;
}

// The forces of an even pull of 1 Pa on the top.
Vector pull_on_top(const TetMesh& mesh) {
  double top = 0.0;
  for (const Vec3& node : mesh.nodes) top = std::max(top, node.z());
  Vector load = Vector::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (const auto& [a, b, c] : geometry::boundary_faces(mesh)) {
    const Vec3& x = mesh.nodes[as_index(a)];
    const Vec3 area = 0.5 * (mesh.nodes[as_index(b)] - x).cross(mesh.nodes[as_index(c)] - x);
    if (std::min({x.z(), mesh.nodes[as_index(b)].z(), mesh.nodes[as_index(c)].z()}) < top - 1e-9)
      continue;
    for (const int node : {a, b, c}) load[3 * node + 2] += area.z() / 3.0;
  }
  return load;
}

// Statics of a linear viscous network, one step at a time.
struct Statics {
  const Network* network;
  const ViscousLaw* law;
  Cholesky factors;
  std::vector<double> memory;
  Vector displacement;

  Statics(const Network& of, const ViscousLaw& with, const std::vector<char>& held)
      : network(&of), law(&with), memory(tissue::memory_size(with) * of.ends.size(), 0.0) {
    EXPECT_TRUE(factors.factor(tissue::stiffness_matrix(of).split(held)));
    displacement = Vector::Zero(3 * of.nodes());
  }

  [[nodiscard]] Vector force(std::span<const MemoryStep> steps, const Vector& at) const {
    std::vector<double> elongation(network->ends.size());
    std::vector<double> effective(network->ends.size());
    std::vector<double> tension(network->ends.size());
    test::elongations(*network, Kinematics::linear, at, elongation);
    tissue::effective_elongations(*law, steps, memory, elongation, effective);
    tissue::tensions(*network, effective, tension);
    Vector sum;
    test::gather_forces(*network, Kinematics::linear, at, tension, sum);
    return sum;
  }

  void remember(std::span<const MemoryStep> steps) {
    std::vector<double> elongation(network->ends.size());
    test::elongations(*network, Kinematics::linear, displacement, elongation);
    tissue::remember(*law, steps, elongation, memory);
  }

  // To the balance with a load on degrees of freedom that are not held.
  void step(std::span<const MemoryStep> steps, const Vector& load, const std::vector<char>& held) {
    Vector missing = load - force(steps, Vector::Zero(displacement.size()));
    for (std::size_t d = 0; d < held.size(); ++d)
      if (held[d] != 0) missing[static_cast<Eigen::Index>(d)] = 0.0;
    displacement = factors.solve(missing) / tissue::effective_slope(*law, steps);
    remember(steps);
  }
};

// e(t) = stress / E (1 - exp(-t/tau)), and back; on coupled springs for the tissue's own E and nu.
TEST(CoupledInTime, KelvinVoigtCreepsAndRecovers) {
  const TetMesh mesh = test::jittered_block({3, 2, 3});
  const std::vector<char> held = on_three_planes(mesh);
  const Vector load = 300.0 * pull_on_top(mesh);
  const ViscousLaw law{.kind = Viscosity::kelvin_voigt, .time = tau};
  for (const Network& network : networks(mesh)) {
    Statics body(network, law, held);
    const Vector settled = body.factors.solve(load);
    if (!network.coupled.empty()) {
      const double strain = 300.0 / soft.young_modulus;
      const Eigen::Matrix3d even =
          Vec3(-soft.poisson_ratio * strain, -soft.poisson_ratio * strain, strain).asDiagonal();
      EXPECT_LT((settled - test::linear_displacement(mesh, even)).norm(), 1e-12 * settled.norm());
    }
    const double dt = 0.13;  // s, three steps a tau
    const std::array steps{MemoryStep::held(dt, tau)};
    double time = 0.0;
    for (int n = 0; n < 8; ++n) {
      body.step(steps, load, held);
      time += dt;
      const Vector want = settled * (1.0 - std::exp(-time / tau));
      EXPECT_LT((body.displacement - want).norm(), 1e-12 * settled.norm());  // exact but rounding
    }
    const double reached = 1.0 - std::exp(-time / tau);
    time = 0.0;
    for (int n = 0; n < 8; ++n) {
      body.step(steps, Vector::Zero(load.size()), held);
      time += dt;
      const Vector want = settled * reached * std::exp(-time / tau);
      EXPECT_LT((body.displacement - want).norm(), 1e-12 * settled.norm());  // the same
    }
  }
}

// e(t) = stress / E (1 - (1 - 1/r) exp(-t / (r tau))), r = E_0 / E; the step is of second order.
TEST(CoupledInTime, StandardLinearSolidCreeps) {
  const TetMesh mesh = test::jittered_block({3, 2, 2});
  const std::vector<char> held = on_three_planes(mesh);
  const Vector load = 300.0 * pull_on_top(mesh);
  const ViscousLaw law{.kind = Viscosity::standard_linear_solid, .branches = {{tau, 1.5}}};
  const double r = law.instantaneous_ratio();
  for (const Network& network : networks(mesh)) {
    std::array<double, 2> error{};
    for (std::size_t finer = 0; finer < 2; ++finer) {
      Statics body(network, law, held);
      const Vector settled = body.factors.solve(load);
      const std::array jump{MemoryStep::at_once()};
      body.step(jump, load, held);
      EXPECT_LT((body.displacement - settled / r).norm(), 1e-12 * settled.norm());  // rounding
      const int count = finer == 0 ? 20 : 40;
      const double dt = 2.0 * r * tau / count;
      const std::array steps{MemoryStep::exact(dt, tau)};
      for (int n = 0; n < count; ++n) body.step(steps, load, held);
      const Vector want = settled * (1.0 - (1.0 - 1.0 / r) * std::exp(-2.0));
      error[finer] = (body.displacement - want).norm() / settled.norm();
    }
    EXPECT_LT(error[0], 5e-4);  // (dt/tau)^2 / 12 of the (1 - 1/r) e^-2 that are still to come
    EXPECT_NEAR(error[0] / error[1], 4.0, 0.1);  // second order
  }
}

// A strain applied at once and held: stress(t) = E e (1 + sum of ratio exp(-t/tau)).
TEST(CoupledInTime, BranchesRelax) {
  const TetMesh mesh = test::jittered_block({2, 3, 3});
  const std::vector<char> held = on_three_planes(mesh);
  const ViscousLaw solid{.kind = Viscosity::standard_linear_solid, .branches = {{tau, 1.5}}};
  const ViscousLaw series{.kind = Viscosity::prony,
                          .branches = {{0.05, 0.7}, {tau, 0.4}, {3.0, 1.1}}};
  for (const Network& network : networks(mesh))
    for (const ViscousLaw& law : {solid, series}) {
      Statics body(network, law, held);
      body.displacement = body.factors.solve(300.0 * pull_on_top(mesh));
      const Vector settled = test::elastic_force(network, Kinematics::linear, body.displacement);
      const double size = settled.cwiseAbs().maxCoeff();
      std::vector<MemoryStep> steps(law.branches.size(), MemoryStep::at_once());
      EXPECT_LT((body.force(steps, body.displacement) - law.instantaneous_ratio() * settled).norm(),
                1e-12 * size);  // rounding
      body.remember(steps);
      const double dt = 0.17;
      for (std::size_t i = 0; i < steps.size(); ++i)
        steps[i] = MemoryStep::exact(dt, law.branches[i].time);
      double time = 0.0;
      for (int n = 0; n < 6; ++n) {
        const Vector force = body.force(steps, body.displacement);
        body.remember(steps);
        time += dt;
        double ratio = 1.0;
        for (const auto& branch : law.branches)
          ratio += branch.ratio * std::exp(-time / branch.time);
        EXPECT_LT((force - ratio * settled).norm(), 1e-12 * size);  // exact but for rounding
      }
    }
}

// Implicit Euler from a random start: what is stored and what moves only become less.
TEST(CoupledInTime, EnergyNeverGrowsUnloaded) {
  const TetMesh mesh = test::jittered_block({2, 1, 2});
  const ViscousLaw laws[] = {{.kind = Viscosity::none},
                             {.kind = Viscosity::nodal_drag, .drag = 40.0},
                             {.kind = Viscosity::kelvin_voigt, .time = 1e-3},
                             {.kind = Viscosity::standard_linear_solid, .branches = {{2e-3, 1.5}}},
                             {.kind = Viscosity::prony, .branches = {{5e-4, 0.5}, {1e-2, 0.8}}}};
  const double dt = 5e-4;  // s, a quarter of the fastest oscillation's period
  for (const Network& network : networks(mesh))
    for (const Kinematics kinematics : {Kinematics::linear, Kinematics::squared})
      for (const ViscousLaw& law : laws) {
        std::vector<MemoryStep> steps;
        if (law.kind == Viscosity::kelvin_voigt)
          steps.push_back(MemoryStep::first_order(dt, law.time));
        for (const auto& branch : law.branches)
          steps.push_back(MemoryStep::first_order(dt, branch.time));
        const double drag = law.kind == Viscosity::nodal_drag ? law.drag : 0.0;
        std::vector<double> elongation(network.ends.size());
        std::vector<double> effective(network.ends.size());
        std::vector<double> tension(network.ends.size());
        Vector mass(3 * network.nodes());
        for (Eigen::Index d = 0; d < mass.size(); ++d)
          mass[d] = network.node_mass[static_cast<std::size_t>(d / 3)];
        Vector u = test::scattered_displacement(mesh, 3e-4);
        Vector v = -100.0 * test::scattered_displacement(mesh, 1e-3);
        std::vector<double> memory(tissue::memory_size(law) * network.ends.size(), 0.0);
        test::elongations(network, kinematics, u, elongation);
        const std::vector<MemoryStep> at_once(steps.size(), MemoryStep::at_once());
        tissue::remember(law, at_once, elongation, memory);
        const auto energy = [&] {
          return test::stored_energy(network, law, memory.empty() ? elongation : memory) +
                 0.5 * v.dot(mass.cwiseProduct(v));
        };
        const double start = energy();
        double before = start;
        for (int n = 0; n < 40; ++n) {
          Vector end = u + dt * v;
          double residual = 1.0;
          for (int newton = 0; newton < 50 && residual > 1e-11; ++newton) {
            test::elongations(network, kinematics, end, elongation);
            tissue::effective_elongations(law, steps, memory, elongation, effective);
            tissue::tensions(network, effective, tension);
            Vector force;
            test::gather_forces(network, kinematics, end, tension, force);
            force += mass.cwiseProduct(end - u - dt * v) / (dt * dt) +
                     drag * mass.cwiseProduct(end - u) / dt;
            SplitMatrix matrix = tissue::tangent(network, kinematics, end,
                                                 tissue::effective_slope(law, steps), tension)
                                     .split(test::nothing_held(network));
            for (Eigen::Index d = 0; d < mass.size(); ++d)
              matrix.local.coeffRef(d, d) += mass[d] * (1.0 / (dt * dt) + drag / dt);
            Cholesky factors;
            ASSERT_TRUE(factors.factor(matrix));
            const Vector change = factors.solve(force);
            end -= change;
            residual = change.norm() / 1e-3;
          }
          ASSERT_LT(residual, 1e-10) << n;
          v = (end - u) / dt;
          u = end;
          test::elongations(network, kinematics, u, elongation);
          tissue::remember(law, steps, elongation, memory);
          const double now = energy();
          EXPECT_LE(now, before * (1.0 + 1e-12)) << n;  // rounding
          before = now;
        }
        EXPECT_LT(before, 0.5 * start);
      }
}

// Leapfrog keeps its bounds below the limit that Lanczos gives, and not above it.
TEST(CoupledInTime, StepLimitIsWhereEnergyStartsToGrow) {
  const TetMesh mesh = test::jittered_block({3, 2, 2});
  for (const Network& network : networks(mesh)) {
    const double limit =
        2.0 / std::sqrt(tissue::largest_frequency_squared(network, test::nothing_held(network)));
    const auto grown = [&](double dt) {
      Vector u = test::scattered_displacement(mesh, 1e-3);
      Vector v = Vector::Zero(u.size());
      const double start = test::elastic_energy(network, Kinematics::linear, u);
      double most = 0.0;
      for (int n = 0; n < 300; ++n) {
        const Vector force = test::elastic_force(network, Kinematics::linear, u);
        for (Eigen::Index d = 0; d < u.size(); ++d)
          v[d] -= (n == 0 ? 0.5 : 1.0) * dt * force[d] /
                  network.node_mass[static_cast<std::size_t>(d / 3)];
        u += dt * v;
        most = std::max(most, test::elastic_energy(network, Kinematics::linear, u));
      }
      return most / start;
    };
    EXPECT_LT(grown(0.9 * limit), 5.3);  // 1 / (1 - 0.9^2) for the highest mode
    EXPECT_GT(grown(1.02 * limit), 1e6);
  }
}

// Lanczos finds what a dense solver finds; the bound without any matrix is above, and not by much:
// also not where flat tetrahedra make springs that are far stiffer than their nodes.
TEST(CoupledInTime, SafeBoundIsAboveTheHighestFrequency) {
  TetMesh flat = test::jittered_block({3, 3, 2});
  flat.nodes[as_index(17)] += Vec3(0.002, -0.002, 0.003);
  for (const TetMesh& mesh : {test::jittered_block({3, 2, 3}), flat})
    for (const double nu : {-0.5, 0.2, 0.45, 0.4995})
      for (const Volume volume : {Volume::none, Volume::tetrahedron, Volume::nodal}) {
        const Isotropic tissue{3e4, nu};
        const Network network = test::coupled_network(mesh, {tissue}, volume, 0.05);
        const double found =
            tissue::largest_frequency_squared(network, test::nothing_held(network));
        Eigen::MatrixXd matrix =
            test::dense(tissue::stiffness_matrix(network).split(test::nothing_held(network)));
        for (Eigen::Index i = 0; i < matrix.rows(); ++i)
          for (Eigen::Index j = 0; j < matrix.cols(); ++j)
            matrix(i, j) /= std::sqrt(network.node_mass[static_cast<std::size_t>(i / 3)] *
                                      network.node_mass[static_cast<std::size_t>(j / 3)]);
        const double highest = dense::symmetric_modes(matrix).values[matrix.rows() - 1];
        EXPECT_GT(found, highest * (1.0 - 1e-9)) << nu;
        // What is added to what was found, and rounding.
        EXPECT_LT(found, highest * (1.0 + 1e-6) * (1.0 + 1e-12)) << nu;
        const double safe = tissue::safe_frequency_squared(network);
        EXPECT_GT(safe, highest) << nu;
        EXPECT_LT(safe, 6.0 * highest) << nu;  // measured up to 4.7, and 400 by elongations
      }
}

}  // namespace
}  // namespace palpate
