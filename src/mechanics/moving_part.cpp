// The change from one part to another, steps under given forces, and loads by contacts.
#include "mechanics/moving_part.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "scenario/integrators.h"
#include "scene/first_touch.h"

namespace palpate::mechanics {
namespace {

using integrate::State;
using integrate::Vector;

tissue::Part first_part(const scene::Scene& scene) {
  const scene::Specimen& specimen = *scene.specimen;
  const auto& rings = scene.scenario.solver.rings;
  if (!rings) return tissue::whole_part(specimen.network);
  const auto& corners =
      specimen.surface->surface().triangles[as_index(scene::first_touch(scene).at.triangle)];
  std::vector<int> start;
  for (const int vertex : corners) start.push_back(specimen.outer_surface[as_index(vertex)]);
  return tissue::part_around(specimen.network, start, *rings);
}

const contact::Spread& loaded(const SphereContact& contact) {
  return contact.wide.vertices.empty() ? contact.load : contact.wide;
}

// Adds `force` (N) to the load of the nodes of a spread.
void add(const contact::Spread& spread, const Vec3& force, const MovingPart& part, Vector& load) {
  for (std::size_t k = 0; k < spread.vertices.size(); ++k) {
    const int node = part.node_of(spread.vertices[k]);
    if (node >= 0) load.segment<3>(3 * node) += spread.shares[k] * force;
  }
}

// Calls push(node, force in N) for every node that a contact loads, per contact.
template <class Push>
void push_nodes(const Touch& touch, const MovingPart& part, const Push& push) {
  for (const SphereContact& contact : touch.contacts) {
    const Vec3 whole = contact.drag - contact.force * contact.patch.normal;
    const contact::Spread& spread = loaded(contact);
    const std::vector<Vec3>& pushes = contact.nodal.push;
    for (std::size_t k = 0; k < spread.vertices.size(); ++k) {
      const int node = part.node_of(spread.vertices[k]);
      if (node >= 0)
        push(node, pushes.empty()
                       ? Vec3(spread.shares[k] * whole)
                       : Vec3(spread.shares[k] * contact.drag + contact.force * pushes[k]));
    }
  }
}

}  // namespace

MovingPart::MovingPart(const scene::Scene& whole) : scene(&whole) { (void)take(first_part(whole)); }

std::vector<Eigen::Index> MovingPart::take(tissue::Part next) {
  const scene::Specimen& specimen = *scene->specimen;
  const tissue::Part previous = std::exchange(part, std::move(next));
  const State old = std::exchange(state, {});
  std::vector<int> number(specimen.network.rest.size(), -1);
  for (std::size_t i = 0; i < part.nodes.size(); ++i)
    number[as_index(part.nodes[i])] = static_cast<int>(i);
  nodes.clear();
  for (const int node : specimen.outer_surface) nodes.push_back(number[as_index(node)]);

  std::vector<char> held(3 * part.nodes.size());
  for (std::size_t d = 0; d < held.size(); ++d)
    held[d] = part.edge[d / 3] != 0 ? 1 : specimen.held[3 * as_index(part.nodes[d / 3]) + d % 3];
  body.emplace(part.network, specimen.kinematics, specimen.law, held);
  const auto freedoms = static_cast<Eigen::Index>(held.size());
  state.time = old.time;
  state.displacement = Vector::Zero(freedoms);
  state.velocity = Vector::Zero(freedoms);
  std::vector<Eigen::Index> freedom_before(held.size(), -1);
  for (std::size_t i = 0; i < previous.nodes.size(); ++i) {
    const int now = number[as_index(previous.nodes[i])];
    if (now < 0) continue;
    const auto from = 3 * static_cast<Eigen::Index>(i);
    for (int axis = 0; axis < 3; ++axis) freedom_before[as_index(3 * now + axis)] = from + axis;
    if (part.edge[as_index(now)] != 0) continue;
    state.displacement.segment<3>(3 * now) = old.displacement.segment<3>(from);
    state.velocity.segment<3>(3 * now) = old.velocity.segment<3>(from);
  }
  body->memory_at(state.displacement, state.memory);
  if (body->linear()) {
    for (std::size_t d = 0; d < held.size(); ++d)
      if (freedom_before[d] >= 0 && part.edge[d / 3] == 0)
        body->inherit(old.memory, 3 * previous.nodes.size(), as_index(freedom_before[d]), d,
                      state.memory);
  } else {
    for (std::size_t s = 0; s < previous.springs.size(); ++s) {
      const auto now = std::ranges::lower_bound(part.springs, previous.springs[s]);
      if (now == part.springs.end() || *now != previous.springs[s]) continue;
      body->inherit(old.memory, previous.springs.size(), s, as_index(now - part.springs.begin()),
                    state.memory);
    }
  }
  load = Vector::Zero(freedoms);
  statics = SymmetricSolver();
  if (monitor)
    monitor->go_on(*body, state);
  else
    monitor.emplace(*body);
  stepper.emplace(*scene, *body, &statics);
  if (time_step > 0.0) stepper->set_step(time_step);
  return freedom_before;
}

void MovingPart::set_step(double size) {
  time_step = size;
  stepper->set_step(size);
  if (equivalent) equivalent->set_step(size);
}

std::optional<std::string> MovingPart::move(const Touch& touch) {
  if (in_modes) {
    auto& modal = std::get<integrate::Modal>(stepper->method());
    push_nodes(touch, *this, [&](int node, const Vec3& force) {
      for (int axis = 0; axis < 3; ++axis) modal.press(3 * node + axis, force[axis]);
    });
    modal.pass(state, time_step);
  }
  if (equivalent) {
    contact_load(touch, *this, load);
    equivalent->pass(load);
  }
  if (in_modes || still) {
    shown = false;
    return std::nullopt;
  }
  contact_load(touch, *this, other_load);
  auto wrong = stepper->step(state, load, other_load, integrate::MemoryRule::exact);
  load.swap(other_load);
  return wrong;
}

void MovingPart::show() {
  if (shown) return;
  shown = true;
  if (still) return respond(Response::statics, equivalent->load(), state.displacement);
  const auto& modal = std::get<integrate::Modal>(stepper->method());
  modal.show(state);
  if (equivalent) {
    add_dropped(equivalent->load(), state.displacement);
    body->memory_at(state.displacement, state.memory);
  }
  const auto energies = modal.energies();
  monitor->take_over(energies.work, energies.lost, energies.held);
}

bool MovingPart::keeps_responses() const {
  return body->linear() && !about(scene->scenario.solver.integrator).explicit_steps;
}

void MovingPart::respond(Response response, const Vector& given, Vector& moved) {
  if (response == Response::statics || response == Response::moving_statics) {
    moved.setZero(given.size());  // the result must not depend on what was asked before
    return respond(response, std::span(&given, 1), std::span(&moved, 1));
  }
  auto* modal = std::get_if<integrate::Modal>(&stepper->method());
  if (modal != nullptr && response == Response::whole_step) {
    // Modal bodies are linear: linearise() cannot fail.
    unloaded.setZero(given.size());
    (void)modal->linearise(state.displacement, unloaded);
    unloaded = modal->base();
    (void)modal->linearise(state.displacement, given);
    moved = modal->base() - unloaded;
    return;
  }
  std::visit(
      [&](const auto& method) {
        if constexpr (requires { method.response(given, moved); }) method.response(given, moved);
      },
      stepper->method());
}

void MovingPart::respond(Response response, std::span<const Vector> loads,
                         std::span<Vector> moved) {
  const auto* modal = std::get_if<integrate::Modal>(&stepper->method());
  if (response == Response::moving_statics && modal != nullptr && !modal->keeps_all()) {
    for (std::size_t k = 0; k < loads.size(); ++k) modal->kept(loads[k], moved[k]);
    return;
  }
  prepare(statics, *body);
  if (!statics.solve(loads, moved)) throw MeshError(tissue::not_held);
}

void MovingPart::add_dropped(const Vector& equivalent_load, Vector& moved) {
  const auto* modal = std::get_if<integrate::Modal>(&stepper->method());
  if (modal == nullptr || modal->keeps_all() || equivalent_load.size() == 0) return;
  modal->dropped(equivalent_load, unloaded);
  moved += unloaded;
}

void contact_load(const Touch& touch, const MovingPart& part, Vector& load) {
  load.setZero(part.freedoms());
  push_nodes(touch, part, [&](int node, const Vec3& force) { load.segment<3>(3 * node) += force; });
}

void drag_load(const Touch& touch, const MovingPart& part, Vector& load) {
  load.setZero(part.freedoms());
  for (const SphereContact& contact : touch.contacts)
    add(loaded(contact), contact.drag, part, load);
}

void finer_load(const Touch& touch, const MovingPart& part, Vector& load) {
  load.setZero(part.freedoms());
  for (const SphereContact& contact : touch.contacts) {
    const Vec3 push = contact.drag - contact.elastic * contact.patch.normal;
    add(contact.load, push, part, load);
    add(contact.wide, -push, part, load);
  }
}

}  // namespace palpate::mechanics
