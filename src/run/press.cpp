// Travel and slide over time, and a row of results at every output interval.
#include "run/press.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/units.h"
#include "run/contact_row.h"
#include "run/half_space_contact.h"
#include "run/pace.h"
#include "run/pressed_mesh.h"
#include "run/pressure_map.h"
#include "run/scene_picture.h"
#include "scene/first_touch.h"

namespace palpate::run {
namespace {

using scenario::Hold;
using scenario::Indent;
using scenario::Retract;
using scenario::Slide;

// A step of the programme as travel and slide over time.
struct Motion {
  double from = 0.0, to = 0.0;                             // m, travel
  Vec3 start = Vec3::Zero(), end = Vec3::Zero();           // m, sideways
  double duration = 0.0;                                   // s; the longest, until a force
  double force = std::numeric_limits<double>::infinity();  // N, to stop at
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
    // A force that never comes must not press for ever: to the radius, where Hertz ends.
    motion.to =
        indent->to.second ? std::max(travel, scene.scenario.finger.radius) : indent->to.value;
    if (indent->to.second) motion.force = indent->to.value;
    motion.duration = (motion.to - travel) / indent->rate;
  } else if (const auto* retract = std::get_if<Retract>(&step)) {
    motion.to = retract->to;
    motion.duration = (travel - retract->to) / retract->rate;
  } else if (const auto* slide = std::get_if<Slide>(&step)) {
    const double angle = slide->direction * std::numbers::pi / 180.0;
    motion.end += slide->by * Vec3(std::cos(angle), std::sin(angle), 0.0);
    motion.duration = slide->by / slide->rate;
    motion.keeps_force = slide->keep == Slide::Keep::force;
  } else {
    motion.duration = std::get<Hold>(step).time;
  }
  return motion;
}

class Press {
 public:
  Press(const scene::Scene& scene, const std::atomic<bool>& stop, record::CaseRecord& record)
      : scene_(scene), stop_(stop), record_(record), history_(scene) {
    if (!scene.specimen) {
      first_ = scene::pressed_place(scene);
      touch_.finger = first_ + scene.finger.sphere_radius * Vec3::UnitZ();
      return;
    }
    mesh_.emplace(scene);
    in_rows_ = suits_lanes(scene);
    first_ = scene::first_touch(scene).finger;
    touch_.finger = first_;
    if (scene.scenario.output.tissue) record_.mesh = scene.specimen->mesh;
    if (scene.scenario.output.picture) record_.picture = make_picture(scene);
  }

  Course all() {
    Vec3 sideways = Vec3::Zero();
    for (std::size_t i = 0; i < scene_.scenario.steps.size(); ++i) {
      step_ = static_cast<int>(i) + 1;
      const Motion motion = make_motion(scene_.scenario.steps[i], touch_.travel, sideways, scene_);
      if (i == 0) write_row();
      if (motion.duration <= 0.0) {  // after a step to a force nobody knows the travel beforehand
        record_.remarks.push_back("step " + std::to_string(step_) +
                                  " has nothing to do: the finger is there already");
        continue;
      }
      going_ = true;
      if (in_rows_)
        for (Course rows = run_in_rows(motion); March* march = rows.next();) co_yield *march;
      else
        going_ = run(motion);
      if (!going_) co_return;
      sideways = motion.end;
      if (scene_.scenario.output.pressure_maps) add_map();
      if (scene_.scenario.output.tissue && mesh_) add_frame();
    }
    if (mesh_) record_.findings.push_back({"energy_imbalance", mesh_->imbalance()});
    if (mesh_ && scene_.scenario.solver.rings)
      record_.findings.push_back({"edge_reaction_over_force", edge_share_});
    if (mesh_ && scene_.scenario.contact.spread == scenario::Contact::Spread::nearest_node)
      record_.findings.push_back({"sinking_mm", unit::mm.from_si(deepest_sinking_)});
    if (!mesh_ && (scene_.scenario.output.tissue || scene_.scenario.output.picture))
      record_.remarks.push_back(
          "there is no mesh to show: `auto` chose `hertz`; set `solver.model = \"mass_spring\"` "
          "for "
          "`output.tissue` and `output.picture`");
    if (on_crease_)
      record_.remarks.push_back(
          "the finger touched the specimen at a crease or rim: the curvature there is that of the "
          "side it touched");
    if (nearly_conforming_)
      record_.remarks.push_back(
          "the tissue is hollow beyond half the finger's curvature where it was pressed: the "
          "contact "
          "grows wide against the sphere, and Hertz's law is a poor one");
    if (one_sided_)
      record_.remarks.push_back(
          "near a boundary or crease the curvature was read from one side only, to first order");
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

  // Row by row: first the forces, which follow from the finger alone, then the mesh. What run()
  // gives is in going_.
  Course run_in_rows(const Motion& motion) {
    const Pace pace = begin(motion);
    const double start = time_;
    going_ = false;
    for (int row = 0; row < pace.rows; ++row) {
      if (stop_.load()) {
        (void)end_early(record_, record::Outcome::interrupted, "interrupted");
        co_return;
      }
      mesh_->clear_march();
      std::optional<std::string> wrong;
      bool there = false;
      double end = start + pace.time(row + 1, 0);
      for (int k = 1; k <= pace.steps && !there && !wrong; ++k) {
        const double time = pace.time(row, k);
        const Vec3 sideways = move_finger(motion, time);
        if (motion.keeps_force) wrong = keep_force(sideways);
        if (!wrong) wrong = mesh_->add_step(place(sideways), start + time, history_, touch_);
        there = !wrong && touch_.force() >= motion.force;
        if (there) end = start + time;
      }
      March& march = mesh_->march();
      if (!march.times.empty()) co_yield march;
      if (march.done > 0) record_.last_stable_time = march.times[march.done - 1];
      if (march.wrong) wrong = march.wrong;  // the forces went wrong after it, if they did
      if (wrong) {
        (void)diverged(*wrong);
        co_return;
      }
      time_ = end;
      write_row();
      if (there) break;
      if (mesh_->inverted()) {
        (void)diverged("a tetrahedron has turned inside out");
        co_return;
      }
      if (row + 1 == pace.rows && std::isfinite(motion.force)) {
        (void)diverged("the force of the step was not reached");
        co_return;
      }
    }
    going_ = true;
  }

  // Where it is after `time` s of the motion, sideways; a travel that is kept is set.
  Vec3 move_finger(const Motion& motion, double time) {
    const Vec3 sideways = motion.sideways(time);
    if (!motion.keeps_force) touch_.travel = motion.travel(time);
    touch_.slide = sideways.norm();
    return sideways;
  }

  // False where the case ended early.
  bool run(const Motion& motion) {
    const bool to_force = std::isfinite(motion.force);
    const Pace pace = begin(motion);
    const double start = time_;
    for (int row = 0; row < pace.rows; ++row) {
      if (stop_.load()) return end_early(record_, record::Outcome::interrupted, "interrupted");
      for (int k = 1; k <= pace.steps; ++k) {
        const double time = pace.time(row, k);
        if (!advance(motion, time, start + time)) return false;
        if (touch_.force() >= motion.force) {
          time_ = start + time;
          write_row();
          return true;
        }
      }
      time_ = start + pace.time(row + 1, 0);
      write_row();
      if (mesh_ && mesh_->inverted()) return diverged("a tetrahedron has turned inside out");
    }
    if (to_force) return diverged("the force of the step was not reached");
    return true;
  }

  // To the finger's place after `time` s of the motion, at `now`, s.
  bool advance(const Motion& motion, double time, double now) {
    const Vec3 sideways = move_finger(motion, time);
    if (!mesh_) {
      if (auto wrong = press_half_space(scene_, first_ + sideways, touch_)) return diverged(*wrong);
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

  // Sets the travel at which the force is what it was when the slide began. Where the force waits
  // for the mesh, one Newton step a solver step follows it.
  std::optional<std::string> keep_force(const Vec3& sideways) {
    constexpr int most_tries = 50;
    Touch tried = touch_;
    for (int i = 0; i < most_tries; ++i) {
      if (mesh_->forces_follow_finger()) {
        tried = touch_;
        if (auto wrong = mesh_->try_out(place(sideways), tried)) return wrong;
      }
      double stiffness = 0.0;
      for (const SphereContact& contact : tried.contacts)
        stiffness += (contact.stiffness > 0.0 ? contact.stiffness
                                              : contact.law.point.stiffness(contact.depth)) *
                     contact.patch.normal.z();
      const double missing = kept_force_ - tried.force();
      // Out of touch, down by a little.
      touch_.travel += stiffness > 0.0 ? missing / stiffness : 1e-3 * scene_.finger.sphere_radius;
      if (!mesh_->forces_follow_finger() || std::abs(missing) <= 1e-9 * kept_force_)
        return std::nullopt;
    }
    return "no depth gives the force that the slide keeps";
  }

  bool diverged(const std::string& reason) {
    return end_early(record_, record::Outcome::diverged, reason);
  }

  void write_row() {
    record::ContactRow row = contact_row(scene_, touch_);
    row.step = step_;
    row.time = time_;
    record_.contact.push_back(row);
    for (const SphereContact& one : touch_.contacts) {
      on_crease_ = on_crease_ || one.on_crease;
      nearly_conforming_ = nearly_conforming_ || one.law.nearly_conforming;
      one_sided_ = one_sided_ || (one.one_sided && one.law.mean_curvature != 0.0);
    }
    if (mesh_ && scene_.scenario.solver.rings && touch_.pressed() > 0.0)
      edge_share_ = std::max(edge_share_, mesh_->edge_reaction() / touch_.pressed());
    if (mesh_ && scene_.scenario.contact.spread == scenario::Contact::Spread::nearest_node)
      for (const SphereContact& one : touch_.contacts)
        deepest_sinking_ = std::max(deepest_sinking_, sunk(one));
    if (!mesh_) record_.last_stable_time = time_;
  }

  // Of the nodes under a contact, by their shares of its force, m.
  [[nodiscard]] double sunk(const SphereContact& contact) {
    const integrate::Vector displacement = mesh_->displacement();
    double sum = 0.0;
    for (std::size_t k = 0; k < contact.load.vertices.size(); ++k) {
      const auto vertex = static_cast<std::size_t>(contact.load.vertices[k]);
      sum -= contact.load.shares[k] *
             contact.patch.normal.dot(displacement.segment<3>(3 * scene_.specimen->skin[vertex]));
    }
    return sum;
  }

  void add_map() {
    record::PressureMap map = draw_map(scene_, touch_);
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
    std::vector<double> area(specimen.skin.size(), 0.0);
    const geometry::Surface& surface = specimen.surface->surface();
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      for (const int vertex : surface.triangles[t])
        area[static_cast<std::size_t>(vertex)] +=
            geometry::twice_area(surface, static_cast<int>(t)).norm() / 6.0;
    frame.contact_pressure.assign(specimen.mesh.nodes.size(), 0.0);
    for (const SphereContact& contact : touch_.contacts)
      for (std::size_t k = 0; k < contact.load.vertices.size(); ++k) {
        const auto vertex = static_cast<std::size_t>(contact.load.vertices[k]);
        frame.contact_pressure[static_cast<std::size_t>(specimen.skin[vertex])] +=
            contact.force * contact.load.shares[k] / area[vertex];
      }
    record_.frames.push_back(std::move(frame));
  }

  const scene::Scene& scene_;
  const std::atomic<bool>& stop_;
  record::CaseRecord& record_;
  ContactHistory history_;
  std::optional<PressedMesh> mesh_;
  double solver_step_ = 0.0;  // s
  Vec3 first_ =
      Vec3::Zero();  // m, the finger's point at the first touch; without a mesh, the top's
  Touch touch_;
  double kept_force_ = 0.0;  // N, during a slide
  double edge_share_ = 0.0;
  double deepest_sinking_ = 0.0;  // m, where all is on one node
  double time_ = 0.0;
  int step_ = 1;
  bool in_rows_ = false;
  bool going_ = true;
  bool on_crease_ = false;
  bool one_sided_ = false;
  bool nearly_conforming_ = false;
};

}  // namespace

Course press(const scene::Scene& scene, const std::atomic<bool>& stop, record::CaseRecord& record) {
  Press one(scene, stop, record);
  for (Course course = one.all(); March* march = course.next();) co_yield *march;
}

}  // namespace palpate::run
