// Least squares of curves that are linear in some of their parameters.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "fit/ceres_fit.h"

namespace palpate::fit {

// y_i = sum_j c_j phi_ij(s): linear in the factors c, non-linear in the shapes s.
struct Separable {
  std::size_t linear = 1;  // number of factors
  // Computes phi at these shapes, one row of `linear` numbers per point; false if it cannot.
  std::function<bool(std::span<const double> shapes, std::span<double> phi)> columns;
  std::vector<std::vector<double>> starts;  // shapes, each with its best factors; the best is taken
  // 1 or more: of so many of the best starts the nearest minima are compared first.
  std::size_t minima = 0;
};

// The best of `starts`, by linear least squares for c, and from there a minimum over all of them.
// The parameters are c, then s; derivatives with respect to s are central differences. Scale y and
// the shapes to order one. Failed where no start can be computed.
[[nodiscard]] Minimum minimise(std::span<const double> y, const Separable& curve,
                               int max_iterations);

// Replaces parameter i by `value`, whose derivative with respect to the parameter is `slope`.
void replace_parameter(Minimum& minimum, std::size_t i, double value, double slope);

// Errors of parameter i that has become p_i + factor p_j, to first order.
void add_to_parameter(Minimum& minimum, std::size_t i, std::size_t j, double factor);

// Parameter k becomes that which was parameter from[k].
void reorder_parameters(Minimum& minimum, std::span<const std::size_t> from);

}  // namespace palpate::fit
