// The modes as largest eigenvalues: of the stiffness and of the compliance.
#include "stability/modes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "base/eigen_pair.h"
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
  Vector force;
  const auto multiply = [&](const Vector& x, Vector& image) {
    const Vector u = scale.cwiseProduct(x);
    body.stiffness().multiply(u, force);
    if (contact != nullptr)
      force += contact->stiffness * contact->weights.dot(u) * contact->weights;
    image = scale.cwiseProduct(force);
  };
  const Vector start = scattered(body).cwiseProduct(body.mass().cwiseSqrt());
  const EigenPair found = largest_eigenpair(start, 1e-9, multiply);
  return {std::sqrt(std::max(found.value, 0.0)), scale.cwiseProduct(found.vector)};
}

BodyMode lowest_mode(const integrate::Body& body) {
  integrate::State state;
  state.displacement = Vector::Zero(body.mass().size());
  state.velocity = state.displacement;
  state.memory = body.memory_at(state.displacement);
  integrate::Implicit statics(body, integrate::Implicit::Inertia::none);
  statics.begin(state, 0.0, integrate::MemoryRule::at_once);
  if (!statics.linearise(state.displacement, state.displacement))
    throw std::domain_error("the body is not held");
  // M^1/2 K^-1 M^1/2, whose largest eigenvalue is 1 / omega^2
  const Vector root_mass = body.mass().cwiseSqrt();
  const auto multiply = [&](const Vector& x, Vector& image) {
    statics.response(root_mass.cwiseProduct(x), image);
    image = root_mass.cwiseProduct(image).eval();
  };
  const EigenPair found =
      largest_eigenpair(root_mass.cwiseProduct(scattered(body)), 1e-9, multiply);
  return {1.0 / std::sqrt(found.value), found.vector.cwiseQuotient(root_mass)};
}

}  // namespace palpate::stability
