// The highest mode by Lanczos, the lowest mode by inverse iteration.
#include "stability/modes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "base/index.h"
#include "integrate/implicit.h"

namespace palpate::stability {

using integrate::Vector;

Vector scattered(const integrate::Body& body) {
  Vector vector = Vector::Zero(body.mass().size());
  std::uint64_t state = 1;  // of a linear congruential generator
  for (Eigen::Index d = 0; d < vector.size(); ++d) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    if (body.held()[as_index(d)] == 0)
      vector[d] = static_cast<double>(state >> 11) / 9007199254740992.0 - 0.5;
  }
  return vector;
}

BodyMode highest_mode(const integrate::Body& body, const ContactSpring* contact) {
  Vector scale = body.mass().cwiseSqrt().cwiseInverse();
  for (Eigen::Index d = 0; d < scale.size(); ++d)
    if (body.held()[as_index(d)] != 0) scale[d] = 0.0;
  const std::vector<double> no_memory = body.memory_at(Vector::Zero(scale.size()));
  Vector force;
  const auto multiply = [&](const Vector& x) -> Vector {
    const Vector u = scale.cwiseProduct(x);
    body.force(u, no_memory, force);
    if (contact != nullptr)
      force += contact->stiffness * contact->weights.dot(u) * contact->weights;
    return scale.cwiseProduct(force);
  };

  constexpr Eigen::Index most_steps = 400;
  const Eigen::Index steps = std::min(scale.size(), most_steps);
  Eigen::MatrixXd basis(scale.size(), steps);
  Vector alpha(steps);
  Vector beta(steps);
  Vector next = scattered(body).cwiseProduct(body.mass().cwiseSqrt()).normalized();
  BodyMode mode;
  for (Eigen::Index k = 0; k < steps; ++k) {
    basis.col(k) = next;
    Vector image = multiply(next);
    alpha[k] = next.dot(image);
    for (int twice = 0; twice < 2; ++twice)
      for (Eigen::Index j = 0; j <= k; ++j) image -= basis.col(j).dot(image) * basis.col(j);
    beta[k] = image.norm();
    const bool last = k + 1 == steps || beta[k] == 0.0;
    if (k % 10 == 9 || last) {
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
      ritz.computeFromTridiagonal(alpha.head(k + 1), beta.head(k));
      const double squared = ritz.eigenvalues()[k];
      const double residual = beta[k] * std::abs(ritz.eigenvectors()(k, k));
      if (residual <= 1e-9 * squared || last) {
        mode.frequency = std::sqrt(std::max(squared, 0.0));
        mode.shape = scale.cwiseProduct(basis.leftCols(k + 1) * ritz.eigenvectors().col(k));
        return mode;
      }
    }
    next = image / beta[k];
  }
  return mode;
}

BodyMode lowest_mode(const integrate::Body& body) {
  integrate::State state;
  state.displacement = Vector::Zero(body.mass().size());
  state.velocity = state.displacement;
  state.memory = body.memory_at(state.displacement);
  integrate::Implicit statics(body, integrate::Implicit::Inertia::none);
  statics.begin(state, 0.0, integrate::MemoryRule::at_once);
  BodyMode mode;
  mode.shape = scattered(body);
  if (!statics.linearise(state.displacement, state.displacement))
    throw std::domain_error("the body is not held");
  constexpr int most_rounds = 2000;
  for (int i = 0; i < most_rounds; ++i) {
    mode.shape /= std::sqrt(mode.shape.dot(body.mass().cwiseProduct(mode.shape)));
    const Vector image = statics.response(body.mass().cwiseProduct(mode.shape));
    // omega^2 = x.M x / x.M K^-1 M x, with x.M x = 1
    const double frequency = std::sqrt(1.0 / mode.shape.dot(body.mass().cwiseProduct(image)));
    const bool settled = std::abs(frequency - mode.frequency) <= 1e-10 * frequency;
    mode.frequency = frequency;
    mode.shape = image;
    if (settled) break;
  }
  mode.shape /= std::sqrt(mode.shape.dot(body.mass().cwiseProduct(mode.shape)));
  return mode;
}

}  // namespace palpate::stability
