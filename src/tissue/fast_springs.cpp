// The layout of a network for one pass, and the choice of instructions.
#include "tissue/fast_springs.h"

#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "tissue/edge_form.h"
#include "tissue/fast_edges.h"
#include "tissue/fast_node.h"

// Vectors of four are only passed to inlined functions, so that the ABI warning does not apply.
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace palpate::tissue {
namespace {

enum class Passage { look, remember };

// Springs in groups of four. The last group is filled up with springs without stiffness, whose two
// ends are an additional node that is in no network.
struct FastSpringData {
  std::size_t springs = 0;
  std::size_t memory_size = 0;  // numbers per spring
  bool coupled = false;
  const std::int32_t* ends = nullptr;   // 2 per spring
  const double* along = nullptr;        // 3 per spring: direction, or if not linear, span at rest
  const double* rest_length = nullptr;  // m
  const double* stiffness = nullptr;    // N/m
  const double* ratios = nullptr;       // of the branches
  const MemoryStep* steps = nullptr;    // of this pass
  double* few = nullptr;                // memory of four springs
  double* elongation = nullptr;         // m, where coupled
  double* effective = nullptr;          // m, where coupled
  double* tension = nullptr;            // N, where coupled
  std::size_t tetrahedra = 0;           // in groups of four
  const std::int32_t* six_springs = nullptr;  // 24 per group: 6 springs of 4 tetrahedra
  const double* six_stiffness = nullptr;      // 84 per group: 21 entries of 4 lower triangles
  std::size_t volumes = 0;
  const std::int32_t* volume_start = nullptr;
  const std::int32_t* volume_springs = nullptr;
  const double* dilation = nullptr;          // 1/m
  const double* volume_stiffness = nullptr;  // N m
};

using Springs = void (*)(const FastSpringData&, FastNode*, double* memory, double* energies);
using Pulls = void (*)(const FastSpringData&, FastNode*);
using Place = void (*)(const double* from, FastNode*, std::size_t count);
using Collect = void (*)(const FastNode*, double* to, std::size_t count);
using Turn = void (*)(const FastSpringData&, const FastNode*, double* direction);
using Tensions = void (*)(const FastSpringData&);
using CoupledEnergies = void (*)(const FastSpringData&, const double*, const double*, double*);

}  // namespace
}  // namespace palpate::tissue

// Instructions that every processor has: on x86 two numbers at a time, elsewhere whatever the
// compiler makes of them.
#define PALPATE_LOOPS portable
#define PALPATE_TARGET
#if defined(__x86_64__)
#define PALPATE_ROOT(x)                                                     \
  __builtin_shufflevector(_mm_sqrt_pd(__builtin_shufflevector(x, x, 0, 1)), \
                          _mm_sqrt_pd(__builtin_shufflevector(x, x, 2, 3)), 0, 1, 2, 3)
#else
#define PALPATE_ROOT(x) \
  (Four{__builtin_sqrt(x[0]), __builtin_sqrt(x[1]), __builtin_sqrt(x[2]), __builtin_sqrt(x[3])})
#endif
#include "tissue/fast_loops.h"
#undef PALPATE_LOOPS
#undef PALPATE_TARGET
#undef PALPATE_ROOT

#if defined(__x86_64__)
#define PALPATE_LOOPS avx2
#define PALPATE_TARGET __attribute__((target("avx2")))
#define PALPATE_ROOT(x) _mm256_sqrt_pd(x)
#include "tissue/fast_loops.h"
#undef PALPATE_LOOPS
#undef PALPATE_TARGET
#undef PALPATE_ROOT
#endif

namespace palpate::tissue {

struct FastSprings::Layout {
  FastSpringData data;
  Springs looking = nullptr;
  Springs remembering = nullptr;
  Place to_nodes = nullptr;
  Collect collect = nullptr;
  Pulls pulls = nullptr;
  Turn turn = nullptr;
  Tensions tensions = nullptr;
  CoupledEnergies coupled_energies = nullptr;
  bool dashpots = false;  // of Kelvin-Voigt
  bool branches = false;

  std::optional<FastEdges> edges;  // if it takes the place of all below
  std::vector<FastNode> nodes;     // and the additional node of the last group
  std::vector<std::int32_t> ends;
  std::vector<double> along;
  std::vector<double> rest_length;
  std::vector<double> stiffness;
  std::vector<double> ratios;
  std::vector<double> few;
  std::vector<double> elongation;
  std::vector<double> effective;
  std::vector<double> tension;
  std::vector<double> elongation_before;
  std::vector<double> tension_before;
  std::vector<std::int32_t> six_springs;
  std::vector<double> six_stiffness;
  std::vector<std::int32_t> volume_start;
  std::vector<std::int32_t> volume_springs;
  std::vector<double> dilation;
  std::vector<double> volume_stiffness;

  std::vector<double> at;      // displacement of the last pass, 3 per node
  std::vector<double> from;    // and of the pass before
  std::vector<double> memory;  // after the last pass, if there are branches
  bool passed = false;
  bool passed_before = false;
  bool has_energies = false;
  Energies energies;

  void lay_springs(const Network& network, Kinematics kinematics);
  void lay_couplings(const Network& network);
  void choose(Kinematics kinematics, Viscosity viscosity, Lanes lanes);
  void place(const Vector& displacement);
  void finish();
};

void FastSprings::Layout::lay_springs(const Network& network, Kinematics kinematics) {
  const auto nobody = static_cast<std::int32_t>(network.rest.size());
  const std::size_t count = network.ends.size();
  const std::size_t padded = (count + 3) / 4 * 4;
  nodes.resize(network.rest.size() + 1);
  ends.assign(2 * padded, nobody);
  along.assign(3 * padded + 4, 0.0);  // loads read four numbers, so the last one reads beyond
  rest_length.assign(padded, 1.0);
  stiffness.assign(padded, 0.0);
  for (std::size_t s = 0; s < count; ++s) {
    const auto [a, b] = network.ends[s];
    ends[2 * s] = a;
    ends[2 * s + 1] = b;
    const Vec3 rest = network.rest[as_index(b)] - network.rest[as_index(a)];
    for (int axis = 0; axis < 3; ++axis)
      along[3 * s + as_index(axis)] =
          kinematics == Kinematics::linear ? network.direction[s][axis] : rest[axis];
    rest_length[s] = network.rest_length[s];
    stiffness[s] = network.stiffness[s];
  }
  data.springs = count;
  data.ends = ends.data();
  data.along = along.data();
  data.rest_length = rest_length.data();
  data.stiffness = stiffness.data();
}

void FastSprings::Layout::lay_couplings(const Network& network) {
  data.coupled = !network.coupled.empty() || !network.volumes.empty();
  if (!data.coupled) return;
  // One group beyond the springs, for the tetrahedra that fill up the last group.
  const std::size_t room = (data.springs + 3) / 4 * 4 + 4;
  for (auto* values : {&elongation, &effective, &tension, &elongation_before, &tension_before})
    values->assign(room, 0.0);
  const std::size_t groups = (network.coupled.size() + 3) / 4;
  six_springs.assign(24 * groups, static_cast<std::int32_t>(room - 1));
  six_stiffness.assign(84 * groups, 0.0);
  for (std::size_t t = 0; t < network.coupled.size(); ++t) {
    const CoupledSprings& six = network.coupled[t];
    const std::size_t group = t / 4;
    const std::size_t lane = t % 4;
    for (std::size_t i = 0; i < 6; ++i) {
      six_springs[24 * group + 4 * i + lane] = six.springs[i];
      for (std::size_t j = 0; j <= i; ++j)
        six_stiffness[84 * group + 4 * (i * (i + 1) / 2 + j) + lane] =
            six.stiffness(static_cast<int>(i), static_cast<int>(j));
    }
  }
  volume_start.assign(1, 0);
  for (const SharedVolume& volume : network.volumes) {
    volume_springs.insert(volume_springs.end(), volume.springs.begin(), volume.springs.end());
    dilation.insert(dilation.end(), volume.dilation.begin(), volume.dilation.end());
    volume_start.push_back(static_cast<std::int32_t>(volume_springs.size()));
    volume_stiffness.push_back(volume.stiffness);
  }
  data.elongation = elongation.data();
  data.effective = effective.data();
  data.tension = tension.data();
  data.tetrahedra = 4 * groups;
  data.six_springs = six_springs.data();
  data.six_stiffness = six_stiffness.data();
  data.volumes = network.volumes.size();
  data.volume_start = volume_start.data();
  data.volume_springs = volume_springs.data();
  data.dilation = dilation.data();
  data.volume_stiffness = volume_stiffness.data();
}

void FastSprings::Layout::choose(Kinematics kinematics, Viscosity viscosity, Lanes lanes) {
  looking = portable::choose(kinematics, viscosity, Passage::look);
  remembering = portable::choose(kinematics, viscosity, Passage::remember);
  to_nodes = &portable::place;
  collect = &portable::collect;
  pulls = portable::choose_pulls(kinematics);
  turn = portable::choose_turn(kinematics);
  tensions = &portable::tensions;
  coupled_energies = &portable::coupled_energies;
#if defined(__x86_64__)
  if (lanes == Lanes::portable || !__builtin_cpu_supports("avx2")) return;
  looking = avx2::choose(kinematics, viscosity, Passage::look);
  remembering = avx2::choose(kinematics, viscosity, Passage::remember);
  to_nodes = &avx2::place;
  collect = &avx2::collect;
  pulls = avx2::choose_pulls(kinematics);
  turn = avx2::choose_turn(kinematics);
  tensions = &avx2::tensions;
  coupled_energies = &avx2::coupled_energies;
#endif
}

// Copies displacements to the nodes and clears their forces.
void FastSprings::Layout::place(const Vector& displacement) {
  at.swap(from);
  passed_before = passed;
  passed = true;
  std::memcpy(at.data(), displacement.data(), at.size() * sizeof(double));
  if (edges)
    edges->pass(displacement);
  else
    to_nodes(displacement.data(), nodes.data(), nodes.size() - 1);
}

void FastSprings::Layout::finish() {
  if (!data.coupled) return;
  tensions(data);
  pulls(data, nodes.data());
}

FastSprings::FastSprings(const Network& network, Kinematics kinematics, const ViscousLaw& law,
                         Turning turning, Lanes lanes)
    : layout_(std::make_unique<Layout>()) {
  Layout& layout = *layout_;
  layout.at.assign(3 * network.rest.size(), 0.0);
  layout.from = layout.at;
  const bool coupled = !network.coupled.empty() || !network.volumes.empty();
  if (coupled && kinematics == Kinematics::linear && turning == Turning::never &&
      memory_size(law) == 0 && has_edge_form(network)) {
    layout.edges.emplace(network, lanes);
    return;
  }
  layout.lay_springs(network, kinematics);
  layout.lay_couplings(network);
  for (const Branch& branch : law.branches) layout.ratios.push_back(branch.ratio);
  layout.branches = !law.branches.empty();
  if (layout.branches) layout.memory.reserve(memory_size(law) * network.ends.size());
  layout.dashpots = law.kind == Viscosity::kelvin_voigt;
  layout.data.ratios = layout.ratios.data();
  layout.data.memory_size = memory_size(law);
  layout.few.assign(4 * layout.data.memory_size, 0.0);
  layout.data.few = layout.few.data();
  const Viscosity viscosity = layout.branches || layout.dashpots ? law.kind : Viscosity::none;
  layout.choose(kinematics, viscosity, lanes);
}

FastSprings::~FastSprings() = default;
FastSprings::FastSprings(FastSprings&&) noexcept = default;
FastSprings& FastSprings::operator=(FastSprings&&) noexcept = default;

void FastSprings::remember(const Vector& displacement, std::span<const MemoryStep> steps,
                           std::span<double> memory) {
  Layout& layout = *layout_;
  const bool had_tension = layout.passed;
  layout.place(displacement);
  if (layout.edges) {
    layout.energies = {layout.edges->stored(), 0.0};
    layout.has_energies = true;
    return;
  }
  layout.data.steps = steps.data();
  if (layout.data.coupled) {
    layout.elongation.swap(layout.elongation_before);
    layout.tension.swap(layout.tension_before);
    layout.data.elongation = layout.elongation.data();
    layout.data.tension = layout.tension.data();
  }
  double energies[2];
  layout.remembering(layout.data, layout.nodes.data(), memory.data(), energies);
  layout.finish();
  layout.has_energies = !layout.data.coupled || (!layout.branches && had_tension);
  if (layout.data.coupled)
    layout.coupled_energies(layout.data, layout.tension_before.data(),
                            layout.elongation_before.data(), energies);
  layout.energies = {energies[0], layout.branches || layout.dashpots ? energies[1] : 0.0};
  if (layout.branches) layout.memory.assign(memory.begin(), memory.end());
}

void FastSprings::look(const Vector& displacement, std::span<const double> memory) {
  Layout& layout = *layout_;
  layout.place(displacement);
  layout.has_energies = false;
  if (layout.edges) return;
  // A look changes no memory; the cast is there because both passes have the same signature.
  double energies[2];
  layout.looking(layout.data, layout.nodes.data(), const_cast<double*>(memory.data()), energies);
  layout.finish();
  if (layout.branches) layout.memory.assign(memory.begin(), memory.end());
}

namespace {

bool same(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

std::span<const double> numbers(const Vector& vector) {
  return {vector.data(), as_index(vector.size())};
}

}  // namespace

bool FastSprings::stands_at(const Vector& displacement) const {
  return layout_->passed && same(numbers(displacement), layout_->at);
}

bool FastSprings::knows(const Vector& displacement, std::span<const double> memory) const {
  return stands_at(displacement) && (!layout_->branches || same(memory, layout_->memory));
}

void FastSprings::turn_as(const FastSprings& other) {
  layout_->passed = false;
  other.layout_->turn(other.layout_->data, other.layout_->nodes.data(), layout_->along.data());
}

bool FastSprings::came_from(const Vector& before) const {
  return layout_->passed_before && same(numbers(before), layout_->from);
}

const FastSprings::Energies* FastSprings::energies() const {
  return layout_->has_energies ? &layout_->energies : nullptr;
}

void FastSprings::force(Vector& force) const {
  const std::size_t numbers = layout_->at.size();
  force.resize(static_cast<Eigen::Index>(numbers));
  if (layout_->edges)
    layout_->edges->force(force.data());
  else
    layout_->collect(layout_->nodes.data(), force.data(), numbers / 3);
}

}  // namespace palpate::tissue
