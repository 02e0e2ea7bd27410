// A press by the model `solid`: contacts, rows and findings.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/contacts.h"
#include "record/record.h"
#include "scene/scene.h"
#include "solid/finger_press.h"

namespace palpate::run {

// On one mesh; where `solver.tolerance` is below what it states, or a wall is thin, on two or
// three, extrapolated.
//                                                                docs/theory.md [solid_force]
class SolidPress {
 public:
  // The scene must outlive this. Tries to mesh a body that fail end after `longest_search` (s):
  // time decides whether there is a mesh, not which. Throws MeshError.
  explicit SolidPress(const scene::Scene& scene, double longest_search = 60.0);

  // The straight way sideways of a step, m beside the first touch, and how far along it the finger
  // is.
  struct Way {
    Vec3 start, end;
    double along = 0.0;
  };
  // Finds the force at touch.travel and sets the touch's contact, one for all spheres, to it.
  // Returns a sentence if there is no equilibrium. Throws Stopped.
  [[nodiscard]] std::optional<std::string> find(const Way& way, mechanics::Touch& touch);

  // What the last find() knows better than the touch: radius, pressure, spheres, error.
  void complete(record::ContactRow& row) const;

  void add_findings(record::CaseRecord& record) const;

  // The finest mesh without the middles of edges, m: of the part of the body that mirrors make
  // whole.
  [[nodiscard]] geometry::TetMesh corners() const;

  [[nodiscard]] std::size_t meshes() const { return presses_.size(); }
  // The displaced surface under a touch of find(), on a mesh counted from the coarsest; empty
  // without contact.
  [[nodiscard]] solid::FingerPress::OuterSurface surface(std::size_t mesh,
                                                         const mechanics::Touch& touch);

  // On the finest mesh.
  [[nodiscard]] record::PressureMap map(const mechanics::Touch& touch);

 private:
  // The surface of a file as the mesh takes it.
  enum class Surface { smooth, flat, unchanged, split };
  // Makes the presses, and again with simpler bodies where one cannot be meshed. Throws MeshError.
  void make();
  // Whether there is a simpler body, which is then taken: smaller inclusions, then flat triangles,
  // then those of the file alone, then the same with edges that are only split.
  [[nodiscard]] bool simpler();
  [[nodiscard]] const scene::SolidBody& body() const { return flat_ ? *flat_ : *scene_->solid; }
  [[nodiscard]] solid::FingerOrder order(double per_radius) const;

  const scene::Scene* scene_;
  double longest_search_;  // s
  Surface surface_ = Surface::smooth;
  bool included_ = false;        // balls of another tissue
  double inclusion_size_ = 1.0;  // of their radii
  std::optional<scene::SolidBody> flat_;
  std::vector<std::unique_ptr<solid::FingerPress>> presses_;  // coarsest mesh first
  std::vector<double> asked_, per_radius_;  // elements in the contact radius: wanted, and taken
  double deepest_ = 0.0;                    // m, travel
  double width_ = 1.0;    // of the contact across a sharp edge, over that on a flat
  double finer_ = 1.0;    // elements than asked for, in a thin wall or a skin
  bool on_skin_ = false;  // a stiff and thin one on softer tissue
  solid::Moment now_;
  double error_ = 0.0;      // of the last force, a fraction of it
  double wall_ = HUGE_VAL;  // m, thickness under the finger where nothing holds the other side
};

}  // namespace palpate::run
