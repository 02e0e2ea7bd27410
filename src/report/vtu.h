// A deformed mesh as a file for ParaView, and the list of such files over time.
#pragma once

#include <array>
#include <span>
#include <string>

#include "geometry/tet_mesh.h"

namespace palpate::report {

// Small strain of a tetrahedron: xx, yy, zz, xy, yz, xz, the order of VTK for symmetric tensors.
// Shear components are those of the tensor, half of the engineering shear strains.
using Strain = std::array<double, 6>;

// The mesh at one time. Empty spans are not in the file.
struct VtuFrame {
  const geometry::TetMesh& mesh;                  // undeformed
  double time = 0.0;                              // s
  std::span<const Vec3> displacement = {};        // m, one per node
  std::span<const double> contact_pressure = {};  // Pa, one per node, compression positive
  std::span<const Strain> strain = {};            // one per tetrahedron
};

// Returns the frame as the bytes of a .vtu file: VTK's XML UnstructuredGrid, version 1.0, arrays in
// base64, numbers in double precision. Points are the deformed positions in mm. Point data are
// `displacement_mm` (a warp with factor -1 shows the undeformed body) and `contact_pressure_kPa`;
// cell data are `tissue` (the mesh's region), `strain`, `volume_change` (its trace) and
// `equivalent_strain`, sqrt(2/3 e:e) of the deviatoric strain; `TimeValue` is in s. The same frame
// gives the same bytes. Format: VTK's documentation, "XML file formats".
[[nodiscard]] std::string vtu_bytes(const VtuFrame& frame);

// One file of a collection.
struct TimedFile {
  double time = 0.0;  // s
  std::string file;   // path relative to the .pvd file
};

// Returns the bytes of a .pvd file, with which ParaView opens all `files` as one animation.
[[nodiscard]] std::string pvd_bytes(std::span<const TimedFile> files);

}  // namespace palpate::report
