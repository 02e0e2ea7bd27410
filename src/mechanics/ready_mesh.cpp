// Preparation of a mesh for a live run, after which solver steps allocate no memory.
#include "mechanics/pressed_mesh.h"

#include <cmath>

#include "contact/hertz.h"
#include "scenario/integrators.h"
#include "scene/first_touch.h"

namespace palpate::mechanics {
namespace {

// How far from its first touch the programme lets the finger press, with room for a hand that does
// not follow it closely, m.
double farthest_reach(const scene::Scene& scene) {
  double path = 4.0 * contact::hertz::contact_radius(
                          scene::deepest_travel(scene.scenario, scene.law()), scene.law().radius);
  path += scene.law().radius;
  for (const scenario::Step& step : scene.scenario.steps)
    if (const auto* slide = std::get_if<scenario::Slide>(&step)) path += std::abs(slide->by);
  return path;
}

}  // namespace

// Steps still allocate
// - for non-linear bodies: factors, in implicit steps at every linearisation, and in explicit steps
//   with dashpots between nodes whenever the dashpots have turned far;
// - for `resolved`: the equations of the nodes in contact;
// - for `solver.rings`: the new part and its influences when another part starts to move;
// - influences, once per node in contact, if all of them would take more than `most_answers`;
// - where a hand presses far beside the programme's path, once per vertex of the skin;
// - contacts beyond four per sphere, once each.
void PressedMesh::make_ready(Touch& touch) {
  constexpr double most_answers = 1e9;  // bytes
  for (Touch* one : {&rubbing_, &next_, &touch}) contacts_.make_room(*one);
  start_.reserve(contact::most_shares * touch.contacts.room());
  for (std::vector<char>* flags : {&reach_.inside, &reach_.moving})
    flags->reserve(specimen_->network.rest.size());

  // Steps at rest, without contact, change no state, but every method allocates its factors and
  // vectors in them; some methods do so only in their second step.
  const Vec3 place = touch.finger;
  const Vec3 away = scene::first_touch(*scene_).finger + specimen_->height() * Vec3::UnitZ();
  ContactHistory none(*scene_);
  // An error in these steps occurs again in the first real step, which reports it.
  for (const int i : {1, 2}) (void)step(away, i * time_step_, none, touch);
  state_.time = 0.0;
  touch.finger = place;

  if (beyond_) beyond_->make_ready(farthest_reach(*scene_));
  const Eigen::Index freedoms = state_.displacement.size();
  const bool answers = body_->linear() && !about(scene_->scenario.solver.integrator).explicit_steps;
  if (influence_ && (answers || inertia_))
    (void)influence_->ask_all(skin_nodes_, freedoms, most_answers);
  if (response_ && answers) (void)response_->ask_all(skin_nodes_, freedoms, most_answers);
}

}  // namespace palpate::mechanics
