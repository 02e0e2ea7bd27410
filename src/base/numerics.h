// Roots, minima, Gauss points, Student's t and Bessel's functions, by Boost.Math in double
// precision.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

namespace palpate::numerics {

// Refers to a function of one number that outlives the call it is given to; allocates nothing.
template <class Value>
class Function {
 public:
  template <class Callable>
  requires(!std::is_same_v<std::remove_cvref_t<Callable>, Function>)
      // NOLINTNEXTLINE(google-explicit-constructor, bugprone-forwarding-reference-overload)
      Function(Callable&& callable)
      : of_(const_cast<void*>(static_cast<const void*>(std::addressof(callable)))),
        call_([](void* of, double x) -> Value {
          return (*static_cast<std::remove_reference_t<Callable>*>(of))(x);
        }) {}
  Value operator()(double x) const { return call_(of_, x); }

 private:
  void* of_;
  Value (*call_)(void*, double);
};

struct Interval {
  double low = 0.0, high = 0.0;  // low < high
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

// The part of `within` in which a continuous function changes its sign, a few units in the last
// place wide (Alefeld, Potra & Shi 1995). Where it has the same sign at both ends, the end with the
// smaller value.
[[nodiscard]] Interval root(Interval within, Function<double> of);

struct Tangent {
  double value = 0.0, slope = 0.0;
};
// The root by Newton's method from `start`, with bisection where it would leave `within`; the
// function has different signs at the ends. The last step is below 1e-9 of the root, so that its
// error is rounding.
[[nodiscard]] double root(double start, Interval within, Function<Tangent> of);

// The part of `within`, of at most `width` of its upper end, in which the answer changes; 0 for
// neighbouring numbers. The function is true at the lower end and false at the upper one, and is
// not asked there.
[[nodiscard]] Interval change(Interval within, double width, Function<bool> of);

// The place of the smallest value, to 1e-8 of the interval (Brent 1973). Where the function has no
// finite value, it counts as 1e100.
[[nodiscard]] double minimum(Interval within, Function<double> of);

// Gauss and Legendre's rule on [-1, 1], in ascending order; computed once for every number of
// points.
struct GaussRule {
  std::vector<double> nodes, weights;
};
[[nodiscard]] const GaussRule& gauss_rule(int points);

// The t for which P(T <= t) = probability, 0 to 1, with `degrees` > 0 degrees of freedom.
[[nodiscard]] double student_t_quantile(double probability, double degrees);

// Bessel's function of the first kind, of order 0 or 1, for any x. The C library's j0 and j1 differ
// between processors.
[[nodiscard]] double bessel_j(int order, double x);

}  // namespace palpate::numerics

namespace palpate {

struct EigenPair {
  double value = 0.0;
  Eigen::VectorXd vector;  // of unit length
};

// Lanczos's method with implicit restarts (Calvetti, Reichel & Sorensen 1994) from `start`, on
// which all bits of the result depend, until the residual is at most `tolerance` of the eigenvalue.
// `multiply(x, image)` fills `image`. Keeps 20 vectors. Throws MeshError if 10000 products are not
// enough.
[[nodiscard]] EigenPair largest_eigenpair(
    const Eigen::VectorXd& start, double tolerance,
    const std::function<void(const Eigen::VectorXd&, Eigen::VectorXd&)>& multiply);

}  // namespace palpate
