// Finds the surface from the heights and forces that a stand or a gauge measures in a slow press.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "contact/viscous_contact.h"

namespace palpate::live {

// Mean and standard deviation of readings; those of a long time, about the last hundred.
class Readings {
 public:
  double count = 0.0;
  void add(double force);
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] double deviation() const { return std::sqrt(variance_); }

 private:
  double mean_ = 0.0, variance_ = 0.0;
};

// A straight line through points by least squares. Allocates nothing.
class StraightLine {
 public:
  void add(double x, double y);
  [[nodiscard]] double count() const { return count_; }

  struct Found {
    double slope = 0.0;
    double zero = 0.0;  // the x at which the line is 0
  };
  // Nothing with fewer than three points, and for a level line.
  [[nodiscard]] std::optional<Found> found() const;

 private:
  double count_ = 0.0;
  double first_ = 0.0;  // sums are of x - first_, to reduce rounding errors
  double x_ = 0.0, xx_ = 0.0, y_ = 0.0, xy_ = 0.0;
};

// F^(2/3): the force of a sphere is F = c (z_0 - z)^(3/2), so that this is linear in z and vanishes
// at the surface z_0 for any stiffness of the tissue.
[[nodiscard]] double linear_in_depth(double force);

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
