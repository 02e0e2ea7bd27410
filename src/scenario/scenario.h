// What was asked: a scenario as plain values in SI units, complete with its defaults.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/fields.h"
#include "contact/coupling.h"
#include "integrate/central_difference.h"
#include "tissue/springs.h"
#include "tissue/stiffness.h"
#include "tissue/viscous.h"

namespace palpate::scenario {

struct Cuboid {
  static constexpr Word word{"cuboid", "A box; the finger presses the middle of its top."};
  std::array<double, 3> size{0.060, 0.060, 0.030};  // m
};
using Shape = std::variant<Cuboid>;

struct Kuhn {
  static constexpr Word word{"kuhn", "Cells of six tetrahedra, all alike (the paper's cube)."};
  std::array<int, 3> cells{3, 4, 6};
};
struct Mirrored {
  static constexpr Word word{"mirrored", "Kuhn cells, every second one reflected."};
  std::array<int, 3> cells{3, 4, 6};
};
struct Tetgen {
  static constexpr Word word{"tetgen", "An unstructured mesh by TetGen."};
  int nodes = 728;
};
struct MeshFile {
  static constexpr Word word{"file", "A ready mesh in TetGen's .node and .ele files."};
  std::string file;
  std::string unit;  // a length unit's symbol
};
using Mesh = std::variant<Kuhn, Mirrored, Tetgen, MeshFile>;

struct Tissue {
  enum class Base { automatic, bonded, frictionless };
  std::string material = "skin";
  Shape shape = Cuboid{};
  Mesh mesh = Mirrored{};
  std::optional<double> density;        // kg/m^3; empty properties come from the material
  std::optional<double> young_modulus;  // Pa
  std::optional<double> poisson_ratio;
  tissue::Viscosity viscosity = tissue::Viscosity::kelvin_voigt;
  std::optional<double> retardation_time;     // s
  std::optional<double> relaxation_time;      // s
  std::optional<double> instantaneous_ratio;  // E_0 / E_inf
  std::optional<double> drag;                 // 1/s
  Base base = Base::automatic;
};

struct Finger {
  enum class Weight { in_contact, apart };
  std::string material = "finger";  // or `rigid`
  double radius = 0.011;            // m
  int spheres = 1;
  std::optional<double> density;
  std::optional<double> young_modulus;
  std::optional<double> poisson_ratio;
  Weight weight = Weight::in_contact;
};

struct Contact {
  contact::Coupling coupling = contact::Coupling::consistent;
  double friction = 0.0;
  double ambient_force = 0.0;  // N, F_a of eq. (1)
};

struct Solver {
  enum class Model { automatic, hertz, mass_spring };
  enum class Integrator { central_difference, backward_difference, quasi_static, modal };
  Model model = Model::automatic;
  double tolerance = 0.05;
  tissue::StiffnessRule stiffness = tissue::StiffnessRule::fitted;
  tissue::Kinematics kinematics = tissue::Kinematics::linear;
  Integrator integrator = Integrator::central_difference;
  integrate::Start start = integrate::Start::consistent;
  std::optional<double> time_step;  // s
  std::optional<int> substeps;      // a time step is cut into; empty: as many as are stable
  bool allow_unstable = false;
  std::optional<int> rings;  // empty: all
};

struct Indent {
  static constexpr Word word{"indent", "Press to a travel, or until a force is reached."};
  Target to{0.003, false};  // m, or N where `second`
  double rate = 0.005;      // m/s
};
struct Hold {
  static constexpr Word word{"hold", "Keep the travel for a time."};
  double time = 1.0;  // s
};
struct Retract {
  static constexpr Word word{"retract", "Withdraw to a travel."};
  double to = 0.0;      // m
  double rate = 0.005;  // m/s
};
struct Creep {
  static constexpr Word word{
      "creep", "Stress on the specimen's end faces at once, held, withdrawn: strain over time."};
  double stress = 1e3;         // Pa, compression positive
  double load_time = 1.0;      // s
  double recovery_time = 1.0;  // s
};
struct Relax {
  static constexpr Word word{"relax",
                             "Strain of the whole specimen at once, held: stress over time."};
  double strain = 0.05;  // shortening over height
  double time = 1.0;     // s
};
using Step = std::variant<Indent, Hold, Retract, Creep, Relax>;

struct Output {
  double interval = 1e-3;  // s
  bool pressure_maps = true;
  bool fits = true;
  bool figures = true;
  bool pdf = false;
  std::map<std::string, double> display_scale;  // by case, for figures and fits only
};

struct Scenario {
  int schema = 1;
  std::string title;
  Tissue tissue;
  Finger finger;
  Contact contact;
  Solver solver;
  std::vector<Step> steps;
  Output output;

  // Whether the steps load the end faces of the specimen, without a finger.
  [[nodiscard]] bool uniform() const;
};

// The one list of a scenario's keys, with their units, ranges, defaults and where they count.
void fields(FieldVisitor& visitor, Scenario& scenario);

}  // namespace palpate::scenario
