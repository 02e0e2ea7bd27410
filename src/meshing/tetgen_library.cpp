// Converts surfaces and meshes to and from TetGen's arrays; the only file that includes tetgen.h.
#define TETLIBRARY
#include "meshing/tetgen_library.h"

#include <tetgen.h>

#include <utility>

namespace palpate::meshing::tetgen_library {
namespace {

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
  for (const auto& triangle : surface.triangles) {
    tetgenio::init(facet);
    facet->numberofpolygons = 1;
    facet->polygonlist = new tetgenio::polygon[1];
    facet->polygonlist->numberofvertices = 3;
    facet->polygonlist->vertexlist = new int[3]{triangle[0], triangle[1], triangle[2]};
    ++facet;
  }
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

}  // namespace

geometry::TetMesh run(const geometry::Surface& surface, const std::string& switches) {
  tetgenio in;
  tetgenio out;
  fill(in, surface);
  std::string quiet = "Q" + switches;  // TetGen needs a writable text
  tetrahedralize(quiet.data(), &in, &out);
  return taken(out);
}

}  // namespace palpate::meshing::tetgen_library
