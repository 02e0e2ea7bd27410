// The only file that includes Spectra.
#include "base/eigen_pair.h"

#include <Spectra/SymEigsSolver.h>

#include <algorithm>

#include "base/error.h"

namespace palpate {
namespace {

using Vector = Eigen::VectorXd;

struct Products {
  using Scalar = double;
  Eigen::Index size;
  const std::function<void(const Vector&, Vector&)>& multiply;
  mutable Vector from{}, to{};

  [[nodiscard]] Eigen::Index rows() const { return size; }
  [[nodiscard]] Eigen::Index cols() const { return size; }
  void perform_op(const double* x, double* image) const {
    from = Vector::Map(x, size);
    multiply(from, to);
    Vector::Map(image, size) = to;
  }
};

}  // namespace

EigenPair largest_eigenpair(const Vector& start, double tolerance,
                            const std::function<void(const Vector&, Vector&)>& multiply) {
  constexpr Eigen::Index kept = 20;
  constexpr Eigen::Index most_restarts = 1000;
  Products products{start.size(), multiply};
  Spectra::SymEigsSolver<Products> solver(products, 1, std::min(kept, start.size()));
  solver.init(start.data());
  if (solver.compute(Spectra::SortRule::LargestAlge, most_restarts, tolerance) < 1)
    throw MeshError("a mode of the mesh was not found; mesh the body again with a quality bound");
  return {solver.eigenvalues()[0], solver.eigenvectors(1).col(0)};
}

}  // namespace palpate
