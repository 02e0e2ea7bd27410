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
#include "contact/law.h"
#include "finger/layer.h"
#include "geometry/curvature.h"
#include "geometry/shapes.h"
#include "integrate/central_difference.h"
#include "tissue/springs.h"
#include "tissue/stiffness.h"
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
struct HalfSpace {
  static constexpr Word word{"half_space",
                             "Endless tissue under a flat, a dome or a bowl: for `hertz` only."};
  double curvature = 0.0;             // 1/m, convex positive
  std::optional<double> curvature_2;  // 1/m, across; empty: the same
};
struct SurfaceFile {
  static constexpr Word word{"file", "A closed surface from an STL, OBJ, PLY or OFF file."};
  std::string file;
  std::string unit;  // a length unit's symbol
};
struct AsMeshed {
  static constexpr Word word{"as_meshed", "Whatever `tissue.mesh`, a ready mesh, holds."};
};
using Shape = std::variant<Cuboid, Cylinder, Ellipsoid, Ligament, BoneShaft, LayeredLimb, HalfSpace,
                           SurfaceFile, AsMeshed>;

struct Kuhn {
  static constexpr Word word{"kuhn", "Cells of six tetrahedra, all alike (the paper's cube)."};
  std::array<int, 3> cells{3, 4, 6};
  double grading = 1.0;  // of the longest cells over the shortest, which lie under the finger
};
struct Mirrored {
  static constexpr Word word{"mirrored", "Kuhn cells, every second one reflected."};
  std::array<int, 3> cells{3, 4, 6};
  double grading = 1.0;
};
struct Tetgen {
  static constexpr Word word{"tetgen", "An unstructured mesh by TetGen."};
  int nodes = 728;
  std::optional<int> tetrahedra;  // empty: as the nodes give
  std::optional<double> edge;     // m; where given, `nodes` does not count
};
struct MeshFile {
  static constexpr Word word{"file", "A ready mesh: TetGen's .node and .ele, or Gmsh's .msh."};
  std::string file;
  std::string unit;  // a length unit's symbol
};
using Mesh = std::variant<Kuhn, Mirrored, Tetgen, MeshFile>;

// A spring behind a dashpot, of a Prony series.
struct Branch {
  double relaxation_time = 1.0;  // s
  double ratio = 1.0;            // its modulus over that of the relaxed tissue
};

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
  std::vector<Branch> branches;               // of `prony`
  std::optional<double> drag;                 // 1/s
  Base base = Base::automatic;
  std::optional<double> base_height;  // m; empty: 0 on a flat underside, else a tenth of the height
};

// What a part of the specimen is made of, where that is not `tissue.material`.
struct Substance {
  std::string material = "muscle";
  std::optional<double> density = {};        // kg/m^3; empty properties come from the material
  std::optional<double> young_modulus = {};  // Pa
  std::optional<double> poisson_ratio = {};  // independent springs have one of their own
};
struct TaggedRegion {
  static constexpr Word word{"tagged", "A region of the shape or of the mesh file, by its number."};
  int tag = 1;
  Substance substance;
};
struct Lump {
  static constexpr Word word{"sphere", "A lump inside the specimen."};
  std::array<double, 3> centre{0.030, 0.030, 0.022};  // m
  double radius = 0.005;                              // m
  Substance substance;
};
struct Slab {
  static constexpr Word word{"slab", "A flat layer of a cuboid, from side to side."};
  double bottom = 0.0;  // m, of its two heights
  double top = 0.010;
  Substance substance;
};
using Region = std::variant<TaggedRegion, Lump, Slab>;
[[nodiscard]] inline const Substance& substance(const Region& region) {
  return std::visit([](const auto& one) -> const Substance& { return one.substance; }, region);
}

struct Finger {
  enum class Weight { in_contact, apart };
  std::string material = "finger";  // or `rigid`
  double radius = 0.011;            // m
  int spheres = 1;
  finger::Calibration calibration = finger::Calibration::force;
  std::optional<double> x, y;  // m, where it presses; empty: the middle of the specimen
  std::optional<double> density;
  std::optional<double> young_modulus;
  std::optional<double> poisson_ratio;
  Weight weight = Weight::in_contact;
};

struct Contact {
  enum class CurvatureOn { rest, deformed };
  enum class Viscosity { automatic, none, tissue };
  enum class Depth { automatic, hertz, neo_hookean };
  enum class Direction { automatic, skin, sphere };
  enum class Spread { pressure, nearest_node };
  enum class Slip { mindlin, coulomb };
  contact::CurvatureLaw law = contact::CurvatureLaw::elliptic;
  geometry::CurvatureMethod curvature = geometry::CurvatureMethod::quadric;
  CurvatureOn curvature_on = CurvatureOn::rest;
  int curvature_rings = 2;
  contact::Coupling coupling = contact::Coupling::consistent;
  Viscosity viscosity = Viscosity::automatic;
  Depth depth = Depth::automatic;
  Direction direction = Direction::automatic;
  Spread spread = Spread::pressure;
  double friction = 0.0;
  Slip slip = Slip::mindlin;
  double ambient_force = 0.0;  // N, F_a of eq. (1)
};

struct Solver {
  enum class Model { automatic, hertz, layer, mass_spring, coupled_springs };
  enum class Integrator {
    automatic,
    central_difference,
    semi_implicit_euler,
    backward_difference,
    tr_bdf2,
    quasi_static,
    modal
  };
  enum class Volume { automatic, none, tetrahedron, nodal };
  Model model = Model::automatic;
  double tolerance = 0.05;
  tissue::StiffnessRule stiffness = tissue::StiffnessRule::fitted;
  Volume volume = Volume::automatic;
  tissue::Kinematics kinematics = tissue::Kinematics::linear;
  Integrator integrator = Integrator::automatic;
  integrate::Start start = integrate::Start::consistent;
  integrate::DampingVelocity damping = integrate::DampingVelocity::centred;
  std::optional<double> time_step;  // s
  std::optional<int> substeps;      // a time step is cut into; empty: as many as are stable
  bool allow_unstable = false;
  std::optional<int> rings;  // empty: all
};

// The haptic device that would show the force: for what is found about it.
struct Device {
  std::optional<double> damping;  // N s/m; empty: there is none
  double frame = 1e-3;            // s
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
struct Slide {
  enum class Keep { travel, force };
  static constexpr Word word{"slide", "Move sideways at the same depth or the same force."};
  double by = 0.010;       // m
  double rate = 0.005;     // m/s
  double direction = 0.0;  // degrees from x towards y
  Keep keep = Keep::travel;
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
using Step = std::variant<Indent, Hold, Retract, Slide, Creep, Relax>;

struct Output {
  double interval = 1e-3;        // s
  std::vector<double> force_at;  // m, indentations whose force is a finding
  bool pressure_maps = true;
  bool fits = true;
  bool figures = true;
  bool pdf = false;
  bool tissue = false;                          // deformed meshes for ParaView
  bool picture = false;                         // of the scene
  std::map<std::string, double> display_scale;  // by case, for figures and fits only
};

struct Scenario {
  int schema = 1;
  std::string title;
  Tissue tissue;
  std::vector<Region> regions;
  Finger finger;
  Contact contact;
  Device device;
  Solver solver;
  std::vector<Step> steps;
  Output output;

  // Whether the steps load the end faces of the specimen, without a finger.
  [[nodiscard]] bool uniform() const;

  // False where it is plain that no mesh will be made; `auto` may still do without one.
  [[nodiscard]] bool meshed() const;

  // Whether the contact force knows the tissue's viscosity, once that has been filled in.
  [[nodiscard]] bool viscous_contact() const;
};

// The one list of a scenario's keys, with their units, ranges, defaults and where they count.
void fields(FieldVisitor& visitor, Scenario& scenario);

}  // namespace palpate::scenario
