// Eight loads at a time, so that any width gives the same bits; src/CMakeLists.txt has compiler
// options.
#include "contact/point_loads.h"

#include <cmath>

#include "base/wide.h"

namespace palpate::contact {
namespace {

constexpr std::size_t lanes = 8;
using Lanes = double[lanes];

double total(const Lanes& sums) {
  return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}

struct Sums {
  Lanes ux = {}, uy = {}, uz = {}, xx = {}, yy = {}, zz = {}, xy = {}, xz = {}, yz = {};

  [[nodiscard]] PointField totals() const {
    return {total(ux), total(uy), total(uz), total(xx), total(yy),
            total(zz), total(xy), total(xz), total(yz)};
  }
};

// With R from the load to the point, z its depth, d = |R| + z, r the part of R in the plane and k =
// 1 - 2 nu. The stresses in the plane are without Johnson's division by r^2, since |R| - z = r^2/d.
PALPATE_WIDEST void press(std::size_t count, const double* x_of, const double* y_of,
                          const double* share_of, double x, double y, double z, double least,
                          double nu, Sums* to) {
  const double k = 1.0 - 2.0 * nu;
  Sums sums;
  for (std::size_t first = 0; first < count; first += lanes)
    for (std::size_t i = 0; i < lanes; ++i) {
      const double rx = x - x_of[first + i];
      const double ry = y - y_of[first + i];
      const double share = share_of[first + i];
      const double away = std::sqrt(rx * rx + ry * ry + least + z * z);
      const double by_away = 1.0 / away;
      const double by_d = 1.0 / (away + z);
      const double cube = by_away * by_away * by_away;
      const double even = share * k * by_away * by_d;
      const double uneven = share * k * cube * by_d * by_d * (2.0 * away + z);
      const double push = share * 3.0 * z * cube * by_away * by_away;
      const double inward = share * z * cube - even;
      sums.ux[i] += inward * rx;
      sums.uy[i] += inward * ry;
      sums.uz[i] -= share * (z * z * cube + 2.0 * (1.0 - nu) * by_away);
      sums.xx[i] += even - uneven * ry * ry - push * rx * rx;
      sums.yy[i] += even - uneven * rx * rx - push * ry * ry;
      sums.xy[i] += (uneven - push) * rx * ry;
      sums.zz[i] -= push * z * z;
      sums.xz[i] += push * z * rx;
      sums.yz[i] += push * z * ry;
    }
  *to = sums;
}

// With t the unit vector of the load, p = R . t and n = (0, 0, 1) outwards:
// 4 pi G u = t (1/|R| + k/d) + R p/|R|^3 - k p r/(|R| d^2) - k p n/(|R| d)
// 2 pi sigma = -3 p R R^T/|R|^5 + k [p (1/|R|^3 - 1/(|R| d^2)) 1 - (t r^T + r t^T)/(|R| d^2)
//              + p (1/(|R|^3 d^2) + 2/(|R|^2 d^3)) r r^T]; what has the factor k acts in the plane
//              only.
PALPATE_WIDEST void drag(std::size_t count, const double* x_of, const double* y_of,
                         const double* share_of, double x, double y, double z, double least,
                         double nu, double tx, double ty, Sums* to) {
  const double k = 1.0 - 2.0 * nu;
  Sums sums;
  for (std::size_t first = 0; first < count; first += lanes)
    for (std::size_t i = 0; i < lanes; ++i) {
      const double rx = x - x_of[first + i];
      const double ry = y - y_of[first + i];
      const double share = share_of[first + i];
      const double away = std::sqrt(rx * rx + ry * ry + least + z * z);
      const double by_away = 1.0 / away;
      const double by_d = 1.0 / (away + z);
      const double cube = by_away * by_away * by_away;
      const double p = rx * tx + ry * ty;
      const double even = share * (by_away + k * by_d);
      const double turned = share * k * by_away * by_d * by_d;
      const double outward = share * p * cube - p * turned;
      sums.ux[i] += even * tx + outward * rx;
      sums.uy[i] += even * ty + outward * ry;
      sums.uz[i] -= share * p * by_away * (z * by_away * by_away + k * by_d);
      const double pull = share * 3.0 * p * cube * by_away * by_away;
      const double all = share * k * p * cube - p * turned;
      const double along = p * turned * by_away * (by_away + 2.0 * by_d) - pull;
      sums.xx[i] += all - 2.0 * turned * tx * rx + along * rx * rx;
      sums.yy[i] += all - 2.0 * turned * ty * ry + along * ry * ry;
      sums.xy[i] += along * rx * ry - turned * (tx * ry + ty * rx);
      sums.zz[i] -= pull * z * z;
      sums.xz[i] += pull * z * rx;
      sums.yz[i] += pull * z * ry;
    }
  *to = sums;
}

}  // namespace

PointField boussinesq(const PointLoads& loads, double x, double y, double depth, double least,
                      double poisson_ratio) {
  Sums sums;
  press(loads.x.size(), loads.x.data(), loads.y.data(), loads.share.data(), x, y, depth, least,
        poisson_ratio, &sums);
  return sums.totals();
}

PointField cerruti(const PointLoads& loads, double x, double y, double depth, double least,
                   double poisson_ratio, double along_x, double along_y) {
  Sums sums;
  drag(loads.x.size(), loads.x.data(), loads.y.data(), loads.share.data(), x, y, depth, least,
       poisson_ratio, along_x, along_y, &sums);
  return sums.totals();
}

}  // namespace palpate::contact
