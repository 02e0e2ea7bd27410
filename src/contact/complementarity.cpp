// Solves a linear system for each guess of the points in contact, until all signs are right.
#include "contact/complementarity.h"

#include <Eigen/Cholesky>

namespace palpate::contact {
namespace {

// Computes the forces that close the gaps of the pressed points; all others are zero.
bool close_gaps(const Eigen::MatrixXd& compliance, const Eigen::VectorXd& gap,
                const std::vector<char>& pressed, Eigen::VectorXd& force) {
  std::vector<Eigen::Index> at;
  for (std::size_t i = 0; i < pressed.size(); ++i)
    if (pressed[i] != 0) at.push_back(static_cast<Eigen::Index>(i));
  force.setZero(gap.size());
  if (at.empty()) return true;
  const Eigen::LLT<Eigen::MatrixXd> factors(compliance(at, at));
  if (factors.info() != Eigen::Success) return false;
  const Eigen::VectorXd overlap = -gap(at);
  const Eigen::VectorXd closing = factors.solve(overlap);
  force(at) = closing;
  return true;
}

}  // namespace

bool press_apart(const Eigen::MatrixXd& compliance, const Eigen::VectorXd& gap,
                 std::vector<char>& pressed, Eigen::VectorXd& force) {
  constexpr int most_blocks = 10;  // block steps in a row without progress
  // Rounding error of a closed gap, relative to the depths.
  const double closed = 1e-12 * gap.cwiseAbs().maxCoeff();
  std::size_t fewest = pressed.size() + 1;
  int blocks = most_blocks;
  while (true) {
    if (!close_gaps(compliance, gap, pressed, force)) return false;
    const Eigen::VectorXd left = gap + compliance * force;
    std::vector<std::size_t> wrong;
    for (std::size_t i = 0; i < pressed.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (pressed[i] != 0 ? force[at] < 0.0 : left[at] < -closed) wrong.push_back(i);
    }
    if (wrong.empty()) return true;
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      blocks = most_blocks;
    } else if (blocks > 0) {
      --blocks;
    } else {
      wrong = {wrong.back()};
    }
    for (const std::size_t i : wrong) pressed[i] = pressed[i] != 0 ? 0 : 1;
  }
}

}  // namespace palpate::contact
