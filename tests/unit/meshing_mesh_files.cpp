// Regions in .ele files, and a mesh file of any kind by its ending.
#include "meshing/mesh_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "geometry/cuboid.h"

namespace palpate::meshing {
namespace {

class AnyMeshFile : public testing::Test {
 protected:
  AnyMeshFile() { std::filesystem::create_directories(folder_); }
  ~AnyMeshFile() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("palpate_any_" + std::to_string(getpid()));
};

TEST_F(AnyMeshFile, regions_survive_a_round_trip) {
  geometry::TetMesh mesh = geometry::cuboid({1, 1, 1}, {1, 1, 2}, geometry::CellPattern::kuhn);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    mesh.regions.push_back(t < 6 ? 0 : -40 + static_cast<int>(t));
  write_node_ele(path("box.ele"), mesh);
  EXPECT_EQ(read_text(path("box.ele")).substr(0, 7), "12 4 1\n");
  EXPECT_EQ(read_node_ele(path("box.ele"), 1.0).regions, mesh.regions);
}

TEST_F(AnyMeshFile, without_regions_no_attribute_is_written) {
  const geometry::TetMesh mesh =
      geometry::cuboid({1, 1, 1}, {1, 1, 1}, geometry::CellPattern::kuhn);
  write_node_ele(path("box.ele"), mesh);
  EXPECT_EQ(read_text(path("box.ele")).substr(0, 6), "6 4 0\n");
  EXPECT_TRUE(read_node_ele(path("box.ele"), 1.0).regions.empty());
}

TEST_F(AnyMeshFile, only_a_single_whole_attribute_is_a_region) {
  write_atomically(path("paw.node"), "4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
  write_atomically(path("paw.ele"), "1 4 2\n0 0 1 2 3 17 0.5\n");
  EXPECT_TRUE(read_node_ele(path("paw.ele"), 1.0).regions.empty());
  write_atomically(path("paw.ele"), "1 4 1\n0 0 1 2 3 17\n");
  EXPECT_EQ(read_node_ele(path("paw.ele"), 1.0).regions, std::vector<int>{17});
  write_atomically(path("paw.ele"), "1 4 1\n0 0 1 2 3 0.5\n");
  try {
    (void)read_node_ele(path("paw.ele"), 1.0);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), path("paw.ele") +
                                ":2:11: the region wants a whole number, got `0.5`; write it like "
                                "`12`");
  }
}

TEST_F(AnyMeshFile, the_ending_tells_the_kind) {
  const geometry::TetMesh mesh =
      geometry::cuboid({1, 1, 1}, {1, 1, 1}, geometry::CellPattern::kuhn);
  write_node_ele(path("box.node"), mesh);
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n";
  for (std::size_t n = 0; n < 8; ++n)
    text += std::to_string(n + 1) + " " + std::to_string(mesh.nodes[n].x()) + " " +
            std::to_string(mesh.nodes[n].y()) + " " + std::to_string(mesh.nodes[n].z()) + "\n";
  text += "$EndNodes\n$Elements\n6\n";
  for (std::size_t t = 0; t < 6; ++t) {
    text += std::to_string(t + 1) + " 4 0";
    for (const int node : mesh.tetrahedra[t]) text += " " + std::to_string(node + 1);
    text += "\n";
  }
  write_atomically(path("box.msh"), text + "$EndElements\n");
  for (const char* name : {"box.node", "box.ele", "box.msh"}) {
    const geometry::TetMesh back = read_mesh(path(name), 0.5).mesh;
    EXPECT_EQ(back.tetrahedra, mesh.tetrahedra) << name;
    EXPECT_EQ(back.nodes.back(), 0.5 * mesh.nodes.back()) << name;
  }
}

TEST_F(AnyMeshFile, other_endings_are_refused) {
  for (const char* name : {"box.step", "box", "box.meshb"}) {
    try {
      (void)read_mesh(path(name), 1.0);
      FAIL() << "no error";
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), path(name) +
                                  ": a mesh file wants the ending `.msh`, `.vtu`, `.vtk`, `.inp`, "
                                  "`.mesh`, `.node` or `.ele`; save "
                                  "it as one of them");
    }
  }
}

}  // namespace
}  // namespace palpate::meshing
