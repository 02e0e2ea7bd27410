// Steps of a mesh under a finger, from the coupling that knows nothing of the mesh to those that
// solve for both together; the compliances C_ij of docs/theory.md [contacts].
#include "mechanics/couplings.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "contact/half_space.h"
#include "contact/hertz.h"
#include "mechanics/monitor.h"
#include "scenario/integrators.h"

namespace palpate::mechanics {
namespace {

using integrate::MemoryRule;
using integrate::Vector;

// The radius of the contact divided by the square root of its depth, sqrt(m).
double radius_per_root(const contact::ContactLaw& law) {
  const contact::LayerContact* layer = law.point.layer;
  return layer != nullptr ? law.radius_share * std::sqrt(layer->radius) : std::sqrt(law.a * law.b);
}

// How far from its first touch the loading history lets the finger press, with room for a hand that
// does not follow it closely, m.
double farthest_reach(const scene::Scene& scene) {
  double path = 4.0 * contact::hertz::contact_radius(
                          scene::deepest_travel(scene.scenario, scene.law()), scene.law().radius);
  path += scene.law().radius;
  for (const scenario::Step& step : scene.scenario.steps)
    if (const auto* slide = std::get_if<scenario::Slide>(&step)) path += std::abs(slide->by);
  return path;
}

}  // namespace

std::optional<std::string> OneWay::find(const Vec3& finger, Touch& touch) {
  skin->detect(finger, nullptr);
  return skin->find(finger, touch, [this](Touch& now) {
    SkinContacts::guess_depth(now.contacts);
    return skin->settle(
        now, [](auto&, auto& compliance) -> auto& { return compliance; });
  });
}

std::optional<std::string> OneWay::step(const StepTo& to) {
  if (auto wrong = find(to.finger, to.touch)) return wrong;
  to.history.pass(*part->scene, to.duration, to.touch);
  return part->move(to.touch);
}

void Consistent::begin_part(const std::vector<Eigen::Index>& /*from*/) {
  const scene::Scene& scene = *part->scene;
  beyond_.emplace(scene, part->part, part->body->held(),
                  scene::deepest_travel(scene.scenario, scene.law()));
  finer_.resize(0);
}

void Consistent::make_ready() { beyond_->make_ready(farthest_reach(*part->scene)); }

std::optional<std::string> Consistent::find(const Vec3& finger, Touch& touch) {
  skin->detect(finger, nullptr);
  return skin->find(
      finger, touch,
      [this](Touch& now) {
        // Steps in modes alone are frames in which every loaded node costs time.
        if (!part->in_modes)
          for (SphereContact& contact : now.contacts) skin->spread_wide(contact);
        SkinContacts::guess_depth(now.contacts);
        return skin->settle(
            now, [&](auto&, Eigen::MatrixXd& compliance) -> auto& {
              find_sinking(now.contacts, compliance);
              return compliance;
            });
      },
      body());
}

std::optional<std::string> Consistent::step(const StepTo& to) {
  if (auto wrong = find(to.finger, to.touch)) return wrong;
  to.history.pass(*part->scene, to.duration, to.touch);
  if (!part->in_modes) load_finely(to.touch);
  return part->move(to.touch);
}

// The surface displacement under the single sphere that a group of spheres with
// `calibration = "force"` replaces: the mean over the group's contacts, weighted by their effective
// depths, each with the patch of that sphere, which `joint` receives.
BodySinking::Value Consistent::joint_sinking(const KeptList<SphereContact>& contacts,
                                             contact::Patch& joint) {
  double approaches = 0.0;
  for (const SphereContact& contact : contacts) {
    approaches += std::max(0.0, contact.approach);
    if (contact.patch.radius() > joint.radius()) joint = contact.patch;
  }
  // a^2 = R h, and R is n^(1/3) times a sphere's radius.
  const double wider = std::pow(static_cast<double>(part->scene->finger.centres.size()), 1.0 / 6.0);
  joint.a *= wider;
  joint.b *= wider;
  BodySinking::Value sum;
  if (!(approaches > 0.0)) return sum;
  for (const SphereContact& contact : contacts) {
    if (contact.approach <= 0.0) continue;
    contact::Patch here = contact.patch;
    here.a = joint.a;
    here.b = joint.b;
    const BodySinking::Value own = beyond_->at(here);
    const double weight = contact.approach / approaches;
    sum.sinking += weight * own.sinking;
    sum.slope += weight * own.slope;
    sum.error += weight * own.error;
    sum.doubt += weight * own.doubt;
  }
  return sum;
}

// The contact radius a is the one that stores the most energy, docs/theory.md [energy]:
//   F = F_Hertz(a) / (1 - (5/3) E* a^2 s'(a)),   travel = a^2 / R + (s + a s') F.
// Both take the form of the contact equations: the law times a factor, and a compliance.
void Consistent::find_sinking(KeptList<SphereContact>& contacts, Eigen::MatrixXd& compliance) {
  constexpr double most_stiffening = 0.8;
  const auto count = static_cast<Eigen::Index>(contacts.size());
  const bool as_one = presses_as_one(*part->scene);
  const auto& tissue = part->scene->scenario.tissue;
  const double plane_modulus =
      tissue.young_modulus / (1.0 - tissue.poisson_ratio * tissue.poisson_ratio);
  contact::Patch joint;
  BodySinking::Value of_all;
  if (as_one) of_all = joint_sinking(contacts, joint);
  for (Eigen::Index i = 0; i < count; ++i) {
    SphereContact& own = contacts[as_index(i)];
    const BodySinking::Value value = as_one ? of_all : beyond_->at(own.patch);
    const double radius = (as_one ? joint : own.patch).radius();
    // F_Hertz = 4/3 E* a h, for an ellipse with a modulus that makes this so. A layer's law knows
    // its own contact radius.
    const double modulus = as_one ? part->scene->finger.whole.modulus
                                  : 0.75 * own.law.point.coefficient / radius_per_root(own.law);
    const double stiffening =
        std::min(most_stiffening, 5.0 / 3.0 * modulus * radius * radius * value.slope);
    // The mesh is linear: it sinks by the force without the factor of a deep press.
    own.sinking_error = value.error / own.deep;
    own.sinking_doubt = value.doubt / own.deep;
    double sinking = value.sinking / own.deep;
    if (own.law.point.layer == nullptr) {
      own.law.point.part /= 1.0 - stiffening;
      sinking += radius * value.slope / own.deep;
    }
    if (as_one) {
      compliance.row(i).head(count).setConstant(sinking);
      continue;
    }
    compliance(i, i) = sinking;
    // Symmetrised, c_ij = (c_ij + c_ji) / 2, because readings at points are not quite symmetric.
    for (Eigen::Index j = 0; j < count; ++j) {
      if (i == j) continue;
      const SphereContact& other = contacts[as_index(j)];
      const double between =
          own.patch.normal.dot(other.patch.normal) *
              contact::half_space_sinking((own.patch.position - other.patch.position).norm(), 1.0,
                                          other.patch.radius(), plane_modulus) +
          beyond_->rest(own.patch.normal, own.load, part->nodes, other.patch);
      compliance(i, j) += 0.5 * between / other.deep;
      compliance(j, i) += 0.5 * between / own.deep;
    }
  }
}

std::vector<double> Consistent::errors(const SphereContact& contact) {
  contact::Patch patch = contact.patch;
  patch.a = patch.b = patch.radius();
  return beyond_->errors(patch);
}

Vector Consistent::displacement() {
  if (finer_.size() == 0) return part->state.displacement;
  Vector further;
  part->respond(Response::statics, finer_, further);
  return part->state.displacement + further;
}

namespace {

// The memory rule of the mesh's integrator.
MemoryRule memory_rule(const scene::Scene& scene) {
  return scene.scenario.solver.integrator == scenario::Solver::Integrator::backward_difference
             ? MemoryRule::first_order
             : MemoryRule::exact;
}

// The largest displacement of any node of the surface, m.
double rise(const MovingPart& part, const Vector& displacement) {
  double most = 0.0;
  for (const int node : part.nodes)
    if (node >= 0) most = std::max(most, displacement.segment<3>(3 * node).squaredNorm());
  return std::sqrt(most);
}

}  // namespace

ConsistentWithInertia::ConsistentWithInertia(SkinContacts& contacts, MovingPart& moving)
    : OnMesh(contacts, moving),
      statics(contacts, moving),
      inertia_(moving),
      crept_(moving.scene->specimen->law, memory_rule(*moving.scene)) {}

void ConsistentWithInertia::begin_part(const std::vector<Eigen::Index>& from) {
  statics.begin_part(from);
  inertia_.statics.forget();
  inertia_.response.forget();
  crept_.renumber(from);
}

void ConsistentWithInertia::make_ready() {
  statics.make_ready();
  inertia_.make_room(skin->most_contacts());
  inertia_.statics.ask_all();
  if (part->keeps_responses()) inertia_.response.ask_all();
}

// Stages of different durations follow each other only in a method with two stages, where exp() is
// therefore called in the step, twice per branch and stage.
void ConsistentWithInertia::set_stage(double duration) {
  if (duration == stage_) return;
  stage_ = duration;
  crept_.set_step(duration);
  slope_ = 1.0;
  for (const contact::Branch& branch : part->scene->relaxation.branches)
    slope_ += branch.ratio * (1.0 - tissue::MemoryStep::exact(duration, branch.time).end);
}

std::optional<std::string> ConsistentWithInertia::find(const Motion& motion, const StepTo& to) {
  // An oscillating surface may reach a finger that does not touch it at rest. Places that the
  // finger touches neither on the surface at rest nor on the moving surface are left out.
  skin->detect(to.finger, nullptr, rise(*part, motion.displacement))
      .erase_if([&](SphereContact& contact) {
        if (contact.approach > 0.0) return false;
        contact.patch.axis = contact.patch.normal.unitOrthogonal();
        skin->spread_wide(contact);
        return contact.approach - inertia_.sunk(motion.displacement, contact) <= 0.0;
      });
  return skin->find(
      to.finger, to.touch,
      [&](Touch& now) -> std::optional<std::string> {
        for (SphereContact& contact : now.contacts) skin->spread_wide(contact);
        const auto complete = [&](std::vector<double>& approaches,
                                  Eigen::MatrixXd& compliance) -> const Eigen::MatrixXd& {
          statics.find_sinking(now.contacts, compliance);
          return inertia_.complete(motion, now.contacts, compliance, approaches);
        };
        do {
          inertia_.begin(motion, now.contacts);
          if (auto wrong = skin->settle(now, complete)) return wrong;
        } while (inertia_.release(motion, now.contacts));
        inertia_.remember(motion, skin->compliance(), now.contacts);
        return std::nullopt;
      },
      statics.body());
}

// Finds the contacts of the finger with a moving mesh; leaves their load in the part's `load`.
std::optional<std::string> ConsistentWithInertia::meet(const Vector& displacement, double share,
                                                       const StepTo& to) {
  const bool viscous = to.history.relaxes();
  // Friction acts as in the previous step; its static displacement does not count as motion.
  if (!viscous) drag_load(to.touch, *part, drag_);
  const Motion motion{.displacement = displacement,
                      .still = viscous ? crept_.load() : drag_,
                      .still_has_past = viscous,
                      .share = share,
                      .slope = slope_,
                      .time_step = stage_};
  if (auto wrong = find(motion, to)) return wrong;
  if (viscous) {
    for (SphereContact& contact : to.touch.contacts) contact.force = contact.elastic;
    to.history.pass(*part->scene, stage_, to.touch);
    for (SphereContact& contact : to.touch.contacts)
      contact.force = std::max(0.0, contact.force + contact.radiated);
    rub(*part->scene, Vec3::Zero(), to.touch);
    inertia_.keep_forces(to.touch);
  }
  contact_load(to.touch, *part, part->load);
  if (viscous) crept_.pass(part->load);
  statics.load_finely(to.touch);
  return std::nullopt;
}

// In modal steps the mean of the loads at both ends acts during the whole step. The mesh then
// receives exactly the work that the contact's spring loses, mode by mode, and every step size is
// stable.
template <class Linearised>
std::optional<std::string> ConsistentWithInertia::step_with(Linearised& method, const StepTo& to) {
  constexpr bool modal = std::is_same_v<Linearised, integrate::Modal>;
  constexpr double share = modal ? 0.5 : 1.0;
  const auto act = [&](const Vector& at_end) {
    if constexpr (modal)
      acting_ = share * (part->load_before + at_end);
    else
      acting_ = at_end;
  };
  drag_load(to.touch, *part, drag_);
  act(drag_);
  method.begin(part->state, part->time_step, modal ? MemoryRule::held : MemoryRule::first_order);
  if (!method.linearise(part->state.displacement, acting_)) return not_positive;
  reached_ = method.base();
  if (auto wrong = meet(reached_, share, to)) return wrong;
  acting_ = share * (part->load - drag_);
  inertia_.response.to(acting_, moved_);
  moved_ += reached_;
  act(part->load);
  method.finish(part->state, moved_, acting_);
  return std::nullopt;
}

std::optional<std::string> ConsistentWithInertia::step(const StepTo& to) {
  set_stage(to.duration);
  return std::visit(
      [&](auto& method) -> std::optional<std::string> {
        if constexpr (requires { method.base(); }) {
          return step_with(method, to);
        } else {
          if (auto wrong =
                  part->stepper->step(part->state, part->load, part->load, MemoryRule::exact))
            return wrong;
          return meet(part->state.displacement, 0.0, to);
        }
      },
      part->stepper->method());
}

void FromMesh::make_ready() {
  skin->make_room(next_);
  if (part->keeps_responses()) influence.ask_all();
}

template <class Find>
std::optional<std::string> FromMesh::step_by(MemoryRule rule, const Find& find, Touch& touch) {
  return std::visit(
      [&](auto& method) -> std::optional<std::string> {
        if constexpr (requires { method.base(); }) {
          return balance(method, rule, find, touch);
        } else {
          if (auto wrong = part->stepper->step(part->state, part->load, part->load, rule))
            return wrong;
          if (auto wrong = find(part->state.displacement, touch)) return wrong;
          contact_load(touch, *part, part->load);
          return std::nullopt;
        }
      },
      part->stepper->method());
}

template <class Linearised, class Find>
std::optional<std::string> FromMesh::balance(Linearised& method, MemoryRule rule, const Find& find,
                                             Touch& touch) {
  const bool linear = part->body->linear();
  reached_ = part->state.displacement;
  // Friction acts as in the previous step; the contact equations give the normal forces.
  drag_load(touch, *part, drag_);
  method.begin(part->state, part->time_step, rule);
  for (int i = 0; i < most_linearisations; ++i) {
    if (!linear) influence.forget();
    if (!method.linearise(reached_, drag_)) return not_positive;
    next_ = touch;
    if (auto wrong = find(method.base(), next_)) return wrong;
    contact_load(next_, *part, part->other_load);
    further_ = part->other_load - drag_;
    method.response(further_, moved_);
    moved_ += method.base();
    const double change = (moved_ - reached_).cwiseAbs().maxCoeff();
    reached_ = moved_;
    if (!std::isfinite(change)) return not_finite;
    if (linear || change <= settled_length) {
      method.finish(part->state, reached_, part->other_load);
      std::swap(touch, next_);
      part->load = part->other_load;
      return std::nullopt;
    }
  }
  return not_settled;
}

std::optional<std::string> Series::step(const StepTo& to) {
  const bool once = about(part->scene->scenario.solver.integrator).explicit_steps;
  const auto solve = [&](Touch& now) {
    const auto complete = [&](auto&, Eigen::MatrixXd& compliance) -> auto& {
      if (!once) find_sinking(now.contacts, compliance);
      return compliance;
    };
    return skin->settle(now, complete, once ? 1 : SkinContacts::most_passes);
  };
  const auto find = [&](const Vector& displacement, Touch& now) {
    skin->detect(to.finger, &displacement);
    return skin->find(to.finger, now, solve);
  };
  return step_by(MemoryRule::exact, find, to.touch);
}

// The sinking of the mesh under each contact per newton on each other, m/N.
void Series::find_sinking(const KeptList<SphereContact>& contacts, Eigen::MatrixXd& compliance) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      const SphereContact& own = contacts[as_index(i)];
      const SphereContact& pressed = contacts[as_index(j)];
      PairTable& kept = influence.kept;
      kept.look(own.patch.normal, pressed.patch.normal);
      double sum = 0.0;
      for (std::size_t k = 0; k < own.load.vertices.size(); ++k) {
        const int vertex = own.load.vertices[k];
        double moved = 0.0;
        for (std::size_t l = 0; l < pressed.load.vertices.size(); ++l) {
          const int loaded = pressed.load.vertices[l];
          moved += pressed.load.shares[l] * kept.at(vertex, loaded, [&] {
            return influence.block(part->node_of(vertex), part->node_of(loaded));
          });
        }
        sum += own.load.shares[k] * moved;
      }
      compliance(i, j) = sum;
    }
}

// A node in contact takes any force, and a force that is linear in each step would oscillate about
// the correct one.                                                    docs/theory.md, below [cells]
std::optional<std::string> Resolved::step(const StepTo& to) {
  const auto find = [&](const Vector& displacement, Touch& now) {
    return contact_.find(to.finger, displacement, influence, now);
  };
  return step_by(MemoryRule::first_order, find, to.touch);
}

}  // namespace palpate::mechanics
