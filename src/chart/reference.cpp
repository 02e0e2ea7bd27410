// Presses a scenario at rest with `solid`, and in motion with coupled springs, on several meshes.
#include "chart/reference.h"

#include <algorithm>
#include <cmath>

#include "base/doing.h"
#include "base/error.h"
#include "base/stop_scope.h"
#include "base/text.h"
#include "base/units.h"
#include "chart/truth.h"
#include "run/choose.h"
#include "run/family.h"
#include "run/refined_mesh.h"
#include "scenario/integrators.h"
#include "scenario/programme.h"
#include "scene/estimates.h"
#include "scene/specimen_mesh.h"

namespace palpate::chart {
namespace {

using Coupling = contact::Coupling;
using Integrator = scenario::Solver::Integrator;
using scenario::Scenario;

constexpr int levels = 3;
constexpr int coarsest = 4;            // cells per contact radius under the finger, first level
constexpr double first_nodes = 700.0;  // first level of a moving body if contact is not resolved
constexpr double tolerance_of_solid = 0.005;   // asks for all of its meshes
constexpr double tolerance_of_surface = 0.01;  // asks for two

// The part of a symmetric body that is computed: all, the half y > 0 or the quarter x, y > 0.
enum class Part { whole, half, quarter };

int copies(Part part) { return part == Part::quarter ? 4 : part == Part::half ? 2 : 1; }

bool in_the_middle(const std::optional<double>& place, double size) {
  return !place || std::abs(*place - 0.5 * size) <= 1e-9 * size;
}

// Slides along x keep the symmetry about the plane y = 0 only.
Part part_of(const Scenario& scenario, const scenario::Cuboid& box) {
  bool slides = false;
  for (const scenario::Step& step : scenario.steps)
    if (const auto* slide = std::get_if<scenario::Slide>(&step)) {
      slides = true;
      if (std::remainder(slide->direction, 180.0) != 0.0) return Part::whole;
    }
  if (!in_the_middle(scenario.finger.y, box.size[1])) return Part::whole;
  return slides || !in_the_middle(scenario.finger.x, box.size[0]) ? Part::half : Part::quarter;
}

[[noreturn]] void refuse_at(const scenario::Family& family, const std::string& key,
                            const std::string& sentence) {
  throw InputError(place_of(family.document, key), sentence);
}

void refuse_unless_refined(const scenario::Family& family, const Scenario& scenario) {
  if (scenario.uniform())
    refuse_at(family, "step",
              "`palpate reference` refines a press; the reference of a test between platens, with "
              "its error, is told by `palpate chart`");
  if (std::holds_alternative<scenario::HalfSpace>(scenario.tissue.shape))
    refuse_at(family, "tissue.shape",
              "a `half_space` has no mesh to refine; on it `hertz` is exact for small depths");
}

void refuse_slides_at_a_force(const scenario::Family& family, const Scenario& scenario) {
  for (std::size_t i = 0; i < scenario.steps.size(); ++i)
    if (const auto* slide = std::get_if<scenario::Slide>(&scenario.steps[i]);
        slide != nullptr && slide->keep == scenario::Slide::Keep::force)
      refuse_at(family, "step." + std::to_string(i + 1) + ".keep",
                "the reference slides at a depth; write `keep = \"displacement\"`");
}

// What inertia adds to the force, with its error, at the moments of the rows; nothing where coupled
// springs cannot be refined, or end elsewhere than the reference.
std::optional<History> added_by_inertia(const Asked& asked, std::size_t of_case, bool flows,
                                        double interval, const std::vector<ReferenceRow>& rows) {
  const Scenario& scenario = asked.family.cases[of_case].scenario;
  if (flows || rows.empty() || rows.back().slide != 0.0) return std::nullopt;
  if (mesh_setting(scenario, 1.0).empty()) return std::nullopt;
  const auto run = [&](double factor, const char* integrator) {
    std::vector<std::string> settings{model_setting(scenario::strongest.of),
                                      "contact.coupling=consistent",
                                      "tissue.viscosity=none",
                                      std::string("solver.integrator=") + integrator,
                                      "output.interval=" + number_text(1e3 * interval) + " ms",
                                      mesh_setting(scenario, factor)};
    if (scenario::resolve(asked.family.cases[of_case], scenario::Model::solid).finger.replaced > 0)
      settings.emplace_back("finger.spheres=1");
    return run_with(asked, of_case, settings).moments;
  };
  const auto on = [&](double factor) {
    History added = run(factor, "modal");
    const History still = run(factor, "quasi_static");
    for (std::size_t i = 0; i < std::min(added.size(), still.size()); ++i)
      added[i].value -= still[i].value;
    return added;
  };
  set_doing({"effect of inertia"});
  try {
    const History own = on(1.0);
    History finer = on(4.0);
    if (own.size() != rows.size() || finer.size() != rows.size()) return std::nullopt;
    for (std::size_t i = 0; i < rows.size(); ++i)
      finer[i].error = std::abs(finer[i].value - own[i].value);
    return finer;
  } catch (const InputError&) {
  } catch (const MeshError&) {
  }
  return std::nullopt;
}

// Adds the effect of inertia, or its estimate to the error; says which.
std::string add_inertia(const std::optional<History>& added, double estimated,
                        std::vector<ReferenceRow>& rows) {
  double most = 0.0;
  double peak = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double still = rows[i].force;
    peak = std::max(peak, std::abs(still));
    rows[i].error += added ? (*added)[i].error : estimated * std::abs(still);
    if (!added) continue;
    rows[i].force += (*added)[i].value;
    most = std::max(most, std::abs((*added)[i].value));
  }
  if (!added) return "without inertia, whose estimated effect is " + percent_text(estimated);
  return "and what inertia adds to coupled springs, " + percent_text(peak > 0.0 ? most / peak : 0);
}

// A press that moves, on meshes of coupled springs.
class Refinement {
 public:
  Refinement(const scenario::Case& one, const scenario::Family& family, const scene::Choice& choice)
      : family_(family), case_(one), given_(choice.chosen), found_(choice.expected) {
    if (std::holds_alternative<scenario::MeshFile>(case_.scenario.tissue.mesh))
      refuse_at(family, "tissue.mesh",
                "a ready mesh is not refined where inertia matters; give the shape, and let "
                "`palpate` mesh it");
    refuse_forces(family, "a step to a force ends elsewhere on every mesh; give a displacement");
    const auto* box = std::get_if<scenario::Cuboid>(&case_.scenario.tissue.shape);
    resolved_ =
        box != nullptr && case_.scenario.regions.empty() && case_.scenario.finger.spheres == 1;
    strengthen();
    if (resolved_) cut(std::get<scenario::Cuboid>(case_.scenario.tissue.shape));
  }

  // The scene of a level, counted from 0.
  scene::Scene build(int level) {
    scenario::Case one = case_;
    mesh(one.scenario, level);
    shorten_steps(one.scenario, level);
    scene::Scene scene = run::build_scene(one, family_);
    if (part_ != Part::whole) hold_mirrors(*scene.specimen);
    return scene;
  }

  // The cells' size over the deepest contact radius or, without `resolved`, over the first level's.
  [[nodiscard]] double spacing(int level) const {
    return resolved_ ? 1.0 / (coarsest + level)
                     : static_cast<double>(coarsest) / (coarsest + level);
  }
  [[nodiscard]] bool resolved() const { return resolved_; }
  [[nodiscard]] Part part() const { return part_; }
  [[nodiscard]] const scene::Estimates& estimates() const { return found_; }

 private:
  void strengthen() {
    Scenario& scenario = case_.scenario;
    scenario::Solver& solver = scenario.solver;
    // A contact without viscosity gives the force of the relaxed tissue. In the couplings of the
    // reference the mesh's viscosity would change it.
    if (scenario.contact.viscosity == scenario::Contact::Viscosity::none &&
        !contact::mesh_is_tissue(scenario.contact.coupling))
      scenario.tissue.viscosity = tissue::Viscosity::none;
    solver.model = scenario::strongest.of;
    solver.volume = scenario::Solver::Volume::nodal;
    solver.integrator = Integrator::backward_difference;
    solver.time_step.reset();
    solver.substeps.reset();
    solver.rings.reset();
    scenario.contact.coupling = resolved_ ? Coupling::resolved : Coupling::consistent;
    scenario.contact.depth = given_.contact.depth;
    if (resolved_) {
      scenario.contact.viscosity = scenario::Contact::Viscosity::none;
      scenario.contact.depth = scenario::Contact::Depth::hertz;
    }
    scenario.output.keep_rows_only();
  }

  void cut(scenario::Cuboid& box) {
    part_ = part_of(case_.scenario, box);
    scenario::Finger& finger = case_.scenario.finger;
    if (part_ == Part::whole) return;
    box.size[1] *= 0.5;
    finger.y = 0.0;
    if (part_ == Part::half) return;
    box.size[0] *= 0.5;
    finger.x = 0.0;
  }

  void mesh(Scenario& scenario, int level) const {
    const double finer = static_cast<double>(coarsest + level) / coarsest;
    const auto* box = std::get_if<scenario::Cuboid>(&scenario.tissue.shape);
    if (resolved_) {
      scenario.tissue.mesh = graded(*box, level);
    } else if (box != nullptr && scenario.regions.empty()) {
      const double cell = std::cbrt(box->size[0] * box->size[1] * box->size[2] / first_nodes);
      scenario::Mirrored cells;
      for (std::size_t axis = 0; axis < 3; ++axis)
        cells.cells[axis] =
            std::max(2, static_cast<int>(std::lround(box->size[axis] / cell * finer)));
      scenario.tissue.mesh = cells;
    } else {
      scenario::Tetgen cells;
      cells.nodes = static_cast<int>(first_nodes * finer * finer * finer);
      scenario.tissue.mesh = cells;
    }
  }

  // Cells of at most 1 / (coarsest + level) contact radii a under the finger, growing with the
  // distance d as sqrt(1 + (d/a)^2): a length L takes asinh(L/a) (coarsest + level) cells.
  [[nodiscard]] scenario::Mirrored graded(const scenario::Cuboid& box, int level) const {
    const Vec3 size(box.size[0], box.size[1], box.size[2]);
    const Vec3 place(case_.scenario.finger.x.value_or(0.5 * size.x()),
                     case_.scenario.finger.y.value_or(0.5 * size.y()), size.z());
    const double radius = found_.contact_radius;
    scenario::Mirrored mesh;
    double farthest = 0.0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      int units = 0;
      for (const double length : {place[axis], size[axis] - place[axis]}) {
        units += static_cast<int>(std::ceil(std::asinh(length / radius)));
        farthest = std::max(farthest, length);
      }
      mesh.cells[as_index(axis)] = units * (coarsest + level);
    }
    mesh.grading = std::sqrt(1.0 + farthest * farthest / (radius * radius));
    return mesh;
  }

  // Substeps in which a pressure wave crosses at most half a cell under the finger.
  void shorten_steps(Scenario& scenario, int level) const {
    const scenario::Resolved::Tissue& tissue = given_.tissue;
    const double nu = tissue.poisson_ratio;
    const double speed = std::sqrt(tissue.young_modulus * (1.0 - nu) /
                                   ((1.0 + nu) * (1.0 - 2.0 * nu) * tissue.density));
    const double cell = found_.contact_radius / (coarsest + level);
    scenario.solver.substeps =
        static_cast<int>(std::max(1.0, std::ceil(2.0 * scenario.output.interval * speed / cell)));
  }

  void hold_mirrors(scene::Specimen& specimen) const {
    for (std::size_t n = 0; n < specimen.mesh.nodes.size(); ++n) {
      if (specimen.mesh.nodes[n].y() == 0.0) specimen.held[3 * n + 1] = 1;
      if (part_ == Part::quarter && specimen.mesh.nodes[n].x() == 0.0) specimen.held[3 * n] = 1;
    }
  }

  const scenario::Family& family_;
  scenario::Case case_;       // changed for the refinement
  scenario::Resolved given_;  // the original scenario
  scene::Estimates found_;
  bool resolved_ = false;
  Part part_ = Part::whole;
};

// The scene of a press at rest by `solid`, which says as much as `tolerance` asks for.
scene::Scene solid_scene(scenario::Case one, const scenario::Family& family, double tolerance) {
  Scenario& scenario = one.scenario;
  if (!scenario::viscous_contact(scenario))
    scenario.contact.viscosity = scenario::Contact::Viscosity::none;
  scenario.contact.depth.reset();
  scenario.solver = {};
  scenario.solver.model = scenario::Model::solid;
  scenario.solver.tolerance = tolerance;
  scenario.output.keep_rows_only();
  return run::build_scene(one, family);
}

void warn_of_error(Reference& reference) {
  if (reference.rows.empty()) return;
  const auto worst = std::ranges::max_element(reference.rows, {}, &ReferenceRow::force);
  if (!(worst->force > 0.0)) return;
  reference.warnings.push_back("further refinement may change the greatest force, " +
                               rounded_text(worst->force) + " N, by " +
                               percent_text(worst->error / worst->force));
}

void say_how(const Refinement& refinement, Reference& reference) {
  std::string how = refinement.resolved() ? "coupled springs, contact resolved node by node"
                                          : "coupled springs with `consistent` contact";
  if (refinement.part() != Part::whole)
    how += refinement.part() == Part::quarter ? ", on a quarter of the body, by symmetry"
                                              : ", on half of the body, by symmetry";
  how += ", backward differences with steps proportional to the cells";
  reference.warnings.push_back(how);
  warn_of_error(reference);
}

// A press that moves.
Reference in_motion(const scenario::Case& one, const scenario::Family& family,
                    const scene::Choice& choice) {
  Refinement refinement(one, family, choice);
  Reference reference;
  reference.moves = true;
  std::vector<double> spacings;
  const double factor = copies(refinement.part());
  for (int level = 0; level < levels; ++level) {
    const scene::Scene scene = refinement.build(level);
    set_doing({"level " + std::to_string(level + 1) + " of " + std::to_string(levels) + ": " +
               std::to_string(scene.specimen->network.nodes()) + " nodes"});
    const record::CaseRecord record = run::run_case(scene);
    if (record.outcome != record::Outcome::completed) {
      reference.diverged = "level " + std::to_string(level + 1) + ": " + record.reason;
      return reference;
    }
    spacings.push_back(refinement.spacing(level));
    if (level == 0)
      for (const record::ContactRow& row : record.contact)
        reference.rows.push_back(
            {.step = row.step, .time = row.time, .travel = row.travel, .slide = row.slide});
    for (std::size_t i = 0; i < std::min(record.contact.size(), reference.rows.size()); ++i)
      reference.rows[i].forces.push_back(factor * record.contact[i].contact_force);
  }
  for (ReferenceRow& row : reference.rows) {
    const Extrapolated found = extrapolate(spacings, row.forces);
    row.force = found.value;
    // Linear elasticity does not know what large strains change, which grows with the depth.
    const double deep = refinement.estimates().deep_bound * std::max(0.0, row.travel) /
                        refinement.estimates().travel;
    row.error = found.error + deep * std::abs(found.value);
    row.order = found.order;
  }
  say_how(refinement, reference);
  return reference;
}

}  // namespace

Ran run_with(const Asked& asked, std::size_t of_case, const std::vector<std::string>& settings) {
  const auto family = with_settings(asked, of_case, settings);
  scene::Scene scene = run::build_scene(family.cases.front(), family);
  scene.scenario.output.keep_rows_only();
  const record::CaseRecord record = run::run_case(scene);
  StopScope::end_if_stopped();
  if (record.outcome == record::Outcome::diverged)
    throw MeshError("the reference of case " + family.cases.front().name +
                    " diverged: " + record.reason);
  return {history(scene.scenario, record), scene.specimen ? scene.specimen->network.nodes() : 0};
}

Reference refer(const Asked& asked, std::size_t of_case, const MostRows& most) {
  refuse_unless_refined(asked.family, asked.family.cases[of_case].scenario);
  // `consistent` decides whether the force is viscous, because with other couplings the viscosity
  // belongs to the mesh.
  const auto family = with_settings(asked, of_case, {"contact.coupling=consistent"});
  scenario::Case one = family.cases.front();
  Scenario& scenario = one.scenario;
  const scene::Choice choice = run::choose(one);
  const double inertia = choice.expected.inertia;
  const double tolerance = scenario.solver.tolerance;
  const bool flows = scenario::viscous_contact(scenario);
  // Waves at the contact need its cells in motion. A swing of the whole body is added to the
  // solid's force, which coupled springs have less exactly.
  const bool moves = scenario.solver.integrator ? about(*scenario.solver.integrator).inertia
                                                : inertia - choice.expected.swing >= tolerance;
  double& interval = scenario.output.interval;
  // The rows of an elastic press at rest do not depend on the rows between them.
  const double rows = flows || moves ? most.in_time : most.still;
  interval *= std::max(1.0, std::ceil(scenario::programme_time(scenario) / (rows * interval)));
  scenario.contact.direction = asked.family.cases[of_case].scenario.contact.direction;
  if (moves) return in_motion(one, family, choice);
  refuse_slides_at_a_force(family, scenario);
  set_doing({"the solid on three meshes"});
  const scene::Scene scene = solid_scene(one, family, tolerance_of_solid);
  const record::CaseRecord record = run::run_case(scene);
  Reference reference;
  if (record.outcome != record::Outcome::completed) {
    reference.diverged = record.reason;
    return reference;
  }
  for (const record::ContactRow& row : record.contact)
    reference.rows.push_back({.step = row.step,
                              .time = row.time,
                              .travel = row.travel,
                              .slide = row.slide,
                              .force = row.contact_force,
                              .error = row.mesh_error * row.contact_force});
  reference.how =
      flows ? "viscosity by the contact's law of time" : "the force of the relaxed tissue";
  if (inertia > 0.1 * tolerance)
    reference.how +=
        ", " + add_inertia(added_by_inertia(asked, of_case, flows, interval, reference.rows),
                           inertia, reference.rows);
  else
    reference.how += ", without inertia, whose estimated effect is " + percent_text(inertia);
  reference.warnings.push_back("`solid` on three meshes, extrapolated; " + reference.how);
  if (scene.scenario.finger.replaced > 0)
    reference.warnings.emplace_back(
        "spheres by `calibration = \"force\"` stand for one, which is pressed");
  warn_of_error(reference);
  return reference;
}

run::SurfaceReference refer_surface(const Asked& asked, std::size_t of_case) {
  const scenario::Case& one = asked.family.cases[of_case];
  const bool moves = run::choose(one).expected.inertia >= one.scenario.solver.tolerance;
  const auto* flat = std::get_if<scenario::HalfSpace>(&one.scenario.tissue.shape);
  if (one.scenario.uniform() || flat != nullptr || moves) return {};
  try {
    return run::displaced_by_solid(solid_scene(one, asked.family, tolerance_of_surface));
  } catch (const MeshError&) {
    return {};
  }
}

record::Table reference_table(const std::vector<std::pair<std::string, Reference>>& cases) {
  std::size_t columns = 0;
  for (const auto& [name, reference] : cases)
    for (const ReferenceRow& row : reference.rows) columns = std::max(columns, row.forces.size());
  record::Table table{
      {"case", "step", "time_s", "travel_mm", "slide_mm", "contact_force_N", "error_N", "order"},
      {}};
  for (std::size_t i = 1; i <= columns; ++i)
    table.columns.push_back("level_" + std::to_string(i) + "_N");
  for (const auto& [name, reference] : cases)
    for (const ReferenceRow& row : reference.rows) {
      std::vector<record::Cell> cells;
      cells.emplace_back(name);
      for (const double number :
           {static_cast<double>(row.step), row.time, unit::mm.from_si(row.travel),
            unit::mm.from_si(row.slide), row.force, row.error, row.order})
        cells.emplace_back(number);
      cells.insert(cells.end(), row.forces.begin(), row.forces.end());
      cells.resize(table.columns.size());
      table.rows.push_back(std::move(cells));
    }
  return table;
}

}  // namespace palpate::chart
