// The layout of eight bodies in lanes, and the choice of instructions.
#include "tissue/lane_springs.h"

#include <algorithm>
#include <array>
#include <bit>

#include "tissue/edge_form.h"
#include "tissue/lane_data.h"

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"  // all functions that take vectors are inlined
#endif

#define PALPATE_LOOPS lanes_portable
#define PALPATE_TARGET
#define PALPATE_WIDTH 2
#include "tissue/lane_loops.h"
#undef PALPATE_LOOPS
#undef PALPATE_TARGET
#undef PALPATE_WIDTH

#if defined(__x86_64__)
#define PALPATE_LOOPS lanes_avx2
#define PALPATE_TARGET __attribute__((target("avx2")))
#define PALPATE_WIDTH 4
#include "tissue/lane_loops.h"
#undef PALPATE_LOOPS
#undef PALPATE_TARGET
#undef PALPATE_WIDTH

#define PALPATE_LOOPS lanes_avx512
#define PALPATE_TARGET __attribute__((target("avx512f")))
#define PALPATE_WIDTH 8
#include "tissue/lane_loops.h"
#undef PALPATE_LOOPS
#undef PALPATE_TARGET
#undef PALPATE_WIDTH
#endif

namespace palpate::tissue {
SparseLoad sparse(const Vector& load) {
  SparseLoad few;
  for (Eigen::Index d = 0; d < load.size(); ++d) {
    if (std::bit_cast<std::uint64_t>(load[d]) == 0) continue;
    few.freedoms.push_back(static_cast<std::int32_t>(d));
    few.forces.push_back(load[d]);
  }
  return few;
}

struct LaneSprings::Layout {
  LaneData data;
  LanePasses passes;
  std::vector<std::int32_t> first, second, beginning, ending_start, ending, loaded;
  std::vector<double> along;
  std::vector<Eight> stiffness, displacement, moved, force, tension, memory;
  std::vector<Eight> keep, begin, end, ratio;
  std::vector<Eight> mass, inverse, load_before, load_after;
  Eight square, rate, drag, drag_step, jumped;
  EdgeForm form;  // of coupled springs, without the stiffness
  std::vector<Eight> block, turn, weight, pressure;
  Eight kinetic, work, stored, lost, moved_squares;

  struct Lane {
    LaneStep step;
    std::vector<char> held;
    std::vector<double> branch_times;                 // s
    std::array<std::vector<std::int32_t>, 2> loaded;  // freedoms, before and after
    bool first = false;                               // the next step is the first of a series
    LaneEnergies energies;
  };
  std::array<Lane, width> lanes;

  void lay(const Network& network);
  void lay_couplings(const Network& network);
  void connect();
  void take_load_off(std::size_t lane);
  void set_square(std::size_t lane);
};

void LaneSprings::Layout::lay(const Network& network) {
  const std::size_t nodes = network.rest.size();
  const std::size_t springs = network.ends.size();
  beginning.assign(nodes + 1, 0);
  ending_start.assign(nodes + 1, 0);
  ending.resize(springs);
  for (const auto& [a, b] : network.ends) {
    first.push_back(a);
    second.push_back(b);
    ++beginning[as_index(a) + 1];
    ++ending_start[as_index(b) + 1];
  }
  for (std::size_t n = 0; n < nodes; ++n) {
    beginning[n + 1] += beginning[n];
    ending_start[n + 1] += ending_start[n];
  }
  std::vector<std::int32_t> next(ending_start);
  for (std::size_t s = 0; s < springs; ++s)
    ending[as_index(next[as_index(second[s])]++)] = static_cast<std::int32_t>(s);
  for (auto* values : {&displacement, &moved, &force, &load_before, &load_after, &inverse})
    values->resize(3 * nodes);
  mass.resize(nodes);
  loaded.assign(nodes, 0);
  stiffness.resize(springs);
  tension.resize(springs);
}

void LaneSprings::Layout::lay_couplings(const Network& network) {
  data.coupled = !network.coupled.empty() || !network.volumes.empty();
  if (!data.coupled) return;
  form = edge_form(network);
  block.resize(form.block.size());
  turn.resize(form.turn.size());
  weight.resize(form.weight.size());
  pressure.resize(form.weight.size());
  force.resize(std::max(force.size(), 3 * weight.size()));
}

void LaneSprings::Layout::connect() {
  const auto numbers = [](std::vector<Eight>& values) {
    return values.empty() ? nullptr : values.front().lane;
  };
  const bool coupled = data.coupled;
  data = {.nodes = mass.size(),
          .springs = stiffness.size(),
          .branches = ratio.size(),
          .coupled = coupled,
          .first = first.data(),
          .second = second.data(),
          .beginning = beginning.data(),
          .ending_start = ending_start.data(),
          .ending = ending.data(),
          .along = along.data(),
          .stiffness = numbers(stiffness),
          .displacement = numbers(displacement),
          .moved = numbers(moved),
          .force = numbers(force),
          .tension = numbers(tension),
          .memory = numbers(memory),
          .keep = numbers(keep),
          .begin = numbers(begin),
          .end = numbers(end),
          .ratio = numbers(ratio),
          .mass = numbers(mass),
          .inverse = numbers(inverse),
          .square = square.lane,
          .rate = rate.lane,
          .drag = drag.lane,
          .jumped = jumped.lane,
          .drag_step = drag_step.lane,
          .load_before = numbers(load_before),
          .load_after = numbers(load_after),
          .loaded = loaded.data(),
          .edges = form.edges(),
          .inner = form.inner,
          .slots = weight.size(),
          .edge_ends = form.ends.data(),
          .edge_slots = form.slots.data(),
          .change = form.change.data(),
          .block = numbers(block),
          .turn = numbers(turn),
          .weight = numbers(weight),
          .pressure = numbers(pressure),
          .kinetic = kinetic.lane,
          .work = work.lane,
          .stored = stored.lane,
          .lost = lost.lane,
          .moved_squares = moved_squares.lane};
}

bool LaneSprings::can(const Network& network, const ViscousLaw& law) {
  if (law.kind == Viscosity::kelvin_voigt) return false;
  // A node's forces are summed in the order of the springs only if the springs are sorted.
  if (!std::is_sorted(network.ends.begin(), network.ends.end())) return false;
  const bool coupled = !network.coupled.empty() || !network.volumes.empty();
  return !coupled || (law.branches.empty() && has_edge_form(network));
}

bool LaneSprings::alike(const Network& a, const Network& b) {
  if (a.ends != b.ends || a.rest != b.rest || a.direction != b.direction ||
      a.coupled.size() != b.coupled.size() || a.volumes.size() != b.volumes.size())
    return false;
  return (a.coupled.empty() && a.volumes.empty()) || edge_form(a).alike(edge_form(b));
}

LaneSprings::LaneSprings(const Network& network, const ViscousLaw& law, Lanes lanes)
    : layout_(std::make_unique<Layout>()) {
  Layout& layout = *layout_;
  layout.lay(network);
  for (const Vec3& along : network.direction)
    layout.along.insert(layout.along.end(), along.begin(), along.end());
  layout.lay_couplings(network);
  for (auto* values : {&layout.keep, &layout.begin, &layout.end, &layout.ratio})
    values->resize(law.branches.size());
  if (!law.branches.empty()) layout.memory.resize((1 + law.branches.size()) * network.ends.size());
  layout.connect();
  layout.passes = lanes_portable::choose(layout.data, law.kind);
#if defined(__x86_64__)
  if (lanes == Lanes::portable) return;
  if (__builtin_cpu_supports("avx512f"))
    layout.passes = lanes_avx512::choose(layout.data, law.kind);
  else if (__builtin_cpu_supports("avx2"))
    layout.passes = lanes_avx2::choose(layout.data, law.kind);
#endif
}

LaneSprings::~LaneSprings() = default;
LaneSprings::LaneSprings(LaneSprings&&) noexcept = default;
LaneSprings& LaneSprings::operator=(LaneSprings&&) noexcept = default;

void LaneSprings::enter(std::size_t lane, const Network& network, const ViscousLaw& law,
                        std::span<const char> held) {
  leave(lane);
  Layout& layout = *layout_;
  Layout::Lane& own = layout.lanes[lane];
  own.held.assign(held.begin(), held.end());
  for (std::size_t n = 0; n < network.node_mass.size(); ++n)
    layout.mass[n].lane[lane] = network.node_mass[n];
  for (std::size_t s = 0; s < network.stiffness.size(); ++s)
    layout.stiffness[s].lane[lane] = network.stiffness[s];
  if (layout.data.coupled) {
    const EdgeForm form = edge_form(network);
    const auto fill = [&](const std::vector<double>& from, std::vector<Eight>& to) {
      for (std::size_t i = 0; i < from.size(); ++i) to[i].lane[lane] = from[i];
    };
    fill(form.block, layout.block);
    fill(form.turn, layout.turn);
    fill(form.weight, layout.weight);
  }
  layout.drag.lane[lane] = law.kind == Viscosity::nodal_drag ? law.drag : 0.0;
  own.branch_times.clear();
  for (std::size_t i = 0; i < law.branches.size(); ++i) {
    own.branch_times.push_back(law.branches[i].time);
    layout.ratio[i].lane[lane] = law.branches[i].ratio;
  }
}

void LaneSprings::place(std::size_t lane, const Standing& standing) {
  Layout& layout = *layout_;
  for (std::size_t d = 0; d < layout.displacement.size(); ++d) {
    const auto i = static_cast<Eigen::Index>(d);
    layout.displacement[d].lane[lane] = (*standing.displacement)[i];
    layout.moved[d].lane[lane] = (*standing.velocity)[i];
    layout.force[d].lane[lane] = (*standing.force)[i];
  }
  layout.rate.lane[lane] = 1.0;  // until begin(), `moved` contains the velocity
  for (std::size_t i = 0; i < layout.memory.size(); ++i)
    layout.memory[i].lane[lane] = standing.memory[i];
}

void LaneSprings::Layout::set_square(std::size_t lane) {
  const Lane& own = lanes[lane];
  const double time_step = own.step.time_step;
  const bool consistent = own.first && own.step.consistent;
  square.lane[lane] = (consistent ? 1.0 : 2.0) * time_step * time_step;
  drag_step.lane[lane] = consistent ? 0.0 : time_step;
}

void LaneSprings::begin(std::size_t lane, const LaneStep& step) {
  Layout& layout = *layout_;
  Layout::Lane& own = layout.lanes[lane];
  own.step = step;
  own.first = true;
  layout.set_square(lane);
  const double time_step = step.time_step;
  const double rate = layout.rate.lane[lane];
  for (Eight& moved : layout.moved)
    moved.lane[lane] = step.consistent ? time_step * (rate * moved.lane[lane]) : 0.0;
  layout.rate.lane[lane] = 1.0 / time_step;
  for (std::size_t d = 0; d < layout.inverse.size(); ++d) {
    const double mass = layout.mass[d / 3].lane[lane];
    const double diagonal = 2.0 * mass + time_step * (layout.drag.lane[lane] * mass);
    layout.inverse[d].lane[lane] = own.held[d] != 0 ? 0.0 : 1.0 / diagonal;
  }
  for (std::size_t i = 0; i < own.branch_times.size(); ++i) {
    const MemoryStep passage = MemoryStep::exact(time_step, own.branch_times[i]);
    layout.keep[i].lane[lane] = passage.keep;
    layout.begin[i].lane[lane] = passage.begin;
    layout.end[i].lane[lane] = passage.end;
  }
}

void LaneSprings::Layout::take_load_off(std::size_t lane) {
  for (std::size_t i = 0; i < 2; ++i) {
    for (const std::int32_t d : lanes[lane].loaded[i]) {
      (i == 0 ? load_before : load_after)[as_index(d)].lane[lane] = 0.0;
      --loaded[as_index(d) / 3];
    }
    lanes[lane].loaded[i].clear();
  }
}

void LaneSprings::load(std::size_t lane, const SparseLoad& before, const SparseLoad& after) {
  Layout& layout = *layout_;
  layout.take_load_off(lane);
  const auto put = [&](const SparseLoad& load, std::vector<Eight>& to,
                       std::vector<std::int32_t>& own) {
    own = load.freedoms;
    for (std::size_t k = 0; k < load.freedoms.size(); ++k) {
      to[as_index(load.freedoms[k])].lane[lane] = load.forces[k];
      ++layout.loaded[as_index(load.freedoms[k]) / 3];
    }
  };
  auto& own = layout.lanes[lane].loaded;
  put(before, layout.load_before, own[0]);
  put(after, layout.load_after, own[1]);
  layout.jumped.lane[lane] = 0.0;
}

void LaneSprings::jump(std::size_t lane) { layout_->jumped.lane[lane] = 1.0; }

void LaneSprings::leave(std::size_t lane) {
  Layout& layout = *layout_;
  Layout::Lane& own = layout.lanes[lane];
  layout.take_load_off(lane);
  own = {};
  for (auto* values :
       {&layout.displacement, &layout.moved, &layout.force, &layout.inverse, &layout.stiffness,
        &layout.memory, &layout.block, &layout.turn, &layout.weight})
    for (Eight& value : *values) value.lane[lane] = 0.0;
}

void LaneSprings::step() {
  Layout& layout = *layout_;
  layout.passes.advance(layout.data);
  layout.passes.springs(layout.data);
  for (std::size_t lane = 0; lane < width; ++lane) {
    Layout::Lane& own = layout.lanes[lane];
    own.energies = {
        layout.work.lane[lane], layout.kinetic.lane[lane], layout.stored.lane[lane],
        layout.drag.lane[lane] != 0.0 ? layout.moved_squares.lane[lane] : layout.lost.lane[lane]};
    if (!own.first) continue;
    own.first = false;
    layout.set_square(lane);
  }
}

const LaneEnergies& LaneSprings::energies(std::size_t lane) const {
  return layout_->lanes[lane].energies;
}

void LaneSprings::displacement(std::size_t lane, Vector& displacement) const {
  const auto& from = layout_->displacement;
  displacement.resize(static_cast<Eigen::Index>(from.size()));
  for (std::size_t d = 0; d < from.size(); ++d)
    displacement[static_cast<Eigen::Index>(d)] = from[d].lane[lane];
}

void LaneSprings::force(std::size_t lane, Vector& force) const {
  const auto& from = layout_->force;  // of slots too
  force.resize(static_cast<Eigen::Index>(layout_->displacement.size()));
  for (Eigen::Index d = 0; d < force.size(); ++d) force[d] = from[as_index(d)].lane[lane];
}

}  // namespace palpate::tissue
