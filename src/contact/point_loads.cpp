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

// With R from the load to the point, z its depth, r = (x, y) the part of R in the plane and d = |R|
// + z.
struct Near {
  double share, x, y;
  double away, by_away, by_d, cube;  // |R|, 1/|R|, 1/d, 1/|R|^3
};

// Calls add(lane, near) for every load.
template <class Add>
PALPATE_ALWAYS void visit(std::size_t count, const double* x_of, const double* y_of,
                          const double* share_of, double x, double y, double z, double least,
                          const Add& add) {
  for (std::size_t first = 0; first < count; first += lanes)
    for (std::size_t i = 0; i < lanes; ++i) {
      const double rx = x - x_of[first + i];
      const double ry = y - y_of[first + i];
      const double away = std::sqrt(rx * rx + ry * ry + least + z * z);
      const double by_away = 1.0 / away;
      add(i, Near{share_of[first + i], rx, ry, away, by_away, 1.0 / (away + z),
                  by_away * by_away * by_away});
    }
}

// With k = 1 - 2 nu. The stresses in the plane are without Johnson's division by r^2, since |R| - z
// = r^2/d.
PALPATE_WIDEST void press(std::size_t count, const double* x_of, const double* y_of,
                          const double* share_of, double x, double y, double z, double least,
                          double nu, Sums* to) {
  const double k = 1.0 - 2.0 * nu;
  Sums sums;
  visit(
      count, x_of, y_of, share_of, x, y, z,
      least, [&](std::size_t i, const Near& at) __attribute__((always_inline)) {
        const double even = at.share * k * at.by_away * at.by_d;
        const double uneven = at.share * k * at.cube * at.by_d * at.by_d * (2.0 * at.away + z);
        const double push = at.share * 3.0 * z * at.cube * at.by_away * at.by_away;
        const double inward = at.share * z * at.cube - even;
        sums.ux[i] += inward * at.x;
        sums.uy[i] += inward * at.y;
        sums.uz[i] -= at.share * (z * z * at.cube + 2.0 * (1.0 - nu) * at.by_away);
        sums.xx[i] += even - uneven * at.y * at.y - push * at.x * at.x;
        sums.yy[i] += even - uneven * at.x * at.x - push * at.y * at.y;
        sums.xy[i] += (uneven - push) * at.x * at.y;
        sums.zz[i] -= push * z * z;
        sums.xz[i] += push * z * at.x;
        sums.yz[i] += push * z * at.y;
      });
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
  visit(
      count, x_of, y_of, share_of, x, y, z,
      least, [&](std::size_t i, const Near& at) __attribute__((always_inline)) {
        const double p = at.x * tx + at.y * ty;
        const double even = at.share * (at.by_away + k * at.by_d);
        const double turned = at.share * k * at.by_away * at.by_d * at.by_d;
        const double outward = at.share * p * at.cube - p * turned;
        sums.ux[i] += even * tx + outward * at.x;
        sums.uy[i] += even * ty + outward * at.y;
        sums.uz[i] -= at.share * p * at.by_away * (z * at.by_away * at.by_away + k * at.by_d);
        const double pull = at.share * 3.0 * p * at.cube * at.by_away * at.by_away;
        const double all = at.share * k * p * at.cube - p * turned;
        const double along = p * turned * at.by_away * (at.by_away + 2.0 * at.by_d) - pull;
        sums.xx[i] += all - 2.0 * turned * tx * at.x + along * at.x * at.x;
        sums.yy[i] += all - 2.0 * turned * ty * at.y + along * at.y * at.y;
        sums.xy[i] += along * at.x * at.y - turned * (tx * at.y + ty * at.x);
        sums.zz[i] -= pull * z * z;
        sums.xz[i] += pull * z * at.x;
        sums.yz[i] += pull * z * at.y;
      });
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
