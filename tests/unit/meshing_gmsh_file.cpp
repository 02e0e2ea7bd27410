// Gmsh's .msh files: both versions give one mesh; what is read over; every error with its place.
#include "meshing/mesh_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "meshing/cells.h"

namespace palpate::meshing {
namespace {

const std::string kHead2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string kHead4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";

// Two tetrahedra on one face in groups 7 and 3, the second one inside out; node 50 is unused; a
// point, a line and a triangle are there too. Laid out as Gmsh 4.8 writes it.
const std::string kNodes2 =
    "$Nodes\n6\n10 0 0 0\n20 1 0 0\n50 9 9 9\n30 0 1 0\n40 0 0 1\n1000 1 1 1\n$EndNodes\n";
const std::string kElements2 =
    "$Elements\n5\n1 15 2 0 1 10\n2 1 2 0 1 10 20\n3 2 2 11 1 10 30 20\n4 4 2 7 1 10 20 30 40\n"
    "5 4 3 3 2 1 20 30 1000 40\n$EndElements\n";
const std::string kVersion2 =
    kHead2 + "$PhysicalNames\n2\n3 7 \"skin, soft\"\n3 3 \"muscle\"\n$EndPhysicalNames\n" +
    kNodes2 + kElements2;
const std::string kVersion1 =
    "$NOD\n6\n10 0 0 0\n20 1 0 0\n50 9 9 9\n30 0 1 0\n40 0 0 1\n1000 1 1 1\n$ENDNOD\n"
    "$ELM\n3\n3 2 11 1 3 10 30 20\n4 4 7 1 4 10 20 30 40\n5 4 3 2 4 20 30 1000 40\n$ENDELM\n";
const std::string kEntities4 =
    "$Entities\n1 1 1 2\n1 0 0 0 0 \n1 0 0 0 1 0 0 0 2 1 -2 \n1 0 0 0 1 1 0 1 11 1 1 \n"
    "1 0 0 0 1 1 1 1 7 1 1 \n2 0 0 0 1 1 1 1 -3 1 1 \n$EndEntities\n";
const std::string kNodes4 =
    "$Nodes\n3 6 10 1000\n0 1 0 1\n10\n0 0 0\n1 1 1 2\n20\n50\n1 0 0 0.5\n9 9 9 0.7\n3 1 0 "
    "3\n30\n40"
    "\n1000\n0 1 0\n0 0 1\n1 1 1\n$EndNodes\n";
const std::string kElements4 =
    "$Elements\n5 5 1 5\n0 1 15 1\n1 10 \n1 1 1 1\n2 10 20 \n2 1 2 1\n3 10 30 20 \n3 1 4 1\n"
    "4 10 20 30 40 \n3 2 4 1\n5 20 30 1000 40 \n$EndElements\n";
const std::string kVersion4 = kHead4 + kEntities4 + kNodes4 + kElements4;

class GmshFile : public testing::Test {
 protected:
  ~GmshFile() override { std::filesystem::remove(path_); }

  [[nodiscard]] geometry::TetMesh read(const std::string& text,
                                       double metres_per_unit = 1.0) const {
    write_atomically(path_, text);
    return read_mesh(path_, metres_per_unit).mesh;
  }

  // The error without the folder.
  [[nodiscard]] std::string complaint(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(path_.size());
    }
    return "no error";
  }

  // The same with one piece of the text changed.
  [[nodiscard]] std::string complaint(std::string text, const std::string& piece,
                                      const std::string& other) const {
    const std::size_t at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece;
    return complaint(text.replace(at, piece.size(), other));
  }

  std::string path_ = testing::TempDir() + "palpate_gmsh" + std::to_string(::getpid()) + ".msh";
};

TEST_F(GmshFile, all_versions_give_the_same_mesh) {
  std::string short_version = kVersion2;  // as Gmsh wrote it once
  short_version.replace(short_version.find("2.2"), 3, "2");
  for (const std::string& text : {kVersion1, short_version, kVersion2, kVersion4}) {
    const geometry::TetMesh mesh = read(text);
    const std::vector<Vec3> nodes{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    EXPECT_EQ(mesh.nodes, nodes);
    const std::vector<std::array<int, 4>> tetrahedra{{0, 1, 2, 3}, {1, 2, 3, 4}};
    ASSERT_EQ(mesh.tetrahedra.size(), 2u);
    EXPECT_EQ(mesh.tetrahedra[0], tetrahedra[0]);
    EXPECT_EQ(geometry::signed_volume(mesh, 1), 1.0 / 3.0);  // turned round
    EXPECT_EQ(mesh.regions, (std::vector<int>{7, 3}));
  }
}

TEST_F(GmshFile, groups_of_faces_have_numbers_and_names) {
  const std::string named =
      "$PhysicalNames\n2\n2 11 \"under side\"\n3 7 \"skin\"\n$EndPhysicalNames\n";
  const std::array<Vec3, 3> face{Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(1, 0, 0)};
  for (const std::string& text : {kVersion1, kHead2 + named + kNodes2 + kElements2,
                                  kHead4 + named + kEntities4 + kNodes4 + kElements4}) {
    write_atomically(path_, text);
    for (const char* group : {"11", "under side"}) {
      if (text == kVersion1 && std::string(group) != "11") continue;
      const auto found = faces_of_group(path_, group, 1.0);
      ASSERT_EQ(found.size(), 1U);
      EXPECT_EQ(found.front(), face);
    }
  }
  const auto complaint = [&](const char* group) -> std::string {
    try {
      (void)faces_of_group(path_, group, 1.0);
    } catch (const KeyError& error) {
      EXPECT_EQ(error.key(), "tissue.base_side");
      return std::string(error.what()).substr(path_.size());
    }
    return "no error";
  };
  EXPECT_EQ(complaint("yy"),
            ": there is no group of faces `yy`; `tissue.base_side` wants `under side`, "
            "or a direction such as `-z`");
  // A surface in two groups belongs to both.
  std::string both = kEntities4;
  const std::string once = "1 0 0 0 1 1 0 1 11 1 1";
  both.replace(both.find(once), once.size(), "1 0 0 0 1 1 0 2 11 12 1 1");
  write_atomically(path_, kHead4 + both + kNodes4 + kElements4);
  EXPECT_EQ(faces_of_group(path_, "11", 1e-3), faces_of_group(path_, "12", 1e-3));
  write_atomically(path_, kHead2 + kNodes2 + "$Elements\n1\n4 4 2 7 1 10 20 30 40\n$EndElements\n");
  EXPECT_EQ(complaint("7"),
            ": there is no group of faces `7`; `tissue.base_side` wants a direction such as `-z`");
}

TEST_F(GmshFile, units_become_metres) { EXPECT_EQ(read(kVersion4, 1e-3).nodes[4].x(), 1e-3); }

TEST_F(GmshFile, without_groups_there_are_no_regions) {
  EXPECT_TRUE(read(kHead4 + kNodes4 + kElements4).regions.empty());
  const std::string plain =
      "$Elements\n2\n4 4 0 10 20 30 40\n5 4 2 0 1 20 30 40 1000\n$EndElements\n";
  EXPECT_TRUE(read(kHead2 + kNodes2 + plain).regions.empty());
}

TEST_F(GmshFile, other_sections_are_read_over) {
  const std::string more =
      "$Comments\n$Nodes in here\n$EndComments\n$Periodic\n1\n0 1 2\n$EndPeriodic\n"
      "$NodeData\nnumbers$EndNodeData\n";
  EXPECT_EQ(read(kHead2 + more + kNodes2 + kElements2 + more).tetrahedra.size(), 2u);
}

TEST_F(GmshFile, line_ends_of_windows_are_read) {
  std::string text = kVersion4;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\r\n");
  EXPECT_EQ(read(text).nodes, read(kVersion4).nodes);
}

TEST_F(GmshFile, other_formats_are_refused_with_a_remedy) {
  EXPECT_EQ(complaint(""),
            ": the file does not begin with `$MeshFormat`; save it from Gmsh as version 4.1 (`gmsh "
            "-format msh41`)");
  EXPECT_EQ(complaint("$NOD\n").substr(0, 29), ":1: section `$NOD` ends too e");
  EXPECT_NE(complaint(kVersion1, "$ENDNOD", "$EndNOD").find("`$ENDNOD` should stand here"),
            std::string::npos);
  EXPECT_EQ(complaint(kVersion4, "4.1 0 8", "4.1 1 8"),
            ":2: no binary numbers follow, as `1 8` announces; save the file again from Gmsh");
  EXPECT_EQ(complaint(kVersion4, "4.1 0 8", "4 0 8"),
            ":2:1: version `4` is not read; save it as 4.1 (`gmsh -format msh41`)");
  EXPECT_EQ(complaint(kVersion4, "4.1 0 8\n$EndMeshFormat", "4.1 0 8\n$Nodes"),
            ":3: `$EndMeshFormat` should stand here; save the file again from Gmsh");
}

TEST_F(GmshFile, what_is_no_plain_body_is_refused) {
  EXPECT_EQ(
      complaint(kHead4 + kEntities4 + kNodes4 + "$Elements\n0 0 0 0\n$EndElements\n"),
      ":32: the file holds no solid cells and no faces; mesh the volumes (`gmsh -3`), and where "
      "there are physical groups put the volumes into them");
  EXPECT_EQ(complaint(kVersion4, "3 2 4 1\n5", "3 2 99 1\n5"),
            ":40:5: elements of type 99 are not known; mesh again with tetrahedra of first or "
            "second order");
  EXPECT_EQ(
      complaint(kVersion2, "5 4 3 3", "5 11 3 3"),
      ":24: the line has 10 words, but at least 16 belong here; save the file again from Gmsh");
  EXPECT_EQ(complaint(kVersion4, "1 7 1 1", "2 7 3 1 1"),
            ":9:15: the volume belongs to 2 physical groups, so its tissue is not clear; leave it "
            "in one");
  EXPECT_EQ(complaint(kHead4 + "$PartitionedEntities\n"),
            ":4:1: the mesh is cut into partitions; save it without them");
}

TEST_F(GmshFile, bad_lines_have_a_place) {
  EXPECT_EQ(complaint(kVersion2, "30 0 1 0", "30 0 one 0"),
            ":14:6: y wants a finite number, got `one`; write it like `12.5` or `1.25e1`");
  EXPECT_EQ(complaint(kVersion2, "30 0 1 0", "30 0 nan 0").substr(0, 7), ":14:6: ");
  EXPECT_EQ(complaint(kVersion2, "30 0 1 0", "30 0 1"),
            ":14: the line has 3 words, but at least 4 belong here; save the file again from Gmsh");
  EXPECT_EQ(complaint(kVersion2, "30 0 1 0", "20 0 1 0"),
            ":14: there are two nodes with tag 20; save the file again from Gmsh");
  EXPECT_EQ(complaint(kVersion2, "$Nodes\n6", "$Nodes\n-6"),
            ":10:1: the number of nodes wants 0 or more, got `-6`; save the file again from Gmsh");
  EXPECT_EQ(complaint(kVersion2, "$Nodes\n6", "$Nodes\n5"),
            ":16: `$EndNodes` should stand here; save the file again from Gmsh");
  EXPECT_EQ(complaint(kVersion2, "$Nodes\n6", "$Nodes\n7"),
            ":17: section `$Nodes` ends too early; save the file again from Gmsh");
  EXPECT_EQ(complaint(kVersion2, "10 20 30 40", "10 20 31 40"),
            ":23:17: there is no node `31` in `$Nodes`; save the file again from Gmsh");
  EXPECT_EQ(complaint(kVersion2, "10 20 30 40", "10 20 30"),
            ":23: the line has 8 words, but at least 9 belong here; save the file again from Gmsh");
  EXPECT_EQ(complaint(kVersion2, "4 4 2 7", "4 4 2 x").substr(0, 7), ":23:7: ");
  EXPECT_EQ(complaint(kVersion4, "10 20 30 40 \n", "10 20 30 \n").substr(0, 30),
            ":39: the line has 4 words, but");
  EXPECT_EQ(complaint(kVersion4, "$Entities\n1 1 1 2", "$Entities\n1 1 1 3"),
            ":11: section `$Entities` ends too early; save the file again from Gmsh");
  EXPECT_EQ(complaint(kVersion4, "1 7 1 1 ", "1"),
            ":9: the line has 8 words, but at least 9 belong here; save the file again from Gmsh");
  EXPECT_EQ(complaint(kHead2 + "rubbish\n"),
            ":4:1: a section such as `$Nodes` should begin here, got `rubbish`; save the file "
            "again from Gmsh");
  EXPECT_EQ(complaint(kHead2 + "$Comments\n$EndNodes\n"),
            ":5: section `$Comments` has no `$EndComments`; save the file again from Gmsh");
}

// Wherever a file breaks off, it says so; it is read only where nothing but the last end is gone.
TEST_F(GmshFile, files_that_break_off_are_refused) {
  for (const std::string& text : {kVersion2, kVersion4})
    for (std::size_t length = 0; length + 1 < text.size(); ++length)
      ASSERT_NE(complaint(text.substr(0, length)), "no error") << length;
}

TEST_F(GmshFile, a_missing_file_is_named) {
  EXPECT_THROW((void)read_mesh("/nowhere/paw.msh", 1.0), InputError);
}

}  // namespace
}  // namespace palpate::meshing
