// Steps by the coupling, and the moving part of the specimen, which follows the contact.
#include "mechanics/pressed_mesh.h"

#include "scene/first_touch.h"
#include "scene/time_plan.h"

namespace palpate::mechanics {
namespace {

using integrate::Vector;

Coupling make_coupling(SurfaceContacts& outer_surface, MovingPart& part) {
  const scenario::Resolved& scenario = part.scene->scenario;
  switch (scenario.contact.coupling) {
    case contact::Coupling::one_way:
      return Coupling(std::in_place_type<OneWay>, outer_surface, part);
    case contact::Coupling::series:
      return Coupling(std::in_place_type<Series>, outer_surface, part);
    case contact::Coupling::resolved:
      return Coupling(std::in_place_type<Resolved>, outer_surface, part);
    case contact::Coupling::consistent: break;
  }
  if (scene::inertia_reaches_force(scenario))
    return Coupling(std::in_place_type<ConsistentWithInertia>, outer_surface, part);
  return Coupling(std::in_place_type<Consistent>, outer_surface, part);
}

}  // namespace

PressedMesh::PressedMesh(const scene::Scene& scene)
    : part_(scene), outer_surface_(part_), coupling_(make_coupling(outer_surface_, part_)) {}

void PressedMesh::set_step(double time_step) {
  if (time_step != part_.time_step)
    std::visit([](auto& coupling) { coupling.forget_steps(); }, coupling_);
  part_.set_step(time_step);
  const scenario::Resolved& scenario = part_.scene->scenario;
  const bool alone = forces_follow_finger() && !scenario.solver.rings &&
                     scenario.contact.curvature_on == scenario::Contact::CurvatureOn::rest;
  const auto* modal = std::get_if<integrate::Modal>(&part_.stepper->method());
  part_.in_modes = alone && modal != nullptr && modal->passes_alone();
  part_.still = alone && part_.body->linear() &&
                scenario.solver.integrator == scenario::Solver::Integrator::quasi_static;
  if (!part_.equivalent && (part_.still || (part_.in_modes && !modal->keeps_all()))) {
    part_.equivalent.emplace(part_.body->law(), integrate::MemoryRule::exact);
    part_.equivalent->set_step(time_step);
  }
}

// Steps still allocate
// - for non-linear bodies: factors, in implicit steps at every linearisation, and in explicit steps
//   with dashpots between nodes whenever the dashpots have turned far;
// - for `resolved`: the equations of the nodes in contact;
// - for `solver.rings`: the new part and its influences when another part starts to move;
// - influences, once per node in contact, if all of them are too large for Influence::ask_all();
// - where a hand presses far beside the loading history's path, once per vertex of the surface;
// - contacts beyond four per sphere, once each.
void PressedMesh::make_ready(Touch& touch) {
  const scene::Scene& scene = *part_.scene;
  start_.reserve(contact::most_shares * outer_surface_.most_contacts());
  for (std::vector<char>* flags : {&reach_.inside, &reach_.moving})
    flags->reserve(scene.specimen->network.rest.size());

  // Two steps at rest, far from contact, so that later steps do not allocate: some methods make
  // their factors and vectors only in their second step.
  const Vec3 place = touch.finger;
  const Vec3 away = scene::first_touch(scene).finger + scene.specimen->height() * Vec3::UnitZ();
  ContactHistory none(scene);
  // An error in these steps occurs again in the first real step, which reports it.
  for (const int i : {1, 2}) (void)step(away, i * part_.time_step, none, touch);
  part_.state.time = 0.0;
  touch.finger = place;
  outer_surface_.make_room(touch);  // after these steps, which may exchange it for another one
  std::visit([](auto& coupling) { coupling.make_ready(); }, coupling_);
}

bool PressedMesh::forces_follow_finger() const {
  return std::visit([](const auto& coupling) { return coupling.follows_finger; }, coupling_);
}

Consistent* PressedMesh::statics() {
  if (auto* moving = std::get_if<ConsistentWithInertia>(&coupling_)) return &moving->statics;
  return std::get_if<Consistent>(&coupling_);
}

std::optional<std::string> PressedMesh::try_out(const Vec3& finger, Touch& touch) {
  if (Consistent* consistent = statics()) return consistent->find(finger, touch);
  return std::get<OneWay>(coupling_).find(finger, touch);
}

std::optional<std::string> PressedMesh::step(const Vec3& finger, double time,
                                             ContactHistory& history, Touch& touch) {
  const auto go = [&](const Vec3& to, double duration) {
    return std::visit(
        [&](auto& coupling) {
          return coupling.step({to, duration, history, touch});
        },
        coupling_);
  };
  if (part_.in_modes || part_.still) {
    part_.state.time = time;
    return go(finger, part_.time_step);
  }
  part_.before = part_.state;
  part_.load_before = part_.load;
  double duration = part_.time_step;
  if (auto* staged = std::get_if<integrate::TrBdf2>(&part_.stepper->method());
      staged != nullptr && !forces_follow_finger()) {
    constexpr double part = integrate::TrBdf2::first_part;
    const Vec3 from = touch.finger;
    staged->start_under(part_.load);
    if (auto wrong = go(from + part * (finger - from), part * duration)) return wrong;
    duration = (1.0 - part) * duration;
  }
  if (auto wrong = go(finger, duration)) return wrong;
  part_.state.time = time;  // a sum of steps would accumulate rounding errors
  // Modal steps with inertia are loaded by the mean load during the whole step.
  const bool mean = std::holds_alternative<ConsistentWithInertia>(coupling_) &&
                    std::holds_alternative<integrate::Modal>(part_.stepper->method());
  if (mean) part_.other_load = 0.5 * (part_.load_before + part_.load);
  if (auto unstable = part_.monitor->step(part_.before, part_.state,
                                          mean ? part_.other_load : part_.load_before,
                                          mean ? part_.other_load : part_.load))
    return unstable;
  if (part_.scene->scenario.solver.rings) follow(touch);
  return std::nullopt;
}

// Chooses another part if the contact has moved.
void PressedMesh::follow(const Touch& touch) {
  const scene::Specimen& specimen = *part_.scene->specimen;
  start_.clear();
  for (const SphereContact& contact : touch.contacts)
    for (const int vertex : contact.load.vertices)
      start_.push_back(specimen.outer_surface[as_index(vertex)]);
  if (start_.empty()) return;
  const int rings = *part_.scene->scenario.solver.rings;
  tissue::reach_around(specimen.network, start_, rings, reach_);
  if (tissue::spans(part_.part, reach_)) return;
  const auto from = part_.take(tissue::part_around(specimen.network, start_, rings));
  std::visit([&](auto& coupling) { coupling.begin_part(from); }, coupling_);
  contact_load(touch, part_, part_.load);
}

Vector PressedMesh::of_specimen(const Vector& of_part) const {
  Vector all = Vector::Zero(3 * part_.scene->specimen->network.nodes());
  for (std::size_t i = 0; i < part_.part.nodes.size(); ++i)
    all.segment<3>(3 * part_.part.nodes[i]) = of_part.segment<3>(3 * static_cast<Eigen::Index>(i));
  return all;
}

const integrate::State& PressedMesh::state() {
  part_.show();
  return part_.state;
}

Vector PressedMesh::displacement() {
  part_.show();
  Consistent* consistent = statics();
  Vector moved = consistent != nullptr ? consistent->displacement() : part_.state.displacement;
  if (const auto* moving = std::get_if<ConsistentWithInertia>(&coupling_))
    part_.add_dropped(moving->equivalent_load(), moved);
  return of_specimen(moved);
}

std::vector<double> PressedMesh::errors(const SphereContact& contact) {
  return statics()->errors(contact);
}

bool PressedMesh::inverted() {
  // There the mesh is loaded through the narrow patch, but its motion does not reach the force.
  if (part_.in_modes && statics() != nullptr) return false;
  part_.show();
  return tissue::inverted(part_.scene->specimen->mesh, of_specimen(part_.state.displacement));
}

double PressedMesh::edge_reaction() {
  Vector force;
  part_.body->force(part_.state.displacement, part_.state.memory, force);
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < part_.part.nodes.size(); ++i)
    if (part_.part.edge[i] != 0) sum += force.segment<3>(3 * static_cast<Eigen::Index>(i));
  return sum.norm();
}

std::optional<double> PressedMesh::imbalance() {
  if (part_.still) return std::nullopt;
  part_.show();
  return part_.monitor->imbalance();
}

bool PressedMesh::shows_slowly() const {
  return part_.equivalent && part_.freedoms() >= SymmetricSolver::large;
}

std::optional<PressedMesh::KeptModes> PressedMesh::kept_modes(const Touch& touch) {
  const auto* modal = std::get_if<integrate::Modal>(&part_.stepper->method());
  if (modal == nullptr || modal->keeps_all()) return std::nullopt;
  KeptModes kept{.count = modal->modes()};
  if (std::holds_alternative<ConsistentWithInertia>(coupling_) && touch.pressed() > 0.0) {
    Vector sunk = Vector::Zero(part_.freedoms());
    part_.add_dropped(part_.load, sunk);
    kept.dropped_share = sunk.dot(part_.load) / (touch.pressed() * touch.travel);
  }
  return kept;
}

double PressedMesh::solution_error() {
  const Consistent* consistent = statics();
  return std::max(part_.statics.error(),
                  consistent != nullptr ? consistent->solution_error() : 0.0);
}

}  // namespace palpate::mechanics
