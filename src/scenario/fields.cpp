// All keys of a scenario, each listed once.
#include <algorithm>
#include <functional>

#include "scenario/integrators.h"
#include "scenario/scenario.h"
#include "scenario/words.h"

namespace palpate::scenario {
namespace {

struct Conditions {
  Use mesh;          // keys of a mesh, which are ignored without one
  Use finger;        // physics of a finger
  Use mesh_physics;  // physics that only a mesh can represent
  Use pressed_mesh;  // keys of a mesh under a finger, ignored without one
  Use springs;       // of independent springs
  Use based;         // of specimens with a base: a mesh or a layer
  Use held;          // where the base of a pressed body is: of models that know its sides
  Use formula;       // keys of models without a mesh, which are ignored with one
  bool solid;        // the model is `solid`, which takes a body from a mesh file

  explicit Conditions(const Scenario& scenario);
};

using namespace words;

Conditions::Conditions(const Scenario& scenario) {
  const bool meshed = scenario.meshed();
  const std::optional<Model>& model = scenario.solver.model;
  const std::string when = !meshed && !model
                               ? "on another `tissue.shape` than `half_space`"
                               : "with " + models_that(std::mem_fn(&ModelTraits::meshed));
  mesh = {meshed, when, Use::Otherwise::note};
  mesh_physics = {meshed, when};
  springs = meshed ? Use{!model || traits(*model).independent(),
                         "with " + models_that(std::mem_fn(&ModelTraits::independent)),
                         Use::Otherwise::note}
                   : mesh;
  solid = model == Model::solid;
  based = model && traits(*model).thickness ? Use{} : mesh;
  formula = {!model || traits(*model).formula(),
             "with " + models_that(std::mem_fn(&ModelTraits::formula)), Use::Otherwise::note};
  // If steps of both kinds are mixed, the mixture is reported instead of the keys of the finger.
  const bool presses = !std::ranges::all_of(scenario.steps, loads_end_faces);
  finger = {presses || scenario.steps.empty(),
            "by steps with a finger (indent, hold, retract, slide)"};
  held = (model ? traits(*model).sides : meshed) ? finger : mesh;
  pressed_mesh = meshed ? Use{finger.used, finger.when, Use::Otherwise::note} : mesh;
}

void finger_fields(FieldVisitor& visitor, Finger& finger) {
  visitor.text({"material", "`finger` (the paper's silicone rubber), any tissue, or `rigid`."},
               finger.material);
  visitor.quantity({"radius", "Radius of the single sphere that has the finger's mass."},
                   finger.radius, unit::mm, between(unit::mm.to_si(1e-6), unit::mm.to_si(1e6)));
  visitor.count({"spheres", "Sphere bodies of equal mass that make up the finger, eq. (5)."},
                finger.spheres, between(1, 64));
  visitor.choice(
      of_the_paper(
          {"calibration",
           "Which property several spheres share with the single sphere that they replace.",
           {finger.spheres > 1, "with more than one of `spheres`", Use::Otherwise::note}}),
      finger.calibration, calibrations);
  visitor.quantity_or(
      "auto",
      {"x",
       "Where it presses, in the coordinates of the body; `auto`: the middle of the specimen."},
      finger.x, unit::mm, {});
  visitor.quantity_or("auto", {"y", "Likewise."}, finger.y, unit::mm, {});
  visitor.quantity_list({"at",
                         "A place in the coordinates of a body from a file: three lengths, in "
                         "place of `x` and `y`. The finger presses the nearest place of the "
                         "surface, along its normal unless `towards` is given."},
                        finger.at, unit::mm, {});
  visitor.text({"towards",
                "The direction of the press in the coordinates of a body from a file, as `up` of "
                "`tissue.shape`. Default: down."},
               finger.towards);
  const Use elastic{!finger.rigid(), "where the finger is not `rigid`"};
  visitor.quantity({"young_modulus", "Default: the material's.", elastic}, finger.young_modulus,
                   unit::kPa, above(0));
  visitor.number({"poisson_ratio", "Default: the material's.", elastic}, finger.poisson_ratio,
                 {.low = -1, .high = 0.5, .low_allowed = false});
  visitor.choice({"weight", "How the finger's weight is counted."}, finger.weight, weights);
  visitor.quantity({"density",
                    "Default: the material's.",
                    {finger.weight == Finger::Weight::apart, "with `weight = \"apart\"`"}},
                   finger.density, unit::density, above(0));
}

void contact_fields(FieldVisitor& visitor, Contact& contact, const Conditions& use) {
  visitor.choice({"coupling", "How contact law and mesh share the tissue's compliance.", use.mesh},
                 contact.coupling, couplings);
  visitor.choice(of_the_paper({"law", "How the tissue's curvature enters the contact law."}),
                 contact.law, laws);
  visitor.choice(of_the_paper({"curvature", "How curvature is computed on a mesh.", use.mesh}),
                 contact.curvature, curvature_methods);
  visitor.choice(of_the_paper({"curvature_on", "The surface whose curvature is used.", use.mesh}),
                 contact.curvature_on, curvature_surfaces);
  visitor.count(
      of_the_paper({"curvature_rings",
                    "Rings of vertices around the contact that curvature depends on.", use.mesh}),
      contact.curvature_rings, between(1, 8));
  visitor.choice_or(auto_contact_viscosities,
                    {"viscosity", "Whether the contact force includes the tissue's viscosity."},
                    contact.viscosity, contact_viscosities);
  visitor.choice_or(auto_depths, {"depth", "How the force grows in a deep press."}, contact.depth,
                    depths);
  visitor.choice_or(auto_directions,
                    {"direction",
                     "The direction in which `resolved` measures gaps and applies forces.",
                     {contact.coupling == contact::Coupling::resolved,
                      "with `coupling = \"resolved\"`", Use::Otherwise::note}},
                    contact.direction, directions);
  visitor.choice(
      of_the_paper({"spread", "How a contact force is distributed over nodes.", use.mesh}),
      contact.spread, loaded);
  visitor.number({"friction", "Coulomb's coefficient mu."}, contact.friction, at_least(0));
  visitor.choice(
      of_the_paper(
          {"slip",
           "How friction sets in. With `coupling = \"consistent\"` on a bonded base the mesh tells "
           "how far the tissue follows the finger; otherwise it does so as a half-space.",
           {contact.friction > 0.0, "with `friction` above 0", Use::Otherwise::note}}),
      contact.slip, slips);
  visitor.quantity({"ambient_force", "F_a of eq. (1), added to the force."}, contact.ambient_force,
                   unit::N, {});
}

void device_fields(FieldVisitor& visitor, Device& device) {
  visitor.quantity(
      {"damping", "The device's own; if given, findings.csv says what it displays passively."},
      device.damping, unit::N_s_per_m, at_least(0));
  visitor.quantity({"frame",
                    "Time from one force to the next.",
                    {device.damping.has_value(), "with `device.damping`", Use::Otherwise::note}},
                   device.frame, unit::ms, above(0));
}

void solver_fields(FieldVisitor& visitor, Solver& solver, const Conditions& use) {
  visitor.choice_or(auto_models, {"model", "The model; `auto` takes the cheapest that serves."},
                    solver.model, models);
  visitor.number({"tolerance", "Relative error of the force that `auto` accepts."},
                 solver.tolerance,
                 {.low = 0, .high = 1, .low_allowed = false, .high_allowed = false});
  visitor.choice(of_the_paper({"stiffness", "Spring stiffness from Young's modulus.", use.springs}),
                 solver.stiffness, stiffnesses);
  visitor.choice_or(auto_volumes, {"volume", "How a change of volume is resisted.", use.mesh},
                    solver.volume, volumes);
  visitor.choice({"kinematics", "Whether springs keep their directions or rotate.", use.mesh},
                 solver.kinematics, kinematics_words);
  visitor.choice_or(auto_integrators, {"integrator", "The time integrator.", use.mesh},
                    solver.integrator, integrators);
  using Integrator = Solver::Integrator;
  const Integrator integrator = solver.integrator.value_or(Integrator::central_difference);
  const bool central = integrator == Integrator::central_difference;
  const auto of_steps = [&](bool used, const char* when) {
    return use.mesh.used ? Use{used, when, Use::Otherwise::note} : use.mesh;
  };
  const Use centred = of_steps(central, "with `integrator = \"central_difference\"`");
  const Use stepped = of_steps(about(integrator).explicit_steps,
                               "with an explicit `integrator`, as \"central_difference\"");
  visitor.choice(of_the_paper({"start", "How the first time step is made.", centred}), solver.start,
                 starts);
  visitor.choice(
      of_the_paper(
          {"damping", "The velocity with which drag and dashpots act in a step.", centred}),
      solver.damping, damping_velocities);
  visitor.quantity_or("auto", {"time_step", "`auto`: the output interval.", use.mesh},
                      solver.time_step, unit::ms, above(0));
  visitor.count_or("auto",
                   {"substeps",
                    "Equal parts of a time step; `auto`: as many as stability, or the accuracy of "
                    "implicit methods, requires.",
                    use.mesh},
                   solver.substeps, between(1, 1e8));
  visitor.flag(
      of_the_paper({"allow_unstable",
                    "Run an explicit step above the stability limit, to see it fail.", stepped}),
      solver.allow_unstable);
  visitor.count_or("all",
                   of_the_paper({"rings",
                                 "Rings of nodes around the contact that move; other nodes are "
                                 "fixed. This is the paper's method, for comparisons with it: a "
                                 "frame of the whole mesh takes less time by `modal`.",
                                 use.pressed_mesh}),
                   solver.rings, between(1, 1000));
  visitor.count_or(
      "auto",
      {"modes",
       "The lowest modes, which `modal` keeps; the others follow without inertia. `auto`: 128, "
       "from 1000 nodes on 32, or all of them where the force follows from the whole motion.",
       solver.integrator == Integrator::modal || !solver.integrator
           ? use.pressed_mesh
           : Use{false, "with `integrator = \"modal\"`", Use::Otherwise::note}},
      solver.modes, between(1, 1e6));
}

void output_fields(FieldVisitor& visitor, Output& output, const Conditions& use) {
  visitor.quantity({"interval", "Time between rows of the CSV files."}, output.interval, unit::ms,
                   above(0));
  visitor.quantity_list({"force_at",
                         "Depths at which the force of the first `indent` is written to "
                         "findings.csv, such as `force_at_1_mm_N`.",
                         use.finger},
                        output.force_at, unit::mm, above(0));
  visitor.flag({"pressure_maps",
                "An EXR map at the end of every step.",
                {use.finger.used, use.finger.when, Use::Otherwise::note}},
               output.pressure_maps);
  visitor.flag({"fits", "Regressions of the curves."}, output.fits);
  visitor.flag({"figures", "SVG figures by gnuplot."}, output.figures);
  visitor.flag({"report", "A page with the result, figures and derived quantities, `report.html`."},
               output.report);
  visitor.choice(of_the_paper({"paper",
                               "Which figure of Chen 2007 the page sets its results beside.",
                               {output.report, "with `report`", Use::Otherwise::note}}),
                 output.paper, papers);
  visitor.flag({"pdf", "Figures as PDF too."}, output.pdf);
  visitor.flag({"png", "Figures and pressure maps as PNG too."}, output.png);
  visitor.choice(
      {"regression",
       "The regression of `fits.csv` that is drawn over the force in figures.",
       {output.fits && output.figures, "with `fits` and `figures`", Use::Otherwise::note}},
      output.regression, regressions);
  visitor.flag({"tissue", "Deformed meshes for ParaView.", use.pressed_mesh}, output.tissue);
  visitor.choice({"tissue_at",
                  "When the meshes of `tissue` are written.",
                  {output.tissue, "with `tissue`", Use::Otherwise::note}},
                 output.tissue_at, meshes_at);
  visitor.flag({"picture", "A picture of the scene."}, output.picture);
  visitor.numbers_by_name(
      of_the_paper({"display_scale",
                    "Factors by case, for figures and an extra fit; CSV stays in newtons."}),
      output.display_scale, above(0));
}

}  // namespace

// FieldVisitor::alternatives finds these functions by argument-dependent lookup.
static void fields(FieldVisitor& visitor, Cuboid& cuboid) {
  visitor.quantities({"size", "Length, width and height."}, cuboid.size, unit::mm, above(0));
}
static void fields(FieldVisitor& visitor, Cylinder& shape) {
  visitor.quantity({"radius", "Of the bar."}, shape.radius, unit::mm, above(0));
  visitor.quantity({"length", "Along y."}, shape.length, unit::mm, above(0));
}
static void fields(FieldVisitor& visitor, Ellipsoid& shape) {
  visitor.quantities({"size", "Full lengths of its three axes."}, {shape.size.data(), 3}, unit::mm,
                     above(0));
}
static void fields(FieldVisitor& visitor, Ligament& shape) {
  visitor.quantity({"length", "Along y."}, shape.length, unit::mm, above(0));
  visitor.quantity({"width", "In the middle."}, shape.width, unit::mm, above(0));
  visitor.quantity({"thickness", "In the middle."}, shape.thickness, unit::mm, above(0));
}
static void fields(FieldVisitor& visitor, BoneShaft& shape) {
  visitor.quantity({"length", "Along y."}, shape.length, unit::mm, above(0));
  visitor.quantity({"radius", "In the middle."}, shape.radius, unit::mm, above(0));
  visitor.quantity({"end_radius", "At both ends."}, shape.end_radius, unit::mm, above(0));
}
static void fields(FieldVisitor& visitor, LayeredLimb& shape) {
  visitor.quantity({"length", "Along y."}, shape.length, unit::mm, above(0));
  visitor.quantity({"radius", "At y = 0."}, shape.radius, unit::mm, above(0));
  visitor.quantity({"end_radius", "At the other end."}, shape.end_radius, unit::mm, above(0));
  visitor.quantity({"skin_thickness", "Of region 0."}, shape.skin_thickness, unit::mm, above(0));
  visitor.quantity({"bone_radius", "Of region 2."}, shape.bone_radius, unit::mm, above(0));
}
static void fields(FieldVisitor& visitor, Disc& shape) {
  visitor.quantity({"radius", "Of its round side."}, shape.radius, unit::mm, above(0));
  visitor.quantity({"height", "Along z."}, shape.height, unit::mm, above(0));
}
static void fields(FieldVisitor& visitor, HalfSpace& shape) {
  visitor.quantity({"curvature", "Of the surface, convex positive; 0 is a flat."}, shape.curvature,
                   unit::per_metre, {});
  visitor.quantity({"curvature_2", "Across the first. Default: the same."}, shape.curvature_2,
                   unit::per_metre, {});
}
static void fields(FieldVisitor& visitor, SurfaceFile& shape) {
  visitor.text({"file", "Path of the surface, from the scenario's folder."}, shape.file);
  visitor.text({"unit", "The length unit of its coordinates, such as `mm`. Required."}, shape.unit);
  visitor.text({"up",
                "The direction in the file's coordinates that points up, against the way of the "
                "finger: `x`, `-y`, or three numbers such as `0 0.2 1`."},
               shape.up);
  visitor.flag(
      {"repair",
       "Whether small faults are mended, with a note: vertices in one place, doubled triangles, "
       "sheets that share a vertex, triangles that face inwards, holes, and triangles that cross."},
      shape.repair);
  visitor.number({"repair_up_to",
                  "Share of the area that holes, or triangles that cross, may have to be mended."},
                 shape.repair_up_to, {.low = 0, .high = 0.5});
  visitor.count_or(
      "auto",
      {"part",
       "Which of several closed parts the body is, by falling volume, filled; `auto`: the largest, "
       "or the one nearest to `finger.at`, with the parts inside it as cavities, and a note."},
      shape.part, between(1, 1e6));
}
static void fields(FieldVisitor& visitor, AsMeshed& shape) {
  visitor.text({"up", "As for a surface from a file."}, shape.up);
}

static void grading(FieldVisitor& visitor, double& ratio) {
  visitor.number({"grading",
                  "Size of the largest cells, at the far ends, over that of the smallest, under "
                  "the finger; 1: all equal."},
                 ratio, between(1, 1000));
}
static void refinement(FieldVisitor& visitor, Refinement& mesh) {
  visitor.flag({"refine",
                "Whether a press with `consistent` contact refines this mesh where its own error "
                "in the force comes from, until that error is below half of `solver.tolerance`. "
                "Default: true if the scenario gives no `tissue.mesh`."},
               mesh.refine);
  visitor.count({"most_nodes",
                 "Where refining stops.",
                 {mesh.refine, "with `refine = true`", Use::Otherwise::note}},
                mesh.most_nodes, between(8, 1e6));
}
static void fields(FieldVisitor& visitor, Kuhn& mesh) {
  visitor.counts({"cells", "Cells along x, y and z."}, mesh.cells, between(1, 500));
  grading(visitor, mesh.grading);
  refinement(visitor, mesh);
}
static void fields(FieldVisitor& visitor, Mirrored& mesh) {
  visitor.counts({"cells", "Cells along x, y and z."}, mesh.cells, between(1, 500));
  grading(visitor, mesh.grading);
  refinement(visitor, mesh);
}
static void fields(FieldVisitor& visitor, Tetgen& mesh) {
  visitor.count(
      {"nodes", "How many nodes to aim at.", {!mesh.edge, "without `edge`", Use::Otherwise::note}},
      mesh.nodes, between(8, 1e6));
  visitor.count_or(
      "auto", {"tetrahedra", "How many tetrahedra to aim at as well; not for cuboids and files."},
      mesh.tetrahedra, between(1, 1e7));
  visitor.quantity_or("auto", {"edge", "A length of edges to aim at instead of a count."},
                      mesh.edge, unit::mm, above(0));
  refinement(visitor, mesh);
}
static void fields(FieldVisitor& visitor, MeshFile& mesh) {
  visitor.text({"file", "Path of the file, from the scenario's folder."}, mesh.file);
  visitor.text({"unit", "The length unit of its coordinates, such as `mm`. Required."}, mesh.unit);
  refinement(visitor, mesh);
}

static void fields(FieldVisitor& visitor, Indent& step) {
  visitor.either({"to",
                  "Displacement below the undeformed surface (column `travel_mm`), or contact "
                  "force, to reach."},
                 step.to, unit::mm, unit::N, above(0));
  visitor.quantity({"rate", "Speed of the finger."}, step.rate, unit::mm_per_s, above(0));
}
static void fields(FieldVisitor& visitor, Hold& step) {
  visitor.quantity({"time", "How long."}, step.time, unit::s, above(0));
}
static void fields(FieldVisitor& visitor, Retract& step) {
  visitor.quantity({"to", "Displacement to go back to; negative is above the surface."}, step.to,
                   unit::mm, {});
  visitor.quantity({"rate", "Speed of the finger."}, step.rate, unit::mm_per_s, above(0));
}
static void fields(FieldVisitor& visitor, Slide& step) {
  visitor.quantity({"by", "How far."}, step.by, unit::mm, above(0));
  visitor.quantity({"rate", "Speed of the finger."}, step.rate, unit::mm_per_s, above(0));
  visitor.number({"direction", "Degrees from x towards y."}, step.direction, between(-360, 360));
  visitor.choice({"keep", "What stays as it was when the slide began."}, step.keep, keeps);
}
static void fields(FieldVisitor& visitor, Creep& step) {
  visitor.quantity({"stress", "On the end faces, compression positive."}, step.stress, unit::kPa,
                   above(0));
  visitor.quantity({"load_time", "How long the stress stays."}, step.load_time, unit::s, above(0));
  visitor.quantity({"recovery_time", "How long to record after it is removed."}, step.recovery_time,
                   unit::s, at_least(0));
}
static void fields(FieldVisitor& visitor, Relax& step) {
  visitor.number({"strain", "Shortening over height."}, step.strain,
                 {.low = 0, .high = 1, .low_allowed = false, .high_allowed = false});
  visitor.quantity({"time", "How long it is held."}, step.time, unit::s, above(0));
}

static void fields(FieldVisitor& visitor, Compress& step) {
  visitor.number({"strain", "Shortening over height at the end."}, step.strain,
                 {.low = 0, .high = 1, .low_allowed = false, .high_allowed = false});
  visitor.quantity({"rate", "How fast the strain grows: the platen's speed over the height."},
                   step.rate, unit::per_second, above(0));
  visitor.quantity({"hold_time", "How long the strain stays afterwards."}, step.hold_time, unit::s,
                   at_least(0));
  visitor.choice({"platen", "How the upper platen holds the specimen; `tissue.base` is the lower."},
                 step.platen, bases);
}

static void fields(FieldVisitor& visitor, TaggedRegion& region) {
  visitor.text({"name",
                "The name of the region's group in the mesh file: a physical group of Gmsh, an "
                "element set of Abaqus."},
               region.name);
  visitor.count({"tag",
                 "The number of the region in the shape or in the mesh file.",
                 {region.name.empty(), "without `name`", Use::Otherwise::note}},
                region.tag, between(0, 1e9));
}
static void fields(FieldVisitor& visitor, Inclusion& region) {
  visitor.quantities({"centre",
                      "In the coordinates of the file that gives the body, or from the lowest "
                      "corner of a shape that palpate makes; `palpate explain SCENARIO` prints the "
                      "body's box. 99 % of the inclusion must lie in the body."},
                     region.centre, unit::mm, {});
  visitor.quantity({"radius", "Of the inclusion."}, region.radius, unit::mm, above(0));
}
static void fields(FieldVisitor& visitor, Slab& region) {
  visitor.quantity({"bottom", "Height where it begins, like `centre` of an inclusion."},
                   region.bottom, unit::mm, {});
  visitor.quantity({"top", "Height where it ends; the top of the body is `tissue`."}, region.top,
                   unit::mm, {});
}

namespace {

// The keys of a region that follow those of its part.
void substance_fields(FieldVisitor& visitor, Region& region) {
  visitor.text({"material", "As `tissue.material`."}, region.material);
  visitor.quantity({"young_modulus", "Default: the material's."}, region.young_modulus, unit::kPa,
                   above(0));
  visitor.number({"poisson_ratio",
                  "Default: the material's. Independent springs without a volume term have a ratio "
                  "of their own."},
                 region.poisson_ratio,
                 {.low = -1, .high = 0.5, .low_allowed = false, .high_allowed = true});
  visitor.quantity({"density", "Default: the material's."}, region.density, unit::density,
                   above(0));
}

void fields(FieldVisitor& visitor, Tissue& tissue, const Conditions& use) {
  visitor.text({"material",
                "A tissue of materials/chen2007.toml (skin, muscle, bone, ligament, upper_leg), or "
                "`file.toml#name` of your own."},
               tissue.material);
  visitor.table({"shape", "The specimen's shape."},
                [&](FieldVisitor& inner) { inner.alternatives(tissue.shape); });
  const bool brings_body = std::holds_alternative<AsMeshed>(tissue.shape) ||
                           (use.solid && std::holds_alternative<MeshFile>(tissue.mesh));
  visitor.table({"mesh", "How the shape is cut into tetrahedra.", brings_body ? Use{} : use.mesh},
                [&](FieldVisitor& inner) { inner.alternatives(tissue.mesh); });
  visitor.quantity({"young_modulus", "Of the relaxed tissue. Default: the material's."},
                   tissue.young_modulus, unit::kPa, above(0));
  visitor.number({"poisson_ratio",
                  "Default: the material's. With `mass_spring` it affects the contact and the "
                  "volume term only: independent springs have a ratio of their own, near 1/4."},
                 tissue.poisson_ratio,
                 {.low = -1,
                  .high = 0.5,
                  .low_allowed = false,
                  .high_allowed = false,
                  .remedy = "for a tissue that keeps its volume give 0.49, which lowers the force "
                            "by 1.3 % on deep tissue and by more on a thin layer"});
  visitor.quantity({"density", "Default: the material's.", use.mesh_physics}, tissue.density,
                   unit::density, above(0));
  visitor.choice({"viscosity",
                  "The viscous law of the tissue. A material without `retardation_time` is elastic "
                  "unless something asks for viscosity."},
                 tissue.viscosity, viscosities);
  const auto with = [&](tissue::Viscosity law, const char* when) {
    return Use{tissue.viscosity == law, when};
  };
  visitor.quantity({"retardation_time", "tau = eta / E of Kelvin-Voigt. Default: the material's.",
                    with(tissue::Viscosity::kelvin_voigt, "with `viscosity = \"kelvin_voigt\"`")},
                   tissue.retardation_time, unit::s, above(0));
  const Use solid = with(tissue::Viscosity::standard_linear_solid,
                         "with `viscosity = \"standard_linear_solid\"`");
  visitor.quantity({"relaxation_time", "tau at constant strain. Default: the material's.", solid},
                   tissue.relaxation_time, unit::s, above(0));
  visitor.number(
      {"instantaneous_ratio",
       "E_0 / E_inf, instantaneous over relaxed modulus. Default: the material's.", solid},
      tissue.instantaneous_ratio, at_least(1));
  visitor.tables(
      {"branch", "A branch of the Prony series; may be repeated.",
       with(tissue::Viscosity::prony, "with `viscosity = \"prony\"`")},
      static_cast<int>(tissue.branches.size()),
      [&](int size) { tissue.branches.resize(as_index(size)); },
      [&](FieldVisitor& inner, int i) {
        Branch& branch = tissue.branches[as_index(i)];
        inner.quantity({"relaxation_time", "At constant strain."}, branch.relaxation_time, unit::s,
                       above(0));
        inner.number({"ratio", "Its modulus over that of the relaxed tissue."}, branch.ratio,
                     above(0));
      });
  visitor.quantity({"drag", "d / m of eq. (10). Default: the material's.",
                    with(tissue::Viscosity::nodal_drag, "with `viscosity = \"nodal_drag\"`")},
                   tissue.drag, unit::per_second, at_least(0));
  visitor.choice_or(auto_bases, {"base", "How the base of the specimen is supported.", use.based},
                    tissue.base, bases);
  visitor.text(
      {"base_side",
       "The side of a body from a file that is fixed: a direction in its coordinates, as `up` of "
       "`tissue.shape`, or the name or number of a group of faces of a Gmsh or MEDIT file. "
       "`base_height` is then along the opposite direction. Default: the underside.",
       use.held},
      tissue.base_side);
  visitor.quantity_or(
      "auto",
      {"base_height",
       "The surface up to this height, in the coordinates of the body, is its base; `auto`: the "
       "underside where it is flat, else the lowest tenth of the specimen.",
       use.held},
      tissue.base_height, unit::mm, {});
}

}  // namespace

bool PlainScenario::uniform() const { return std::ranges::any_of(steps, loads_end_faces); }

bool Scenario::meshed() const {
  return solver.model ? traits(*solver.model).meshed()
                      : !std::holds_alternative<HalfSpace>(tissue.shape);
}

void fields(FieldVisitor& visitor, Scenario& scenario) {
  const Conditions use(scenario);
  visitor.count({"schema", "Version of this format."}, scenario.schema, between(1, 1));
  visitor.text({"title", "For figures and reports."}, scenario.title);
  visitor.table({"tissue", "The specimen."},
                [&](FieldVisitor& inner) { fields(inner, scenario.tissue, use); });
  visitor.tables(
      {"region", "Parts of the specimen with another material."},
      static_cast<int>(scenario.regions.size()),
      [&](int size) { scenario.regions.resize(as_index(size)); },
      [&](FieldVisitor& inner, int i) {
        Region& region = scenario.regions[as_index(i)];
        inner.alternatives(region.part,
                           [&](FieldVisitor& part) { substance_fields(part, region); });
      });
  visitor.table({"finger", "The spheres that press.", use.finger},
                [&](FieldVisitor& inner) { finger_fields(inner, scenario.finger); });
  visitor.table({"contact", "The contact law.", use.finger},
                [&](FieldVisitor& inner) { contact_fields(inner, scenario.contact, use); });
  visitor.table({"device", "A haptic device that would display the force.", use.finger},
                [&](FieldVisitor& inner) { device_fields(inner, scenario.device); });
  visitor.table({"solver", "Model, integrator and time step."},
                [&](FieldVisitor& inner) { solver_fields(inner, scenario.solver, use); });
  visitor.tables(
      {"step", "The loading history, in order."}, static_cast<int>(scenario.steps.size()),
      [&](int size) { scenario.steps.resize(as_index(size)); },
      [&](FieldVisitor& inner, int i) { inner.alternatives(scenario.steps[as_index(i)]); });
  visitor.table({"output", "What is written."},
                [&](FieldVisitor& inner) { output_fields(inner, scenario.output, use); });
}

namespace {

class Numbers final : public FieldVisitor {
 public:
  // Called with each key and a function that sets its value.
  using Each = std::function<void(NumericKey&&, const std::function<void(double)>&)>;
  explicit Numbers(Each each) : each_(std::move(each)) {}

  void real(const Key& key, std::optional<double>& value, const Real& kind) override {
    put(key, key.name, kind, [&](double si) { value = si; });
  }
  void either(const Key& key, Target& target, const Unit& first, const Unit& second,
              const Range& range) override {
    put(key, key.name, {target.second ? &second : &first, range},
        [&](double si) { target.value = si; });
  }
  void quantities(const Key& key, std::span<double> si, const Unit& unit,
                  const Range& range) override {
    for (std::size_t i = 0; i < si.size(); ++i)
      put(key, std::string(key.name) + "." + std::to_string(i + 1), {&unit, range},
          [&](double given) { si[i] = given; });
  }
  void whole(const Key&, std::optional<int>&, const Whole&) override {}
  void text(const Key&, std::string&) override {}
  void flag(const Key&, bool&) override {}
  void counts(const Key&, std::span<int>, const Range&) override {}
  void quantity_list(const Key&, std::vector<double>&, const Unit&, const Range&) override {}
  void numbers_by_name(const Key&, std::map<std::string, double>&, const Range&) override {}
  void choice_of(const Key&, int&, std::span<const Word>) override {}
  void table(const Key& key, const Fields& fields) override {
    inside(key.name, key.use, [&] { fields(*this); });
  }
  void tables(const Key& key, int size, const std::function<void(int)>&,
              const std::function<void(FieldVisitor&, int)>& fields) override {
    for (int i = 0; i < size; ++i)
      inside(std::string(key.name) + "." + std::to_string(i + 1), key.use,
             [&] { fields(*this, i); });
  }
  void kind(int chosen, std::span<const Word>, const std::function<Fields(int)>& choose) override {
    choose(chosen)(*this);
  }

 private:
  void put(const Key& key, const std::string& name, const Real& kind,
           const std::function<void(double)>& set) {
    const std::optional<Unit> unit =
        kind.unit != nullptr ? std::optional(*kind.unit) : std::nullopt;
    each_({prefix_ + name, unit, kind.range, outer_.used ? key.use : outer_}, set);
  }

  void inside(const std::string& name, const Use& use, const std::function<void()>& visit) {
    const std::string prefix = prefix_;
    const Use outer = outer_;
    prefix_ += name + ".";
    if (outer_.used) outer_ = use;
    visit();
    prefix_ = prefix;
    outer_ = outer;
  }

  Each each_;
  std::string prefix_;
  Use outer_;
};

}  // namespace

std::vector<NumericKey> numeric_keys(const Scenario& scenario) {
  std::vector<NumericKey> keys;
  Scenario copy = scenario;
  Numbers visitor([&](NumericKey&& key, const auto&) { keys.push_back(std::move(key)); });
  fields(visitor, copy);
  return keys;
}

bool set_number(Scenario& scenario, std::string_view path, double si) {
  bool found = false;
  Numbers visitor([&](NumericKey&& key, const auto& set) {
    if (key.path != path) return;
    set(si);
    found = true;
  });
  fields(visitor, scenario);
  return found;
}

}  // namespace palpate::scenario
