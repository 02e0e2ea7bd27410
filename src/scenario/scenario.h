// The scenario as the user wrote it: SI units, defaults, and empty values for keys left open.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/fields.h"
#include "base/vec3.h"
#include "contact/coupling.h"
#include "contact/law.h"
#include "finger/layer.h"
#include "geometry/curvature.h"
#include "geometry/shapes.h"
#include "integrate/central_difference.h"
#include "scenario/model_traits.h"
#include "tissue/coupled.h"
#include "tissue/stiffness.h"
#include "tissue/supports.h"
#include "tissue/viscous.h"

namespace palpate::scenario {

struct Cuboid {
  static constexpr Word word{"cuboid", "A box; the finger presses the middle of its top."};
  std::array<double, 3> size{0.060, 0.060, 0.030};  // m
};
struct Cylinder : geometry::Cylinder {
  static constexpr Word word{"cylinder", "A round bar along y, lying; flat ends."};
};
struct Ellipsoid : geometry::Ellipsoid {
  static constexpr Word word{"ellipsoid", "An ellipsoid, such as a head."};
};
struct Ligament : geometry::Ligament {
  static constexpr Word word{"ligament",
                             "A strap along y with rounded sides, broader at its ends."};
};
struct BoneShaft : geometry::BoneShaft {
  static constexpr Word word{"bone_shaft", "A round shaft along y that widens towards its ends."};
};
struct LayeredLimb : geometry::LayeredLimb {
  static constexpr Word word{
      "layered_limb",
      "A tapered limb along y: region 0 is its skin, 1 the muscle inside, 2 the bone."};
};
struct Disc : geometry::Disc {
  static constexpr Word word{"disc",
                             "A round disc, standing, such as a biopsy punch takes; the finger "
                             "presses its flat top, the sides are free."};
};
struct HalfSpace {
  static constexpr Word word{
      "half_space", "Infinite tissue with a flat, convex or concave surface; for `hertz` only."};
  double curvature = 0.0;             // 1/m, convex positive
  std::optional<double> curvature_2;  // 1/m, across the first; empty: the same
};
struct SurfaceFile {
  static constexpr Word word{"file",
                             "A closed surface from an STL, OBJ, PLY, OFF, VTP or VTU file. For a "
                             "mesh, triangles that are too fine, and needles, are replaced."};
  std::string file;
  std::string unit;            // symbol of a length unit
  std::string up = "z";        // the direction of the file's coordinates that points up
  bool repair = true;          // small faults of the surface
  double repair_up_to = 0.02;  // of its area
  std::optional<int> part;     // of several closed parts; empty: the only one, or the largest
};
struct AsMeshed {
  static constexpr Word word{"as_meshed", "The shape of the ready mesh that `tissue.mesh` names."};
  std::string up = "z";  // as for a surface
};
using Shape = std::variant<Cuboid, Cylinder, Ellipsoid, Ligament, BoneShaft, LayeredLimb, Disc,
                           HalfSpace, SurfaceFile, AsMeshed>;

// Whether, and how far, a mesh is refined where its own error in the force comes from.
struct Refinement {
  bool refine = false;  // true by default only if the scenario gives no mesh
  int most_nodes = 4000;
};
struct Kuhn : Refinement {
  static constexpr Word word{"kuhn", "Cells of six tetrahedra, all alike (the paper's cube)."};
  std::array<int, 3> cells{3, 4, 6};
  double grading = 1.0;  // longest cell over the shortest, which is under the finger
};
struct Mirrored : Refinement {
  static constexpr Word word{"mirrored", "Kuhn cells, every second one reflected."};
  std::array<int, 3> cells{3, 4, 6};
  double grading = 1.0;
};
struct Tetgen : Refinement {
  static constexpr Word word{"tetgen", "An unstructured mesh by TetGen."};
  int nodes = 728;
  std::optional<int> tetrahedra;  // empty: follows from `nodes`
  std::optional<double> edge;     // m; if given, `nodes` is not used
};
struct MeshFile : Refinement {
  static constexpr Word word{
      "file",
      "A ready mesh of tetrahedra, hexahedra, prisms or pyramids: .msh of Gmsh, .vtu and .vtk of "
      "VTK, .inp of Abaqus, .mesh of MEDIT, .node and .ele of TetGen."};
  std::string file;
  std::string unit;  // symbol of a length unit
};
using Mesh = std::variant<Kuhn, Mirrored, Tetgen, MeshFile>;
[[nodiscard]] inline Refinement& refinement(Mesh& mesh) {
  return std::visit([](auto& kind) -> Refinement& { return kind; }, mesh);
}
[[nodiscard]] inline const Refinement& refinement(const Mesh& mesh) {
  return std::visit([](const auto& kind) -> const Refinement& { return kind; }, mesh);
}

// A branch of a Prony series: a spring in series with a dashpot.
struct Branch {
  double relaxation_time = 1.0;  // s
  double ratio = 1.0;            // its modulus over the modulus of the relaxed tissue
};

// Where a scenario may leave keys of a table open, to a material or to `auto`, the other keys are
// members of a base `Plain...`. The structs derived here add the open keys as optionals; those of
// scenario/resolved.h add them as plain values.
struct PlainTissue {
  std::string material = "skin";
  Shape shape = Cuboid{};
  Mesh mesh = Mirrored{};
  tissue::Viscosity viscosity = tissue::Viscosity::kelvin_voigt;
  std::vector<Branch> branches;       // for `prony`
  std::string base_side;              // the held side: a direction or a group of faces; empty: down
  std::optional<double> base_height;  // m; empty: the flat underside, or else a tenth of the height
};
struct Tissue : PlainTissue {
  std::optional<double> density;        // kg/m^3; empty properties are those of the material
  std::optional<double> young_modulus;  // Pa
  std::optional<double> poisson_ratio;
  std::optional<double> retardation_time;     // s
  std::optional<double> relaxation_time;      // s
  std::optional<double> instantaneous_ratio;  // E_0 / E_inf
  std::optional<double> drag;                 // 1/s
  std::optional<tissue::Base> base;
};

struct TaggedRegion {
  static constexpr Word word{"tagged",
                             "A region of the shape or of the mesh file, by its number or name."};
  int tag = 1;
  std::string name = {};  // of a group in the mesh file; if it is empty, `tag` counts
};
struct Inclusion {
  static constexpr Word word{"sphere", "An inclusion inside the specimen."};
  std::array<double, 3> centre{0.030, 0.030, 0.022};  // m
  double radius = 0.005;                              // m
};
struct Slab {
  static constexpr Word word{"slab", "A flat layer of the body, from side to side."};
  double bottom = 0.0;  // m, like `top` a height
  double top = 0.010;
};
using Part = std::variant<TaggedRegion, Inclusion, Slab>;

// A part of the specimen with another material than `tissue.material`.
struct PlainRegion {
  Part part;
  std::string material = "muscle";
};
struct Region : PlainRegion {
  std::optional<double> density = {};        // kg/m^3; empty properties are those of the material
  std::optional<double> young_modulus = {};  // Pa
  std::optional<double> poisson_ratio =
      {};  // not used by independent springs without a volume term
};

struct PlainFinger {
  enum class Weight { in_contact, apart };
  std::string material = "finger";  // a tissue, or `rigid`
  double radius = 0.011;            // m
  int spheres = 1;
  finger::Calibration calibration = finger::Calibration::force;
  std::optional<double> x, y;  // m, position; empty: the middle of the specimen
  std::vector<double> at;      // m, three; or empty: `x` and `y` count
  std::string towards;         // direction of the press; empty: down, or into the surface at `at`
  Weight weight = Weight::in_contact;

  [[nodiscard]] bool rigid() const { return material == "rigid"; }
};
struct Finger : PlainFinger {
  std::optional<double> density;
  std::optional<double> young_modulus;
  std::optional<double> poisson_ratio;
};

struct PlainContact {
  enum class CurvatureOn { rest, deformed };
  enum class Viscosity { none, tissue };
  enum class Depth { hertz, neo_hookean };
  enum class Direction { surface, sphere };
  enum class Spread { pressure, nearest_node };
  enum class Slip { mindlin, coulomb };
  contact::CurvatureLaw law = contact::CurvatureLaw::elliptic;
  geometry::CurvatureMethod curvature = geometry::CurvatureMethod::quadric;
  CurvatureOn curvature_on = CurvatureOn::rest;
  int curvature_rings = 2;
  contact::Coupling coupling = contact::Coupling::consistent;
  Spread spread = Spread::pressure;
  double friction = 0.0;
  Slip slip = Slip::mindlin;
  double ambient_force = 0.0;  // N, F_a of eq. (1)
};
struct Contact : PlainContact {
  std::optional<Viscosity> viscosity;
  std::optional<Depth> depth;
  std::optional<Direction> direction;
};

struct PlainSolver {
  using Model = scenario::Model;
  using Volume = tissue::Volume;
  enum class Integrator {
    central_difference,
    semi_implicit_euler,
    backward_difference,
    tr_bdf2,
    quasi_static,
    modal
  };
  enum class Kinematics { linear, nonlinear };
  enum class Damping { centred, lagged };
  double tolerance = 0.05;
  tissue::StiffnessRule stiffness = tissue::StiffnessRule::fitted;
  Kinematics kinematics = Kinematics::linear;
  integrate::Start start = integrate::Start::consistent;
  Damping damping = Damping::centred;
  std::optional<double> time_step;  // s
  std::optional<int> substeps;      // of a time step; empty: as many as are needed
  bool allow_unstable = false;
  std::optional<int> rings;  // of moving nodes; empty: all nodes move
  std::optional<int> modes;  // kept by `modal`, the lowest; empty: default_modes
};
struct Solver : PlainSolver {
  std::optional<Model> model;
  std::optional<Volume> volume;
  std::optional<Integrator> integrator;
};

// The haptic device that would display the force, for findings about it.
struct Device {
  std::optional<double> damping;  // N s/m; empty: no device
  double frame = 1e-3;            // s
};

struct Indent {
  static constexpr Word word{"indent", "Press to a displacement, or until a force is reached."};
  Target to{0.003, false};  // m, or N where `second`
  double rate = 0.005;      // m/s
};
struct Hold {
  static constexpr Word word{"hold", "Keep the displacement for a time."};
  double time = 1.0;  // s
};
struct Retract {
  static constexpr Word word{"retract", "Withdraw to a displacement."};
  double to = 0.0;      // m
  double rate = 0.005;  // m/s
};
struct Slide {
  enum class Keep { displacement, force };
  static constexpr Word word{"slide", "Move sideways at the same depth or the same force."};
  double by = 0.010;       // m
  double rate = 0.005;     // m/s
  double direction = 0.0;  // degrees from x towards y
  Keep keep = Keep::displacement;

  [[nodiscard]] Vec3 way() const {  // m
    const double angle = direction * std::numbers::pi / 180.0;
    return by * Vec3(std::cos(angle), std::sin(angle), 0.0);
  }
};
struct Creep {
  static constexpr Word word{
      "creep", "A stress on the end faces, applied at once, held, then removed: strain over time."};
  double stress = 1e3;         // Pa, compression positive
  double load_time = 1.0;      // s
  double recovery_time = 1.0;  // s
};
struct Relax {
  static constexpr Word word{
      "relax", "A strain of the whole specimen, applied at once and held: stress over time."};
  double strain = 0.05;  // shortening over height
  double time = 1.0;     // s
};
struct Compress {
  static constexpr Word word{"compress",
                             "A strain of the whole specimen that grows at a constant rate and "
                             "then stays: stress over strain."};
  double strain = 0.1;                               // shortening over height, at the end
  double rate = 0.01;                                // 1/s
  double hold_time = 0.0;                            // s
  tissue::Base platen = tissue::Base::frictionless;  // the upper one

  [[nodiscard]] double ramp_time() const { return strain / rate; }
  [[nodiscard]] double strain_at(double time) const { return std::min(strain, rate * time); }
};
using Step = std::variant<Indent, Hold, Retract, Slide, Creep, Relax, Compress>;

// Whether the step loads the end faces of the specimen, without a finger.
[[nodiscard]] inline bool loads_end_faces(const Step& step) {
  return std::holds_alternative<Creep>(step) || std::holds_alternative<Relax>(step) ||
         std::holds_alternative<Compress>(step);
}

struct Output {
  enum class Regression { none, logarithmic, power, exponential };
  enum class Paper { none, figure_6, figure_7 };
  enum class Meshes { steps, rows };
  double interval = 1e-3;        // s
  std::vector<double> force_at;  // m, indentations at which the force is a finding
  bool pressure_maps = true;
  bool fits = true;
  bool figures = true;
  bool report = true;         // report.html
  Paper paper = Paper::none;  // compared on the page
  bool pdf = false;
  bool png = false;
  Regression regression = Regression::none;     // drawn over the force in figures
  bool tissue = false;                          // deformed meshes for ParaView
  Meshes tissue_at = Meshes::steps;             // at their ends, or at every row of the CSV files
  bool picture = false;                         // of the scene
  std::map<std::string, double> display_scale;  // by case, only for figures and fits

  // Leaves rows as the only result of a run: no maps, no deformed meshes, no picture and no page.
  void keep_rows_only() { pressure_maps = tissue = picture = report = false; }
};

struct PlainScenario {
  int schema = 1;
  std::string title;
  Device device;
  std::vector<Step> steps;
  Output output;

  // Whether the steps load the end faces of the specimen, without a finger.
  [[nodiscard]] bool uniform() const;
};
struct Scenario : PlainScenario {
  Tissue tissue;
  std::vector<Region> regions;
  Finger finger;
  Contact contact;
  Solver solver;

  // False if no mesh can be made; while the model is open, true means that one may be made.
  [[nodiscard]] bool meshed() const;
};

// Whether the contact force includes the tissue's viscosity, in a Scenario or a Resolved.
template <class AnyScenario>
[[nodiscard]] bool viscous_contact(const AnyScenario& scenario) {
  return scenario.contact.viscosity == Contact::Viscosity::tissue &&
         scenario.contact.coupling != contact::Coupling::one_way &&
         scenario.tissue.viscosity != tissue::Viscosity::none &&
         scenario.tissue.viscosity != tissue::Viscosity::nodal_drag;
}

// The only list of a scenario's keys, with units, ranges, defaults and conditions of their effect.
void fields(FieldVisitor& visitor, Scenario& scenario);

struct NumericKey {
  std::string path;          // as in `--set`: `tissue.shape.size.3`, `region.1.top`
  std::optional<Unit> unit;  // nothing for a pure number
  Range range;               // in SI units
  Use use;                   // when the key has an effect, with the condition of its table
};

// All keys of real numbers and quantities, in the order of fields(); entries of lists are separate
// keys, counted from 1. Whole numbers are not included.
[[nodiscard]] std::vector<NumericKey> numeric_keys(const Scenario& scenario);

// Sets the number at `path` to `si`, in SI units and unchecked. Returns false if there is none.
bool set_number(Scenario& scenario, std::string_view path, double si);

}  // namespace palpate::scenario
