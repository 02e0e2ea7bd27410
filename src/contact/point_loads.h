// The field of point loads on a half-space, in a file of its own so that it can be compiled with
// vectorisation.
#pragma once

#include <vector>

namespace palpate::contact {

// Their number is a multiple of eight: loads without a share fill it up.
struct PointLoads {
  std::vector<double> x, y;   // m
  std::vector<double> share;  // of the whole load
};

// Sums over the loads, per newton of the whole. Times 1/(4 pi G): the displacement. Times 1/(2 pi):
// the stress.
struct PointField {
  double ux = 0.0, uy = 0.0, uz = 0.0;
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
};

// Loads along -z (Boussinesq), or along the unit vector (along_x, along_y) in the plane (Cerruti).
// The point is (x, y, -depth), m, with a depth of at least 0; `least` (m^2) is added to its squared
// distance from a load, on which it may lie. The sums of loads with equal index modulo 8 are added
// in pairs.
//      K. L. Johnson 1985, eq. (3.18)-(3.19), (3.75)-(3.76)
[[nodiscard]] PointField boussinesq(const PointLoads& loads, double x, double y, double depth,
                                    double least, double poisson_ratio);
[[nodiscard]] PointField cerruti(const PointLoads& loads, double x, double y, double depth,
                                 double least, double poisson_ratio, double along_x,
                                 double along_y);

}  // namespace palpate::contact
