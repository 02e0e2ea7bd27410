// What a time integrator may ask of a body: masses, forces, matrices. It knows no springs.
#pragma once

#include <span>
#include <vector>

#include "base/split_matrix.h"

namespace palpate::integrate {

using Vector = Eigen::VectorXd;

// How the viscous memory passes through a step: exactly for a linear course of elongation, exactly
// for a load that is held, by implicit Euler, by explicit Euler (branches only, whose elongation
// stays), or not at all (a jump that takes no time).
enum class MemoryRule { exact, held, first_order, forward, at_once };

struct TimeStep {
  double size = 0.0;  // s
  MemoryRule rule = MemoryRule::exact;
  bool operator==(const TimeStep&) const = default;
};

// Damping and memory that are proportional to mass or stiffness, as a modal solution needs them.
struct Proportional {
  struct Branch {
    double time = 0.0;   // s, of relaxation
    double ratio = 0.0;  // its stiffness is ratio K
  };
  double drag_rate = 0.0;         // 1/s: D = drag_rate M
  double retardation_time = 0.0;  // s: D = retardation_time K
  std::vector<Branch> branches;   // springs behind dashpots
};

// All vectors have one entry a degree of freedom. Held ones do not move.
class Body {
 public:
  virtual ~Body() = default;

  [[nodiscard]] virtual const Vector& mass() const = 0;          // kg
  [[nodiscard]] virtual const Vector& drag() const = 0;          // N s/m on the ground
  [[nodiscard]] virtual std::span<const char> held() const = 0;  // 1 where held
  [[nodiscard]] virtual bool linear() const = 0;
  [[nodiscard]] virtual const Proportional& proportional() const = 0;

  // The force (N) that holds the displacement (m) in balance, without dashpots and drag.
  virtual void force(const Vector& displacement, std::span<const double> memory,
                     Vector& force) const = 0;

  // The elastic stiffness at rest, N/m; held rows are the identity's.
  [[nodiscard]] virtual SplitMatrix stiffness() const = 0;

  // Dashpots between nodes: their matrix (N s/m; held rows are the identity's), and their force.
  [[nodiscard]] virtual bool has_dashpots() const = 0;
  [[nodiscard]] virtual SplitMatrix dashpots(const Vector& displacement) const = 0;
  virtual void dashpot_force(const Vector& displacement, const Vector& velocity,
                             Vector& force) const = 0;

  // The viscous memory: its value at a displacement reached at once from rest, and its passage
  // through a step that ends at `displacement`.
  virtual void memory_at(const Vector& displacement, std::vector<double>& memory) const = 0;
  [[nodiscard]] std::vector<double> memory_at(const Vector& displacement) const {
    std::vector<double> memory;
    memory_at(displacement, memory);
    return memory;
  }
  virtual void remember(const Vector& displacement, const TimeStep& step,
                        std::vector<double>& memory) const = 0;

  // For implicit steps: the force at the end of a step that ends at `displacement`, dashpots
  // included, and its derivative (held rows are the identity's).
  virtual void step_force(const Vector& displacement, std::span<const double> memory,
                          const TimeStep& step, Vector& force) const = 0;
  [[nodiscard]] virtual SplitMatrix step_stiffness(const Vector& displacement,
                                                   std::span<const double> memory,
                                                   const TimeStep& step) const = 0;
};

// What changes.
struct State {
  double time = 0.0;           // s
  Vector displacement;         // m
  Vector velocity;             // m/s
  std::vector<double> memory;  // of the viscous branches, as the body lays it out
};

}  // namespace palpate::integrate
