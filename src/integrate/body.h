// The interface of a body to time integrators: masses, forces and matrices, but no springs.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "base/block_matrix.h"

namespace palpate::integrate {

using Vector = Eigen::VectorXd;

// How the viscous memory is advanced in a step: exactly for an elongation that is linear in time,
// exactly for a load that is constant, by implicit Euler, by explicit Euler (branches only, at a
// constant elongation), or not at all (a jump that takes no time).   docs/theory.md [memory]
enum class MemoryRule { exact, held, first_order, forward, at_once };

struct TimeStep {
  double size = 0.0;  // s
  MemoryRule rule = MemoryRule::exact;
  bool operator==(const TimeStep&) const = default;
};

// Damping and memory that are proportional to mass or stiffness, which modes need [modes].
struct Proportional {
  struct Branch {
    double time = 0.0;   // s, relaxation time
    double ratio = 0.0;  // its stiffness is ratio K
  };
  double drag_rate = 0.0;         // 1/s: D = drag_rate M
  double retardation_time = 0.0;  // s: D = retardation_time K
  std::vector<Branch> branches;   // springs in series with dashpots
};

// The part of a simulation that changes with time.
struct State {
  double time = 0.0;           // s
  Vector displacement;         // m
  Vector velocity;             // m/s
  std::vector<double> memory;  // of the viscous branches, in the layout of the body

  // What Body::look() fills. Whoever changes displacement or memory otherwise leaves `force` empty.
  Vector force;               // N
  std::vector<Vector> parts;  // of the force: those of the branches, or that of Kelvin-Voigt
  double stored = 0.0;        // J
};

// Sets the entries of held degrees of freedom to 0.
inline void clear_held(std::span<const char> held, Vector& vector) {
  for (std::size_t d = 0; d < held.size(); ++d)
    if (held[d] != 0) vector[static_cast<Eigen::Index>(d)] = 0.0;
}

// All vectors have one entry per degree of freedom. Held degrees of freedom do not move.
class Body {
 public:
  virtual ~Body() = default;

  [[nodiscard]] virtual const Vector& mass() const = 0;          // kg
  [[nodiscard]] virtual const Vector& drag() const = 0;          // N s/m, against the ground
  [[nodiscard]] virtual std::span<const char> held() const = 0;  // 1 where held
  [[nodiscard]] virtual bool linear() const = 0;
  [[nodiscard]] virtual const Proportional& proportional() const = 0;

  // Fills the internal force of a state, which is equal to the load in equilibrium, without
  // dashpots and drag, and its energy, from its displacement and memory.
  virtual void look(State& state) const = 0;
  // The same at the end of a step to the displacement that the state has already: advances its
  // memory first.
  void arrive(State& state, const TimeStep& step) const {
    remember(state.displacement, step, state.memory);
    look(state);
  }

  // The force of such a state alone.
  void force(const Vector& displacement, std::span<const double> memory, Vector& force) const {
    State state;
    state.displacement = displacement;
    state.memory.assign(memory.begin(), memory.end());
    look(state);
    force = std::move(state.force);
  }

  // The elastic stiffness at rest, N/m, without supports.
  [[nodiscard]] virtual const BlockMatrix& stiffness() const = 0;

  // Dashpots between nodes: their matrix (N s/m, without supports) and their force (N).
  [[nodiscard]] virtual bool has_dashpots() const = 0;
  [[nodiscard]] virtual BlockMatrix dashpots(const Vector& displacement) const = 0;
  virtual void dashpot_force(const Vector& displacement, const Vector& velocity,
                             Vector& force) const = 0;

  // The viscous memory: its value at a displacement (m) that is reached at once from rest, and its
  // change in a step that ends at `displacement`.
  virtual void memory_at(const Vector& displacement, std::vector<double>& memory) const = 0;
  [[nodiscard]] std::vector<double> memory_at(const Vector& displacement) const {
    std::vector<double> memory;
    memory_at(displacement, memory);
    return memory;
  }
  virtual void remember(const Vector& displacement, const TimeStep& step,
                        std::vector<double>& memory) const = 0;

  // For implicit steps: the internal force (N) at the end of a step that ends at `displacement`,
  // dashpots included, and its derivative (N/m; the rows of held freedoms are those of the
  // identity).
  virtual void step_force(const Vector& displacement, std::span<const double> memory,
                          const TimeStep& step, Vector& force) const = 0;
  [[nodiscard]] virtual SplitMatrix step_stiffness(const Vector& displacement,
                                                   std::span<const double> memory,
                                                   const TimeStep& step) const = 0;
};

}  // namespace palpate::integrate
