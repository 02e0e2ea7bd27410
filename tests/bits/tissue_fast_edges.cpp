// Coupled springs by their edges: the forces of the loops over springs, the same bits in any lanes.
#include "tissue/fast_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <set>

#include "geometry/surface.h"
#include "jittered_block.h"
#include "tissue/edge_form.h"
#include "tissue/fast_springs.h"
#include "tissue/part.h"

namespace palpate {
namespace {

using tissue::FastEdges;
using tissue::Isotropic;
using tissue::Kinematics;
using tissue::Lanes;
using tissue::Network;
using tissue::Vector;
using tissue::Volume;

geometry::TetMesh block() { return test::jittered_block({4, 3, 3}); }

Network with_volume(const geometry::TetMesh& mesh, const std::vector<Isotropic>& tissues,
                    Volume volume) {
  const std::vector<double> density(tissues.size(), 1000.0);
  Network network = tissue::make_network(
      mesh, density, tissue::van_gelder_stiffness(mesh, std::vector<double>(tissues.size(), 15e3)));
  tissue::add_volume(network, mesh, tissues, volume);
  return network;
}

// Every form: six springs or a volume term, of each tetrahedron or averaged, in one tissue or two.
std::vector<Network> networks() {
  std::vector<Network> all;
  for (const Volume volume : {Volume::none, Volume::tetrahedron, Volume::nodal})
    for (const bool two : {false, true}) {
      const geometry::TetMesh mesh = two ? test::two_regions(block()) : block();
      std::vector<Isotropic> tissues{{15e3, 0.45}};
      if (two) tissues.push_back({60e3, 0.3});
      all.push_back(test::coupled_network(mesh, tissues, volume, 1.0));
      if (volume != Volume::none) all.push_back(with_volume(mesh, tissues, volume));
    }
  return all;
}

Vector force_of(FastEdges& edges, const Vector& displacement) {
  edges.pass(displacement);
  Vector force(displacement.size());
  edges.force(force.data());
  return force;
}

TEST(FastEdges, PullAsTheSpringsWithTheSameBitsInAnyLanes) {
  for (const Network& network : networks()) {
    ASSERT_TRUE(tissue::has_edge_form(network));
    FastEdges portable(network, Lanes::portable);
    FastEdges widest(network, Lanes::widest);
    test::Dice dice(5);
    for (int round = 0; round < 3; ++round) {
      Vector u(3 * network.nodes());
      for (double& component : u) component = 1e-3 * (dice.roll() - 0.5);
      const Vector expected = test::elastic_force(network, Kinematics::linear, u);
      const Vector force = force_of(widest, u);
      const Vector other = force_of(portable, u);
      // Rounding of sums of about a hundred terms.
      EXPECT_LT((force - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff());
      for (Eigen::Index d = 0; d < u.size(); ++d)
        ASSERT_EQ(std::bit_cast<std::uint64_t>(force[d]), std::bit_cast<std::uint64_t>(other[d]));
      EXPECT_EQ(widest.stored(), portable.stored());
      const double stored = test::elastic_energy(network, Kinematics::linear, u);
      EXPECT_NEAR(widest.stored(), stored, 1e-13 * stored);  // another order of the terms
    }
  }
}

// Of one tissue, the edges inside need the fewest numbers.
TEST(EdgeForm, KnowsTheEdgesInsideOneTissue) {
  const geometry::TetMesh mesh = block();
  std::set<std::array<int, 2>> on_skin;
  for (const auto& corners : geometry::skin(mesh).surface.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = corners[i];
      const int b = corners[(i + 1) % 3];
      on_skin.insert({std::min(a, b), std::max(a, b)});
    }
  const tissue::EdgeForm form =
      tissue::edge_form(test::coupled_network(mesh, {{15e3, 0.45}}, Volume::nodal, 1.0));
  EXPECT_EQ(form.edges() - form.inner, on_skin.size());
  // Stiffness alone may differ between lanes.
  EXPECT_TRUE(
      form.alike(tissue::edge_form(test::coupled_network(mesh, {{5e3, 0.3}}, Volume::nodal, 1.0))));
  EXPECT_FALSE(form.alike(
      tissue::edge_form(test::coupled_network(mesh, {{15e3, 0.45}}, Volume::none, 1.0))));
  const tissue::EdgeForm two = tissue::edge_form(test::coupled_network(
      test::two_regions(mesh), {{15e3, 0.45}, {60e3, 0.3}}, Volume::nodal, 1.0));
  EXPECT_LT(two.inner, form.inner);
  EXPECT_GT(two.weight.size(), mesh.nodes.size() + 1);  // two volumes at a node between tissues
}

// A part of a body lacks springs of some volumes: its springs are passed one by one.
TEST(EdgeForm, IsNotThatOfAPartWithMissingSprings) {
  const Network whole = test::coupled_network(block(), {{15e3, 0.45}}, Volume::nodal, 1.0);
  const tissue::Part part = tissue::part_around(whole, std::array{0}, 1);
  EXPECT_FALSE(tissue::has_edge_form(part.network));
  EXPECT_TRUE(tissue::has_edge_form(tissue::whole_part(whole).network));
  Vector u(3 * part.network.nodes());
  test::Dice dice(5);
  for (double& component : u) component = 1e-3 * (dice.roll() - 0.5);
  tissue::FastSprings fast(part.network, Kinematics::linear, {});
  fast.look(u, {});
  Vector force;
  fast.force(force);
  EXPECT_EQ(force, test::elastic_force(part.network, Kinematics::linear, u));
}

}  // namespace
}  // namespace palpate
