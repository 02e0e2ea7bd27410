// Solves a linear system for four waves per layer, for each wave number.
#include "contact/layer_stack.h"

#include <Eigen/LU>
#include <cassert>
#include <cmath>

#include "base/index.h"

namespace palpate::contact {
namespace {

using Row = Eigen::Vector4d;  // coefficients of the four waves

// u_x = U(z) sin kx, u_z = W(z) cos kx, z downwards; stresses divided by 2 G k of the top layer.
struct Face {
  Row along, down, pull, shear;  // U, W, sigma_zz, sigma_xz
};

// The waves (U, W) = (e, e) and ((kz - K) e, kz e), e = exp(-kz), K = 3 - 4 nu, and their mirror
// images at the layer's middle. `kz` and `kd` are the wave number times depth and thickness. They
// satisfy G (lap u + grad div u / (1 - 2 nu)) = 0, also at nu = 1/2.  docs/theory.md [layer_stack]
Face face(double kz, double kd, double stiffness, double nu) {
  const double big_k = 3.0 - 4.0 * nu;
  const double e = std::exp(-kz);
  const double m = std::exp(kz - kd);
  const double back = kd - kz;
  Face at;
  at.along << e, (kz - big_k) * e, m, (back - big_k) * m;
  at.down << e, kz * e, -m, -back * m;
  at.pull << -e, (1.0 - 2.0 * nu - kz) * e, -m, (1.0 - 2.0 * nu - back) * m;
  at.shear << -e, (2.0 - 2.0 * nu - kz) * e, m, -(2.0 - 2.0 * nu - back) * m;
  at.pull *= stiffness;
  at.shear *= stiffness;
  return at;
}

}  // namespace

double stack_sinking(double u, const Layer& layer) {
  assert(u > 0.0);
  const auto layers = static_cast<Eigen::Index>(layer.below.size()) + 1;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(4 * layers, 4 * layers);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(4 * layers);
  const auto piece = [&](Eigen::Index i) {
    return i == 0 ? Sublayer{layer.top(), 1.0, layer.poisson_ratio} : layer.below[as_index(i) - 1];
  };
  // The load is a pressure wave of amplitude 2 G k on the surface.
  const Sublayer first = piece(0);
  const Face surface = face(0.0, u * first.thickness, 1.0, first.poisson_ratio);
  matrix.block<1, 4>(0, 0) = surface.pull.transpose();
  matrix.block<1, 4>(1, 0) = surface.shear.transpose();
  right[0] = -1.0;
  for (Eigen::Index i = 0; i < layers; ++i) {
    const Sublayer own = piece(i);
    const double kd = u * own.thickness;
    const Face bottom = face(kd, kd, own.stiffness, own.poisson_ratio);
    const Eigen::Index row = 2 + 4 * i;
    if (i + 1 == layers) {
      matrix.block<1, 4>(row, 4 * i) = bottom.down.transpose();
      matrix.block<1, 4>(row + 1, 4 * i) =
          (layer.base == LayerBase::bonded ? bottom.along : bottom.shear).transpose();
      break;
    }
    const Sublayer next = piece(i + 1);
    const Face top = face(0.0, u * next.thickness, next.stiffness, next.poisson_ratio);
    const Row* const upper[] = {&bottom.along, &bottom.down, &bottom.pull, &bottom.shear};
    const Row* const lower[] = {&top.along, &top.down, &top.pull, &top.shear};
    for (Eigen::Index k = 0; k < 4; ++k) {
      matrix.block<1, 4>(row + k, 4 * i) = upper[k]->transpose();
      matrix.block<1, 4>(row + k, 4 * i + 4) = -lower[k]->transpose();
    }
  }
  const Eigen::VectorXd waves = matrix.fullPivLu().solve(right);
  // A half-space is displaced by 2 (1 - nu) under this load.
  return surface.down.dot(waves.head<4>()) / (2.0 * (1.0 - first.poisson_ratio));
}

}  // namespace palpate::contact
