// Cuts cells into tetrahedra, and knows VTK's types of cells.
#include "meshing/cells.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"

namespace palpate::meshing {
namespace {

using CellFace = std::vector<int>;

// The faces of a cell by its number of corners; their direction does not matter.
const std::vector<CellFace>& faces_of(int corners) {
  static const std::vector<CellFace> tetrahedron{{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}};
  static const std::vector<CellFace> pyramid{
      {0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  static const std::vector<CellFace> prism{
      {0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  static const std::vector<CellFace> hexahedron{{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  switch (corners) {
    case 4: return tetrahedron;
    case 5: return pyramid;
    case 6: return prism;
    default: return hexahedron;
  }
}

// From the corner with the lowest node to all faces that do not have it, each cut from its own.
void cut_into(std::vector<std::array<int, 4>>& found, const Cell& cell) {
  const std::span<const int> nodes(cell.nodes.data(), as_index(cell.corners));
  const int apex = *std::ranges::min_element(nodes);
  for (const CellFace& face : faces_of(cell.corners)) {
    CellFace own;
    for (const int corner : face) own.push_back(nodes[as_index(corner)]);
    if (std::ranges::find(own, apex) != own.end()) continue;
    std::rotate(own.begin(), std::ranges::min_element(own), own.end());
    for (std::size_t i = 1; i + 1 < own.size(); ++i) {
      std::array<int, 4> one{apex, own[0], own[i], own[i + 1]};
      if (one[1] != one[2] && one[2] != one[3] && one[1] != one[3]) found.push_back(one);
    }
  }
}

struct VtkKind {
  int type;
  int corners;
  bool solid;
  bool curved;
};
constexpr VtkKind vtk_kinds[] = {
    {5, 3, false, false}, {9, 4, false, false}, {10, 4, true, false}, {12, 8, true, false},
    {13, 6, true, false}, {14, 5, true, false}, {22, 3, false, true}, {23, 4, false, true},
    {24, 4, true, true},  {25, 8, true, true},  {26, 6, true, true},  {27, 5, true, true},
    {28, 4, false, true}, {29, 8, true, true},  {32, 6, true, true},  {33, 8, true, true},
    {34, 3, false, true}, {69, 3, false, true}, {70, 4, false, true}, {71, 4, true, true},
    {72, 8, true, true},  {73, 6, true, true},  {74, 5, true, true}};
constexpr int vtk_quadratic_tetrahedron = 24;
constexpr int vtk_strip = 6, vtk_polygon = 7, vtk_pixel = 8, vtk_voxel = 11;
// Points and lines.
constexpr int vtk_passed_over[] = {0, 1, 2, 3, 4, 21, 35, 68};

constexpr int middle_edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

// The edges of a tetrahedron whose middles lie beside those of straight edges, by more than a
// file's rounding: their ends and middle.
std::vector<std::array<int, 3>> bent_edges(const Cell& cell, const std::vector<Vec3>& nodes) {
  constexpr double rounding = 1e-5;
  std::vector<std::array<int, 3>> found;
  for (std::size_t e = 0; cell.middles && e < 6; ++e) {
    const int from = cell.nodes[as_index(middle_edges[e][0])];
    const int to = cell.nodes[as_index(middle_edges[e][1])];
    const int middle = (*cell.middles)[e];
    const Vec3& a = nodes[as_index(from)];
    const Vec3& b = nodes[as_index(to)];
    if ((nodes[as_index(middle)] - 0.5 * (a + b)).norm() > rounding * (b - a).norm())
      found.push_back({from, to, middle});
  }
  return found;
}

// The signed volumes of a tetrahedron with its middles, if it has some, and of that between its
// corners. The determinant of the map from the unit tetrahedron is a cubic, which the rule of five
// points integrates exactly (Keast 1986).
std::pair<double, double> volumes_of(const Cell& cell, const std::vector<Vec3>& nodes) {
  const auto corner = [&](int i) -> const Vec3& {
    return nodes[as_index(cell.nodes[as_index(i)])];
  };
  const auto volume = [&](const Eigen::Vector4d& at) {  // barycentric
    Eigen::Matrix<double, 3, 4> slopes;
    for (int i = 0; i < 4; ++i) slopes.col(i) = (4.0 * at[i] - 1.0) * corner(i);
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [i, j] = std::pair(middle_edges[e][0], middle_edges[e][1]);
      slopes.col(i) += 4.0 * at[j] * nodes[as_index((*cell.middles)[e])];
      slopes.col(j) += 4.0 * at[i] * nodes[as_index((*cell.middles)[e])];
    }
    const Vec3 first = slopes.col(0);
    return (slopes.rightCols<3>().colwise() - first).determinant() / 6.0;
  };
  const double straight =
      (corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(corner(3) - corner(0)) / 6.0;
  if (!cell.middles) return {straight, straight};
  double whole = -0.8 * volume(Eigen::Vector4d::Constant(0.25));
  for (int i = 0; i < 4; ++i)
    whole += 0.45 * volume(Eigen::Vector4d::Constant(1.0 / 6.0) + Eigen::Vector4d::Unit(i) / 3.0);
  return {whole, straight};
}

// What becomes of cells whose edges are not straight.
std::string straightened(const Cells& cells, const std::string& name) {
  std::string text = "the edges of the cells of " + name +
                     " are taken as straight, and the nodes in their middles are not used";
  const bool known = !cells.curved && std::ranges::all_of(cells.solids, [](const Cell& one) {
    return one.corners == 4;
  });
  if (known) {
    std::map<int, std::pair<double, double>> regions;
    std::pair<double, double> body;
    for (const Cell& cell : cells.solids) {
      const auto [whole, straight] = volumes_of(cell, cells.nodes);
      const double sign = straight < 0.0 ? -1.0 : 1.0;
      for (auto* sum : {&regions[cell.region], &body}) {
        sum->first += sign * whole;
        sum->second += sign * straight;
      }
    }
    const auto change = [](const std::pair<double, double>& volumes) {
      const double part = volumes.second / volumes.first - 1.0;
      constexpr double least = 5e-4;
      return std::abs(part) < least
                 ? "the same"
                 : percent_text(std::abs(part)) + (part < 0.0 ? " less" : " more");
    };
    text += ": of their volumes the body has " + change(body);
    for (const auto& [region, volumes] : regions) {
      if (regions.size() == 1) break;
      std::string title = std::to_string(region);
      for (const auto& [one, number] : cells.names)
        if (number == region) title = ticked(one);
      text += ", region " + title + " " + change(volumes);
    }
  }
  return text + "; a finer mesh keeps the shape";
}

std::string ending_in(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string());
}

}  // namespace

NamedMesh tetrahedra_of(const Cells& cells, const std::string& path, double metres_per_unit) {
  if (cells.solids.empty())
    throw InputError({path},
                     cells.faces.empty()
                         ? "holds no solid cells; save the tetrahedra of the volumes too"
                         : "holds faces alone; name it in `tissue.shape`, or mesh its volume");
  NamedMesh made;
  std::vector<std::array<int, 4>> found;
  std::vector<int> regions;
  std::size_t cut = 0;
  for (const Cell& cell : cells.solids) {
    if (cell.corners == 4)
      found.push_back({cell.nodes[0], cell.nodes[1], cell.nodes[2], cell.nodes[3]});
    else
      cut_into(found, cell), ++cut;
    regions.resize(found.size(), cell.region);
  }
  std::vector<int> number(cells.nodes.size(), -1);
  for (const auto& one : found)
    for (const int node : one) number[as_index(node)] = 0;
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] < 0) continue;
    number[n] = static_cast<int>(made.mesh.nodes.size());
    made.mesh.nodes.push_back(cells.nodes[n] * metres_per_unit);
  }
  for (const auto& [a, b, c, d] : found) {
    made.mesh.tetrahedra.push_back(
        {number[as_index(a)], number[as_index(b)], number[as_index(c)], number[as_index(d)]});
    auto& last = made.mesh.tetrahedra.back();
    if (geometry::signed_volume(made.mesh, static_cast<int>(made.mesh.tetrahedra.size()) - 1) < 0.0)
      std::swap(last[2], last[3]);
  }
  for (const Cell& cell : cells.solids)
    for (const auto& [from, to, middle] : bent_edges(cell, cells.nodes)) {
      const auto [a, b] = std::minmax(number[as_index(from)], number[as_index(to)]);
      made.middles[{a, b}] = cells.nodes[as_index(middle)] * metres_per_unit;
    }
  if (std::ranges::any_of(regions, [](int region) { return region != 0; }))
    made.mesh.regions = std::move(regions);
  made.names = cells.names;
  const std::string name = std::filesystem::path(path).filename().string();
  if (cut > 0)
    made.warning = std::to_string(cut) + " hexahedra, prisms and pyramids of " + name +
                   " were cut into tetrahedra";
  if (cells.curved) {
    made.middles.clear();
    made.warning += (made.warning.empty() ? "" : "; ") + straightened(cells, name);
  } else if (!made.middles.empty()) {
    made.straightened = straightened(cells, name);
  }
  return made;
}

bool holds_cells(const std::string& path) {
  const std::string ending = ending_in(path);
  return ending == ".msh" || ending == ".vtk" || ending == ".vtu" || ending == ".vtp" ||
         ending == ".inp" || ending == ".mesh";
}

Cells read_cells(const std::string& path) {
  const std::string ending = ending_in(path);
  if (ending == ".msh") return read_gmsh_cells(path);
  // Some files with the ending of the older format are XML.
  if (ending == ".vtk" && !trimmed(read_text(path).substr(0, 200)).starts_with("<"))
    return read_vtk_cells(path);
  if (ending == ".inp") return read_abaqus_cells(path);
  if (ending == ".mesh") return read_medit_cells(path);
  return read_vtu_cells(path);
}

std::vector<std::array<Vec3, 3>> faces_of_group(const std::string& path, const std::string& group,
                                                double metres_per_unit) {
  const Cells cells = holds_cells(path) ? read_cells(path) : Cells{};
  std::map<int, std::string> known;
  for (const auto& groups : cells.face_groups)
    for (const int number : groups) known[number] = std::to_string(number);
  for (const auto& [name, number] : cells.face_names) known[number] = name;
  std::vector<std::array<Vec3, 3>> found;
  for (std::size_t f = 0; f < cells.face_groups.size(); ++f) {
    if (std::ranges::none_of(cells.face_groups[f], [&](int number) {
          return group == known.at(number) || group == std::to_string(number);
        }))
      continue;
    const std::vector<int>& face = cells.faces[f];
    const auto corner = [&](std::size_t k) -> Vec3 {
      return cells.nodes[as_index(face[k])] * metres_per_unit;
    };
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      found.push_back({corner(0), corner(k), corner(k + 1)});
  }
  if (!found.empty()) return found;
  std::vector<std::string> names;
  for (const auto& [number, name] : known) names.push_back("`" + name + "`, ");
  throw KeyError("tissue.base_side", path + ": there is no group of faces `" + group +
                                         "`; `tissue.base_side` wants " + joined(names, "") +
                                         (names.empty() ? "" : "or ") + "a direction such as `-z`");
}

bool add_vtk_cell(int type, const std::vector<int>& nodes, int at, Cells& cells) {
  if (std::find(std::begin(vtk_passed_over), std::end(vtk_passed_over), type) !=
      std::end(vtk_passed_over))
    return true;
  std::vector<int> corners = nodes;
  if (type == vtk_polygon) {
    if (corners.size() < 3) return false;
    cells.faces.push_back(std::move(corners));
    return true;
  }
  if (type == vtk_voxel && corners.size() == 8) {
    std::swap(corners[2], corners[3]);
    std::swap(corners[6], corners[7]);
    type = 12;
  } else if (type == vtk_pixel && corners.size() == 4) {
    std::swap(corners[2], corners[3]);
    type = 9;
  }
  if (type == vtk_strip) {
    std::ranges::copy(triangles_of_strip(corners), std::back_inserter(cells.faces));
    return true;
  }
  const auto* const kind = std::find_if(std::begin(vtk_kinds), std::end(vtk_kinds),
                                        [&](const VtkKind& one) { return one.type == type; });
  if (kind == std::end(vtk_kinds) || corners.size() < as_index(kind->corners)) return false;
  corners.resize(as_index(kind->corners));
  if (!kind->solid) {
    cells.faces.push_back(std::move(corners));
    return true;
  }
  Cell cell{.corners = kind->corners, .region = at};
  std::ranges::copy(corners, cell.nodes.begin());
  if (type == vtk_quadratic_tetrahedron && nodes.size() == 10)
    cell.middles = {nodes[4], nodes[5], nodes[6], nodes[7], nodes[8], nodes[9]};
  else
    cells.curved = cells.curved || kind->curved;
  cells.solids.push_back(cell);
  return true;
}

std::vector<std::vector<int>> triangles_of_strip(std::span<const int> corners) {
  std::vector<std::vector<int>> found;
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    const int a = corners[i], b = corners[i + 1], c = corners[i + 2];
    if (a == b || b == c || c == a) continue;
    found.push_back(i % 2 == 0 ? std::vector<int>{a, b, c} : std::vector<int>{b, a, c});
  }
  return found;
}

void number_by(const std::vector<double>& regions, Cells& cells) {
  constexpr double most = 2147483647.0;
  for (Cell& cell : cells.solids) {
    const double number =
        as_index(cell.region) < regions.size() ? regions[as_index(cell.region)] : 0.0;
    cell.region = std::abs(number) <= most ? static_cast<int>(std::abs(number)) : 0;
  }
}

bool numbers_parts(const std::string& name) {
  for (const char* known :
       {"gmsh:physical", "medit:ref", "CellEntityIds", "cell_tags", "PhysicalIds", "abaqus:region",
        "attribute", "region", "tissue", "material", "MaterialID", "material_id"})
    if (lower_case(name) == lower_case(known)) return true;
  return false;
}

}  // namespace palpate::meshing
