// Parts of a network: their rings, their edge, and what they keep of the whole.
#include "tissue/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "geometry/cuboid.h"
#include "jittered_block.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using tissue::Network;
using tissue::Part;

Network block() {
  const auto mesh =
      geometry::cuboid(Vec3(0.05, 0.04, 0.03), {5, 4, 3}, geometry::CellPattern::mirrored);
  return tissue::make_network(mesh, std::array{1000.0},
                              tissue::van_gelder_stiffness(mesh, std::array{5e4}));
}

// The springs on the shortest way from `start` to every node, by relaxing all springs until nothing
// changes.
std::vector<int> distances(const Network& network, const std::vector<int>& start) {
  std::vector<int> far(network.rest.size(), std::numeric_limits<int>::max() - 1);
  for (const int node : start) far[static_cast<std::size_t>(node)] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b] : network.ends) {
      int& one = far[static_cast<std::size_t>(a)];
      int& other = far[static_cast<std::size_t>(b)];
      if (one > other + 1) one = other + 1, changed = true;
      if (other > one + 1) other = one + 1, changed = true;
    }
  }
  return far;
}

TEST(Part, HoldsTheRingsAndOneMoreAsItsEdge) {
  const Network whole = block();
  for (const std::vector<int>& start : {std::vector{0}, std::vector{47, 60, 48}}) {
    const auto far = distances(whole, start);
    for (const int rings : {1, 2, 3}) {
      const Part part = tissue::part_around(whole, start, rings);
      std::vector<int> expected;
      for (std::size_t n = 0; n < far.size(); ++n)
        if (far[n] <= rings + 1) expected.push_back(static_cast<int>(n));
      ASSERT_EQ(part.nodes, expected) << rings;
      for (std::size_t i = 0; i < part.nodes.size(); ++i)
        EXPECT_EQ(part.edge[i] != 0, far[static_cast<std::size_t>(part.nodes[i])] == rings + 1);
    }
  }
}

// A part spans the reach of the nodes that it is around, and of no others.
TEST(Part, SpansTheReachThatItIsOf) {
  const Network whole = block();
  const std::vector<std::vector<int>> starts{{0}, {1}, {47, 60, 48}, {119}, {0, 119}};
  tissue::Reach reach;
  for (std::size_t i = 0; i < starts.size(); ++i)
    for (const int rings : {1, 2}) {
      const Part part = tissue::part_around(whole, starts[i], rings);
      for (std::size_t k = 0; k < starts.size(); ++k)
        for (const int others : {1, 2}) {
          tissue::reach_around(whole, starts[k], others, reach);
          const Part other = tissue::part_around(whole, starts[k], others);
          EXPECT_EQ(tissue::spans(part, reach),
                    part.nodes == other.nodes && part.edge == other.edge)
              << i << " " << rings << " " << k << " " << others;
        }
      Part edgeless = part;
      tissue::reach_around(whole, starts[i], rings, reach);
      EXPECT_TRUE(tissue::spans(part, reach));
      edgeless.edge.back() = edgeless.edge.back() != 0 ? 0 : 1;
      EXPECT_FALSE(tissue::spans(edgeless, reach));
    }
}

TEST(Part, KeepsWhatItTakes) {
  const Network whole = block();
  const Part part = tissue::part_around(whole, std::array{60}, 1);
  ASSERT_LT(part.nodes.size(), whole.rest.size());
  ASSERT_EQ(part.network.rest.size(), part.nodes.size());
  for (std::size_t i = 0; i < part.nodes.size(); ++i) {
    EXPECT_EQ(part.network.rest[i], whole.rest[static_cast<std::size_t>(part.nodes[i])]);
    EXPECT_EQ(part.network.node_mass[i], whole.node_mass[static_cast<std::size_t>(part.nodes[i])]);
  }
  ASSERT_EQ(part.network.ends.size(), part.springs.size());
  EXPECT_TRUE(std::is_sorted(part.springs.begin(), part.springs.end()));
  std::size_t between = 0;
  const auto has = [&](int node) {
    return std::binary_search(part.nodes.begin(), part.nodes.end(), node);
  };
  for (const auto& [a, b] : whole.ends) between += has(a) && has(b) ? 1 : 0;
  EXPECT_EQ(part.springs.size(), between);
  for (std::size_t s = 0; s < part.springs.size(); ++s) {
    const auto of_whole = static_cast<std::size_t>(part.springs[s]);
    for (std::size_t end = 0; end < 2; ++end)
      EXPECT_EQ(part.nodes[static_cast<std::size_t>(part.network.ends[s][end])],
                whole.ends[of_whole][end]);
    EXPECT_EQ(part.network.stiffness[s], whole.stiffness[of_whole]);
    EXPECT_EQ(part.network.rest_length[s], whole.rest_length[of_whole]);
    EXPECT_EQ(part.network.direction[s], whole.direction[of_whole]);
  }
}

// Every spring of a node that moves is there: the part pulls at it as the whole does.
TEST(Part, CutsSpringsOnlyAtItsEdge) {
  const Network whole = block();
  const Part part = tissue::part_around(whole, std::array{60}, 1);
  std::vector<int> springs_of_whole(whole.rest.size(), 0);
  for (const auto& [a, b] : whole.ends) {
    ++springs_of_whole[static_cast<std::size_t>(a)];
    ++springs_of_whole[static_cast<std::size_t>(b)];
  }
  std::vector<int> springs(part.nodes.size(), 0);
  for (const auto& [a, b] : part.network.ends) {
    ++springs[static_cast<std::size_t>(a)];
    ++springs[static_cast<std::size_t>(b)];
  }
  for (std::size_t i = 0; i < part.nodes.size(); ++i) {
    if (part.edge[i] == 0) {
      EXPECT_EQ(springs[i], springs_of_whole[static_cast<std::size_t>(part.nodes[i])]);
    }
  }
}

TEST(Part, ManyRingsAreTheWhole) {
  const Network whole = block();
  const Part part = tissue::part_around(whole, std::array{0}, 100);
  const Part all = tissue::whole_part(whole);
  EXPECT_EQ(part.nodes, all.nodes);
  EXPECT_EQ(part.springs, all.springs);
  EXPECT_EQ(part.edge, all.edge);
  EXPECT_EQ(std::count(part.edge.begin(), part.edge.end(), 0),
            static_cast<std::ptrdiff_t>(whole.rest.size()));
}

// Networks whose springs pull on each other, by tetrahedra, by volumes around nodes, or both.
std::vector<Network> coupled_blocks() {
  const auto mesh = test::two_regions(test::jittered_block({6, 5, 4}));
  const std::vector<tissue::Isotropic> tissues{{3e4, 0.45}, {2e5, 0.1}};
  std::vector<Network> all;
  for (const auto volume : {tissue::Volume::tetrahedron, tissue::Volume::nodal}) {
    all.push_back(test::coupled_network(mesh, tissues, volume, 0.05));
    Network hybrid = tissue::make_network(mesh, std::array{1000.0, 1100.0},
                                          tissue::van_gelder_stiffness(mesh, std::array{3e4, 2e5}));
    tissue::add_volume(hybrid, mesh, tissues, volume);
    all.push_back(std::move(hybrid));
  }
  return all;
}

// With all outside held at rest, the part pulls at its moving nodes as the whole does, and its edge
// takes what the whole's held nodes take together.
TEST(Part, OfCoupledSpringsPullsAsTheWhole) {
  for (const Network& whole : coupled_blocks())
    for (const int rings : {0, 1, 2}) {
      const Part part = tissue::part_around(whole, std::array{100}, rings);
      ASSERT_LT(part.nodes.size(), whole.rest.size());
      test::Dice dice(3);
      tissue::Vector of_part = tissue::Vector::Zero(3 * part.network.nodes());
      tissue::Vector of_whole = tissue::Vector::Zero(3 * whole.nodes());
      for (std::size_t i = 0; i < part.nodes.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
          if (part.edge[i] != 0) continue;
          const double move = 1e-3 * (dice.roll() - 0.5);
          of_part[3 * static_cast<Eigen::Index>(i) + axis] = move;
          of_whole[3 * part.nodes[i] + axis] = move;
        }
      for (const auto kinematics : {tissue::Kinematics::linear, tissue::Kinematics::nonlinear,
                                    tissue::Kinematics::squared}) {
        const auto got = test::elastic_force(part.network, kinematics, of_part);
        const auto want = test::elastic_force(whole, kinematics, of_whole);
        const double size = want.cwiseAbs().maxCoeff();
        Vec3 got_edge = Vec3::Zero();
        Vec3 want_edge = Vec3::Zero();
        for (int n = 0; n < whole.nodes(); ++n) want_edge += want.segment<3>(3 * n);
        for (std::size_t i = 0; i < part.nodes.size(); ++i) {
          const Vec3 here = got.segment<3>(3 * static_cast<Eigen::Index>(i));
          const Vec3 there = want.segment<3>(3 * part.nodes[i]);
          if (part.edge[i] != 0) {
            got_edge += here;
          } else {
            want_edge -= there;
            EXPECT_LT((here - there).norm(), 1e-13 * size) << rings;  // rounding: the same terms
          }
        }
        EXPECT_LT((got_edge - want_edge).norm(), 1e-12 * size);  // rounding of some hundred nodes
      }
    }
}

TEST(Part, KeepsOnlyWhatCanPullAtItsNodes) {
  for (const Network& whole : coupled_blocks()) {
    const Part part = tissue::part_around(whole, std::array{100}, 1);
    EXPECT_LT(part.network.coupled.size(), whole.coupled.size() / 2 + 1);
    EXPECT_LT(part.network.volumes.size(), whole.volumes.size() / 2 + 1);
    EXPECT_EQ(part.network.volumes.empty(), whole.volumes.empty());
    EXPECT_EQ(part.network.coupled.empty(), whole.coupled.empty());
    for (const auto& volume : part.network.volumes) {
      EXPECT_EQ(volume.springs.size(), volume.dilation.size());
      EXPECT_TRUE(std::is_sorted(volume.springs.begin(), volume.springs.end()));
    }
    const Part all = tissue::part_around(whole, std::array{0}, 100);
    ASSERT_EQ(all.network.coupled.size(), whole.coupled.size());
    ASSERT_EQ(all.network.volumes.size(), whole.volumes.size());
    for (std::size_t t = 0; t < whole.coupled.size(); ++t) {
      EXPECT_EQ(all.network.coupled[t].springs, whole.coupled[t].springs);
      EXPECT_EQ(all.network.coupled[t].stiffness, whole.coupled[t].stiffness);
    }
    for (std::size_t v = 0; v < whole.volumes.size(); ++v) {
      EXPECT_EQ(all.network.volumes[v].springs, whole.volumes[v].springs);
      EXPECT_EQ(all.network.volumes[v].dilation, whole.volumes[v].dilation);
      EXPECT_EQ(all.network.volumes[v].stiffness, whole.volumes[v].stiffness);
    }
  }
}

}  // namespace
}  // namespace palpate
