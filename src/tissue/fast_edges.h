// Forces of a linear body without memory by its edges, vectorised.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "tissue/lanes.h"
#include "tissue/network.h"

namespace palpate::tissue {

// The springs' form of the same force is in springs.h, and agrees up to rounding. Use one copy per
// thread.
class FastEdges {
 public:
  // The network must have this form (edge_form.h). Copies it: about 100 bytes per edge.
  FastEdges(const Network& network, Lanes lanes);
  ~FastEdges();
  FastEdges(FastEdges&&) noexcept;
  FastEdges& operator=(FastEdges&&) noexcept;

  // Computes the forces at a displacement (m, three numbers per node).
  void pass(const Eigen::VectorXd& displacement);
  // Of the last pass: the force, N, three numbers per node, and the stored energy, J.
  void force(double* force) const;
  [[nodiscard]] double stored() const;

 private:
  struct Layout;
  std::unique_ptr<Layout> layout_;
};

}  // namespace palpate::tissue
