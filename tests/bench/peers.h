// What palpate-versus asks of another library: the forces and the step of particles with springs.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace palpate::versus {

// A body in plain numbers. Vectors have three entries (x, y, z) per node.
struct Model {
  std::vector<double> rest;              // m
  std::vector<double> mass;              // kg, one per node
  std::vector<char> held;                // one per node
  std::vector<double> load;              // N
  std::vector<std::array<int, 2>> ends;  // nodes of a spring
  std::vector<double> stiffness;         // N/m, one per spring
  double drag = 0.0;                     // 1/s: d_i / m_i of each node
  double time_step = 0.0;                // s
};

// Each library is compiled with its own flags and its own Eigen: no header of theirs meets ours.
class Peer {
 public:
  Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  virtual ~Peer() = default;

  // The gradient (N) of the elastic energy at a displacement (m). Afterwards the body is at rest.
  virtual void force(std::span<const double> displacement, std::span<double> force) = 0;

  // What is timed: a whole step if steps_in_time(), the elastic forces alone if not.
  virtual void step() = 0;
  [[nodiscard]] virtual bool steps_in_time() const = 0;
  virtual void displacement(std::span<double> displacement) const = 0;  // m, after the last step
};

// Springs that share one number for their stiffness, or a number for each.
enum class Groups { one, each };

[[nodiscard]] std::unique_ptr<Peer> make_chai3d(const Model& model);
// With Groups::one all springs have the stiffness of the first.
[[nodiscard]] std::unique_ptr<Peer> make_vegafem(const Model& model, Groups groups);

}  // namespace palpate::versus
