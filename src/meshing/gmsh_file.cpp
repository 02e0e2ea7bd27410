// Reads the sections between `$Name` and `$EndName`, and skips those that a mesh does not need.
#include "meshing/gmsh_file.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>

#include "meshing/table_lines.h"

namespace palpate::meshing {
namespace {

constexpr int four_node_tetrahedron = 4;

// Hexahedra, prisms, pyramids and all solid elements of higher order.
bool other_solid(int type) {
  return (type >= 5 && type <= 7) || (type >= 11 && type <= 14) || (type >= 17 && type <= 19) ||
         (type >= 29 && type <= 33) || (type >= 71 && type <= 125);
}

class Reader {
 public:
  Reader(const std::string& path, double metres_per_unit)
      : lines_(path), metres_per_unit_(metres_per_unit) {}

  geometry::TetMesh read() {
    read_format();
    while (lines_.next()) {
      const std::string section(lines_.words()[0]);
      if (section == "$Entities" && version_4_) {
        read_entities();
      } else if (section == "$Nodes") {
        version_4_ ? read_nodes_4() : read_nodes_2();
      } else if (section == "$Elements") {
        version_4_ ? read_elements_4() : read_elements_2();
      } else if (section == "$PartitionedEntities") {
        lines_.fail_at(0, "the mesh is cut into partitions; save it without them");
      } else if (section.starts_with("$") && !section.starts_with("$End")) {
        skip(section);
        continue;
      } else {
        lines_.fail_at(0, "a section such as `$Nodes` should begin here, got `" + section +
                              "`; save the file again from Gmsh");
      }
      expect_end(section);
    }
    if (corners_.empty())
      lines_.fail(
          "the file holds no tetrahedra with four nodes; mesh the volumes in first order (`gmsh "
          "-3`), and where there are physical groups put the volumes into them");
    return assembled();
  }

 private:
  void read_format() {
    if (!lines_.next() || lines_.words()[0] != "$MeshFormat")
      lines_.fail(
          "the file does not begin with `$MeshFormat`; save it from Gmsh as ASCII 4.1 "
          "(`gmsh -format msh41`)");
    step("$MeshFormat", 2);
    const std::string version(lines_.words()[0]);
    if (version != "4.1" && version != "2.2")
      lines_.fail_at(
          0, "version `" + version + "` is not read; save it as ASCII 4.1 (`gmsh -format msh41`)");
    if (lines_.words()[1] != "0")
      lines_.fail_at(1,
                     "the file is binary; save it as ASCII 4.1 (`gmsh -format msh41` without "
                     "`-bin`)");
    version_4_ = version == "4.1";
    expect_end("$MeshFormat");
  }

  // Goes to the next line of a section, which must have at least `least` words.
  void step(const std::string& section, std::size_t least) {
    if (!lines_.next() || lines_.words()[0].starts_with("$"))
      lines_.fail("section `" + section + "` ends too early; save the file again from Gmsh");
    if (lines_.words().size() < least)
      lines_.fail("the line has " + std::to_string(lines_.words().size()) +
                  " words, but at least " + std::to_string(least) +
                  " belong here; save the file again from Gmsh");
  }

  void expect_end(const std::string& section) {
    const std::string end = "$End" + section.substr(1);
    if (!lines_.next() || lines_.words()[0] != end)
      lines_.fail("`" + end + "` should stand here; save the file again from Gmsh");
  }

  void skip(const std::string& section) {
    const std::string end = "$End" + section.substr(1);
    while (lines_.next())
      if (lines_.words()[0] == end) return;
    lines_.fail("section `" + section + "` has no `" + end + "`; save the file again from Gmsh");
  }

  int count(std::size_t i, const std::string& what) const {
    const int number = lines_.whole(i, what);
    if (number < 0)
      lines_.fail_at(i, what + " wants 0 or more, got `" + std::string(lines_.words()[i]) +
                            "`; save the file again from Gmsh");
    return number;
  }

  // Reads the physical group of each volume.
  void read_entities() {
    const std::string section = "$Entities";
    step(section, 4);
    int others = 0;
    for (std::size_t i = 0; i < 3; ++i) others += count(i, "the number of entities");
    const int volumes = count(3, "the number of volumes");
    for (int i = 0; i < others; ++i) step(section, 1);
    for (int i = 0; i < volumes; ++i) {
      step(section, 8);  // tag, box (6), number of groups, groups
      const int groups = count(7, "the number of physical groups");
      if (groups > 1)
        lines_.fail_at(7, "the volume belongs to " + std::to_string(groups) +
                              " physical groups, so its tissue is not clear; leave it in one");
      if (groups == 0) continue;
      if (lines_.words().size() < 9)
        lines_.fail_at(7,
                       "the group's tag is missing; save the file "
                       "again from Gmsh");
      volume_region_[lines_.whole(0, "the volume's tag")] = region(8);
    }
  }

  // A negative tag means that the group reverses the element, which has no effect here.
  int region(std::size_t i) const { return std::abs(lines_.whole(i, "the physical tag")); }

  void add_node(int tag, std::size_t first) {
    const double x = lines_.number(first, "x");
    const double y = lines_.number(first + 1, "y");
    const double z = lines_.number(first + 2, "z");
    if (!node_of_tag_.emplace(tag, static_cast<int>(nodes_.size())).second)
      lines_.fail("there are two nodes with tag " + std::to_string(tag) +
                  "; save the file again from Gmsh");
    nodes_.emplace_back(x * metres_per_unit_, y * metres_per_unit_, z * metres_per_unit_);
  }

  void read_nodes_2() {
    step("$Nodes", 1);
    const int total = count(0, "the number of nodes");
    for (int i = 0; i < total; ++i) {
      step("$Nodes", 4);
      add_node(lines_.whole(0, "the node's tag"), 1);
    }
  }

  void read_nodes_4() {
    step("$Nodes", 4);
    const int blocks = count(0, "the number of blocks");
    for (int b = 0; b < blocks; ++b) {
      step("$Nodes", 4);  // dimension and tag of the entity, parametric, number
      const int total = count(3, "the number of nodes");
      std::vector<int> tags;
      for (int i = 0; i < total; ++i) {
        step("$Nodes", 1);
        tags.push_back(lines_.whole(0, "the node's tag"));
      }
      for (const int tag : tags) {
        step("$Nodes", 3);  // further words are its parameters on a curve or face
        add_node(tag, 0);
      }
    }
  }

  void refuse_other_solids(int type, std::size_t i) const {
    if (other_solid(type))
      lines_.fail_at(i, "elements of type " + std::to_string(type) +
                            " are solids other than tetrahedra with four nodes; mesh again with "
                            "tetrahedra of first order");
  }

  void add_tetrahedron(std::size_t first, int region) {
    std::array<int, 4> corner{};
    for (std::size_t c = 0; c < 4; ++c) {
      const auto node = node_of_tag_.find(lines_.whole(first + c, "a node"));
      if (node == node_of_tag_.end())
        lines_.fail_at(first + c, "there is no node `" + std::string(lines_.words()[first + c]) +
                                      "` in `$Nodes`; save the file again from Gmsh");
      corner[c] = node->second;
    }
    corners_.push_back(corner);
    regions_.push_back(region);
  }

  void read_elements_2() {
    step("$Elements", 1);
    const int total = count(0, "the number of elements");
    for (int i = 0; i < total; ++i) {
      step("$Elements", 3);
      const int type = lines_.whole(1, "the element's type");
      refuse_other_solids(type, 1);
      if (type != four_node_tetrahedron) continue;
      const auto tags = as_index(count(2, "the number of tags"));
      if (lines_.words().size() != 3 + tags + 4)
        lines_.fail("a tetrahedron with " + std::to_string(tags) + " tags wants " +
                    std::to_string(3 + tags + 4) + " words, the line has " +
                    std::to_string(lines_.words().size()) + "; save the file again from Gmsh");
      add_tetrahedron(3 + tags, tags > 0 ? region(3) : 0);
    }
  }

  void read_elements_4() {
    step("$Elements", 4);
    const int blocks = count(0, "the number of blocks");
    for (int b = 0; b < blocks; ++b) {
      step("$Elements", 4);  // dimension and tag of the entity, type, number
      const int entity = lines_.whole(1, "the entity's tag");
      const int type = lines_.whole(2, "the element's type");
      refuse_other_solids(type, 2);
      const int total = count(3, "the number of elements");
      const auto known = volume_region_.find(entity);
      const int region = known == volume_region_.end() ? 0 : known->second;
      for (int i = 0; i < total; ++i) {
        step("$Elements", type == four_node_tetrahedron ? 5 : 1);
        if (type == four_node_tetrahedron) add_tetrahedron(1, region);
      }
    }
  }

  [[nodiscard]] geometry::TetMesh assembled() const {
    std::vector<int> new_index(nodes_.size(), -1);
    for (const auto& corner : corners_)
      for (const int node : corner) new_index[as_index(node)] = 0;
    geometry::TetMesh mesh;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      if (new_index[n] < 0) continue;
      new_index[n] = static_cast<int>(mesh.nodes.size());
      mesh.nodes.push_back(nodes_[n]);
    }
    for (const auto& corner : corners_) {
      std::array<int, 4> renumbered{};
      for (std::size_t c = 0; c < 4; ++c) renumbered[c] = new_index[as_index(corner[c])];
      mesh.tetrahedra.push_back(renumbered);
      if (geometry::signed_volume(mesh, static_cast<int>(mesh.tetrahedra.size()) - 1) < 0.0)
        std::swap(mesh.tetrahedra.back()[2], mesh.tetrahedra.back()[3]);
    }
    if (std::any_of(regions_.begin(), regions_.end(), [](int region) { return region != 0; }))
      mesh.regions = regions_;
    return mesh;
  }

  TableLines lines_;
  double metres_per_unit_;
  bool version_4_ = false;
  std::map<int, int> volume_region_;  // the physical tag of each volume that has one
  std::map<int, int> node_of_tag_;    // into nodes_
  std::vector<Vec3> nodes_;
  std::vector<std::array<int, 4>> corners_;  // into nodes_
  std::vector<int> regions_;                 // one per tetrahedron
};

}  // namespace

geometry::TetMesh read_gmsh(const std::string& path, double metres_per_unit) {
  return Reader(path, metres_per_unit).read();
}

}  // namespace palpate::meshing
