// Newton iterations of steps with contact, and the mesh's compliances C_ij of docs/theory.md (15).
#include <cmath>

#include "mechanics/couplings.h"
#include "mechanics/monitor.h"
#include "scenario/integrators.h"

namespace palpate::mechanics {

using integrate::MemoryRule;
using integrate::Vector;

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
// the correct one.                                                       docs/theory.md, below (73)
std::optional<std::string> Resolved::step(const StepTo& to) {
  const auto find = [&](const Vector& displacement, Touch& now) {
    return contact_.find(to.finger, displacement, influence, now);
  };
  return step_by(MemoryRule::first_order, find, to.touch);
}

std::optional<std::string> OnSolid::step(const StepTo& to) {
  if (auto wrong = contact_.press(to.finger, part->state.displacement, to.touch)) return wrong;
  contact_load(to.touch, *part, part->load);
  return std::nullopt;
}

}  // namespace palpate::mechanics
