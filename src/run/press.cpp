// Moves the finger through the loading history and writes a row at every output interval.
#include "run/pace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/stop_scope.h"
#include "base/units.h"
#include "mechanics/half_space_contact.h"
#include "mechanics/pressed_mesh.h"
#include "run/picture.h"
#include "run/pressure_map.h"
#include "run/solid_press.h"
#include "scene/first_touch.h"
#include "scene/scene.h"

namespace palpate::run {
namespace {

using scenario::Hold;
using scenario::Indent;
using scenario::Retract;
using scenario::Slide;

// A step of the loading history as travel and slide over time.
struct Motion {
  double from = 0.0, to = 0.0;                             // m, travel
  Vec3 start = Vec3::Zero(), end = Vec3::Zero();           // m, sideways
  double duration = 0.0;                                   // s; for a step to a force, the longest
  double force = std::numeric_limits<double>::infinity();  // N, at which the motion ends
  bool keeps_force = false;

  [[nodiscard]] double travel(double time) const {
    return time >= duration ? to : from + (to - from) * time / duration;
  }
  [[nodiscard]] Vec3 sideways(double time) const {
    return time >= duration ? end : Vec3(start + (end - start) * (time / duration));
  }
};

Motion make_motion(const scenario::Step& step, double travel, const Vec3& sideways,
                   const scene::Scene& scene) {
  Motion motion{.from = travel, .to = travel, .start = sideways, .end = sideways};
  if (const auto* indent = std::get_if<Indent>(&step)) {
    // The travel of a step to a force is limited to the finger's radius, beyond Hertz's range.
    motion.to =
        indent->to.second ? std::max(travel, scene.scenario.finger.radius) : indent->to.value;
    if (indent->to.second) motion.force = indent->to.value;
    motion.duration = (motion.to - travel) / indent->rate;
  } else if (const auto* retract = std::get_if<Retract>(&step)) {
    motion.to = retract->to;
    motion.duration = (travel - retract->to) / retract->rate;
  } else if (const auto* slide = std::get_if<Slide>(&step)) {
    motion.end += slide->way();
    motion.duration = slide->by / slide->rate;
    motion.keeps_force = slide->keep == Slide::Keep::force;
  } else {
    motion.duration = std::get<Hold>(step).time;
  }
  return motion;
}

class Press {
 public:
  Press(const scene::Scene& scene, record::CaseRecord& record)
      : scene_(scene), record_(record), history_(scene) {
    if (scene.scenario.output.picture || scene.scenario.output.report)
      record_.picture = picture_of(scene);
    if (scene.solid) {
      solid_.emplace(scene);
      first_ = touch_.finger = scene.solid->first_touch;
      return;
    }
    if (!scene.specimen) {
      first_ = scene::pressed_place(scene);
      touch_.finger = first_ + scene.finger.sphere_radius * Vec3::UnitZ();
      return;
    }
    mesh_.emplace(scene);
    first_ = touch_.finger = scene::first_touch(scene).finger;
    if (scene.scenario.output.tissue) record_.mesh = scene.specimen->mesh;
  }

  void run() {
    Vec3 sideways = Vec3::Zero();
    for (std::size_t i = 0; i < scene_.scenario.steps.size(); ++i) {
      step_ = static_cast<int>(i) + 1;
      const Motion motion = make_motion(scene_.scenario.steps[i], touch_.travel, sideways, scene_);
      if (i == 0) write_row();
      if (motion.duration <= 0.0) {  // possible after a step to a force, whose travel is unknown
        record_.warnings.push_back("step " + std::to_string(step_) +
                                   " has nothing to do: the finger is there already");
        continue;
      }
      if (!run(motion)) return;
      sideways = motion.end;
      if (mesh_) {
        const auto kept = mesh_->kept_modes(touch_);
        if (kept && (!kept_modes_ || kept->dropped_share > kept_modes_->dropped_share))
          kept_modes_ = kept;
      }
      if (scene_.scenario.output.pressure_maps) add_map();
      if (wants_meshes_at(scenario::Output::Meshes::steps)) add_frame();
    }
    if (mesh_) {
      if (const auto imbalance = mesh_->imbalance())
        record_.findings.push_back({"energy_imbalance", *imbalance});
      if (const double error = mesh_->solution_error(); error > 0.0)
        record_.findings.push_back({"solution_error", error});
      if (kept_modes_) {
        record_.findings.push_back({"kept_modes", static_cast<double>(kept_modes_->count)});
        record_.findings.push_back({"dropped_inertia", kept_modes_->dropped_share});
      }
    }
    if (solid_) solid_->add_findings(record_);
    if (mesh_ && scene_.scenario.solver.rings)
      record_.findings.push_back({"edge_reaction_over_force", edge_share_});
    if (mesh_ && scene_.scenario.contact.spread == scenario::Contact::Spread::nearest_node)
      record_.findings.push_back(
          {"surface_displacement_mm", unit::mm.from_si(deepest_surface_displacement_)});
    if (!mesh_ && scene_.scenario.output.tissue)
      record_.warnings.push_back("`" +
                                 std::string(scenario::traits(scene_.scenario.solver.model).word) +
                                 "` writes no displacements of a mesh; set `solver.model = "
                                 "\"coupled_springs\"` for `output.tissue`");
    if (on_crease_)
      record_.warnings.push_back(
          "the finger touched the specimen at a sharp edge or rim: the curvature there is that of "
          "the side it touched");
    if (folded_at_ >= 0.0)
      record_.warnings.push_back(
          "at a displacement of " + quantity_text(folded_at_, unit::mm) +
          " a tetrahedron of the computed displacement turns inside out; the force does not depend "
          "on it, but pictures of the deformed mesh are wrong from there on");
    if (nearly_conforming_)
      record_.warnings.push_back(
          "the tissue is hollow beyond half the finger's curvature where it was pressed: the "
          "contact grows wide compared with the sphere, and Hertz's law is inaccurate");
    if (one_sided_)
      record_.warnings.push_back(
          "near a boundary or sharp edge the curvature was estimated from one side only, to first "
          "order");
  }

 private:
  Pace begin(const Motion& motion) {
    const Pace pace = std::isfinite(motion.force) ? make_open_pace(scene_, motion.duration)
                                                  : make_pace(scene_, motion.duration);
    kept_force_ = touch_.force();
    if (mesh_) mesh_->set_step(pace.step());
    solver_step_ = pace.step();
    history_.slide(motion.start != motion.end);
    return pace;
  }

  // Returns the sideways displacement (m) after `time` s of the motion, and sets slide and travel
  // of touch_; the travel not during a slide at constant force.
  Vec3 move_finger(const Motion& motion, double time) {
    Vec3 sideways = motion.sideways(time);
    if (!motion.keeps_force) touch_.travel = motion.travel(time);
    touch_.slide = sideways.norm();
    return sideways;
  }

  // Returns false if the case has ended early.
  bool run(const Motion& motion) {
    const bool to_force = std::isfinite(motion.force);
    const Pace pace = begin(motion);
    const double start = time_;
    for (int row = 0; row < pace.rows; ++row) {
      for (int k = 1; k <= pace.steps; ++k) {
        StopScope::end_if_stopped();
        const double time = pace.time(row, k);
        if (!advance(motion, time, start + time)) return false;
        if (touch_.force() >= motion.force) {
          time_ = start + time;
          write_row();
          if (to_force) tell_excess(motion.force);
          return true;
        }
      }
      time_ = start + pace.time(row + 1, 0);
      write_row();
      if (mesh_ && looks_for_folds(row + 1 == pace.rows) && folded_at_ < 0.0 && mesh_->inverted()) {
        if (!mesh_->forces_follow_finger())
          return diverged(
              "a tetrahedron has turned inside out; press less deep, or set `solver.kinematics = "
              "\"nonlinear\"` or larger cells in `tissue.mesh`");
        folded_at_ = touch_.travel;
      }
    }
    if (to_force)
      return diverged(
          "the force of the step was not reached; give a smaller force, or a displacement as `to`");
    return true;
  }

  // A step to a force ends with the first step of the solver that reaches it.
  void tell_excess(double wanted) {
    constexpr double worth_telling = 0.01;
    if (touch_.force() <= (1.0 + worth_telling) * wanted) return;
    record_.warnings.push_back(
        "a step to " + rounded_text(wanted, 3) + " N ended at " + rounded_text(touch_.force(), 3) +
        " N, with the first step in time that reached it; take a smaller `output.interval`");
  }

  // Where the displacement does not reach the force, inverted tetrahedra are looked for only if
  // there will be pictures of it; where it takes long to compute, only before them.
  [[nodiscard]] bool looks_for_folds(bool last_row) const {
    const auto& output = scene_.scenario.output;
    if (!mesh_->keeps_load_alone()) return true;
    const bool before_a_picture =
        last_row || wants_meshes_at(scenario::Output::Meshes::rows) || !mesh_->shows_slowly();
    return (output.tissue || output.picture) && before_a_picture;
  }

  // Advances to the finger's position after `time` s of the motion, at `now` (s).
  bool advance(const Motion& motion, double time, double now) {
    const Vec3 sideways = move_finger(motion, time);
    if (solid_) {
      const double along = (sideways - motion.start).norm();
      if (auto wrong = solid_->find({motion.start, motion.end, along}, touch_))
        return diverged(*wrong);
      history_.pass(scene_, solver_step_, touch_);
      return true;
    }
    if (!mesh_) {
      if (auto wrong = mechanics::press_half_space(scene_, first_ + sideways, touch_))
        return diverged(*wrong);
      history_.pass(scene_, solver_step_, touch_);
      return true;
    }
    if (motion.keeps_force)
      if (auto wrong = keep_force(sideways)) return diverged(*wrong);
    if (auto wrong = mesh_->step(place(sideways), now, history_, touch_)) return diverged(*wrong);
    record_.last_stable_time = now;
    return true;
  }

  [[nodiscard]] Vec3 place(const Vec3& sideways) const {
    return first_ + sideways - touch_.travel * Vec3::UnitZ();
  }

  // Sets the travel at which the force equals that at the start of the slide. If the force depends
  // on the mesh's motion, only one Newton step is made per solver step.
  std::optional<std::string> keep_force(const Vec3& sideways) {
    constexpr int most_tries = 50;
    mechanics::Touch tried = touch_;
    for (int i = 0; i < most_tries; ++i) {
      if (mesh_->forces_follow_finger()) {
        tried = touch_;
        if (auto wrong = mesh_->try_out(place(sideways), tried)) return wrong;
      }
      double stiffness = 0.0;
      for (const mechanics::SphereContact& contact : tried.contacts)
        stiffness += (contact.stiffness > 0.0 ? contact.stiffness
                                              : contact.law.point.stiffness(contact.depth)) *
                     contact.patch.normal.z();
      const double missing = kept_force_ - tried.force();
      // Without contact the finger moves down slightly.
      touch_.travel += stiffness > 0.0 ? missing / stiffness : 1e-3 * scene_.finger.sphere_radius;
      if (!mesh_->forces_follow_finger() || std::abs(missing) <= 1e-9 * kept_force_)
        return std::nullopt;
    }
    return "no depth gives the force that the slide keeps; give a smaller force before the slide";
  }

  bool diverged(const std::string& reason) {
    return end_early(record_, record::Outcome::diverged, reason);
  }

  void write_row() {
    record::ContactRow row = contact_row(scene_, touch_);
    if (solid_) solid_->complete(row);
    row.step = step_;
    row.time = time_;
    record_.add(row);
    for (const mechanics::SphereContact& one : touch_.contacts) {
      on_crease_ = on_crease_ || one.on_crease;
      nearly_conforming_ = nearly_conforming_ || one.law.nearly_conforming;
      one_sided_ = one_sided_ || (one.one_sided && one.law.mean_curvature != 0.0);
    }
    if (mesh_ && scene_.scenario.solver.rings && touch_.pressed() > 0.0)
      edge_share_ = std::max(edge_share_, mesh_->edge_reaction() / touch_.pressed());
    if (mesh_ && scene_.scenario.contact.spread == scenario::Contact::Spread::nearest_node)
      for (const mechanics::SphereContact& one : touch_.contacts)
        deepest_surface_displacement_ = std::max(deepest_surface_displacement_, sunk(one));
    if (!mesh_) record_.last_stable_time = time_;
    if (wants_meshes_at(scenario::Output::Meshes::rows)) add_frame();
  }

  [[nodiscard]] bool wants_meshes_at(scenario::Output::Meshes when) const {
    const scenario::Output& output = scene_.scenario.output;
    return mesh_ && output.tissue && output.tissue_at == when;
  }

  // Mean displacement of the nodes under a contact, weighted by their shares of its force, m.
  [[nodiscard]] double sunk(const mechanics::SphereContact& contact) {
    const integrate::Vector displacement = mesh_->displacement();
    double sum = 0.0;
    for (std::size_t k = 0; k < contact.load.vertices.size(); ++k) {
      const auto vertex = as_index(contact.load.vertices[k]);
      sum -= contact.load.shares[k] * contact.patch.normal.dot(displacement.segment<3>(
                                          3 * scene_.specimen->outer_surface[vertex]));
    }
    return sum;
  }

  void add_map() {
    record::PressureMap map = solid_ ? solid_->map(touch_) : draw_map(scene_, touch_);
    map.time = time_;
    map.scenario_case = scene_.name;
    map.step = step_;
    record_.maps.push_back(std::move(map));
  }

  void add_frame() {
    const scene::Specimen& specimen = *scene_.specimen;
    record::TissueFrame frame;
    frame.step = step_;
    frame.time = time_;
    const integrate::Vector displacement = mesh_->displacement();
    for (int n = 0; n < specimen.network.nodes(); ++n)
      frame.displacement.emplace_back(displacement.segment<3>(3 * n));
    std::vector<double> area(specimen.outer_surface.size(), 0.0);
    const geometry::Surface& surface = specimen.surface->surface();
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      for (const int vertex : surface.triangles[t])
        area[as_index(vertex)] += geometry::twice_area(surface, static_cast<int>(t)).norm() / 6.0;
    frame.contact_pressure.assign(specimen.mesh.nodes.size(), 0.0);
    for (const mechanics::SphereContact& contact : touch_.contacts)
      for (std::size_t k = 0; k < contact.load.vertices.size(); ++k) {
        const auto vertex = as_index(contact.load.vertices[k]);
        frame.contact_pressure[as_index(specimen.outer_surface[vertex])] +=
            contact.force * contact.load.shares[k] / area[vertex];
      }
    record_.frames.push_back(std::move(frame));
  }

  const scene::Scene& scene_;
  record::CaseRecord& record_;
  mechanics::ContactHistory history_;
  std::optional<mechanics::PressedMesh> mesh_;
  std::optional<SolidPress> solid_;
  double solver_step_ = 0.0;  // s
  Vec3 first_ =
      Vec3::Zero();  // m, the finger's point at the first touch; without a mesh, the top's
  mechanics::Touch touch_;
  double kept_force_ = 0.0;  // N, during a slide
  double folded_at_ = -1.0;  // m, travel with the first inverted tetrahedron; below 0: none
  double edge_share_ = 0.0;  // largest ratio of edge reaction to contact force
  double deepest_surface_displacement_ = 0.0;  // m, with `contact.spread = "nearest_node"`
  double time_ = 0.0;
  int step_ = 1;
  bool on_crease_ = false;
  std::optional<mechanics::PressedMesh::KeptModes> kept_modes_;
  bool one_sided_ = false;
  bool nearly_conforming_ = false;
};

}  // namespace

void press(const scene::Scene& scene, record::CaseRecord& record) { Press(scene, record).run(); }

}  // namespace palpate::run
