// A deformed mesh as a file for ParaView, and the list of such files over time.
#pragma once

#include <array>
#include <span>
#include <string>

#include "geometry/tet_mesh.h"

namespace palpate::report {

// Small strain of a tetrahedron: xx, yy, zz, xy, yz, xz, VTK's order for symmetric tensors; the
// shears are the tensor's, half of the engineer's.
using Strain = std::array<double, 6>;

// What one moment shows. Spans of length 0 are left out of the file.
struct VtuFrame {
  const geometry::TetMesh& mesh;                  // at rest
  double time = 0.0;                              // s
  std::span<const Vec3> displacement = {};        // m, one a node
  std::span<const double> contact_pressure = {};  // Pa, one a node, compression positive
  std::span<const Strain> strain = {};            // one a tetrahedron
};

// The frame as the bytes of a .vtu file: VTK's XML UnstructuredGrid, version 1.0, arrays in base64,
// doubles in full. Points are the deformed positions in mm. At the points stand `displacement_mm`
// (a warp by it with factor -1 shows the body at rest) and `contact_pressure_kPa`; in the cells
// `tissue` (the mesh's region), `strain`, `volume_change` (its trace) and `equivalent_strain`,
// sqrt(2/3 e:e) of the strain without its volume change; `TimeValue` in s. The same frame gives
// the same bytes. Format: VTK's documentation, "XML file formats".
[[nodiscard]] std::string vtu_bytes(const VtuFrame& frame);

// One file of a collection; `file` as seen from the .pvd.
struct TimedFile {
  double time = 0.0;  // s
  std::string file;
};

// The bytes of a .pvd file, which opens all of them in ParaView as one animation.
[[nodiscard]] std::string pvd_bytes(std::span<const TimedFile> files);

}  // namespace palpate::report
