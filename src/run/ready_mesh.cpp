// What a mesh under a live finger has done before the first step, so that no step takes memory.
#include "run/pressed_mesh.h"
#include "scenario/integrators.h"
#include "scene/first_touch.h"

namespace palpate::run {

// Still allocated in steps:
// - non-linear bodies in implicit steps: factors, at every linearisation; and in explicit ones with
//   dashpots between nodes: factors, whenever these have turned far;
// - `resolved`: the systems of the nodes that touch;
// - `solver.rings`: when another part moves, all that it consists of and its answers to loads;
// - answers to loads, once a node that is touched, where all would take more than `most_answers`;
// - contacts beyond four a sphere, once each.
void PressedMesh::make_ready(Touch& touch) {
  constexpr double most_answers = 1e9;  // bytes
  for (Touch* one : {&rubbing_, &next_, &touch}) contacts_.make_room(*one);
  start_.reserve(contact::most_shares * touch.contacts.room());
  for (std::vector<char>* flags : {&reach_.inside, &reach_.moving})
    flags->reserve(specimen_->network.rest.size());

  // Steps at rest, with the finger off the skin, leave zeros everywhere, and every method with its
  // factors, its memory and its vectors: some take them with their second step alone.
  const Vec3 place = touch.finger;
  const Vec3 away = scene::first_touch(*scene_).finger + specimen_->height() * Vec3::UnitZ();
  ContactHistory none(*scene_);
  // What is wrong with them is wrong with the next one, too, where it is told.
  for (const int i : {1, 2}) (void)step(away, i * time_step_, none, touch);
  state_.time = 0.0;
  touch.finger = place;

  const Eigen::Index freedoms = state_.displacement.size();
  const bool answers =
      body_->linear() && !scenario::explicit_steps(scene_->scenario.solver.integrator);
  if (influence_ && (answers || inertia_ || forces_follow_finger()))
    (void)influence_->ask_all(skin_nodes_, freedoms, most_answers);
  if (one_tissue_) (void)one_tissue_->ask_all(skin_nodes_, freedoms, most_answers);
  if (response_ && answers) (void)response_->ask_all(skin_nodes_, freedoms, most_answers);
}

}  // namespace palpate::run
