// Where methods fail: measured limits of the time step beside the theoretical ones, and every kind
// of failure by a number.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "record/table.h"
#include "scenario/family.h"

namespace palpate::study {

// How a simulation can be wrong, and by what number that is seen.
enum class Failure {
  none,
  divergence,         // energy grows without input
  non_finite,         // numbers leave the finite ones
  inversion,          // a tetrahedron has turned inside out
  false_equilibrium,  // forces balance, without load, away from rest
  locking,            // stiffness grows with the bulk modulus as nu nears 1/2
  drift,              // energy is lost without a damper, or gained below what counts as divergence
  chatter,            // the contact is there in one frame and gone in the next
  tunnelling,         // a press happens between two frames
};
[[nodiscard]] const char* failure_word(Failure failure);

// One measured limit of the step.
struct LimitRow {
  std::string rung, volume, integrator, damping;
  std::string axis;                        // what was varied: `rung`, or a quantity with its unit
  std::optional<double> value;             // in that unit
  std::optional<double> measured, theory;  // s; nothing where there is no limit
  Failure failure = Failure::none;         // beyond it
  std::string note;
};

// One failure, looked for where the scenario could show it.
struct FailureRow {
  Failure failure = Failure::none;
  std::string rung, integrator;
  std::string measure;  // what the numbers are, with their unit
  std::optional<double> setting;
  std::string setting_unit;
  std::optional<double> measured, theory;
  bool reached = false;  // the failure is there at this setting
  std::string note;
};

struct StabilityMap {
  std::vector<LimitRow> limits;
  std::vector<FailureRow> failures;
  std::vector<std::string> sentences;
  bool interrupted = false;  // and incomplete
};

// The map of a case with a mesh, at most `most_map_nodes` of them:
//   every rung (mass_spring, coupled_springs, each with volume none, tetrahedron, nodal) times
//   every damping form (none, nodal_drag, kelvin_voigt, standard_linear_solid) times every
//   integrator of scenario::words::integrators, and central differences with lagged velocity; then,
//   on the scenario's own rung, one axis at a time: Young's modulus, Poisson's ratio, element size,
//   damping, contact stiffness, device damping; then a probe for every failure.
// A limit is measured on the free body (study/free_motion.h), methods without one are tried at up
// to 1000 times the explicit limit. The same bits at every call. `told` hears what is measured and
// the share that is done; a set `stop` ends the map early.
// Throws InputError for a scenario without a mesh or with too large a one, and what scene::build()
// throws.
inline constexpr int most_map_nodes = 1000;
using Told = std::function<void(const std::string& what, double share)>;
[[nodiscard]] StabilityMap map_stability(const scenario::Case& one, const scenario::Family& family,
                                         const std::atomic<bool>& stop, const Told& told);

// stability.csv: rung, volume, integrator, damping, axis, value, limit_us, theory_us, ratio,
// failure, note.
[[nodiscard]] record::Table limit_table(const StabilityMap& map);

// failures.csv: failure, rung, integrator, setting, setting_unit, measure, measured, theory, seen,
// note.
[[nodiscard]] record::Table failure_table(const StabilityMap& map);

}  // namespace palpate::study
