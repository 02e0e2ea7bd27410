// The highest and the lowest mode of a linear body, with a contact's spring in it or not.
#pragma once

#include "integrate/body.h"

namespace palpate::study {

// A spring that reads the displacement of a body as a mean, k (w.u), and loads it by the same
// weights: what an explicit contact is to a mesh.
struct ContactSpring {
  double stiffness = 0.0;     // N/m
  integrate::Vector weights;  // one a degree of freedom, a unit force spread; 0 where held
};

struct BodyMode {
  double frequency = 0.0;   // 1/s
  integrate::Vector shape;  // m, of unit modal mass
};

// Lanczos on M^-1/2 (K + k w w^T) M^-1/2 with full reorthogonalisation, from a scattered start, to
// a residual of 1e-9. The body is linear, without viscous branches. `contact` may be null.
[[nodiscard]] BodyMode highest_mode(const integrate::Body& body, const ContactSpring* contact);

// Inverse iteration, to 1e-10 of the frequency. Throws std::domain_error where the body is not
// held, and has motions that cost no energy.
[[nodiscard]] BodyMode lowest_mode(const integrate::Body& body);

// Numbers between -1/2 and 1/2 without preferred directions, the same on every machine; 0 where
// held.
[[nodiscard]] integrate::Vector scattered(const integrate::Body& body);

}  // namespace palpate::study
