// Files of unstructured meshes: every format and kind of cell gives the same body, and matching
// tetrahedra; broken files are refused wherever they break off.
#include "meshing/cells.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "geometry/half_edges.h"
#include "geometry/surface.h"
#include "meshing/mesh_check.h"
#include "meshing/mesh_files.h"
#include "meshing/surface_files.h"

namespace palpate::meshing {
namespace {

// Two unit cubes side by side along x; the second one has region 5, and 2 cut into prisms.
const std::vector<std::array<int, 3>> kPlaces{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                              {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1},
                                              {2, 0, 0}, {2, 1, 0}, {2, 0, 1}, {2, 1, 1}};
const std::vector<int> kHexahedron{0, 1, 2, 3, 4, 5, 6, 7};
const std::vector<std::vector<int>> kPrisms{{1, 8, 9, 5, 10, 11}, {1, 9, 2, 5, 11, 6}};

std::string text_of(const std::vector<int>& list, int first, const char* between = " ") {
  std::string text;
  for (const int one : list) text += (text.empty() ? "" : between) + std::to_string(one + first);
  return text;
}

std::string places(const char* before_each, const char* between, const char* after_each) {
  std::string text;
  int number = 0;
  for (const auto& [x, y, z] : kPlaces)
    text += (*before_each != '\0' ? std::to_string(++number) + before_each : "") +
            std::to_string(x) + between + std::to_string(y) + between + std::to_string(z) +
            after_each + "\n";
  return text;
}

template <class Number>
std::string bytes_of(const std::vector<Number>& numbers) {
  std::string bytes(numbers.size() * sizeof(Number), '\0');
  if (!bytes.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

std::string binary_gmsh() {
  std::string text = "$MeshFormat\n4.1 1 8\n" + bytes_of<int>({1}) +
                     "\n$EndMeshFormat\n$PhysicalNames\n1\n3 5 \"the right part\"\n"
                     "$EndPhysicalNames\n$Entities\n" +
                     bytes_of<std::size_t>({0, 0, 0, 2});
  for (const int entity : {1, 2}) {
    text += bytes_of<int>({entity}) + bytes_of<double>({0, 0, 0, 2, 1, 1});
    text +=
        entity == 1 ? bytes_of<std::size_t>({0}) : bytes_of<std::size_t>({1}) + bytes_of<int>({-5});
    text += bytes_of<std::size_t>({0});
  }
  text += "\n$EndEntities\n$Nodes\n" + bytes_of<std::size_t>({1, 12, 10, 120}) +
          bytes_of<int>({3, 1, 0}) + bytes_of<std::size_t>({12});
  for (std::size_t i = 1; i <= 12; ++i) text += bytes_of<std::size_t>({10 * i});
  for (const auto& [x, y, z] : kPlaces) text += bytes_of<double>({double(x), double(y), double(z)});
  text += "\n$EndNodes\n$Elements\n" + bytes_of<std::size_t>({2, 3, 1, 3}) +
          bytes_of<int>({3, 1, 5}) + bytes_of<std::size_t>({1, 1});
  for (const int node : kHexahedron) text += bytes_of<std::size_t>({10 * (std::size_t(node) + 1)});
  text += bytes_of<int>({3, 2, 6}) + bytes_of<std::size_t>({2});
  for (const auto& prism : kPrisms) {
    text += bytes_of<std::size_t>({2});
    for (const int node : prism) text += bytes_of<std::size_t>({10 * (std::size_t(node) + 1)});
  }
  return text + "\n$EndElements\n";
}

std::string vtk() {
  return "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 12 float\n" +
         places("", " ", "") + "CELLS 3 23\n8 " + text_of(kHexahedron, 0) + "\n6 " +
         text_of(kPrisms[0], 0) + "\n6 " + text_of(kPrisms[1], 0) +
         "\nCELL_TYPES 3\n12 13\n13\nCELL_DATA 3\nSCALARS region int\nLOOKUP_TABLE default\n0 5 "
         "5\n";
}

// With arrays as `array` encodes them.
template <class Array>
std::string vtu(const std::string& attributes, const Array& array) {
  std::vector<double> all;
  for (const auto& [x, y, z] : kPlaces) all.insert(all.end(), {double(x), double(y), double(z)});
  std::vector<int> nodes = kHexahedron;
  for (const auto& prism : kPrisms) nodes.insert(nodes.end(), prism.begin(), prism.end());
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"" +
         attributes +
         ">\n<UnstructuredGrid><Piece NumberOfPoints=\"12\" NumberOfCells=\"3\"><Points>\n" +
         array("Float64", "Points", bytes_of(all)) + "</Points><Cells>" +
         array("Int32", "connectivity", bytes_of(nodes)) +
         array("Int32", "offsets", bytes_of<int>({8, 14, 20})) +
         array("Int32", "types", bytes_of<int>({12, 13, 13})) + "</Cells><CellData>" +
         array("Int32", "medit:ref", bytes_of<int>({0, 5, 5})) +
         "</CellData></Piece></UnstructuredGrid>\n";
}

std::string base64(const std::string& bytes) {
  const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : letters[bits >> (18 - 6 * k) & 63u];
  }
  return text;
}

std::string vtu_of_base64() {
  return vtu(" header_type=\"UInt32\"",
             [](const std::string& type, const std::string& name, const std::string& bytes) {
               return "<DataArray type=\"" + type + "\" Name=\"" + name +
                      "\" format=\"binary\">\n" +
                      base64(bytes_of<unsigned>({unsigned(bytes.size())}) + bytes) +
                      "\n</DataArray>\n";
             }) +
         "</VTKFile>\n";
}

// Appended raw bytes in compressed blocks of 64.
std::string vtu_of_zlib() {
  std::string appended;
  const std::string head =
      vtu(" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"",
          [&](const std::string& type, const std::string& name, const std::string& bytes) {
            const std::string offset = std::to_string(appended.size());
            std::vector<std::size_t> header{(bytes.size() + 63) / 64, 64, bytes.size() % 64};
            std::string blocks;
            for (std::size_t at = 0; at < bytes.size(); at += 64) {
              const std::string plain = bytes.substr(at, 64);
              std::string packed(compressBound(plain.size()), '\0');
              uLongf size = packed.size();
              compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                       reinterpret_cast<const Bytef*>(plain.data()), plain.size());
              header.push_back(size);
              blocks += packed.substr(0, size);
            }
            appended += bytes_of(header) + blocks;
            return "<DataArray type=\"" + type + "\" Name=\"" + name +
                   "\" format=\"appended\" offset=\"" + offset + "\"/>\n";
          });
  return head + "<AppendedData encoding=\"raw\">\n_" + appended + "\n</AppendedData></VTKFile>\n";
}

std::string abaqus() {
  return "** two cubes\n*Heading\n*Node\n" + places(", ", ", ", "") + "*Element, type=C3D8R\n1, " +
         text_of(kHexahedron, 1, ", ") + "\n*Element, type=C3D6, elset=Right\n2, " +
         text_of(kPrisms[0], 1, ", ") + "\n3, " + text_of({1, 9, 2}, 1, ", ") + ",\n" +
         text_of({5, 11, 6}, 1, ", ") + "\n*Elset, elset=all, generate\n1, 3, 1\n";
}

std::string medit() {
  return "MeshVersionFormatted 2\n\nDimension 3\nVertices 12\n" + places("", " ", " 0") +
         "Hexahedra\n1\n" + text_of(kHexahedron, 1) + " 0\nPrisms\n2\n" + text_of(kPrisms[0], 1) +
         " 5\n" + text_of(kPrisms[1], 1) + " 5\nCorners\n2\n1 2\nEnd\n";
}

class CellFiles : public testing::Test {
 protected:
  ~CellFiles() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string written(const std::string& name, const std::string& text) const {
    write_atomically(folder_ + "/" + name, text);
    return folder_ + "/" + name;
  }

  std::string folder_ = testing::TempDir() + "palpate_cells" + std::to_string(::getpid());
  std::vector<std::pair<std::string, std::string>> all_{
      {"a.msh", binary_gmsh()}, {"a.vtk", vtk()},           {"a.vtu", vtu_of_base64()},
      {"b.vtu", vtu_of_zlib()}, {"b.vtk", vtu_of_base64()}, {"a.inp", abaqus()},
      {"a.mesh", medit()}};
};

TEST_F(CellFiles, every_format_gives_the_same_body) {
  for (const auto& [name, text] : all_) {
    SCOPED_TRACE(name);
    const NamedMesh read = read_mesh(written(name, text), 1.0);
    check(read.mesh, name, 2.0);  // cuts match across the faces of cells
    EXPECT_EQ(read.mesh.nodes.size(), 12u);
    EXPECT_EQ(read.mesh.tetrahedra.size(), 12u);
    double right = 0.0;
    const int part = name == "a.inp" ? 1 : 5;  // sets of Abaqus have no numbers
    for (int t = 0; t < 12; ++t)
      if (read.mesh.region(t) == part) right += geometry::signed_volume(read.mesh, t);
    EXPECT_NEAR(right, 1.0, 1e-12);  // rounding
    EXPECT_TRUE(read.warning.find("were cut into tetrahedra") != std::string::npos);
  }
}

// Two cubes that share a node, and two that share an edge: the boundary of each is a surface then.
TEST_F(CellFiles, what_only_touches_is_parted) {
  for (const bool edge : {false, true}) {
    SCOPED_TRACE(edge);
    std::string text = "MeshVersionFormatted 2\nDimension 3\nVertices\n16\n";
    for (int cube = 0; cube < 2; ++cube)
      for (int k = 0; k < 8; ++k)
        text += std::to_string((k & 1) + cube) + " " + std::to_string((k >> 1 & 1) + cube) + " " +
                std::to_string((k >> 2) + (edge ? 0 : cube)) + " 0\n";
    // The second cube takes the first one's corners where they meet.
    const auto node = [&](int cube, int k) {
      if (cube == 1 && k == 0) return edge ? 4 : 8;
      if (cube == 1 && edge && k == 4) return 8;
      return 8 * cube + k + 1;
    };
    text += "Hexahedra\n2\n";
    for (int cube = 0; cube < 2; ++cube) {
      for (const int k : {0, 1, 3, 2, 4, 5, 7, 6}) text += std::to_string(node(cube, k)) + " ";
      text += "0\n";
    }
    const NamedMesh read = read_mesh(written("touch.mesh", text + "End\n"), 1.0);
    EXPECT_EQ(read.mesh.nodes.size(), 16u);
    EXPECT_NE(read.warning.find(edge ? "2 nodes of" : "1 node of"), std::string::npos)
        << read.warning;
    EXPECT_FALSE(geometry::joints(geometry::outer_surface(read.mesh).surface).refused);
  }
}

// x + x^2 takes the unit tetrahedron of 1/6 to one of 1/6 + 2/24 = 1/4, and its corners to those of
// one of 1/3; beside it lies the unit tetrahedron, with its middles on straight edges.
TEST_F(CellFiles, edges_that_become_straight_are_told_with_what_the_volumes_change) {
  const std::vector<std::array<double, 3>> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<std::pair<int, int>> edges{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  std::vector<std::string> places;
  for (const double curve : {1.0, 0.0}) {
    std::vector<std::array<double, 3>> ten = corners;
    for (const auto& [a, b] : edges)
      ten.push_back({(corners[as_index(a)][0] + corners[as_index(b)][0]) / 2,
                     (corners[as_index(a)][1] + corners[as_index(b)][1]) / 2,
                     (corners[as_index(a)][2] + corners[as_index(b)][2]) / 2});
    for (auto& [x, y, z] : ten)
      places.push_back(number_text(curve == 0.0 ? x + 5.0 : x + x * x) + " " + number_text(y) +
                       " " + number_text(z));
  }
  const auto commas = [](std::string text) {
    for (std::size_t at = 0; (at = text.find(' ', at)) != std::string::npos; at += 2)
      text.replace(at, 1, ", ");
    return text;
  };
  const auto gmsh = [&](const std::vector<int>& cells) {
    std::string text =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 \"lump\"\n"
        "$EndPhysicalNames\n$Nodes\n20\n";
    for (int n = 0; n < 20; ++n) text += std::to_string(n + 1) + " " + places[as_index(n)] + "\n";
    text += "$EndNodes\n$Elements\n" + std::to_string(cells.size()) + "\n";
    for (const int cell : cells)
      text += std::to_string(cell + 1) + " 11 2 " + (cell == 0 ? "7" : "0") + " 1 " +
              text_of({0, 1, 2, 3, 4, 5, 6, 7, 9, 8}, 10 * cell + 1) + "\n";
    return text + "$EndElements\n";
  };
  std::string abaqus_text = "*Node\n", vtk_text =
                                           "# vtk DataFile Version 3.0\nt\nASCII\nDATASET "
                                           "UNSTRUCTURED_GRID\nPOINTS 20 double\n";
  for (int n = 0; n < 20; ++n) {
    abaqus_text += std::to_string(n + 1) + ", " + commas(places[as_index(n)]) + "\n";
    vtk_text += places[as_index(n)] + "\n";
  }
  const std::vector<int> ten{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  abaqus_text += "*Element, type=C3D10, elset=lump\n1, " + text_of(ten, 1, ", ") +
                 "\n*Element, type=C3D10\n2, " + text_of(ten, 11, ", ") + "\n";
  vtk_text +=
      "CELLS 2 22\n10 " + text_of(ten, 0) + "\n10 " + text_of(ten, 10) + "\nCELL_TYPES 2\n24\n24\n";
  // Gmsh 4.8 has `Tetrahedra` of ten nodes in its `.mesh`, later ones `TetrahedraP2`.
  const auto medit_text = [&](const std::string& section) {
    std::string text = "MeshVersionFormatted 2\nDimension 3\nVertices\n20\n";
    for (const std::string& place : places) text += place + " 1\n";
    return text + section + "\n2\n" + text_of(ten, 1) + " 4\n" + text_of(ten, 11) + " 0\nEnd\n";
  };
  // 1/3 over 1/4, and 1/2 over 1/4 + 1/6.
  const auto sentence = [](const std::string& file, const std::string& regions) {
    return "the edges of the cells of " + file +
           " are taken as straight, and the nodes in their middles are not used: of their "
           "volumes the body has 20 % more" +
           regions + "; a finer mesh keeps the shape";
  };
  const std::string both = ", region 0 the same, region `lump` 33 % more";
  const NamedMesh read = read_mesh(written("q.msh", gmsh({0, 1})), 1e-3);
  EXPECT_EQ(read.straightened, sentence("q.msh", both));
  EXPECT_EQ(read_mesh(written("q.inp", abaqus_text), 1.0).straightened, sentence("q.inp", both));
  EXPECT_EQ(read_mesh(written("q.vtk", vtk_text), 1.0).straightened, sentence("q.vtk", ""));
  const std::string of_medit = sentence("q.mesh", ", region 0 the same, region 4 33 % more");
  for (const char* section : {"Tetrahedra", "TetrahedraP2"})
    EXPECT_EQ(read_mesh(written("q.mesh", medit_text(section)), 1.0).straightened, of_medit);
  const NamedMesh straight = read_mesh(written("straight.msh", gmsh({1})), 1.0);
  EXPECT_EQ(straight.straightened, "");
  EXPECT_TRUE(straight.middles.empty());
  // Of the three edges from the origin and the three between the others, one lies along x and two
  // end at its end; their middles are those of the map.
  ASSERT_EQ(read.middles.size(), 3U);
  EXPECT_EQ(read.middles.at({0, 1}), 1e-3 * Vec3(0.75, 0.0, 0.0));
  EXPECT_EQ(read.middles.at({1, 2}), 1e-3 * Vec3(0.75, 0.5, 0.0));
  EXPECT_EQ(read.middles.at({1, 3}), 1e-3 * Vec3(0.75, 0.0, 0.5));
  EXPECT_EQ(read.warning, "");
}

TEST_F(CellFiles, groups_have_names) {
  EXPECT_EQ(read_mesh(written("a.msh", binary_gmsh()), 1.0).names.at("the right part"), 5);
  EXPECT_EQ(read_mesh(written("a.inp", abaqus()), 1.0).names.at("Right"), 1);
}

TEST_F(CellFiles, broken_files_are_refused) {
  for (const auto& [name, text] : all_)
    // The last bytes are ends of sections, closing tags and sets that name nothing.
    for (std::size_t length = 0; length + 110 < text.size(); length += 7) {
      const std::string path = written(name, text.substr(0, length));
      try {
        const geometry::TetMesh mesh = read_mesh(path, 1.0).mesh;
        EXPECT_LT(mesh.tetrahedra.size(), 12u) << name << " " << length;
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()), "");
      }
    }
}

TEST_F(CellFiles, cells_of_other_kinds_are_named) {
  std::string text = vtk();
  text.replace(text.find("12 13\n"), 6, "42 13\n");
  try {
    (void)read_mesh(written("a.vtk", text), 1.0);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("cell 0 is of type 42, which is not read"),
              std::string::npos);
  }
}

TEST_F(CellFiles, faces_alone_are_a_surface) {
  const std::string text =
      "MeshVersionFormatted 1\nDimension\n3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
      "Triangles\n4\n1 3 2 0\n1 2 4 0\n2 3 4 0\n3 1 4 0\nEnd\n";
  EXPECT_EQ(read_surface(written("a.mesh", text), 1.0).triangles.size(), 4u);
  EXPECT_THROW((void)read_mesh(written("a.mesh", text), 1.0), InputError);
  EXPECT_THROW((void)read_surface(written("b.mesh", medit()), 1.0), KeyError);
}

}  // namespace
}  // namespace palpate::meshing
