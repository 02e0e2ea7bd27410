// Runs TetGen in a child process: receives the mesh through a pipe and turns failures into advice.
#include "meshing/tetgen.h"

#include <csignal>
#include <map>
#include <utility>

#include "base/child_process.h"
#include "base/error.h"
#include "base/text.h"
#include "meshing/child_bytes.h"
#include "meshing/tetgen_library.h"

namespace palpate::meshing {
namespace {

constexpr double most_memory = 8.0 * 1024 * 1024 * 1024;  // bytes: about 20 million tetrahedra

// The child's answer.
std::string packed(const geometry::TetMesh& mesh) {
  std::string bytes;
  append(bytes, mesh.nodes);
  append(bytes, mesh.tetrahedra);
  append(bytes, mesh.regions);
  return bytes;
}

geometry::TetMesh taken_mesh(ChildBytes& from) {
  geometry::TetMesh mesh;
  from.take(mesh.nodes);
  from.take(mesh.tetrahedra);
  from.take(mesh.regions);
  if (!from.done()) from.refuse();
  if (mesh.tetrahedra.empty())
    throw TetgenError(
        "TetGen found no inside; close the surface, so that every edge has two faces");
  return mesh;
}

std::string packed(const PieceMesh& made) {
  std::string bytes;
  append(bytes, made.faces);
  append(bytes, made.numbers);
  return bytes + packed(made.mesh);
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

// The bytes that `work` gives after TetGen's call.
std::string by_tetgen(const std::function<std::string()>& work, double time_limit) {
  using End = ChildResult::End;
  ChildResult ended{.end = End::timed_out};
  if (time_limit > 0.0)
    ended = run_in_child(
        [&] {
          tetgen_library::install_exit();
          return work();
        },
        {time_limit, most_memory});
  if (ended.end == End::timed_out || (ended.end == End::killed && ended.code == SIGXCPU))
    throw TetgenError("TetGen did not finish within " + rounded_text(time_limit) +
                      " s; ask for fewer nodes or allow more time");
  if (ended.end == End::killed)
    throw TetgenError("TetGen crashed (signal " + std::to_string(ended.code) +
                      "); look for facets that cross or fold, or change the node count a little");
  if (ended.code != 0) throw TetgenError(advice(ended.code));
  return std::move(ended.output);
}

}  // namespace

geometry::TetMesh tetgen_surface(const geometry::Surface& surface, const std::string& switches,
                                 double time_limit) {
  const std::string bytes =
      by_tetgen([&] { return packed(tetgen_library::run(surface, switches)); }, time_limit);
  ChildBytes from(bytes, "TetGen");
  return taken_mesh(from);
}

PieceMesh tetgen_pieces(const Pieces& pieces, const std::function<double(const Vec3&)>& size,
                        double time_limit) {
  const std::string bytes = by_tetgen(
      [&] { return packed(tetgen_library::run(pieces, size, "pYAq1.5/8o/150O7")); }, time_limit);
  ChildBytes from(bytes, "TetGen");
  PieceMesh made;
  from.take(made.faces);
  from.take(made.numbers);
  made.mesh = taken_mesh(from);
  return made;
}

std::vector<int> name_regions(geometry::TetMesh& mesh,
                              const std::function<std::optional<int>(const Vec3&)>& region_at) {
  struct Sample {
    double volume = 0.0;
    std::size_t tetrahedron = 0;
  };
  std::map<int, Sample> largest;  // its centre is the least affected by rounding
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    Sample& sample = largest[mesh.regions[t]];
    const double volume = geometry::signed_volume(mesh, static_cast<int>(t));
    if (volume > sample.volume) sample = {volume, t};
  }
  std::map<int, std::optional<int>> names;
  for (const auto& [number, sample] : largest) {
    Vec3 middle = Vec3::Zero();
    for (const int node : mesh.tetrahedra[sample.tetrahedron])
      middle += 0.25 * mesh.nodes[as_index(node)];
    names[number] = region_at(middle);
  }
  geometry::TetMesh kept;
  std::vector<char> used(mesh.nodes.size(), 0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const std::optional<int> name = names[mesh.regions[t]];
    if (!name) continue;
    kept.tetrahedra.push_back(mesh.tetrahedra[t]);
    kept.regions.push_back(*name);
    for (const int node : mesh.tetrahedra[t]) used[as_index(node)] = 1;
  }
  std::vector<int> number(mesh.nodes.size(), -1);
  for (std::size_t n = 0; n < used.size(); ++n) {
    if (used[n] == 0) continue;
    number[n] = static_cast<int>(kept.nodes.size());
    kept.nodes.push_back(mesh.nodes[n]);
  }
  for (auto& tetrahedron : kept.tetrahedra)
    for (int& node : tetrahedron) node = number[as_index(node)];
  mesh = std::move(kept);
  return number;
}

}  // namespace palpate::meshing
