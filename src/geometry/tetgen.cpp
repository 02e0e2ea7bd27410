// TetGen behind a wall: the mesh comes through a pipe, and failures become advice.
#include "geometry/tetgen.h"

#include <csignal>
#include <cstring>
#include <type_traits>

#include "base/error.h"
#include "base/text.h"
#include "geometry/child_process.h"
#include "geometry/tetgen_library.h"

namespace palpate::geometry {
namespace {

constexpr double most_memory = 8.0 * 1024 * 1024 * 1024;  // bytes: some 20 million tetrahedra

// The answer: three counts, then the bytes of what they count. Both ends are one program.
struct Counts {
  std::size_t nodes;
  std::size_t tetrahedra;
  std::size_t regions;
};

template <typename Item>
void append(std::string& bytes, const Item* items, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<Item>);
  bytes.append(reinterpret_cast<const char*>(items), count * sizeof(Item));
}

std::string packed(const TetMesh& mesh) {
  const Counts counts{mesh.nodes.size(), mesh.tetrahedra.size(), mesh.regions.size()};
  std::string bytes;
  append(bytes, &counts, 1);
  for (const Vec3& node : mesh.nodes) append(bytes, node.data(), 3);
  append(bytes, mesh.tetrahedra.data(), mesh.tetrahedra.size());
  append(bytes, mesh.regions.data(), mesh.regions.size());
  return bytes;
}

TetMesh unpacked(const std::string& bytes) {
  Counts counts{};
  TetMesh mesh;
  if (bytes.size() < sizeof(counts)) throw MeshError("TetGen gave half an answer; run it again");
  std::memcpy(&counts, bytes.data(), sizeof(counts));
  const std::size_t node_bytes = counts.nodes * 3 * sizeof(double);
  const std::size_t tetrahedron_bytes = counts.tetrahedra * sizeof(std::array<int, 4>);
  const std::size_t region_bytes = counts.regions * sizeof(int);
  if (bytes.size() != sizeof(counts) + node_bytes + tetrahedron_bytes + region_bytes)
    throw MeshError("TetGen gave half an answer; run it again");
  mesh.nodes.resize(counts.nodes);
  mesh.tetrahedra.resize(counts.tetrahedra);
  mesh.regions.resize(counts.regions);
  const char* from = bytes.data() + sizeof(counts);
  for (Vec3& node : mesh.nodes) {
    std::memcpy(node.data(), from, 3 * sizeof(double));
    from += 3 * sizeof(double);
  }
  if (tetrahedron_bytes > 0) std::memcpy(mesh.tetrahedra.data(), from, tetrahedron_bytes);
  from += tetrahedron_bytes;
  if (region_bytes > 0) std::memcpy(mesh.regions.data(), from, region_bytes);
  return mesh;
}

std::string advice(int exit_code) {
  switch (exit_code) {
    case tetgen_library::memory: return "TetGen ran out of memory; ask for fewer nodes";
    case tetgen_library::internal:
      return "TetGen met an internal error; change the node count or the surface a little";
    case tetgen_library::self_intersection:
      return "TetGen found that the surface cuts itself; mend the surface where its facets cross";
    case tetgen_library::tiny_feature:
      return "TetGen found a feature too small to mesh; merge vertices that lie almost together";
    case tetgen_library::close_facets:
      return "TetGen found two facets almost in one place; remove one or move them apart";
    case tetgen_library::input:
      return "TetGen could not read the surface; check its triangles and the switches";
    default:
      return "TetGen ended with code " + std::to_string(exit_code) +
             "; change the node count or the surface a little";
  }
}

struct Outcome {
  double time_limit;

  TetMesh operator()(const ChildAnswer& answer) const {
    TetMesh mesh = unpacked(answer.bytes);
    if (mesh.tetrahedra.empty())
      throw MeshError(
          "TetGen found no inside; close the surface, so that every edge has two faces");
    return mesh;
  }
  TetMesh operator()(const ChildExit& exit) const { throw MeshError(advice(exit.code)); }
  TetMesh operator()(const ChildSignal& signal) const {
    if (signal.number == SIGXCPU) return (*this)(ChildTimeout{});
    throw MeshError("TetGen crashed (signal " + std::to_string(signal.number) +
                    "); look for facets that cross or fold, or change the node count a little");
  }
  TetMesh operator()(const ChildTimeout&) const {
    throw MeshError("TetGen did not finish within " + rounded_text(time_limit) +
                    " s; ask for fewer nodes or allow more time");
  }
};

}  // namespace

TetMesh tetgen_surface(const Surface& surface, const std::string& switches, double time_limit) {
  if (!(time_limit > 0.0)) return Outcome{time_limit}(ChildTimeout{});
  const auto work = [&] {
    tetgen_library::install_exit();
    return packed(tetgen_library::run(surface, switches));
  };
  return std::visit(Outcome{time_limit}, run_in_child(work, {time_limit, most_memory}));
}

}  // namespace palpate::geometry
