// The contact inside a step: which force balances the finger's travel and the mesh's sinking.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>

#include "integrate/central_difference.h"
#include "integrate/implicit.h"
#include "integrate/modal.h"
#include "scene/scene.h"

namespace palpate::run {

using Method = std::variant<integrate::CentralDifference, integrate::Implicit, integrate::Modal>;

// The method that the scenario names, for steps of `time_step` seconds.
[[nodiscard]] Method make_method(const scene::Scene& scene, const scene::SpringBody& body,
                                 double time_step);

// What the contact does at one moment.
struct Touch {
  double travel = 0.0;          // m
  double indentation = 0.0;     // m
  double force = 0.0;           // N
  double contact_radius = 0.0;  // m
  integrate::Vector load;       // N, on the mesh; empty without one
};

// What the half-space in a contact sinks where the mesh is read, with the tissue's own viscosity:
// past + slope * g F at the end of a step, F the force then and g its elastic compliance.
class SelfSinking {
 public:
  explicit SelfSinking(const tissue::ViscousLaw& law) : law_(law) {}

  void begin(double time_step);
  [[nodiscard]] double past() const;
  [[nodiscard]] double slope() const;
  void finish(double elastic);  // g F, m

 private:
  tissue::ViscousLaw law_;
  tissue::MemoryStep step_ = tissue::MemoryStep::at_once();
  double share_ = 0.0;    // of the sinking that takes time
  double before_ = 0.0;   // g F at the start of the step, m
  double delayed_ = 0.0;  // the sinking that takes time, m
};

// Couples a flat contact to a stepped body. Serves one run.
class ContactStepper {
 public:
  ContactStepper(const scene::Scene& scene, const scene::SpringBody& body);

  // The next steps have this size, s. A method that can change its step goes on.
  void begin(double time_step);

  // Steps the state to its next time, with the finger's travel there. Returns what is wrong where
  // no balance is found.
  [[nodiscard]] std::optional<std::string> step(integrate::State& state, double travel,
                                                Touch& touch);

 private:
  [[nodiscard]] std::optional<std::string> touch_mesh(const integrate::Vector& displacement,
                                                      double travel, Touch& touch);
  template <class Linearised>
  [[nodiscard]] std::optional<std::string> balance(Linearised& method, integrate::State& state,
                                                   double travel, Touch& touch);
  [[nodiscard]] integrate::Vector load_of(const contact::Spread& spread, double force) const;

  const scene::Scene* scene_;
  const scene::SpringBody* body_;
  contact::FlatContact contact_;
  SelfSinking self_;
  std::optional<Method> method_;
  double time_step_ = 0.0;
  // Responses to a unit load on one node, as long as the method's matrix stays.
  std::map<int, integrate::Vector> responses_;
};

}  // namespace palpate::run
