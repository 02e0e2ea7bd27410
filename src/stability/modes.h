// The highest and the lowest mode of a linear body, with or without a contact spring.
#pragma once

#include "integrate/body.h"

namespace palpate::stability {

// A linearised explicit contact: the force -k (w.u), distributed over the nodes with weights w.
struct ContactSpring {
  double stiffness = 0.0;     // N/m
  integrate::Vector weights;  // w: nodal forces of a unit force; 0 for held degrees of freedom
};

struct BodyMode {
  double frequency = 0.0;   // rad/s
  integrate::Vector shape;  // kg^-1/2: the modal mass is 1
};

// From M^-1/2 (K + k w w^T) M^-1/2, to a relative residual of 1e-9. The body is linear without
// branches; `contact` can be null.
[[nodiscard]] BodyMode highest_mode(const integrate::Body& body, const ContactSpring* contact);

// From M^1/2 K^-1 M^1/2, to a relative residual of 1e-9. Throws std::domain_error if the body is
// not held and can move without energy.
[[nodiscard]] BodyMode lowest_mode(const integrate::Body& body);

// Pseudo-random numbers in [-1/2, 1/2), the same on every machine; 0 for held degrees of freedom.
[[nodiscard]] integrate::Vector scattered(const integrate::Body& body);

}  // namespace palpate::stability
