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

// Couples a flat contact to a stepped body. Serves one run.
class ContactStepper {
 public:
  ContactStepper(const scene::Scene& scene, const scene::SpringBody& body);

  // Begins the programme at a state, for steps of `time_step`; goes on with the method it has
  // where the step is the same.
  void begin(const integrate::State& state, const Touch& touch, double time_step);

  // Steps the state to its next time, with the finger's travel there. Returns what is wrong where
  // no balance is found.
  [[nodiscard]] std::optional<std::string> step(integrate::State& state, double travel,
                                                Touch& touch);

 private:
  [[nodiscard]] std::optional<std::string> touch_mesh(const integrate::Vector& displacement,
                                                      double travel, Touch& touch) const;
  template <class Linearised>
  [[nodiscard]] std::optional<std::string> balance(Linearised& method, integrate::State& state,
                                                   double travel, Touch& touch);
  [[nodiscard]] integrate::Vector load_of(const contact::Spread& spread, double force) const;

  const scene::Scene* scene_;
  const scene::SpringBody* body_;
  contact::FlatContact contact_;
  std::optional<Method> method_;
  double time_step_ = 0.0;
  // Responses to a unit load on one node, as long as the method's matrix stays.
  std::map<int, integrate::Vector> responses_;
};

}  // namespace palpate::run
