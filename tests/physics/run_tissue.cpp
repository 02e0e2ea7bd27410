// What nature demands of springs: balance, rigid motions, forces from energies.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "geometry/cuboid.h"
#include "scene/spring_body.h"
#include "tissue/network.h"
#include "tissue/stiffness.h"
#include "tissue/supports.h"

namespace palpate {
namespace {

using integrate::Vector;
using tissue::Kinematics;
using tissue::Viscosity;

constexpr Kinematics all_kinematics[] = {Kinematics::linear, Kinematics::nonlinear};
constexpr Viscosity all_viscosities[] = {Viscosity::none, Viscosity::nodal_drag,
                                         Viscosity::kelvin_voigt, Viscosity::standard_linear_solid};

struct Cube {
  geometry::TetMesh mesh =
      geometry::cuboid(Vec3(0.02, 0.03, 0.04), {2, 3, 4}, geometry::CellPattern::mirrored);
  tissue::Network network = tissue::make_network(
      mesh, std::array{1100.0}, tissue::van_gelder_stiffness(mesh, std::array{72.4e3}));

  [[nodiscard]] tissue::ViscousLaw law(Viscosity kind) const {
    tissue::ViscousLaw law{.kind = kind, .time = 0.1, .drag = 50.0};
    if (kind == Viscosity::standard_linear_solid) law.branches = {{0.1, 1.5}};
    return law;
  }
  [[nodiscard]] scene::SpringBody body(Kinematics kinematics, Viscosity kind) const {
    return {network, kinematics, law(kind), std::vector<char>(3 * mesh.nodes.size(), 0)};
  }
  // A smooth displacement of about a millimetre, without symmetry.
  [[nodiscard]] Vector bend(double size) const {
    Vector u(3 * network.nodes());
    for (int i = 0; i < network.nodes(); ++i) {
      const Vec3& x = mesh.nodes[static_cast<std::size_t>(i)];
      u.segment<3>(3 * i) =
          size * Vec3(std::sin(90.0 * x.y()) + x.z() * 20.0, std::cos(70.0 * x.z()) * x.x() * 50.0,
                      std::sin(60.0 * (x.x() + x.y())));
    }
    return u;
  }
};

TEST(Springs, MassIsDensityTimesVolume) {
  const Cube cube;
  double mass = 0.0;
  for (const double m : cube.network.node_mass) mass += m;
  EXPECT_NEAR(mass, 1100.0 * 0.02 * 0.03 * 0.04, 1e-15);  // rounding of 144 sums of 0.026 kg
}

TEST(Springs, ForcesAndMomentsBalance) {
  const Cube cube;
  for (const Kinematics kinematics : all_kinematics) {
    const auto body = cube.body(kinematics, Viscosity::none);
    const Vector u = cube.bend(1e-3);
    Vector force;
    body.force(u, body.memory_at(u), force);
    Vec3 sum = Vec3::Zero();
    Vec3 moment = Vec3::Zero();
    for (int i = 0; i < cube.network.nodes(); ++i) {
      // Linear forces act at rest places, non-linear ones at deformed ones.
      Vec3 place = cube.mesh.nodes[static_cast<std::size_t>(i)];
      if (kinematics == Kinematics::nonlinear) place += u.segment<3>(3 * i);
      sum += force.segment<3>(3 * i);
      moment += place.cross(force.segment<3>(3 * i));
    }
    EXPECT_GT(force.cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_LT(sum.norm(), 1e-13);     // rounding of some hundred forces of up to a newton
    EXPECT_LT(moment.norm(), 1e-14);  // the same at a few centimetres
  }
}

TEST(Springs, RigidMotionsGiveNoForce) {
  const Cube cube;
  const auto rotate = [&](const Eigen::Matrix3d& turn) {
    Vector u(3 * cube.network.nodes());
    for (int i = 0; i < cube.network.nodes(); ++i) {
      const Vec3& x = cube.mesh.nodes[static_cast<std::size_t>(i)];
      u.segment<3>(3 * i) = turn * x - x + Vec3(0.01, -0.02, 0.03);
    }
    return u;
  };
  Vector force;
  // Any rotation for true lengths; for rest directions an infinitesimal one.
  const auto free = cube.body(Kinematics::nonlinear, Viscosity::none);
  const Vector far = rotate(Eigen::AngleAxisd(1.0, Vec3(1, 2, 3).normalized()).matrix());
  free.force(far, free.memory_at(far), force);
  EXPECT_LT(force.cwiseAbs().maxCoeff(), 1e-11);  // k = 3e3 N/m times 1e-16 m of rounding, tenfold
  const auto linear = cube.body(Kinematics::linear, Viscosity::none);
  Eigen::Matrix3d spin = Eigen::Matrix3d::Identity();
  spin(0, 1) = -1e-3;
  spin(1, 0) = 1e-3;
  const Vector near = rotate(spin);
  linear.force(near, linear.memory_at(near), force);
  EXPECT_LT(force.cwiseAbs().maxCoeff(), 1e-12);  // as above, for shorter ways
}

TEST(Springs, RigidRotationStretchesNoDashpot) {
  const Cube cube;
  const auto body = cube.body(Kinematics::nonlinear, Viscosity::kelvin_voigt);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, -1, 2).normalized()).matrix();
  const Vec3 spin(3.0, 1.0, -2.0);
  Vector u(3 * cube.network.nodes());
  Vector v(u.size());
  for (int i = 0; i < cube.network.nodes(); ++i) {
    const Vec3& x = cube.mesh.nodes[static_cast<std::size_t>(i)];
    u.segment<3>(3 * i) = turn * x - x;
    v.segment<3>(3 * i) = spin.cross(turn * x);
  }
  Vector force;
  body.dashpot_force(u, v, force);
  EXPECT_LT(force.cwiseAbs().maxCoeff(), 1e-12);  // c = 300 N s/m times rounding of 0.1 m/s
}

TEST(Springs, ForceIsTheSlopeOfTheEnergy) {
  const Cube cube;
  for (const Kinematics kinematics : all_kinematics) {
    for (const Viscosity kind : {Viscosity::none, Viscosity::standard_linear_solid}) {
      const auto body = cube.body(kinematics, kind);
      const Vector u = cube.bend(1e-3);
      const auto energy = [&](const Vector& displacement) {
        integrate::State state;
        state.displacement = displacement;
        state.memory = body.memory_at(displacement);
        return body.stored(state);
      };
      Vector force;
      body.force(u, body.memory_at(u), force);
      const double step = 1e-7;  // m: truncation 1e-9, rounding 1e-16 J / 1e-7 m
      for (const int d : {0, 31, 77, 140}) {
        Vector more = u;
        Vector less = u;
        more[d] += step;
        less[d] -= step;
        EXPECT_NEAR((energy(more) - energy(less)) / (2.0 * step), force[d],
                    1e-7 * force.cwiseAbs().maxCoeff());
      }
    }
  }
}

TEST(Springs, TangentIsTheSlopeOfTheForce) {
  const Cube cube;
  for (const Kinematics kinematics : all_kinematics) {
    for (const Viscosity kind : all_viscosities) {
      const auto body = cube.body(kinematics, kind);
      // Stretched everywhere: compressed springs leave their geometric term out on purpose.
      Vector u(3 * cube.network.nodes());
      for (int i = 0; i < cube.network.nodes(); ++i)
        u.segment<3>(3 * i) = 0.05 * cube.mesh.nodes[static_cast<std::size_t>(i)];
      const auto memory = body.memory_at(Vector::Zero(u.size()));
      const integrate::TimeStep step{0.02, integrate::MemoryRule::exact};
      const Eigen::MatrixXd tangent = body.step_stiffness(u, memory, step).local;
      const double h = 1e-7;
      for (const int d : {0, 40, 95}) {
        Vector more = u;
        Vector less = u;
        more[d] += h;
        less[d] -= h;
        Vector f_more;
        Vector f_less;
        body.step_force(more, memory, step, f_more);
        body.step_force(less, memory, step, f_less);
        const Vector slope = (f_more - f_less) / (2.0 * h);
        EXPECT_LT((slope - tangent.col(d)).cwiseAbs().maxCoeff(),
                  1e-6 * tangent.cwiseAbs().maxCoeff());  // central differences at 1e-7 m
      }
    }
  }
}

TEST(Springs, HeldFreedomsAreTheIdentity) {
  const Cube cube;
  const auto held = tissue::held_by_base(cube.mesh, tissue::Base::bonded);
  const scene::SpringBody body(cube.network, Kinematics::linear, cube.law(Viscosity::none), held);
  const Eigen::MatrixXd stiffness = body.stiffness().split(body.held()).local;
  int count = 0;
  for (std::size_t d = 0; d < held.size(); ++d) {
    if (held[d] == 0) continue;
    ++count;
    const auto i = static_cast<Eigen::Index>(d);
    EXPECT_EQ(stiffness(i, i), 1.0);
    EXPECT_EQ(stiffness.row(i).cwiseAbs().sum(), 1.0);
  }
  EXPECT_EQ(count, 3 * 3 * 4);  // the base has 3 x 4 nodes
}

}  // namespace
}  // namespace palpate
