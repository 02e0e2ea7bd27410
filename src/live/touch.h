// Finds the surface from the heights and forces that a stand or a gauge measures in a slow press.
#pragma once

#include <optional>
#include <vector>

#include "contact/relaxation.h"

namespace palpate::live {

// The force of a sphere is F = c (z_0 - z)^(3/2), so that F^(2/3) is linear in z and vanishes at
// the surface z_0 for any stiffness of the tissue. The line is fitted by least squares.
class TouchLine {
 public:
  // Adds a reading: height z (m) and force (N), ignored unless above 0. Allocates nothing.
  void add(double z, double force);
  // z_0, m; nothing with fewer than three readings or if the force does not grow downwards.
  [[nodiscard]] std::optional<double> surface() const;

 private:
  double count_ = 0.0;
  double z_first_ = 0.0;  // m: sums are of z - z_first_, to reduce rounding errors
  double z_ = 0.0, zz_ = 0.0, y_ = 0.0, zy_ = 0.0;
};

// The surface from all readings of a slow press, those out of contact as well, so that noise
// averages: least squares of F = a + c p(t), where p is Lee and Radok's integral [viscous] of
// h^(3/2), h = z_0 - z, with the relaxation of the contact's modulus; of Kelvin-Voigt tissue the
// elastic part. a, c and z_0 are free.
class SurfaceSearch {
 public:
  // `relaxation` outlives the object.
  explicit SurfaceSearch(const contact::Relaxation& relaxation) : relaxation_(&relaxation) {}
  void add(double time, double z, double force);  // s, m, N

  struct Found {
    double surface = 0.0;  // z_0, m
    double error = 0.0;    // m, its standard deviation
    double noise = 0.0;    // N, rms of the residuals
  };
  // Nothing with fewer than ten readings or if the force does not grow downwards.
  [[nodiscard]] std::optional<Found> find() const;

 private:
  struct Line {
    double squares = 0.0;  // N^2, of the residuals
    double slope = 0.0;    // c
  };
  [[nodiscard]] Line line(double surface) const;

  const contact::Relaxation* relaxation_;
  std::vector<double> time_, z_, force_;
};

}  // namespace palpate::live
