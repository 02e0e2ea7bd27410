// The tetrahedra of a specimen from the shape, mesh and regions of a scenario.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/shapes.h"
#include "geometry/surface.h"
#include "geometry/tet_mesh.h"
#include "meshing/cells.h"
#include "meshing/surface_repair.h"
#include "scenario/resolved.h"

namespace palpate::scene {

// The shape as a parametric one; nothing for half-spaces and shapes from files.
[[nodiscard]] std::optional<geometry::Shape> parametric(const scenario::Shape& shape);

// The heights (m) of the interfaces between layers and tissue, ascending.
[[nodiscard]] std::vector<double> slab_levels(const scenario::Resolved& scenario);

// The scenario's inclusions; their regions' numbers are those of specimen_mesh().
[[nodiscard]] std::vector<geometry::Inclusion> inclusions_of(const scenario::Resolved& scenario);

// Regions are laid in their order, later over earlier. Throws MeshError if a layer takes more than
// a hundredth of an inclusion before it.
void refuse_covered_inclusions(const scenario::Resolved& scenario);

// All parts of the surface from the scenario's file, not turned. Throws InputError if it cannot be
// read, MeshError if it bounds no body.
[[nodiscard]] meshing::MendedSurface all_parts_of(const scenario::Resolved& scenario,
                                                  const std::string& folder);

// The part of them that the scenario presses, or MeshError.
[[nodiscard]] meshing::WholeSurface part_of(const meshing::MendedSurface& all,
                                            const scenario::Resolved& scenario);

// The mesh from the scenario's file, not turned, with the file's numbers of regions. Throws
// InputError if it cannot be read, MeshError for a size that no body has.
[[nodiscard]] meshing::NamedMesh mesh_of(const scenario::MeshFile& file, const std::string& folder);

// The triangles of the group of faces that `tissue.base_side` names in the body's file, not turned.
// Throws InputError if there is none.
[[nodiscard]] std::vector<std::array<Vec3, 3>> faces_of_base(const scenario::Resolved& scenario,
                                                             const std::string& folder);

struct SpecimenMesh {
  geometry::TetMesh mesh;
  std::string warning = {};  // that of meshing::FileMesh or meshing::NamedMesh, or empty
  std::map<std::string, int> names = {};  // of the file's regions
  geometry::EdgeMiddles middles = {};     // of a file, as are those of meshing::NamedMesh
  std::string straightened = {};
};

// The mesh with the numbers of its substances: TetMesh::regions are 0 for `tissue.material`, then
// the scenario's regions in order. For a uniform test, a shape that lies along y is turned to stand
// on its end. `of_file` is the surface of a SurfaceFile, turned. Relative files are looked for in
// `folder`. Throws MeshError if the shape cannot be
// meshed, or if the mesh has no tetrahedron of a region; InputError for a file that cannot be read.
[[nodiscard]] SpecimenMesh specimen_mesh(const scenario::Resolved& scenario,
                                         const std::string& folder,
                                         const geometry::Surface* of_file);

}  // namespace palpate::scene
