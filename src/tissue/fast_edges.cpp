// The layout of an EdgeForm for its loops, and the choice of instructions.
#include "tissue/fast_edges.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tissue/edge_form.h"
#include "tissue/fast_node.h"

// Vectors of four are only passed to inlined functions, so that the ABI warning does not apply.
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace palpate::tissue {
namespace {

// As in EdgeForm. Slots are in groups of four, the last of which is filled up with weight 0.
struct FastEdgeData {
  std::size_t edges = 0;
  std::size_t inner = 0;
  std::size_t slot_groups = 0;  // slots, rounded up to a multiple of four
  const std::int32_t* ends = nullptr;
  const std::int32_t* slots = nullptr;
  const double* block = nullptr;
  const double* change = nullptr;
  const double* turn = nullptr;
  const double* weight = nullptr;
};

struct EdgePasses {
  void (*place)(const double* from, FastNode*, std::size_t count) = nullptr;
  void (*edges)(const FastEdgeData&, FastNode*) = nullptr;
  void (*collect)(const FastNode*, double* to, std::size_t count) = nullptr;
  double (*work)(const FastNode*, std::size_t count) = nullptr;
};

}  // namespace
}  // namespace palpate::tissue

#define PALPATE_LOOPS edges_portable
#define PALPATE_TARGET
#include "tissue/edge_loops.h"
#undef PALPATE_LOOPS
#undef PALPATE_TARGET

#if defined(__x86_64__)
#define PALPATE_LOOPS edges_avx2
#define PALPATE_TARGET __attribute__((target("avx2")))
#include "tissue/edge_loops.h"
#undef PALPATE_LOOPS
#undef PALPATE_TARGET
#endif

namespace palpate::tissue {

struct FastEdges::Layout {
  EdgeForm form;
  FastEdgeData data;
  EdgePasses passes;
  std::size_t count = 0;        // nodes of the network
  std::vector<FastNode> nodes;  // and the slots beyond them
};

FastEdges::FastEdges(const Network& network, Lanes lanes) : layout_(std::make_unique<Layout>()) {
  Layout& layout = *layout_;
  EdgeForm& form = layout.form;
  form = edge_form(network);
  layout.count = network.rest.size();
  const bool volumes = !form.weight.empty();
  const std::size_t slots = (std::max(form.weight.size(), layout.count) + 3) / 4 * 4;
  layout.nodes.resize(slots);
  form.weight.resize(slots, 0.0);
  for (auto* values : {&form.block, &form.change, &form.turn})
    values->resize(values->size() + 4, 0.0);  // the last loads read beyond
  layout.data = {.edges = form.edges(),
                 .inner = form.inner,
                 .slot_groups = slots,
                 .ends = form.ends.data(),
                 .slots = form.slots.data(),
                 .block = form.block.data(),
                 .change = form.change.data(),
                 .turn = form.turn.data(),
                 .weight = form.weight.data()};
  layout.passes = edges_portable::choose(volumes);
#if defined(__x86_64__)
  if (lanes == Lanes::widest && __builtin_cpu_supports("avx2"))
    layout.passes = edges_avx2::choose(volumes);
#endif
}

FastEdges::~FastEdges() = default;
FastEdges::FastEdges(FastEdges&&) noexcept = default;
FastEdges& FastEdges::operator=(FastEdges&&) noexcept = default;

void FastEdges::pass(const Eigen::VectorXd& displacement) {
  Layout& layout = *layout_;
  layout.passes.place(displacement.data(), layout.nodes.data(), layout.count);
  layout.passes.edges(layout.data, layout.nodes.data());
}

void FastEdges::force(double* force) const {
  layout_->passes.collect(layout_->nodes.data(), force, layout_->count);
}

double FastEdges::stored() const {
  return 0.5 * layout_->passes.work(layout_->nodes.data(), layout_->count);
}

}  // namespace palpate::tissue
