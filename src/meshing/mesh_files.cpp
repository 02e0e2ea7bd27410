// Reads and writes .node and .ele: a header line, then a numbered line per node or tetrahedron.
#include "meshing/mesh_files.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/whole_folder.h"
#include "meshing/table_lines.h"

namespace palpate::meshing {
namespace {

struct Pair {
  std::string node;
  std::string ele;
};

Pair both_files(const std::string& path) {
  const std::filesystem::path given(path);
  if (given.extension() != ".node" && given.extension() != ".ele")
    throw InputError({path},
                     "a mesh file wants the ending `.node` or `.ele`; name either of the two");
  std::filesystem::path node = given;
  std::filesystem::path ele = given;
  return {node.replace_extension(".node").string(), ele.replace_extension(".ele").string()};
}

// Goes to the header; `layout` names its words, of which the first two are required.
void open_header(TableLines& lines, const std::string& layout) {
  if (!lines.next()) lines.fail("the file holds no header line; begin it with `" + layout + "`");
  const auto most = as_index(std::ranges::count(layout, ' ')) + 1;
  if (lines.words().size() < 2 || lines.words().size() > most)
    lines.fail("the header has " + std::to_string(lines.words().size()) + " words; write it as `" +
               layout + "`");
}

// A count from the header, at least `least`; 0 if it is absent.
int header_count(const TableLines& lines, std::size_t i, const std::string& what, int least) {
  if (i >= lines.words().size()) return 0;
  const int count = lines.whole(i, what);
  if (count < least)
    lines.fail_at(i, what + " wants " + std::to_string(least) + " or more, got `" +
                         std::string(lines.words()[i]) + "`; count the lines that follow");
  return count;
}

// Goes to line `i` of `count` and checks that it has `columns` words.
void item_line(TableLines& lines, const std::string& what, int i, int count, std::size_t columns) {
  if (!lines.next())
    lines.fail("the file ends after " + std::to_string(i) + " of " + std::to_string(count) + " " +
               what + "; write it again from its source");
  if (lines.words().size() != columns)
    lines.fail("the line has " + std::to_string(lines.words().size()) +
               " words, but the header asks for " + std::to_string(columns) +
               "; mend the line or the header");
}

void own_number(const TableLines& lines, int expected) {
  if (lines.whole(0, "the first word") != expected)
    lines.fail_at(0, "the line wants number " + std::to_string(expected) + ", got `" +
                         std::string(lines.words()[0]) + "`; number the lines one by one");
}

void expect_end(TableLines& lines, int count, const std::string& what) {
  if (lines.next())
    lines.fail("the header counts " + std::to_string(count) + " " + what +
               ", but another line follows; mend the count or remove the line");
}

// Returns the number of the first node: 0 or 1.
int read_nodes(TableLines lines, double metres_per_unit, geometry::TetMesh& mesh) {
  open_header(lines, "nodes 3 attributes markers");
  const int count = header_count(lines, 0, "the number of nodes", 1);
  if (lines.whole(1, "the dimension") != 3)
    lines.fail_at(1, "the dimension wants `3`, got `" + std::string(lines.words()[1]) +
                         "`; a mesh of tetrahedra has three coordinates a node");
  const int attributes = header_count(lines, 2, "the number of attributes", 0);
  const int markers = header_count(lines, 3, "the number of markers", 0);
  const std::size_t columns = 4 + as_index(attributes) + as_index(markers);
  int first = 0;
  for (int i = 0; i < count; ++i) {
    item_line(lines, "nodes", i, count, columns);
    if (i == 0) first = lines.whole(0, "the first word");
    if (first != 0 && first != 1)
      lines.fail_at(0, "the first node wants number 0 or 1, got `" + std::string(lines.words()[0]) +
                           "`; number the nodes from 0 or 1");
    own_number(lines, first + i);
    const double x = lines.number(1, "x");
    const double y = lines.number(2, "y");
    const double z = lines.number(3, "z");
    mesh.nodes.emplace_back(x * metres_per_unit, y * metres_per_unit, z * metres_per_unit);
  }
  expect_end(lines, count, "nodes");
  return first;
}

void read_tetrahedra(TableLines lines, int first, geometry::TetMesh& mesh) {
  open_header(lines, "tetrahedra 4 attributes");
  const int count = header_count(lines, 0, "the number of tetrahedra", 1);
  if (lines.whole(1, "the number of nodes of a tetrahedron") != 4)
    lines.fail_at(1, "the number of nodes of a tetrahedron wants `4`, got `" +
                         std::string(lines.words()[1]) + "`; make the mesh without `-o2`");
  const int attributes = header_count(lines, 2, "the number of attributes", 0);
  const std::size_t columns = 5 + as_index(attributes);
  const int last = first + static_cast<int>(mesh.nodes.size()) - 1;
  for (int i = 0; i < count; ++i) {
    item_line(lines, "tetrahedra", i, count, columns);
    own_number(lines, first + i);
    std::array<int, 4> corner{};
    for (std::size_t c = 0; c < 4; ++c) {
      const int node = lines.whole(c + 1, "a node");
      if (node < first || node > last)
        lines.fail_at(c + 1, "there is no node `" + std::string(lines.words()[c + 1]) +
                                 "`, the nodes run from " + std::to_string(first) + " to " +
                                 std::to_string(last) + "; check that both files belong together");
      corner[c] = node - first;
    }
    mesh.tetrahedra.push_back(corner);
    if (attributes == 1) mesh.regions.push_back(lines.whole(5, "the region"));
    if (geometry::signed_volume(mesh, i) < 0.0)
      std::swap(mesh.tetrahedra.back()[2], mesh.tetrahedra.back()[3]);
  }
  expect_end(lines, count, "tetrahedra");
}

// The last line of an .ele file that we wrote; its .node file has this hash.
constexpr const char* belongs_to = "# belongs to the .node file with the SHA-256 ";

// False for two files of which a killed program has replaced one.
bool belong_together(const Pair& files) {
  const std::string node = read_text(files.node);
  const std::string ele = read_text(files.ele);
  const std::size_t at = ele.rfind(belongs_to);
  if (at == std::string::npos) return true;
  const std::string hash = trimmed(std::string_view(ele).substr(at + std::strlen(belongs_to)));
  return sha256(node) == hash;
}

// The old nodes, while only the new ones are in their place: no system call replaces two files.
std::string replaced(const Pair& files) { return files.node + ".replaced"; }

// The contents of the .node and the .ele file of a mesh.
std::pair<std::string, std::string> node_ele_texts(const geometry::TetMesh& mesh) {
  std::string nodes = std::to_string(mesh.nodes.size()) + " 3 0 0\n";
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    nodes += std::to_string(n);
    for (int axis = 0; axis < 3; ++axis) nodes += " " + number_text(mesh.nodes[n][axis]);
    nodes += "\n";
  }
  std::string tetrahedra =
      std::to_string(mesh.tetrahedra.size()) + (mesh.regions.empty() ? " 4 0\n" : " 4 1\n");
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    tetrahedra += std::to_string(t);
    for (const int node : mesh.tetrahedra[t]) tetrahedra += " " + std::to_string(node);
    if (!mesh.regions.empty()) tetrahedra += " " + std::to_string(mesh.regions[t]);
    tetrahedra += "\n";
  }
  tetrahedra += belongs_to + sha256(nodes) + "\n";
  return {nodes, tetrahedra};
}

}  // namespace

geometry::TetMesh read_node_ele(const std::string& path, double metres_per_unit) {
  const Pair files = both_files(path);
  if (!belong_together(files))
    throw InputError(
        {files.ele, 0, 0},
        "belongs to other nodes than those of `" + files.node +
            "`, as after an interrupted `palpate convert`; run that again, or rename `" +
            replaced(files) + "` to `" + files.node + "`");
  geometry::TetMesh mesh;
  const int first = read_nodes(TableLines(files.node), metres_per_unit, mesh);
  read_tetrahedra(TableLines(files.ele), first, mesh);
  return mesh;
}

bool holds_node_ele(const std::string& path, const geometry::TetMesh& mesh) {
  const Pair files = both_files(path);
  const auto [nodes, tetrahedra] = node_ele_texts(mesh);
  return holds(files.node, nodes) && holds(files.ele, tetrahedra);
}

void write_node_ele(const std::string& path, const geometry::TetMesh& mesh) {
  const Pair files = both_files(path);
  const auto [nodes, tetrahedra] = node_ele_texts(mesh);
  namespace fs = std::filesystem;
  std::error_code failed;
  if (fs::exists(replaced(files)) && fs::exists(files.ele) && !belong_together(files))
    fs::rename(replaced(files), files.node, failed);
  fs::remove(replaced(files), failed);
  fs::create_hard_link(files.node, replaced(files), failed);
  const bool kept = !failed;
  try {
    write_atomically(files.node, nodes);
    write_atomically(files.ele, tetrahedra);
  } catch (const SystemError&) {
    if (kept) fs::rename(replaced(files), files.node, failed);
    throw;
  }
  if (kept) fs::remove(replaced(files), failed);
}

namespace {

// Gives tetrahedra nodes of their own where they share no face around a node, only the node or an
// edge. Returns the number of new nodes, which come last.
int part_touching(geometry::TetMesh& mesh) {
  for (const auto& [a, b, c, d] : mesh.tetrahedra)  // refused later
    if (a == b || a == c || a == d || b == c || b == d || c == d) return 0;
  // Corners (tetrahedron, local node) at one node are together if a way over faces joins them.
  std::vector<int> leader(4 * mesh.tetrahedra.size());
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int corner) {
    while (leader[as_index(corner)] != corner)
      corner = leader[as_index(corner)] = leader[as_index(leader[as_index(corner)])];
    return corner;
  };
  const auto corner_at = [&](int tetrahedron, int node) {
    const auto& nodes = mesh.tetrahedra[as_index(tetrahedron)];
    return 4 * tetrahedron + static_cast<int>(std::ranges::find(nodes, node) - nodes.begin());
  };
  const std::vector<geometry::FaceUse> uses = geometry::face_uses(mesh);
  for (std::size_t i = 1; i < uses.size(); ++i)
    for (const int node : uses[i].key)
      if (uses[i].key == uses[i - 1].key) {
        const int one = find(corner_at(uses[i].tetrahedron, node));
        leader[as_index(one)] = find(corner_at(uses[i - 1].tetrahedron, node));
      }
  const std::size_t before = mesh.nodes.size();
  std::vector<int> first(before, -1);
  std::map<int, int> parted;  // node of a leader
  for (int corner = 0; corner < static_cast<int>(leader.size()); ++corner) {
    int& node = mesh.tetrahedra[as_index(corner / 4)][as_index(corner % 4)];
    const int own = find(corner);
    int& kept = first[as_index(node)];
    if (kept < 0) kept = own;
    if (kept == own) continue;
    const auto [known, added] = parted.try_emplace(own, static_cast<int>(mesh.nodes.size()));
    if (added) mesh.nodes.emplace_back(mesh.nodes[as_index(node)]);
    node = known->second;
  }
  return static_cast<int>(mesh.nodes.size() - before);
}

NamedMesh as_in_file(const std::string& path, double metres_per_unit) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  if (holds_cells(path)) return tetrahedra_of(read_cells(path), path, metres_per_unit);
  if (ending == ".node" || ending == ".ele") return {read_node_ele(path, metres_per_unit)};
  throw InputError({path},
                   "a mesh file wants the ending `.msh`, `.vtu`, `.vtk`, `.inp`, `.mesh`, `.node` "
                   "or `.ele`; save it as one of them");
}

}  // namespace

NamedMesh read_mesh(const std::string& path, double metres_per_unit) {
  NamedMesh read = as_in_file(path, metres_per_unit);
  if (const int parted = part_touching(read.mesh); parted > 0)
    read.warning += (read.warning.empty() ? "" : "; ") + std::to_string(parted) +
                    (parted == 1 ? " node" : " nodes") + " of " +
                    std::filesystem::path(path).filename().string() +
                    " at which its parts only touch were parted";
  return read;
}

}  // namespace palpate::meshing
