// The tables of a scenario that have no alternatives, and when their keys count.
#pragma once

#include "scenario/scenario.h"

namespace palpate::scenario {

struct Conditions {
  Use mesh;          // machinery of a mesh: left unread without one
  Use finger;        // physics of a finger
  Use mesh_physics;  // physics that only a mesh can honour
  Use pressed_mesh;  // machinery of a mesh under a finger
  Use springs;       // of independent springs
  Use based;         // what stands on something: a mesh or a layer

  explicit Conditions(const Scenario& scenario);
};

void finger_fields(FieldVisitor& visitor, Finger& finger);
void contact_fields(FieldVisitor& visitor, Contact& contact, const Conditions& use);
void device_fields(FieldVisitor& visitor, Device& device);
void solver_fields(FieldVisitor& visitor, Solver& solver, const Conditions& use);
void output_fields(FieldVisitor& visitor, Output& output, const Conditions& use);

}  // namespace palpate::scenario
