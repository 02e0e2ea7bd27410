// Makes meshes from structured meshes, by TetGen, or from files.
#include "scene/specimen_mesh.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "geometry/cuboid.h"
#include "meshing/bisection.h"
#include "meshing/mesh_check.h"
#include "meshing/mesh_files.h"
#include "meshing/surface_files.h"
#include "meshing/tetgen.h"
#include "meshing/tetgen_body.h"
#include "scene/estimates.h"
#include "scene/places.h"

namespace palpate::scene {
namespace {

using Scenario = scenario::Resolved;

constexpr double meshing_time = 120.0;  // s, time limit for TetGen

// Inclusions and layers have region numbers from here on, which no shape or file uses.
constexpr int first_own = 1'000'000'000;

// Assigns tetrahedra to layers by their centres; none crosses the face of a layer. Later regions
// lie over earlier ones, so that a layer leaves a later inclusion as it is.
void number_slabs(geometry::TetMesh& mesh, const Scenario& scenario) {
  for (std::size_t i = 0; i < scenario.regions.size(); ++i) {
    const auto* slab = std::get_if<scenario::Slab>(&scenario.regions[i].part);
    if (slab == nullptr) continue;
    const int own = first_own + static_cast<int>(i);
    mesh.regions.resize(mesh.tetrahedra.size(), 0);
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      double height = 0.0;
      for (const int node : mesh.tetrahedra[t]) height += 0.25 * mesh.nodes[as_index(node)].z();
      if (mesh.regions[t] < own && slab->bottom < height && height < slab->top)
        mesh.regions[t] = own;
    }
  }
}

std::string path_in(const std::string& folder, const std::string& file) {
  return (std::filesystem::path(folder) / file).string();
}

meshing::Target target(const scenario::Tetgen& mesh) {
  meshing::Target target{.nodes = mesh.nodes, .tetrahedra = mesh.tetrahedra.value_or(0)};
  if (mesh.edge) target = {.edge_length = *mesh.edge};
  return target;
}

// With the numbers of the mesh.
std::vector<geometry::Inclusion> numbered_inclusions(const Scenario& scenario) {
  std::vector<geometry::Inclusion> inclusions = inclusions_of(scenario);
  for (geometry::Inclusion& inclusion : inclusions) inclusion.region += first_own - 1;
  return inclusions;
}

geometry::TetMesh tetgen_mesh(const Scenario& scenario, const scenario::Tetgen& mesh) {
  const std::optional<geometry::Shape> known = parametric(scenario.tissue.shape);
  if (!known) throw MeshError("this `tissue.shape` has no mesh; give another one, as `cuboid`");
  const geometry::Shape& shape = *known;
  const std::vector<geometry::Inclusion> inside = numbered_inclusions(scenario);
  const auto* box = std::get_if<geometry::Cuboid>(&shape);
  if (box != nullptr && inside.empty() && !mesh.edge)
    return meshing::tetgen_cuboid(box->size, mesh.nodes, meshing_time);
  meshing::Target wanted = target(mesh);
  while (true) try {
      return meshing::tetgen_shape(shape, inside, wanted, meshing_time);
    } catch (const meshing::TooFewNodes& error) {
      // Only of a mesh to be refined; a finer one has more of its nodes inside.
      if (!mesh.refine || error.least > mesh.most_nodes) throw;
      wanted = {.nodes = std::max(error.least, 2 * wanted.nodes)};
    }
}

// Cells are small where the finger presses.
geometry::Grading grading(const Scenario& scenario, const Vec3& size, double ratio) {
  return {ratio, Vec3(scenario.finger.x.value_or(0.5 * size.x()),
                      scenario.finger.y.value_or(0.5 * size.y()), size.z())};
}

// A press takes 2.6 kB for every tetrahedron (docs/speed.md), of which a node has about six.
void refuse_huge(const scenario::Mesh& mesh) {
  constexpr double most = 3.5e6;
  constexpr double memory = 6 * 2.6e-6;  // GB for a node
  const double nodes = expected_nodes(mesh);
  if (nodes > most)
    throw MeshError("`tissue.mesh` asks for " + rounded_text(nodes, 3) +
                    " nodes, which take about " + rounded_text(memory * nodes, 2) +
                    " GB; ask for at most 3.5 million");
}

SpecimenMesh any_mesh(const Scenario& scenario, const std::string& folder,
                      const geometry::Surface* of_file) {
  refuse_huge(scenario.tissue.mesh);
  refuse_covered_inclusions(scenario);
  SpecimenMesh made;
  geometry::TetMesh& mesh = made.mesh;
  std::string name;
  double volume = 0.0;
  const auto* box = std::get_if<scenario::Cuboid>(&scenario.tissue.shape);
  const Vec3 size =
      box != nullptr ? Vec3(box->size[0], box->size[1], box->size[2]) : Vec3(Vec3::Zero());
  if (box != nullptr) volume = size.prod();
  if (const auto* kuhn = std::get_if<scenario::Kuhn>(&scenario.tissue.mesh)) {
    mesh = geometry::cuboid(size, kuhn->cells, geometry::CellPattern::kuhn,
                            grading(scenario, size, kuhn->grading), slab_levels(scenario));
    name = "the kuhn mesh";
  } else if (const auto* mirrored = std::get_if<scenario::Mirrored>(&scenario.tissue.mesh)) {
    mesh = geometry::cuboid(size, mirrored->cells, geometry::CellPattern::mirrored,
                            grading(scenario, size, mirrored->grading), slab_levels(scenario));
    name = "the mirrored mesh";
  } else if (const auto* tetgen = std::get_if<scenario::Tetgen>(&scenario.tissue.mesh)) {
    name = "TetGen's mesh";
    if (of_file == nullptr) {
      mesh = tetgen_mesh(scenario, *tetgen);
    } else {
      auto [found, warning] = meshing::tetgen_file(*of_file, numbered_inclusions(scenario),
                                                   target(*tetgen), meshing_time);
      made = {std::move(found), std::move(warning)};
    }
  } else {
    const auto& file = std::get<scenario::MeshFile>(scenario.tissue.mesh);
    meshing::NamedMesh read = mesh_of(file, folder);
    for (Vec3& node : read.mesh.nodes) node = scenario.tissue.turn * node;
    for (auto& [edge, middle] : read.middles) middle = scenario.tissue.turn * middle;
    made = {std::move(read.mesh), std::move(read.warning), std::move(read.names),
            std::move(read.middles), std::move(read.straightened)};
    name = "the mesh of " + file.file;
  }
  meshing::check(mesh, name, volume);
  std::vector<double> heights = slab_levels(scenario);
  const Box around = box_of(mesh.nodes);
  std::erase_if(heights, [&](double z) { return z <= around.low.z() || z >= around.high.z(); });
  const std::vector<Vec3> before = made.middles.empty() ? std::vector<Vec3>{} : mesh.nodes;
  for (const double height : heights)
    mesh = meshing::cut_at(std::move(mesh), height, false, parametric(scenario.tissue.shape));
  if (!heights.empty()) {
    std::erase_if(made.middles, [&](const auto& one) {  // of nodes that the cuts moved
      return std::ranges::any_of(one.first, [&](int node) {
        return mesh.nodes[as_index(node)] != before[as_index(node)];
      });
    });
    number_slabs(mesh, scenario);
    meshing::check(mesh, name + ", cut at the layers,", volume);
  }
  return made;
}

// The number in the mesh of a tagged region.
int number_of(const scenario::TaggedRegion& region, std::size_t i,
              const std::map<std::string, int>& names) {
  if (region.name.empty()) return region.tag;
  const auto known = names.find(region.name);
  if (known != names.end()) return known->second;
  std::string all;
  for (const auto& [name, number] : names) all += (all.empty() ? "`" : ", `") + name + "`";
  throw KeyError(
      "region." + std::to_string(i + 1) + ".name",
      "the mesh has no region with the name `" + region.name + "` of `[[region]]` " +
          std::to_string(i + 1) + "; " +
          (all.empty() ? "its file has no names, write `tag` with a number" : "it has " + all));
}

// Replaces the numbers of shapes and files by 0 for the tissue and 1... for the scenario's regions.
void number_regions(SpecimenMesh& made, const Scenario& scenario) {
  geometry::TetMesh& mesh = made.mesh;
  std::vector<char> used(scenario.regions.size(), 0);
  std::vector<int> numbers;
  for (std::size_t i = 0; i < scenario.regions.size(); ++i) {
    const auto* tagged = std::get_if<scenario::TaggedRegion>(&scenario.regions[i].part);
    numbers.push_back(tagged != nullptr ? number_of(*tagged, i, made.names)
                                        : first_own + static_cast<int>(i));
  }
  const auto substance = [&](int number) {
    for (std::size_t i = 0; i < scenario.regions.size(); ++i) {
      if (numbers[i] != number) continue;
      used[i] = 1;
      return static_cast<int>(i) + 1;
    }
    return 0;
  };
  if (mesh.regions.empty()) mesh.regions.assign(mesh.tetrahedra.size(), 0);
  for (int& region : mesh.regions) region = substance(region);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] != 0) continue;
    const std::string number = std::to_string(i + 1);
    const std::string what = "the specimen's mesh has no tetrahedron of `[[region]]` " + number;
    if (std::holds_alternative<scenario::TaggedRegion>(scenario.regions[i].part))
      throw KeyError("region." + number + ".tag",
                     what + "; check its `tag` or `name` against the mesh");
    throw MeshError(what + "; mesh the inclusion finer");
  }
  if (std::ranges::all_of(mesh.regions, [](int r) { return r == 0; })) mesh.regions.clear();
}

// Turns a mesh that lies along y to stand on its end at y = 0.
void stand_up(geometry::TetMesh& mesh) {
  double low = 0.0;
  for (Vec3& node : mesh.nodes) {
    node = Vec3(node.x(), -node.z(), node.y());
    low = std::min(low, node.y());
  }
  for (Vec3& node : mesh.nodes) node.y() -= low;
}

}  // namespace

std::optional<geometry::Shape> parametric(const scenario::Shape& shape) {
  return std::visit(
      [](const auto& one) -> std::optional<geometry::Shape> {
        using One = std::remove_cvref_t<decltype(one)>;
        if constexpr (std::is_same_v<One, scenario::Cuboid>)
          return geometry::Cuboid{Vec3(one.size[0], one.size[1], one.size[2])};
        else if constexpr (std::is_constructible_v<geometry::Shape, const One&>)
          return geometry::Shape(one);
        else
          return std::nullopt;
      },
      shape);
}

std::vector<double> slab_levels(const Scenario& scenario) {
  std::set<double> heights;
  for (const auto& region : scenario.regions)
    if (const auto* slab = std::get_if<scenario::Slab>(&region.part))
      heights.insert({slab->bottom, slab->top});
  heights.erase(0.0);
  return {heights.begin(), heights.end()};
}

void refuse_covered_inclusions(const Scenario& scenario) {
  // The part of a ball below a level: a cap of the height h has the volume pi h^2 (3 r - h) / 3.
  const auto below = [](const scenario::Inclusion& inclusion, double level) {
    const double r = inclusion.radius;
    const double h = std::clamp(level - (inclusion.centre[2] - r), 0.0, 2.0 * r);
    return h * h * (3.0 * r - h) / (4.0 * r * r * r);
  };
  for (std::size_t i = 0; i < scenario.regions.size(); ++i)
    for (std::size_t j = i + 1; j < scenario.regions.size(); ++j) {
      const auto* inclusion = std::get_if<scenario::Inclusion>(&scenario.regions[i].part);
      const auto* slab = std::get_if<scenario::Slab>(&scenario.regions[j].part);
      if (inclusion == nullptr || slab == nullptr) continue;
      const double taken = below(*inclusion, slab->top) - below(*inclusion, slab->bottom);
      if (taken > 0.01)
        throw MeshError("`[[region]]` " + std::to_string(j + 1) + ", a layer, covers " +
                        percent_text(taken) + " of the inclusion of `[[region]]` " +
                        std::to_string(i + 1) +
                        "; write the inclusion after the layer, so that it lies over it");
    }
}

std::vector<geometry::Inclusion> inclusions_of(const Scenario& scenario) {
  std::vector<geometry::Inclusion> found;
  for (std::size_t i = 0; i < scenario.regions.size(); ++i)
    if (const auto* inclusion = std::get_if<scenario::Inclusion>(&scenario.regions[i].part))
      found.push_back({Vec3(inclusion->centre[0], inclusion->centre[1], inclusion->centre[2]),
                       inclusion->radius, static_cast<int>(i) + 1});
  return found;
}

namespace {

meshing::RepairOrder order_of(const Scenario& scenario) {
  const auto& file = std::get<scenario::SurfaceFile>(scenario.tissue.shape);
  return {.repair = file.repair,
          .most_missing = file.repair_up_to,
          .part = file.part,
          .pressed = {},
          .nearest = scenario.tissue.near_part,
          .unit = file.unit};
}

}  // namespace

meshing::MendedSurface all_parts_of(const Scenario& scenario, const std::string& folder) {
  const auto& file = std::get<scenario::SurfaceFile>(scenario.tissue.shape);
  return meshing::mended_surface(
      meshing::read_surface(path_in(folder, file.file), metres_per(file.unit)), file.file,
      order_of(scenario));
}

meshing::WholeSurface part_of(const meshing::MendedSurface& all, const Scenario& scenario) {
  return meshing::whole_part(all, std::get<scenario::SurfaceFile>(scenario.tissue.shape).file,
                             order_of(scenario));
}

meshing::NamedMesh mesh_of(const scenario::MeshFile& file, const std::string& folder) {
  auto read = meshing::read_mesh(path_in(folder, file.file), metres_per(file.unit));
  meshing::refuse_size(read.mesh.nodes, "the mesh of " + file.file, file.unit, "tissue.mesh.unit");
  return read;
}

std::vector<std::array<Vec3, 3>> faces_of_base(const Scenario& scenario,
                                               const std::string& folder) {
  const auto read = [&](const auto& file) {
    return meshing::faces_of_group(path_in(folder, file.file), scenario.tissue.base_side,
                                   metres_per(file.unit));
  };
  const auto* surface = std::get_if<scenario::SurfaceFile>(&scenario.tissue.shape);
  return surface != nullptr ? read(*surface)
                            : read(std::get<scenario::MeshFile>(scenario.tissue.mesh));
}

SpecimenMesh specimen_mesh(const Scenario& scenario, const std::string& folder,
                           const geometry::Surface* of_file) {
  SpecimenMesh made = any_mesh(scenario, folder, of_file);
  geometry::TetMesh& mesh = made.mesh;
  if (!scenario.regions.empty() || !mesh.regions.empty()) number_regions(made, scenario);
  const auto shape = parametric(scenario.tissue.shape);
  if (scenario.uniform() && shape && !geometry::stands(*shape)) stand_up(mesh);
  return made;
}

}  // namespace palpate::scene
