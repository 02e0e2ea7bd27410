// Checks that involve several keys at once.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/text.h"
#include "base/units.h"
#include "scenario/family.h"
#include "scenario/integrators.h"
#include "scenario/programme.h"

namespace palpate::scenario {
namespace {

using Integrator = Solver::Integrator;

class Checker {
 public:
  Checker(const Case& one, const Node& document, std::vector<Problem>& problems)
      : scenario_(one.scenario),
        poisson_ratio_(poisson_ratio(one)),
        document_(document),
        problems_(problems) {}

  void all() {
    const std::size_t before = problems_.size();
    steps();
    shapes();
    methods();
    forces_at();
    time_step();
    if (problems_.size() == before) rows();  // a wrong step also has a wrong duration
  }

 private:
  void problem(const std::string& path, const std::string& message) {
    problems_.push_back({place_of(document_, path), message});
  }

  void steps() {
    if (scenario_.steps.empty())
      return problem("step",
                     "a scenario needs something to do; add a `[[step]]`, as `kind = \"indent\"`");
    const bool uniform = loads_end_faces(scenario_.steps.front());
    const bool ellipsoid = std::holds_alternative<Ellipsoid>(scenario_.tissue.shape);
    if (uniform && (ellipsoid || std::holds_alternative<HalfSpace>(scenario_.tissue.shape)))
      problem("tissue.shape",
              std::string("`creep`, `relax` and `compress` need flat end faces, which ") +
                  (ellipsoid ? "an `ellipsoid`" : "a `half_space`") +
                  " does not have; use `cuboid`, `disc`, `cylinder`, `ligament`, `bone_shaft` or "
                  "`layered_limb`");
    const std::size_t before = problems_.size();
    Reached reached;
    for (std::size_t i = 0; i < scenario_.steps.size(); ++i) {
      const std::string path = "step." + std::to_string(i + 1);
      const Step& step = scenario_.steps[i];
      if (loads_end_faces(step) != uniform)
        return problem(path,
                       "`creep`, `relax` and `compress` load the end faces without a finger, the "
                       "other kinds of `step` have one; put them into two scenarios");
      if (const auto* compress = std::get_if<Compress>(&step))
        if (const auto wrong = compression_problem(scenario_, *compress))
          problem(path + ".kind", *wrong);
      if (const auto* indent = std::get_if<Indent>(&step))
        reached = indented(path + ".to", *indent, reached);
      if (const auto* retract = std::get_if<Retract>(&step))
        reached = retracted(path + ".to", *retract, reached);
      const auto* slide = std::get_if<Slide>(&step);
      if (slide != nullptr && slide->keep == Slide::Keep::force && reached.travel <= 0.0 &&
          reached.in_order)
        problem(path + ".keep",
                "`slide` has no force to keep, for the finger does not press yet; put an `indent` "
                "before it, or write `keep = \"displacement\"`");
    }
    const auto presses = [](const Step& step) { return std::holds_alternative<Indent>(step); };
    if (!uniform && problems_.size() == before && std::ranges::none_of(scenario_.steps, presses))
      problem("step.1",
              "no `step` presses the finger into the tissue; begin with `kind = \"indent\"`");
  }

  // The state that the previous steps have reached.
  struct Reached {
    double travel = 0.0;   // m; after a step to a force, the largest that is possible
    double force = 0.0;    // N, after a step to a force; 0 after other steps
    bool in_order = true;  // false after a step in the wrong direction, so that only it is reported
  };

  Reached indented(const std::string& path, const Indent& indent, Reached before) {
    const bool by_force = before.force > 0.0;
    if (indent.to.second) {
      if (by_force && indent.to.value <= before.force && before.in_order)
        before.in_order = out_of_order(
            path, "`indent` goes to " + quantity_text(indent.to.value, unit::N) +
                      ", which is not above the force of " + quantity_text(before.force, unit::N) +
                      " before it; use `retract` to go back");
      return {scenario_.finger.radius, indent.to.value, before.in_order};
    }
    const std::string to = quantity_text(indent.to.value, unit::mm);
    if (before.in_order && by_force)
      before.in_order = out_of_order(path, "`indent` goes to " + to +
                                               " after a step to a force, which may have gone "
                                               "deeper; give a force here too, or `retract` first");
    else if (before.in_order && indent.to.value <= before.travel)
      before.in_order = out_of_order(path, "`indent` goes to " + to +
                                               ", which is not below the displacement of " +
                                               quantity_text(before.travel, unit::mm) +
                                               " before it; use `retract` to go back");
    else
      too_deep(path, indent.to.value);
    return {indent.to.value, 0.0, before.in_order};
  }

  Reached retracted(const std::string& path, const Retract& retract, Reached before) {
    if (retract.to >= before.travel && before.in_order)
      before.in_order =
          out_of_order(path, "`retract` goes to " + quantity_text(retract.to, unit::mm) +
                                 ", which is not above the displacement of " +
                                 quantity_text(before.travel, unit::mm) +
                                 " before it; use `indent` to go deeper");
    return {retract.to, 0.0, before.in_order};
  }

  bool out_of_order(const std::string& path, const std::string& message) {
    problem(path, message);
    return false;
  }

  void too_deep(const std::string& path, double travel) {
    const double radius = scenario_.finger.radius;
    const std::string to = "`to` of " + quantity_text(travel, unit::mm);
    if (travel > radius)
      problem(path, to + " is deeper than the finger's radius of " +
                        quantity_text(radius, unit::mm) +
                        ", and a sphere presses with its lower half; press less deep, or give a "
                        "larger `finger.radius`");
    const auto* box = std::get_if<Cuboid>(&scenario_.tissue.shape);
    if (travel > radius || box == nullptr) return;
    constexpr double through = 0.9;
    if (const double height = box->size[2]; travel > through * height)
      problem(path, to +
                        (travel < height ? " takes more than " + percent_text(through) + " of"
                                         : std::string(" presses through")) +
                        " the specimen, which is " + quantity_text(height, unit::mm) +
                        " high; press less deep");
    else if (std::sqrt(radius * travel) > 0.5 * std::min(box->size[0], box->size[1]))
      problem(path, to + " makes a contact wider than the specimen's top; press less deep or use a "
                         "wider specimen");
  }

  // Which kinds of shape, mesh and model may be combined.
  void shapes() {
    const Tissue& tissue = scenario_.tissue;
    const bool lattice =
        std::holds_alternative<Kuhn>(tissue.mesh) || std::holds_alternative<Mirrored>(tissue.mesh);
    const bool meshed = scenario_.meshed();
    const bool box = std::holds_alternative<Cuboid>(tissue.shape);
    const bool half_space = std::holds_alternative<HalfSpace>(tissue.shape);
    const bool as_meshed = std::holds_alternative<AsMeshed>(tissue.shape);
    const bool ready = std::holds_alternative<MeshFile>(tissue.mesh);
    if (as_meshed && !ready)
      problem("tissue.shape",
              "`as_meshed` needs a ready mesh; set `tissue.mesh = { file = ..., unit = \"mm\" }`");
    if (meshed && half_space)
      problem("tissue.shape",
              "a `half_space` has no mesh; set `solver.model = \"hertz\"` or another shape");
    if (half_space && !scenario_.regions.empty())
      problem("region", "a `half_space` has no regions; use another `tissue.shape`");
    if (half_space) curved_half_space(std::get<HalfSpace>(tissue.shape));
    const bool takes_file = meshed || scenario_.solver.model == Model::solid;
    if (takes_file && ready && !half_space && !box && !as_meshed)
      problem("tissue.shape",
              "a ready mesh brings its own shape; remove `shape`, or mesh it with `tissue.mesh = { "
              "kind = \"tetgen\", nodes = 728 }`");
    if (meshed && !half_space && lattice && !box && !as_meshed)
      problem("tissue.mesh",
              "`kuhn` and `mirrored` cells fill a `cuboid` only; set `tissue.mesh = { kind = "
              "\"tetgen\", nodes = 728 }`");
    const bool inclusions = std::ranges::any_of(scenario_.regions, [](const Region& region) {
      return std::holds_alternative<Inclusion>(region.part);
    });
    if ((meshed || as_meshed) && inclusions && !std::holds_alternative<Tetgen>(tissue.mesh))
      problem("tissue.mesh",
              as_meshed
                  ? "a ready mesh takes no `sphere` region; give its cells a group in the file and "
                    "name it in a `tagged` region, or give the body's surface as `tissue.shape`"
                  : "a `sphere` region is meshed by TetGen only; set `tissue.mesh = { kind = "
                    "\"tetgen\", nodes = 1500 }`");
    slabs();
    directions();
    const auto* tetgen = std::get_if<Tetgen>(&tissue.mesh);
    if (tetgen != nullptr && tetgen->tetrahedra &&
        (box || tetgen->edge || std::holds_alternative<SurfaceFile>(tissue.shape)))
      problem("tissue.mesh.tetrahedra",
              "`tetrahedra` is a target besides `nodes`, for shapes other than `cuboid` and "
              "surface files; remove it");
    tags();
  }

  // The closed form is that of a single sphere on the top of a curved half-space.
  void curved_half_space(const HalfSpace& shape) {
    if (shape.curvature == 0.0 && shape.curvature_2.value_or(0.0) == 0.0) return;
    const auto wrong = [&](const std::string& path, const std::string& what,
                           const std::string& remedy) {
      problem(path, "there is no formula for " + what + " a curved `half_space`; " + remedy +
                        ", or use another `tissue.shape`, such as `ellipsoid`");
    };
    const Finger& finger = scenario_.finger;
    if (finger.spheres > 1) wrong("finger.spheres", "several spheres on", "set `spheres = 1`");
    if (finger.x || finger.y)
      wrong(finger.x ? "finger.x" : "finger.y", "a finger beside the top of", "remove `x` and `y`");
    for (std::size_t i = 0; i < scenario_.steps.size(); ++i)
      if (std::holds_alternative<Slide>(scenario_.steps[i]))
        wrong("step." + std::to_string(i + 1), "a `slide` over", "remove it");
  }

  // How a body from a file stands, and from where it is pressed.
  void directions() {
    const auto asked = [&](const std::string& path, const std::string& text) {
      if (!text.empty() && !direction_of(text))
        problem(path, "`" + path.substr(path.rfind('.') + 1) + "` wants a direction, got `" + text +
                          "`; write it as `y`, `-x` or `0 0.2 1`");
    };
    const auto* surface = std::get_if<SurfaceFile>(&scenario_.tissue.shape);
    const auto* meshed = std::get_if<AsMeshed>(&scenario_.tissue.shape);
    const Finger& finger = scenario_.finger;
    const std::string up = surface != nullptr ? surface->up : meshed != nullptr ? meshed->up : "z";
    if (up.empty()) problem("tissue.shape.up", "`up` is empty; write it as `z`");
    asked("tissue.shape.up", up);
    asked("finger.towards", finger.towards);
    if (!finger.at.empty() && finger.at.size() != 3)
      problem("finger.at", "`at` wants three lengths, got " + std::to_string(finger.at.size()) +
                               "; write it as `[\"1 mm\", \"2 mm\", \"3 mm\"]`");
    const char* aside = !finger.at.empty()                    ? "finger.at"
                        : !finger.towards.empty()             ? "finger.towards"
                        : !scenario_.tissue.base_side.empty() ? "tissue.base_side"
                                                              : nullptr;
    if (aside != nullptr && surface == nullptr && meshed == nullptr)
      return problem(aside,
                     "`" + std::string(aside) +
                         "` is for bodies from files; give the body as a file, or leave it out");
    const bool turned = aside != nullptr || up != "z";
    if (turned && (finger.x || finger.y))
      problem(finger.x ? "finger.x" : "finger.y",
              "`x` and `y` are for a finger that comes along -z; give the place as `finger.at`");
    if (aside == nullptr) return;
    if (scenario_.tissue.base == tissue::Base::frictionless)
      problem(
          "tissue.base",
          "a body that is pressed from its side needs a bonded base; write `base = \"bonded\"`");
    for (std::size_t i = 0; i < scenario_.regions.size(); ++i)
      if (std::holds_alternative<Slab>(scenario_.regions[i].part))
        problem("region." + std::to_string(i + 1),
                "a `slab` is for a finger that comes from above; use a `tagged` region of a mesh, "
                "or remove `" +
                    std::string(aside) + "`");
  }

  // Slabs of a cuboid must lie below its top; they must not overlap.
  void slabs() {
    const auto* box = std::get_if<Cuboid>(&scenario_.tissue.shape);
    std::map<double, double> taken;  // bottoms and tops
    for (std::size_t i = 0; i < scenario_.regions.size(); ++i) {
      const auto* slab = std::get_if<Slab>(&scenario_.regions[i].part);
      if (slab == nullptr) continue;
      const std::string path = "region." + std::to_string(i + 1);
      if (slab->top <= slab->bottom)
        problem(path + ".top", "`top` is not above `bottom`; exchange the two");
      else if (box != nullptr && slab->top >= box->size[2])
        problem(path + ".top",
                "`top` reaches the cuboid's top, which the finger presses; make that layer the "
                "`tissue` and what lies below it a `slab`");
      for (const auto& [bottom, top] : taken)
        if (slab->bottom < top && bottom < slab->top)
          problem(path + ".bottom", "another `slab` lies there too; give them different heights");
      taken.emplace(slab->bottom, slab->top);
    }
  }

  void tags() {
    std::set<int> known;
    for (std::size_t i = 0; i < scenario_.regions.size(); ++i) {
      const auto* tagged = std::get_if<TaggedRegion>(&scenario_.regions[i].part);
      if (tagged != nullptr && tagged->name.empty() && !known.insert(tagged->tag).second)
        problem("region." + std::to_string(i + 1) + ".tag", "another `[[region]]` has `tag` " +
                                                                std::to_string(tagged->tag) +
                                                                " too; keep one of the two");
    }
  }

  void methods() {
    const Solver& solver = scenario_.solver;
    const ModelTraits* const given = solver.model ? &traits(*solver.model) : nullptr;
    if (given != nullptr && !given->uniform && scenario_.uniform())
      problem("solver.model", "`" + std::string(given->word) +
                                  "` has no specimen between platens; set " +
                                  models_that(std::mem_fn(&ModelTraits::uniform)));
    viscosity();
    if (scenario_.contact.depth == Contact::Depth::neo_hookean && !scenario_.uniform() &&
        contact::mesh_is_tissue(scenario_.contact.coupling))
      problem("contact.depth",
              "with this `coupling` the mesh is the tissue, and the factor is that of a contact "
              "law; write `coupling = \"consistent\"`, or `depth = \"hertz\"`");
    if (given != nullptr && given->solid && !scenario_.uniform()) solid();
    if (!scenario_.meshed()) return;
    if (given != nullptr) springs(*given);
    if (scenario_.contact.coupling == contact::Coupling::resolved && solver.integrator &&
        (about(*solver.integrator).explicit_steps || solver.integrator == Integrator::modal))
      problem("solver.integrator",
              "`resolved` solves for forces and motion together, which an explicit method cannot "
              "do, and in `modal` steps they oscillate; set `integrator` to `quasi_static`, "
              "`backward_difference` or `tr_bdf2`");
    if (scenario_.contact.spread == Contact::Spread::nearest_node && !scenario_.uniform() &&
        !contact::presses_one_node(scenario_.contact.coupling))
      problem("contact.spread",
              "`nearest_node` is for `one_way` and `series`; write `spread = \"pressure\"`");
    if (solver.integrator == Integrator::modal &&
        solver.kinematics == Solver::Kinematics::nonlinear)
      problem("solver.kinematics",
              "`modal` solves linear bodies only; set `solver.kinematics = \"linear\"` or another "
              "integrator");
    if (solver.integrator == Integrator::quasi_static &&
        scenario_.tissue.viscosity == tissue::Viscosity::nodal_drag)
      problem("solver.integrator",
              "`quasi_static` has no nodal drag; set `solver.integrator = \"backward_difference\"` "
              "or another viscosity");
  }

  // Checks a model with a mesh that the scenario names.
  void springs(const ModelTraits& model) {
    const Solver& solver = scenario_.solver;
    const bool volume = solver.volume.value_or(Solver::Volume::none) != Solver::Volume::none;
    const std::string coupled = models_that(std::mem_fn(&ModelTraits::coupled));
    const std::string independent = models_that(std::mem_fn(&ModelTraits::independent));
    if (model.independent() && volume && poisson_ratio_ < 0.2)
      problem("solver.volume",
              "below a Poisson's ratio of 0.2 independent springs, which have 1/4, would need a "
              "volume term of negative stiffness; set `volume = \"none\"` or " +
                  coupled);
    for (std::size_t i = 0; model.independent() && !volume && i < scenario_.regions.size(); ++i) {
      const std::string path = "region." + std::to_string(i + 1) + ".poisson_ratio";
      if (given(path))
        problem(path,
                "independent springs have a Poisson's ratio of their own; set `solver.volume = "
                "\"nodal\"` or " +
                    coupled + ", or leave it out");
    }
    if (model.coupled() && solver.volume == Solver::Volume::none)
      problem("solver.volume",
              "`" + std::string(model.word) +
                  "` always resist a change of volume; set `solver.volume = \"nodal\"`, or " +
                  independent);
  }

  // Checks what `solid` does not know: it is at rest, and without friction.
  void solid() {
    if (scenario_.contact.coupling != contact::Coupling::consistent)
      problem("contact.coupling",
              "`solid` carries contact and tissue in one mesh; leave `coupling` out");
    for (std::size_t i = 0; i < scenario_.steps.size(); ++i) {
      const auto* slide = std::get_if<Slide>(&scenario_.steps[i]);
      if (slide == nullptr) continue;
      const std::string meshed = models_that(std::mem_fn(&ModelTraits::meshed));
      if (slide->keep == Slide::Keep::force)
        problem("step." + std::to_string(i + 1) + ".keep",
                "`solid` slides at a depth; write `keep = \"displacement\"`, or set " + meshed);
      if (scenario_.contact.friction > 0.0)
        problem("contact.friction",
                "`solid` slides without friction; leave `friction` out, or set " + meshed);
    }
  }

  // Whether the scenario itself contains a dotted path.
  [[nodiscard]] bool given(const std::string& path) const {
    const Place here = place_of(document_, path);
    const Place around = place_of(document_, path.substr(0, path.rfind('.')));
    return here.line != around.line || here.column != around.column;
  }

  void viscosity() {
    using tissue::Viscosity;
    const Tissue& tissue = scenario_.tissue;
    if (tissue.viscosity == Viscosity::prony && tissue.branches.empty())
      problem(
          "tissue.viscosity",
          "`prony` needs branches; add a `[[tissue.branch]]` with `relaxation_time` and `ratio`");
    if (scenario_.contact.viscosity != Contact::Viscosity::tissue || scenario_.uniform()) return;
    if (tissue.viscosity == Viscosity::none || tissue.viscosity == Viscosity::nodal_drag)
      problem("contact.viscosity",
              std::string("a contact can include the viscosity of a material only, and "
                          "`tissue.viscosity` is `") +
                  (tissue.viscosity == Viscosity::none ? "none" : "nodal_drag") +
                  "`; set it to `kelvin_voigt`, `standard_linear_solid` or `prony`");
    if (scenario_.meshed() && contact::mesh_is_tissue(scenario_.contact.coupling))
      problem("contact.viscosity",
              "with this `coupling` the mesh carries the tissue's viscosity to the contact "
              "already; write `viscosity = \"none\"`");
    for (std::size_t i = 0; i < scenario_.steps.size(); ++i) {
      const auto* slide = std::get_if<Slide>(&scenario_.steps[i]);
      if (slide != nullptr && slide->keep == Slide::Keep::force)
        problem("step." + std::to_string(i + 1) + ".keep",
                "a slide cannot keep a force that relaxes; write `keep = \"displacement\"`, or "
                "`contact.viscosity = \"none\"`");
    }
  }

  void forces_at() {
    const std::vector<double>& depths = scenario_.output.force_at;
    for (std::size_t i = 1; i < depths.size(); ++i)
      if (std::find(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(i), depths[i]) !=
          depths.begin() + static_cast<std::ptrdiff_t>(i))
        return problem("output.force_at",
                       "`force_at` has " + quantity_text(depths[i], unit::mm) + " twice; keep one");
  }

  void time_step() {
    if (!scenario_.meshed()) return;  // the key is not read
    const Output& output = scenario_.output;
    const double step = scenario_.solver.time_step.value_or(output.interval);
    const double ratio = output.interval / step;
    if (ratio > 1e6)
      problem(
          "solver.time_step",
          "`time_step` is " + quantity_text(step, unit::ms) +
              ", more than a million times shorter than `output.interval`; choose a longer one");
    else if (ratio < 0.5 || std::abs(ratio - std::round(ratio)) > 1e-6 * ratio)
      problem("solver.time_step",
              "`time_step` is " + quantity_text(step, unit::ms) +
                  ", which does not fit a whole number of times into `output.interval` of " +
                  quantity_text(output.interval, unit::ms) +
                  "; write `time_step = \"auto\"` or a whole part of the interval");
  }

  void rows() {
    const Output& output = scenario_.output;
    const double total = programme_time(scenario_);
    if (total / output.interval > 1e6)
      problem("output.interval", "`output.interval` of " +
                                     quantity_text(output.interval, unit::ms) + " would write " +
                                     rounded_text(total / output.interval) +
                                     " rows a case, and a million is the most; use a longer one");
  }

  const Scenario& scenario_;
  double poisson_ratio_;  // of the tissue
  const Node& document_;
  std::vector<Problem>& problems_;
};

}  // namespace

void check(const Case& one, const Node& document, std::vector<Problem>& problems) {
  Checker(one, document, problems).all();
}

}  // namespace palpate::scenario
