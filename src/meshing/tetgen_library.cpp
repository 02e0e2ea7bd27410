// Converts surfaces and meshes to and from TetGen's arrays; the only file that includes tetgen.h.
#define TETLIBRARY
#include "meshing/tetgen_library.h"

#include <tetgen.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/index.h"
#include "geometry/box_tree.h"

namespace palpate::meshing::tetgen_library {
namespace {

void fill(tetgenio::facet& facet, const std::array<int, 3>& triangle) {
  tetgenio::init(&facet);
  facet.numberofpolygons = 1;
  facet.polygonlist = new tetgenio::polygon[1];
  facet.polygonlist->numberofvertices = 3;
  facet.polygonlist->vertexlist = new int[3]{triangle[0], triangle[1], triangle[2]};
}

// TetGen frees the arrays with delete[], so they are allocated with new[].
void fill(tetgenio& io, const geometry::Surface& surface) {
  io.numberofpoints = static_cast<int>(surface.vertices.size());
  io.pointlist = new double[3 * surface.vertices.size()];
  double* coordinate = io.pointlist;
  for (const Vec3& vertex : surface.vertices)
    for (int axis = 0; axis < 3; ++axis) *coordinate++ = vertex[axis];

  io.numberoffacets = static_cast<int>(surface.triangles.size());
  io.facetlist = new tetgenio::facet[surface.triangles.size()];
  tetgenio::facet* facet = io.facetlist;
  for (const auto& triangle : surface.triangles) fill(*facet++, triangle);
}

geometry::TetMesh taken(const tetgenio& io) {
  geometry::TetMesh mesh;
  for (int n = 0; n < io.numberofpoints; ++n)
    mesh.nodes.emplace_back(io.pointlist[3 * n], io.pointlist[3 * n + 1], io.pointlist[3 * n + 2]);
  for (int t = 0; t < io.numberoftetrahedra; ++t) {
    const int* corner = io.tetrahedronlist + static_cast<std::ptrdiff_t>(t) * io.numberofcorners;
    mesh.tetrahedra.push_back({corner[0], corner[1], corner[2], corner[3]});
    if (geometry::signed_volume(mesh, t) < 0.0)
      std::swap(mesh.tetrahedra.back()[2], mesh.tetrahedra.back()[3]);
  }
  // With `A` the only attribute of a tetrahedron is the number of its region.
  for (int t = 0; io.numberoftetrahedronattributes > 0 && t < io.numberoftetrahedra; ++t)
    mesh.regions.push_back(
        static_cast<int>(io.tetrahedronattributelist[t * io.numberoftetrahedronattributes]));
  return mesh;
}

// The size that TetGen's callback asks for; the child process exists for one mesh only.
const std::function<double(const Vec3&)>* wanted_size = nullptr;

constexpr double longest = 2.2;

// Whether a tetrahedron is too large: by its volume, that of a regular one with the wanted edges
// being 0.118, or by its longest edge.
bool too_large(double* a, double* b, double* c, double* d, double*, double) {
  constexpr double largest = 0.26;
  const std::array<Vec3, 4> corner{Vec3(a[0], a[1], a[2]), Vec3(b[0], b[1], b[2]),
                                   Vec3(c[0], c[1], c[2]), Vec3(d[0], d[1], d[2])};
  const double size = (*wanted_size)(0.25 * (corner[0] + corner[1] + corner[2] + corner[3]));
  double most = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j) most = std::max(most, (corner[i] - corner[j]).norm());
  const double volume =
      std::abs((corner[1] - corner[0]).cross(corner[2] - corner[0]).dot(corner[3] - corner[0])) /
      6.0;
  return volume > largest * size * size * size || most > longest * size;
}

// TetGen gives a tetrahedron up where a new node at the centre of its sphere would come too near to
// the surface: below a contact on a bent surface a few hundred may stay twenty times as long as
// they should. The middles of what such tetrahedra are halved into, apart from each other and from
// the surface.
std::vector<Vec3> nodes_inside(const geometry::TetMesh& mesh, const geometry::BoxTree& surface,
                               const std::function<double(const Vec3&)>& size) {
  constexpr double given_up = 2.0 * longest;
  constexpr double apart = 0.7;
  std::vector<Vec3> found;
  std::vector<std::array<Vec3, 4>> pieces;
  for (const auto& corners : mesh.tetrahedra) {
    pieces.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) pieces.back()[i] = mesh.nodes[as_index(corners[i])];
    bool whole = true;
    while (!pieces.empty()) {
      const std::array<Vec3, 4> piece = pieces.back();
      pieces.pop_back();
      const Vec3 middle = 0.25 * (piece[0] + piece[1] + piece[2] + piece[3]);
      std::array<std::size_t, 2> edge{0, 1};
      for (const auto& [i, j] : geometry::corner_edges)
        if ((piece[as_index(i)] - piece[as_index(j)]).norm() >
            (piece[edge[0]] - piece[edge[1]]).norm())
          edge = {as_index(i), as_index(j)};
      const double wanted = size(middle);
      const double length = (piece[edge[0]] - piece[edge[1]]).norm();
      if (whole && length <= given_up * wanted) break;
      whole = false;
      if (length > wanted) {
        for (const std::size_t end : edge) {
          pieces.push_back(piece);
          pieces.back()[end] = 0.5 * (piece[edge[0]] + piece[edge[1]]);
        }
        continue;
      }
      const double least = apart * apart * wanted * wanted;
      if (surface.nearest(middle).distance_squared < least) continue;
      if (std::ranges::none_of(
              found, [&](const Vec3& other) { return (other - middle).squaredNorm() < least; }))
        found.push_back(middle);
    }
  }
  return found;
}

}  // namespace

PieceMesh run(const Pieces& pieces, const std::function<double(const Vec3&)>& size,
              const std::string& switches) {
  wanted_size = &size;
  const geometry::BoxTree tree(pieces.surface);
  geometry::Surface filled = pieces.surface;
  std::string quiet = "Q" + switches;
  constexpr int most_times = 4;
  PieceMesh made;
  for (int times = 0; times < most_times; ++times) {
    tetgenio in;
    tetgenio out;
    fill(in, filled);
    in.facetmarkerlist = new int[pieces.numbers.size()];
    std::ranges::copy(pieces.numbers, in.facetmarkerlist);
    in.tetunsuitable = &too_large;
    tetrahedralize(quiet.data(), &in, &out);
    made = {taken(out), {}, {}};
    for (int f = 0; f < out.numberoftrifaces; ++f) {
      const int* corner = out.trifacelist + 3 * f;
      made.faces.push_back({corner[0], corner[1], corner[2]});
      made.numbers.push_back(out.trifacemarkerlist[f]);
    }
    const std::vector<Vec3> inside = nodes_inside(made.mesh, tree, size);
    if (inside.empty()) break;
    filled.vertices.insert(filled.vertices.end(), inside.begin(), inside.end());
  }
  return made;
}

geometry::TetMesh run(const geometry::Surface& surface, const std::string& switches) {
  tetgenio in;
  tetgenio out;
  fill(in, surface);
  std::string quiet = "Q" + switches;  // TetGen needs a writable text
  tetrahedralize(quiet.data(), &in, &out);
  return taken(out);
}

}  // namespace palpate::meshing::tetgen_library
