// Chooses whether to keep the file's triangles, and what to do if TetGen finds no mesh with them.
#include "meshing/tetgen_file.h"

#include <cmath>
#include <exception>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "meshing/surface_remeshing.h"

namespace palpate::meshing {
namespace {

// An equilateral triangle of edge l has an area of sqrt(3) / 4 l^2.
double spacing_of(const geometry::Surface& surface) {
  return std::sqrt(geometry::area(surface) /
                   (0.433 * static_cast<double>(surface.triangles.size())));
}

// Whether the surface is finer than the mesh should be.
bool too_fine(const geometry::Surface& surface, const Target& target) {
  return target.nodes > 0 ? static_cast<int>(surface.vertices.size()) >= target.nodes
                          : spacing_of(surface) < 0.5 * target.edge_length;
}

std::string told(const geometry::Surface& before, std::size_t needles, const Remeshed& after) {
  std::string text = "the " + std::to_string(before.triangles.size()) +
                     " triangles of the surface became " +
                     std::to_string(after.surface.triangles.size()) + " for the mesh";
  if (needles > 0) text += ", because " + std::to_string(needles) + " of them are needles";
  return text + (needles > 0 ? "; " : ", because they are finer than the mesh asked for; ") +
         "the two surfaces are at most " + rounded_text(unit::mm.from_si(after.distance), 2) +
         " mm apart";
}

geometry::Body body_of(geometry::Surface surface, std::span<const geometry::Lump> lumps) {
  const double spacing = spacing_of(surface);
  geometry::Body body;
  body.parts.push_back({std::move(surface), 0});
  for (const geometry::Lump& lump : lumps) geometry::add_lump(body, lump, spacing);
  return body;
}

}  // namespace

FileMesh tetgen_file(geometry::Surface surface, std::span<const geometry::Lump> lumps,
                     const Target& target, double time_limit) {
  FileMesh made;
  const std::size_t needles = count_needles(surface);
  const auto remesh = [&] {
    auto better =
        remeshed(surface, target.nodes > 0 ? cell_for(surface, target.nodes) : target.edge_length);
    if (!better) return false;
    made.remark = told(surface, needles, *better);
    surface = std::move(better->surface);
    return true;
  };
  const auto meshed = [&](const Target& wanted) {
    return tetgen_body(body_of(surface, lumps), wanted, time_limit);
  };
  std::exception_ptr failure;
  const auto attempt = [&] {
    // The mesh keeps the surface's vertices, so that it cannot have fewer nodes.
    if (target.nodes > 0 && too_fine(surface, target)) return false;
    try {
      made.mesh = meshed(target);
    } catch (const MeshError&) {
      if (target.nodes == 0) throw;
      failure = std::current_exception();
      return false;
    }
    return true;
  };
  const bool changed = (too_fine(surface, target) || needles > 0) && remesh();
  if (attempt() || (!changed && remesh() && attempt())) return made;
  made.mesh = meshed({.edge_length = spacing_of(surface)});
  if (failure && static_cast<int>(made.mesh.nodes.size()) < target.nodes)
    std::rethrow_exception(failure);
  made.remark += (made.remark.empty() ? "" : "; ") + std::string("the mesh has ") +
                 std::to_string(made.mesh.nodes.size()) + " nodes instead of " +
                 std::to_string(target.nodes) + ", because it keeps the surface's vertices";
  return made;
}

}  // namespace palpate::meshing
