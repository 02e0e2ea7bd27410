// Nodes, solid cells and faces as files of unstructured meshes hold them, and their tetrahedra.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/curved_edges.h"
#include "geometry/tet_mesh.h"

namespace palpate::meshing {

// A tetrahedron, pyramid, prism or hexahedron has 4, 5, 6 or 8 corners, in VTK's order, which is
// that of Gmsh, Abaqus and MEDIT too.
struct Cell {
  std::array<int, 8> nodes{};
  int corners = 0;
  int region = 0;
  // Of a quadratic tetrahedron: the nodes on the edges 01, 12, 02, 03, 13 and 23.
  std::optional<std::array<int, 6>> middles = {};
};

struct Cells {
  std::vector<Vec3> nodes;  // in the file's unit
  std::vector<Cell> solids;
  std::vector<std::vector<int>> faces;        // corners, counter-clockwise from outside
  std::vector<std::vector<int>> face_groups;  // of Gmsh and MEDIT, per face; else empty
  std::map<std::string, int> names;           // regions of solids by the names of their groups
  std::map<std::string, int> face_names;
  bool curved = false;  // some solids have further nodes that are not kept
};

// A mesh with the names of its regions, and a sentence on what was made of the file's cells.
struct NamedMesh {
  geometry::TetMesh mesh;
  std::map<std::string, int> names = {};
  std::string warning = {};
  geometry::EdgeMiddles middles = {};  // m, of curved tetrahedra
  std::string straightened = {};       // a sentence on what is lost where these are not used
};

// The tetrahedra in all solids, which match across faces: every quadrangle is cut from its node
// with the lowest number (Dompierre et al. 1999). Only nodes of tetrahedra are kept, in the order
// of the file; `regions` is empty if all are 0. Tetrahedra that are inside out are turned round,
// those of degenerate cells with a repeated node are excluded. Middles of curved
// edges are kept if all curved cells are tetrahedra. Coordinates are multiplied by
// `metres_per_unit`. Throws InputError for `path` if there are no solids.
[[nodiscard]] NamedMesh tetrahedra_of(const Cells& cells, const std::string& path,
                                      double metres_per_unit);

// The cells of a file by its ending: .msh of Gmsh, .vtk and .vtu or .vtp of VTK, .inp of Abaqus,
// .mesh of MEDIT. Throws InputError, with file and line where there are lines.
[[nodiscard]] bool holds_cells(const std::string& path);
[[nodiscard]] Cells read_cells(const std::string& path);

// The triangles of the faces of a group of a Gmsh or MEDIT file, by its name or number; a polygon
// is a fan. Throws InputError for another file, and for a group that it does not have, with those
// that it has.
[[nodiscard]] std::vector<std::array<Vec3, 3>> faces_of_group(const std::string& path,
                                                              const std::string& group,
                                                              double metres_per_unit);

// The readers. All numbers of nodes in the result are in range, and all coordinates finite.
// Gmsh: version 1 in ASCII, 2.2 or 4.1 in ASCII or binary of either byte order, elements of any
// order; tags of nodes may have gaps. A cell's region is the absolute value of its physical tag, 0
// without one. Refused: partitioned meshes, and volumes in several physical groups.
[[nodiscard]] Cells read_gmsh_cells(const std::string& path);
// VTK: regions are those of the first array of cells that numbers_parts(). XML files in ASCII or
// binary, appended or not, plain or compressed by zlib.
[[nodiscard]] Cells read_vtk_cells(const std::string& path);
[[nodiscard]] Cells read_vtu_cells(const std::string& path);
// Abaqus: one part; regions are the sets of elements, numbered in the order of their appearance.
[[nodiscard]] Cells read_abaqus_cells(const std::string& path);
// MEDIT in ASCII: regions are the references of solids.
[[nodiscard]] Cells read_medit_cells(const std::string& path);

// VTK's cells, by their type: adds one with these nodes as a solid or face. `at` is its number in
// the file, which becomes its region until number_by() replaces it. False for other types.
[[nodiscard]] bool add_vtk_cell(int type, const std::vector<int>& nodes, int at, Cells& cells);
// The triangles of a strip of corners, all turned like the first, without those that have a corner
// twice.
[[nodiscard]] std::vector<std::vector<int>> triangles_of_strip(std::span<const int> corners);
// Replaces the numbers by an array with an entry for every cell of the file, or by 0 if it is
// empty.
void number_by(const std::vector<double>& regions, Cells& cells);
// Whether an array of this name tells to which part a cell belongs, as other programs write it.
[[nodiscard]] bool numbers_parts(const std::string& name);

}  // namespace palpate::meshing
