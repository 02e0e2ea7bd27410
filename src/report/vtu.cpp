// Writes VTK's XML files with numbers in base64.
#include "report/vtu.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "base/units.h"
#include "base/written.h"

namespace palpate::report {
namespace {

static_assert(std::endian::native == std::endian::little, "the files declare LittleEndian");

// The beginning of a file, up to an element `name`, which is left open.
std::string xml_file(const char* name) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"";
  text += name;
  text += "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<";
  text += name;
  return text += ">\n";
}

// One array. The base64 text contains the number of bytes, then the numbers.
template <class Number>
std::string array(std::string_view type, const std::string& name, const std::string& attributes,
                  const std::vector<Number>& values) {
  const std::uint64_t size = values.size() * sizeof(Number);
  std::string bytes(sizeof size + size, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + sizeof size, values.data(), size);
  return "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\"" + attributes +
         " format=\"binary\">" + base64(bytes) + "</DataArray>\n";
}

std::string doubles(const std::string& name, int components, const std::vector<double>& values,
                    std::span<const char* const> component_names = {}) {
  std::string attributes =
      components == 1 ? "" : " NumberOfComponents=\"" + std::to_string(components) + "\"";
  for (std::size_t i = 0; i < component_names.size(); ++i)
    attributes += " ComponentName" + std::to_string(i) + "=\"" + component_names[i] + "\"";
  return array("Float64", name, attributes, values);
}

std::vector<double> in_mm(std::span<const Vec3> vectors) {
  std::vector<double> values;
  for (const Vec3& vector : vectors)
    for (int axis = 0; axis < 3; ++axis) values.push_back(unit::mm.from_si(vector[axis]));
  return values;
}

std::string points(const VtuFrame& frame) {
  std::vector<Vec3> deformed = frame.mesh.nodes;
  for (std::size_t n = 0; n < frame.displacement.size(); ++n) deformed[n] += frame.displacement[n];
  return "<Points>\n" + doubles("Points", 3, in_mm(deformed)) + "</Points>\n";
}

std::string cells(const geometry::TetMesh& mesh) {
  constexpr std::uint8_t vtk_tetra = 10;
  std::vector<std::int32_t> corners, ends;
  for (const auto& tetrahedron : mesh.tetrahedra) {
    corners.insert(corners.end(), tetrahedron.begin(), tetrahedron.end());
    ends.push_back(static_cast<std::int32_t>(corners.size()));
  }
  const std::vector<std::uint8_t> types(mesh.tetrahedra.size(), vtk_tetra);
  return "<Cells>\n" + array("Int32", "connectivity", "", corners) +
         array("Int32", "offsets", "", ends) + array("UInt8", "types", "", types) + "</Cells>\n";
}

std::string point_data(const VtuFrame& frame) {
  std::string text = "<PointData>\n";
  if (!frame.displacement.empty()) text += doubles("displacement_mm", 3, in_mm(frame.displacement));
  if (!frame.contact_pressure.empty()) {
    std::vector<double> shown;
    for (const double pressure : frame.contact_pressure)
      shown.push_back(unit::kPa.from_si(pressure));
    text += doubles("contact_pressure_kPa", 1, shown);
  }
  return text + "</PointData>\n";
}

// sqrt(2/3 e:e) of the deviatoric strain; each shear component occurs twice in e:e.
double equivalent(const Strain& strain, double volume_change) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double normal = strain[i] - volume_change / 3.0;
    sum += normal * normal + 2.0 * strain[i + 3] * strain[i + 3];
  }
  return std::sqrt(2.0 / 3.0 * sum);
}

std::string cell_data(const VtuFrame& frame) {
  std::vector<std::int32_t> tissues;
  for (std::size_t t = 0; t < frame.mesh.tetrahedra.size(); ++t)
    tissues.push_back(frame.mesh.region(static_cast<int>(t)));
  std::string text = "<CellData>\n" + array("Int32", "tissue", "", tissues);
  if (!frame.strain.empty()) {
    std::vector<double> components, volume_changes, equivalents;
    for (const Strain& strain : frame.strain) {
      components.insert(components.end(), strain.begin(), strain.end());
      volume_changes.push_back(strain[0] + strain[1] + strain[2]);
      equivalents.push_back(equivalent(strain, volume_changes.back()));
    }
    constexpr std::array names{"xx", "yy", "zz", "xy", "yz", "xz"};
    text += doubles("strain", 6, components, names) + doubles("volume_change", 1, volume_changes) +
            doubles("equivalent_strain", 1, equivalents);
  }
  return text + "</CellData>\n";
}

}  // namespace

std::string vtu_bytes(const VtuFrame& frame) {
  const std::size_t nodes = frame.mesh.nodes.size();
  const std::size_t tetrahedra = frame.mesh.tetrahedra.size();
  assert(frame.displacement.empty() || frame.displacement.size() == nodes);
  assert(frame.contact_pressure.empty() || frame.contact_pressure.size() == nodes);
  assert(frame.strain.empty() || frame.strain.size() == tetrahedra);
  return xml_file("UnstructuredGrid") + "<FieldData>\n" +
         array("Float64", "TimeValue", " NumberOfTuples=\"1\"", std::vector<double>{frame.time}) +
         "</FieldData>\n<Piece NumberOfPoints=\"" + std::to_string(nodes) + "\" NumberOfCells=\"" +
         std::to_string(tetrahedra) + "\">\n" + point_data(frame) + cell_data(frame) +
         points(frame) + cells(frame.mesh) + "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

std::string pvd_bytes(std::span<const TimedFile> files) {
  std::string text = xml_file("Collection");
  for (const TimedFile& entry : files)
    text += "<DataSet timestep=\"" + number_text(entry.time) + "\" part=\"0\" file=\"" +
            escaped(entry.file) + "\"/>\n";
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace palpate::report
