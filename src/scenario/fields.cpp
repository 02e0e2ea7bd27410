// All keys of a scenario, each listed once.
#include <algorithm>
#include <array>

#include "scenario/field_tables.h"
#include "scenario/words.h"

namespace palpate::scenario {
namespace {

using namespace words;

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
static void fields(FieldVisitor& visitor, HalfSpace& shape) {
  visitor.quantity({"curvature", "Of the surface, convex positive; 0 is a flat."}, shape.curvature,
                   unit::per_metre, {});
  visitor.quantity({"curvature_2", "Across the first. Default: the same."}, shape.curvature_2,
                   unit::per_metre, {});
}
static void fields(FieldVisitor& visitor, SurfaceFile& shape) {
  visitor.text({"file", "Path of the surface, from the scenario's folder."}, shape.file);
  visitor.text({"unit", "The length unit of its coordinates, such as `mm`. Required."}, shape.unit);
}
static void fields(FieldVisitor&, AsMeshed&) {}

static void grading(FieldVisitor& visitor, double& ratio) {
  visitor.number({"grading",
                  "Size of the largest cells, at the far ends, over that of the smallest, "
                  "under the finger; 1: all equal."},
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
  visitor.text({"file", "Path of the .node or .msh file, from the scenario's folder."}, mesh.file);
  visitor.text({"unit", "The length unit of its coordinates, such as `mm`. Required."}, mesh.unit);
  refinement(visitor, mesh);
}

static void fields(FieldVisitor& visitor, Indent& step) {
  visitor.either({"to", "Travel below the undeformed surface, or contact force, to reach."},
                 step.to, unit::mm, unit::N, above(0));
  visitor.quantity({"rate", "Speed of the finger."}, step.rate, unit::mm_per_s, above(0));
}
static void fields(FieldVisitor& visitor, Hold& step) {
  visitor.quantity({"time", "How long."}, step.time, unit::s, above(0));
}
static void fields(FieldVisitor& visitor, Retract& step) {
  visitor.quantity({"to", "Travel to go back to; negative is above the surface."}, step.to,
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
  visitor.count({"tag", "The number of the region in the shape or in the mesh file."}, region.tag,
                between(0, 1e9));
}
static void fields(FieldVisitor& visitor, Lump& region) {
  visitor.quantities(
      {"centre", "In the specimen's coordinates, from the lowest corner of its bounding box."},
      region.centre, unit::mm, {});
  visitor.quantity({"radius", "Of the lump."}, region.radius, unit::mm, above(0));
}
static void fields(FieldVisitor& visitor, Slab& region) {
  visitor.quantity({"bottom", "Height where it begins."}, region.bottom, unit::mm, at_least(0));
  visitor.quantity({"top", "Height where it ends; the top of the body is `tissue`."}, region.top,
                   unit::mm, above(0));
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
                "A tissue of materials/chen2007.toml (skin, muscle, bone, ligament, upper_leg), "
                "or `file.toml#name` of your own."},
               tissue.material);
  visitor.table({"shape", "The specimen's shape."},
                [&](FieldVisitor& inner) { inner.alternatives(tissue.shape); });
  visitor.table({"mesh", "How the shape is cut into tetrahedra.", use.mesh},
                [&](FieldVisitor& inner) { inner.alternatives(tissue.mesh); });
  visitor.quantity({"young_modulus", "Of the relaxed tissue. Default: the material's."},
                   tissue.young_modulus, unit::kPa, above(0));
  visitor.number(
      {"poisson_ratio",
       "Default: the material's. With `mass_spring` it affects the contact and the volume "
       "term only: independent springs have a ratio of their own, near 1/4."},
      tissue.poisson_ratio,
      {.low = -1,
       .high = 0.5,
       .low_allowed = false,
       .high_allowed = false,
       .remedy = "for a tissue that keeps its volume give 0.49, which lowers the force by 1.3 % on "
                 "deep tissue and by more on a thin layer"});
  visitor.quantity({"density", "Default: the material's.", use.mesh_physics}, tissue.density,
                   unit::density, above(0));
  visitor.choice({"viscosity", "The viscous law of the tissue."}, tissue.viscosity, viscosities);
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
  visitor.quantity_or("auto",
                      {"base_height",
                       "The skin up to this height is its base; `auto`: the underside where it is "
                       "flat, else the lowest tenth of the specimen.",
                       use.mesh.used ? use.finger : use.mesh},
                      tissue.base_height, unit::mm, at_least(0));
}

}  // namespace

bool PlainScenario::uniform() const {
  return std::any_of(steps.begin(), steps.end(), loads_end_faces);
}

bool Scenario::meshed() const {
  return solver.model ? rung(*solver.model).meshed()
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
      {"step", "The loading programme, in order."}, static_cast<int>(scenario.steps.size()),
      [&](int size) { scenario.steps.resize(as_index(size)); },
      [&](FieldVisitor& inner, int i) { inner.alternatives(scenario.steps[as_index(i)]); });
  visitor.table({"output", "What is written."},
                [&](FieldVisitor& inner) { output_fields(inner, scenario.output, use); });
}

}  // namespace palpate::scenario
