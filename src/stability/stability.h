// The stability map: measured and theoretical limits of the time step, and probes for failures.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "plot/gnuplot.h"
#include "record/table.h"
#include "scenario/family.h"

namespace palpate::stability {

// The kinds of failure of a simulation.
enum class Failure {
  none,
  divergence,         // energy grows without input
  non_finite,         // a number is infinite or NaN
  inversion,          // a tetrahedron has turned inside out
  false_equilibrium,  // without load, forces balance in a deformed state
  locking,            // stiffness grows with the bulk modulus as nu approaches 1/2
  drift,              // without a damper, energy is lost, or gained too slowly for divergence
  chatter,            // the contact begins or ends again and again from frame to frame
};
[[nodiscard]] constexpr const char* failure_word(Failure failure) {
  return name_of<Failure::chatter>(failure);
}

// One measured limit of the time step.
struct LimitRow {
  std::string model, volume, integrator, damping;
  std::string axis;                        // varied quantity with its unit, or `model`
  std::optional<double> value;             // of the quantity, in this unit
  std::optional<double> measured, theory;  // s; nothing: no limit
  Failure failure = Failure::none;         // beyond the limit
  std::string note;
};

// One probe for a failure.
struct FailureRow {
  Failure failure = Failure::none;
  std::string model, integrator;
  std::string measure;  // name and unit of the numbers `measured` and `theory`
  std::optional<double> setting;
  std::string setting_unit;
  std::optional<double> measured, theory;
  bool reached = false;  // whether the failure occurs at this setting
  std::string note;
};

struct StabilityMap {
  std::vector<LimitRow> limits;
  std::vector<FailureRow> failures;
  std::string tested;  // the case in a sentence
  std::vector<std::string> sentences;
  std::optional<double> longest_step = {};  // s, of central differences without damping
};

// Measures the map of a case with a mesh of at most `most_map_nodes` nodes:
//   - every model with a mesh (mass_spring with volume none, tetrahedron, nodal; coupled_springs
//   with
//     tetrahedron, nodal), with every damping (none, nodal_drag, kelvin_voigt,
//     standard_linear_solid) and every integrator, and central differences with lagged velocity;
//   - for the scenario's model one quantity at a time: Young's modulus, Poisson's ratio (always
//     coupled_springs), element size, damping, contact stiffness, device damping;
//   - a probe for every kind of failure.
// Meshes of more than 200 nodes get fewer settings. Limits are measured on the free body
// (stability/free_motion.h); methods without a limit are tried at up to 1000 times the explicit
// limit. The result has the same bits in every call. `told` receives the name of each measurement
// and the share done, 0 to 1. Throws Stopped, InputError for a scenario
// without a mesh or with too many nodes, and like scene::build().
inline constexpr int most_map_nodes = 1000;
using Told = std::function<void(const std::string& what, double share)>;
[[nodiscard]] StabilityMap map_stability(const scenario::Case& one, const scenario::Family& family,
                                         const Told& told);

// stability.csv: model, volume, integrator, damping, axis, value, limit_us, theory_us, ratio,
// failure, note.
[[nodiscard]] record::Table limit_table(const StabilityMap& map);

// failures.csv: failure, model, integrator, setting, setting_unit, measure, measured, theory, seen,
// note.
[[nodiscard]] record::Table failure_table(const StabilityMap& map);

// stability.gp: one panel per axis of the map, theory as lines and measurements as points, and a
// strip with the kinds of failure. Reads stability.csv and failures.csv.
[[nodiscard]] plot::Sheet stability_sheet(const std::string& title, const StabilityMap& map);

// Writes the tables and the figure into `folder` and renames it to its final name. Returns
// warnings, for example on a figure. Throws SystemError if the folder cannot be written.
[[nodiscard]] std::vector<std::string> write_map(const StabilityMap& map, const std::string& title,
                                                 WholeFolder& folder);

}  // namespace palpate::stability
