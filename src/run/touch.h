// The contact of a finger with a mesh: which force balances its travel.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "base/cholesky.h"
#include "run/stepper.h"

namespace palpate::run {

// What the contact does at one moment.
struct Touch {
  double travel = 0.0;          // m
  double indentation = 0.0;     // m
  double force = 0.0;           // N
  double contact_radius = 0.0;  // m
  integrate::Vector load;       // N, on the mesh; empty without one
};

// The sinking of every node under a unit load on single nodes of the top, found when first asked
// for and kept. `respond` gives the displacement under a load, m.
class UnitResponses {
 public:
  using Respond = std::function<integrate::Vector(const integrate::Vector&)>;

  // The displacement under 1 N spread as `spread` says, m.
  [[nodiscard]] integrate::Vector under(const contact::Spread& spread, Eigen::Index freedoms,
                                        const Respond& respond);
  void clear() { known_.clear(); }

 private:
  std::map<int, integrate::Vector> known_;
};

// one_way and consistent: the force is a function of the travel alone, because the sinking that
// Hertz does not know is taken from statics: travel = h + (c - g) F, c the mesh's compliance where
// it is read and g the half-space's there. So the motion of the mesh cannot feed back on the force.
class StaticContact {
 public:
  StaticContact(const scene::Scene& scene, const scene::SpringBody& body);

  // Sets the touch to this travel, m. Returns what is wrong where nothing balances.
  [[nodiscard]] std::optional<std::string> touch(double travel, Touch& touch);

 private:
  const scene::Scene* scene_;
  contact::FlatContact contact_;
  Cholesky factors_;
  std::vector<char> held_;
  UnitResponses responses_;
};

// series: h = travel - u, u the sinking of the mesh under the contact, here and now.
class SeriesContact {
 public:
  SeriesContact(const scene::Scene& scene, const scene::SpringBody& body)
      : scene_(&scene), body_(&body), contact_(scene::make_contact(scene)) {}

  // Steps the state to its next time with the finger's travel there. Returns what is wrong where
  // no balance is found.
  [[nodiscard]] std::optional<std::string> step(Stepper& stepper, integrate::State& state,
                                                double travel, Touch& touch);

 private:
  template <class Linearised>
  [[nodiscard]] std::optional<std::string> balance(Linearised& method, double time_step,
                                                   integrate::State& state, double travel,
                                                   Touch& touch);

  const scene::Scene* scene_;
  const scene::SpringBody* body_;
  contact::FlatContact contact_;
  UnitResponses responses_;  // as long as the method's matrix stays
  double responses_step_ = 0.0;
};

}  // namespace palpate::run
