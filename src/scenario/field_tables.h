// The keys of tables without alternatives, and the conditions under which keys have an effect.
#pragma once

#include "scenario/scenario.h"

namespace palpate::scenario {

struct Conditions {
  Use mesh;          // keys of a mesh, which are ignored without one
  Use finger;        // physics of a finger
  Use mesh_physics;  // physics that only a mesh can represent
  Use pressed_mesh;  // keys of a mesh under a finger, ignored without one
  Use springs;       // of independent springs
  Use based;         // of specimens with a base: a mesh or a layer
  Use formula;       // keys of models without a mesh, which are ignored with one

  explicit Conditions(const Scenario& scenario);
};

void finger_fields(FieldVisitor& visitor, Finger& finger);
void contact_fields(FieldVisitor& visitor, Contact& contact, const Conditions& use);
void device_fields(FieldVisitor& visitor, Device& device);
void solver_fields(FieldVisitor& visitor, Solver& solver, const Conditions& use);
void output_fields(FieldVisitor& visitor, Output& output, const Conditions& use);

}  // namespace palpate::scenario
