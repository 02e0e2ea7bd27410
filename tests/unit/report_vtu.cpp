// The .vtu file: well-formed XML whose decoded arrays are the frame's numbers; the .pvd list.
#include "report/vtu.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <vector>

#include "geometry/cuboid.h"

namespace palpate::report {
namespace {

struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;
  std::vector<Element> children;

  // The only child of that name.
  [[nodiscard]] const Element& child(const std::string& wanted) const {
    const Element* found = nullptr;
    for (const Element& each : children)
      if (each.name == wanted) {
        EXPECT_EQ(found, nullptr) << "two of " << wanted;
        found = &each;
      }
    if (!found) throw std::runtime_error("no element " + wanted + " in " + name);
    return *found;
  }

  [[nodiscard]] const Element& array(const std::string& wanted) const {
    for (const Element& each : children)
      if (each.attributes.at("Name") == wanted) return each;
    throw std::runtime_error("no array " + wanted + " in " + name);
  }
};

// As much XML as these files use; throws std::runtime_error where it is not well-formed.
class Xml {
 public:
  explicit Xml(const std::string& text) : text_(text) {}

  Element root() {
    expect("<?xml version=\"1.0\"?>\n");
    Element root = element();
    expect("\n");
    if (at_ != text_.size()) throw std::runtime_error("text after the root");
    return root;
  }

 private:
  void expect(const std::string& piece) {
    if (text_.compare(at_, piece.size(), piece) != 0)
      throw std::runtime_error("wants " + piece + " at " + std::to_string(at_));
    at_ += piece.size();
  }

  std::string until(const std::string& ends) {
    const std::size_t end = text_.find_first_of(ends, at_);
    if (end == std::string::npos) throw std::runtime_error("breaks off");
    const std::string found = text_.substr(at_, end - at_);
    at_ = end;
    return found;
  }

  Element element() {
    Element result;
    expect("<");
    result.name = until(" />");
    while (text_[at_] == ' ') {
      ++at_;
      const std::string key = until("=");
      expect("=\"");
      const std::string value = until("\"<");
      expect("\"");
      if (!result.attributes.emplace(key, value).second) throw std::runtime_error("twice " + key);
    }
    if (text_[at_] == '/') {
      expect("/>");
      return result;
    }
    expect(">");
    while (true) {
      result.text += until("<");
      if (text_[at_ + 1] == '/') break;
      result.children.push_back(element());
    }
    expect("</" + result.name + ">");
    return result;
  }

  const std::string& text_;
  std::size_t at_ = 0;
};

std::string decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  EXPECT_EQ(text.size() % 4, 0u);
  const std::size_t length = std::min(text.find('='), text.size());
  EXPECT_LE(text.size() - length, 2u);
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (std::size_t i = 0; i < length; ++i) {
    const std::size_t digit = digits.find(text[i]);
    EXPECT_NE(digit, std::string::npos);
    bits = bits << 6U | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(count) & 255U);
  }
  return bytes;
}

template <class Number>
std::vector<Number> numbers(const Element& array, const std::string& type) {
  EXPECT_EQ(array.attributes.at("type"), type);
  EXPECT_EQ(array.attributes.at("format"), "binary");
  const std::string bytes = decoded(array.text);
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data(), sizeof size);
  EXPECT_EQ(size, bytes.size() - sizeof size);
  std::vector<Number> values(size / sizeof(Number));
  if (size > 0) std::memcpy(values.data(), bytes.data() + sizeof size, size);
  return values;
}

std::vector<double> doubles(const Element& array) { return numbers<double>(array, "Float64"); }

class Vtu : public testing::Test {
 protected:
  Vtu() {
    for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
      mesh_.regions.push_back(static_cast<int>(t) - 2);
      strain_.push_back({0.1, 0.02, -0.03, 0.004, 0.005, 1e-3 * static_cast<double>(t)});
    }
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
      displacement_.emplace_back(1e-3 / static_cast<double>(n + 3), -2e-3, 0.0);
      pressure_.push_back(1e3 / static_cast<double>(n + 7));
    }
  }

  [[nodiscard]] VtuFrame frame() const {
    return {.mesh = mesh_,
            .time = 0.1,
            .displacement = displacement_,
            .contact_pressure = pressure_,
            .strain = strain_};
  }

  static Element piece(const std::string& bytes) {
    return Xml(bytes).root().child("UnstructuredGrid").child("Piece");
  }

  geometry::TetMesh mesh_ =
      geometry::cuboid({0.06, 0.05, 0.03}, {2, 1, 1}, geometry::CellPattern::kuhn);
  std::vector<Vec3> displacement_;
  std::vector<double> pressure_;
  std::vector<Strain> strain_;
};

TEST_F(Vtu, SaysWhatItIs) {
  const std::string bytes = vtu_bytes(frame());
  const Element root = Xml(bytes).root();
  EXPECT_EQ(root.name, "VTKFile");
  EXPECT_EQ(root.attributes.at("type"), "UnstructuredGrid");
  EXPECT_EQ(root.attributes.at("version"), "1.0");
  EXPECT_EQ(root.attributes.at("byte_order"), "LittleEndian");
  EXPECT_EQ(root.attributes.at("header_type"), "UInt64");
  const Element& grid = root.child("UnstructuredGrid");
  EXPECT_EQ(doubles(grid.child("FieldData").array("TimeValue")), std::vector<double>{0.1});
  EXPECT_EQ(grid.child("Piece").attributes.at("NumberOfPoints"), "12");
  EXPECT_EQ(grid.child("Piece").attributes.at("NumberOfCells"), "12");
}

TEST_F(Vtu, PointsLessDisplacementAreTheBodyAtRest) {
  const Element file = piece(vtu_bytes(frame()));
  const std::vector<double> points = doubles(file.child("Points").array("Points"));
  const Element& moved = file.child("PointData").array("displacement_mm");
  EXPECT_EQ(moved.attributes.at("NumberOfComponents"), "3");
  EXPECT_EQ(file.child("Points").array("Points").attributes.at("NumberOfComponents"), "3");
  const std::vector<double> displacement = doubles(moved);
  ASSERT_EQ(points.size(), 36u);
  ASSERT_EQ(displacement.size(), 36u);
  for (std::size_t i = 0; i < 36; ++i) {
    const auto axis = static_cast<Eigen::Index>(i % 3);
    EXPECT_NEAR(displacement[i], 1e3 * displacement_[i / 3][axis], 1e-15);            // rounding
    EXPECT_NEAR(points[i] - displacement[i], 1e3 * mesh_.nodes[i / 3][axis], 1e-13);  // rounding
  }
}

TEST_F(Vtu, CarriesPressureAndTissue) {
  const Element file = piece(vtu_bytes(frame()));
  const std::vector<double> pressure =
      doubles(file.child("PointData").array("contact_pressure_kPa"));
  ASSERT_EQ(pressure.size(), 12u);
  for (std::size_t n = 0; n < 12; ++n)
    EXPECT_NEAR(pressure[n], 1e-3 * pressure_[n], 1e-15 * pressure_[n]);  // rounding
  EXPECT_EQ(numbers<std::int32_t>(file.child("CellData").array("tissue"), "Int32"),
            std::vector<std::int32_t>(mesh_.regions.begin(), mesh_.regions.end()));
}

TEST_F(Vtu, CarriesTetrahedra) {
  const Element file = piece(vtu_bytes(frame()));
  const Element& cells = file.child("Cells");
  const auto corners = numbers<std::int32_t>(cells.array("connectivity"), "Int32");
  const auto ends = numbers<std::int32_t>(cells.array("offsets"), "Int32");
  ASSERT_EQ(corners.size(), 48u);
  for (std::size_t t = 0; t < 12; ++t) {
    EXPECT_EQ(ends[t], static_cast<std::int32_t>(4 * t + 4));
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(corners[4 * t + c], mesh_.tetrahedra[t][c]);
  }
  EXPECT_EQ(numbers<std::uint8_t>(cells.array("types"), "UInt8"),
            std::vector<std::uint8_t>(12, 10));  // VTK_TETRA
}

// By hand for the first cell: trace 0.09, deviator 0.07, -0.01, -0.06, shears 0.004, 0.005, 0.
TEST_F(Vtu, CarriesStrain) {
  const Element file = piece(vtu_bytes(frame()));
  const Element& data = file.child("CellData");
  EXPECT_EQ(data.array("strain").attributes.at("NumberOfComponents"), "6");
  EXPECT_EQ(data.array("strain").attributes.at("ComponentName3"), "xy");
  const std::vector<double> strain = doubles(data.array("strain"));
  ASSERT_EQ(strain.size(), 72u);
  for (std::size_t i = 0; i < 72; ++i) EXPECT_EQ(strain[i], strain_[i / 6][i % 6]);
  EXPECT_NEAR(doubles(data.array("volume_change"))[0], 0.09, 1e-16);  // rounding
  const double sum = 0.07 * 0.07 + 0.01 * 0.01 + 0.06 * 0.06 + 2 * (0.004 * 0.004 + 0.005 * 0.005);
  const std::vector<double> equivalent = doubles(data.array("equivalent_strain"));
  EXPECT_NEAR(equivalent[0], std::sqrt(2.0 / 3.0 * sum), 1e-15);  // rounding
  EXPECT_NEAR(equivalent[7], std::sqrt(2.0 / 3.0 * (sum + 2 * 0.007 * 0.007)), 1e-15);
}

// A bar pulled by e along z that keeps its volume has the equivalent strain e.
TEST_F(Vtu, EquivalentStrainOfAPulledBar) {
  strain_.assign(12, {-0.01, -0.01, 0.02, 0, 0, 0});
  const Element file = piece(vtu_bytes(frame()));
  EXPECT_NEAR(doubles(file.child("CellData").array("equivalent_strain"))[3], 0.02, 1e-16);
}

TEST_F(Vtu, LeavesOutWhatIsNotThere) {
  mesh_.regions.clear();
  const Element file = piece(vtu_bytes({.mesh = mesh_}));
  EXPECT_TRUE(file.child("PointData").children.empty());
  ASSERT_EQ(file.child("CellData").children.size(), 1u);
  EXPECT_EQ(numbers<std::int32_t>(file.child("CellData").array("tissue"), "Int32"),
            std::vector<std::int32_t>(12, 0));
  EXPECT_EQ(doubles(file.child("Points").array("Points"))[33], 60.0);
}

// Byte counts that leave 0, 1 and 2 bytes over in base64, and the smallest mesh.
TEST_F(Vtu, AllLengthsAreEncoded) {
  for (int cells = 1; cells < 5; ++cells) {
    const geometry::TetMesh mesh =
        geometry::cuboid({1, 1, 1}, {cells, 1, 1}, geometry::CellPattern::kuhn);
    const Element file = piece(vtu_bytes({.mesh = mesh}));
    EXPECT_EQ(numbers<std::uint8_t>(file.child("Cells").array("types"), "UInt8").size(),
              mesh.tetrahedra.size());
  }
  const Element empty = piece(vtu_bytes({.mesh = {}}));
  EXPECT_TRUE(doubles(empty.child("Points").array("Points")).empty());
}

TEST_F(Vtu, KeepsWhatIsNotANumber) {
  pressure_[4] = std::numeric_limits<double>::quiet_NaN();
  const Element file = piece(vtu_bytes(frame()));
  EXPECT_TRUE(std::isnan(doubles(file.child("PointData").array("contact_pressure_kPa"))[4]));
}

TEST_F(Vtu, SameFrameSameBytes) {
  const std::string bytes = vtu_bytes(frame());
  EXPECT_EQ(bytes, vtu_bytes(frame()));
  displacement_[3].z() = 1e-18;
  EXPECT_NE(bytes, vtu_bytes(frame()));
}

// The first bytes as VTK 9.1's own reader takes them: 8 bytes of size and 8 of 0.25 in one text.
TEST_F(Vtu, TheSizeStandsInsideTheSameText) {
  VtuFrame quarter = frame();
  quarter.time = 0.25;
  EXPECT_NE(vtu_bytes(quarter).find(">CAAAAAAAAAAAAAAAAADQPw==<"), std::string::npos);
}

TEST(Pvd, ListsFilesByTime) {
  const std::vector<TimedFile> files{{0.0, "tissue_000.vtu"}, {0.1, "a & \"b\" <c>.vtu"}};
  const std::string bytes = pvd_bytes(files);
  const Element root = Xml(bytes).root();
  EXPECT_EQ(root.attributes.at("type"), "Collection");
  const Element& collection = root.child("Collection");
  ASSERT_EQ(collection.children.size(), 2u);
  EXPECT_EQ(collection.children[0].attributes.at("timestep"), "0");
  EXPECT_EQ(collection.children[0].attributes.at("file"), "tissue_000.vtu");
  EXPECT_EQ(collection.children[1].attributes.at("timestep"), "0.1");
  EXPECT_EQ(collection.children[1].attributes.at("file"), "a &amp; &quot;b&quot; &lt;c&gt;.vtu");
  EXPECT_TRUE(Xml(pvd_bytes({})).root().child("Collection").children.empty());
}

}  // namespace
}  // namespace palpate::report
