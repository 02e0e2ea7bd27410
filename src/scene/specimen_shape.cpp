// A cache of meshes, surfaces and fits, with the text of the keys on which they depend as its key.
#include "scene/specimen_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/fields.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "contact/hertz.h"
#include "geometry/box.h"
#include "geometry/surface.h"
#include "meshing/bisection.h"
#include "meshing/mesh_check.h"
#include "scenario/programme.h"
#include "scene/places.h"
#include "scene/scene.h"
#include "scene/specimen_mesh.h"

namespace palpate::scene {
namespace {

using Scenario = scenario::Resolved;

// The area of the surface's triangles that lie in the plane at height `z`, m^2.
double flat_area(const geometry::OuterSurface& outer_surface, double z, double tolerance) {
  double sum = 0.0;
  for (std::size_t t = 0; t < outer_surface.surface.triangles.size(); ++t) {
    bool inside = true;
    for (const int v : outer_surface.surface.triangles[t])
      inside = inside && std::abs(outer_surface.surface.vertices[as_index(v)].z() - z) <= tolerance;
    if (inside)
      sum += 0.5 * geometry::twice_area(outer_surface.surface, static_cast<int>(t)).norm();
  }
  return sum;
}

// Whether the mesh depends on the finger's position: graded structured meshes are finer under the
// finger.
bool knows_finger(const scenario::Mesh& mesh) {
  if (const auto* kuhn = std::get_if<scenario::Kuhn>(&mesh)) return kuhn->grading != 1.0;
  if (const auto* mirrored = std::get_if<scenario::Mirrored>(&mesh))
    return mirrored->grading != 1.0;
  return false;
}

}  // namespace

SpecimenShape shape_of(geometry::TetMesh mesh, double base_level) {
  geometry::OuterSurface outer_surface = geometry::outer_surface(mesh);
  const auto [low, high] = geometry::reach_along(mesh.nodes, Vec3::UnitZ());
  const double flat = 1e-9 * geometry::diagonal(mesh);
  const double top_area = flat_area(outer_surface, high, flat);
  const double bottom_area = flat_area(outer_surface, low, flat);
  return {.mesh = std::move(mesh),
          .outer_surface = std::move(outer_surface.nodes),
          .surface = geometry::SmoothSurface(std::move(outer_surface.surface)),
          .top_area = top_area,
          .bottom_area = bottom_area,
          .base_level = base_level};
}

SpecimenShape make_shape(const Scenario& scenario, const std::string& folder,
                         const geometry::SmoothSurface* of_file) {
  SpecimenMesh made =
      specimen_mesh(scenario, folder, of_file == nullptr ? nullptr : &of_file->surface());
  geometry::TetMesh& mesh = made.mesh;
  const auto [low, high] = geometry::reach_along(mesh.nodes, Vec3::UnitZ());
  const double rounding = 1e-4 * (high - low);  // of files, in a flat underside
  const double level = base_level(scenario, geometry::outer_surface(mesh).surface);
  if (level > low + rounding && !scenario.uniform() && scenario.tissue.held_from_below() &&
      !std::holds_alternative<scenario::MeshFile>(scenario.tissue.mesh)) {
    mesh = meshing::cut_at(std::move(mesh), level, true, parametric(scenario.tissue.shape));
    meshing::check(mesh, "the mesh, cut at the border of the base,", 0.0);
  }
  SpecimenShape shape = shape_of(std::move(mesh), level);
  shape.warning = std::move(made.warning);
  shape.straightened = std::move(made.straightened);
  return shape;
}

std::string shape_key(const Scenario& scenario) {
  scenario::Scenario only;
  only.tissue.shape = scenario.tissue.shape;
  only.tissue.mesh = scenario.tissue.mesh;
  only.tissue.base_height = scenario.tissue.base_height;
  for (const auto& region : scenario.regions) only.regions.push_back({{region.part, ""}});
  if (knows_finger(scenario.tissue.mesh)) {
    only.finger.x = scenario.finger.x;
    only.finger.y = scenario.finger.y;
  }
  only.solver.model = scenario::strongest.of;  // has a mesh, and reads all keys of shape and mesh
  // A uniform test turns shapes to stand on their ends.
  if (scenario.uniform())
    only.steps.emplace_back(scenario::Creep{});
  else
    only.steps.emplace_back(scenario::Indent{});
  std::string key = fields_as_toml([&](FieldVisitor& visitor) { scenario::fields(visitor, only); });
  // How the body lies, whatever keys say so: presses in several places share it.
  for (int i = 0; i < 9; ++i) key += number_text(scenario.tissue.turn(i / 3, i % 3)) + " ";
  for (int i = 0; i < 3; ++i) key += number_text(scenario.tissue.base_up[i]) + " ";
  return key + std::to_string(scenario.tissue.near_part);
}

SpecimenShapes::Entry& SpecimenShapes::entry(const Scenario& scenario) {
  std::string key = shape_key(scenario);
  if (refines(scenario)) key += refining_key(scenario);
  const std::lock_guard lock(looking_up_);
  return entries_[key];
}

template <class Part, class Made>
void SpecimenShapes::fill(Entry& entry, std::unique_ptr<Part>& part, const Made& made) {
  const Stopwatch watch;
  part = std::make_unique<Part>(made());
  const double spent = watch.seconds();
  entry.seconds += spent;
  seconds_ += spent;
}

std::size_t SpecimenShapes::size() {
  const std::lock_guard lock(looking_up_);
  return entries_.size();
}

const SpecimenShape& SpecimenShapes::shape(const Scenario& scenario, const std::string& folder) {
  return shape(scenario, [&] {
    const bool file = std::holds_alternative<scenario::SurfaceFile>(scenario.tissue.shape);
    return make_shape(scenario, folder, file ? surface(scenario, folder).must().get() : nullptr);
  });
}

const SpecimenShape& SpecimenShapes::shape(const Scenario& scenario, const Make& make) {
  Entry& known = entry(scenario);
  const std::lock_guard lock(known.building);
  if (!known.shape) fill(known, known.shape, make);
  return *known.shape;
}

const tissue::SpringFit& SpecimenShapes::fit(const Scenario& scenario, const std::string& folder) {
  const geometry::TetMesh& mesh = shape(scenario, folder).mesh;
  Entry& known = entry(scenario);
  const std::lock_guard lock(known.building);
  if (!known.fit) fill(known, known.fit, [&] { return tissue::fit_springs(mesh); });
  return *known.fit;
}

const SpecimenShapes::Numbers& SpecimenShapes::kept_numbers(const std::string& key,
                                                            const std::function<Numbers()>& make) {
  auto& [making, numbers] = [&]() -> auto& {
    const std::lock_guard lock(looking_up_);
    return numbers_[key];
  }
  ();
  const std::lock_guard lock(making);
  if (!numbers) numbers = make();
  return *numbers;
}

double SpecimenShapes::seconds(const Scenario& scenario) {
  Entry& known = entry(scenario);
  const std::lock_guard lock(known.building);
  return known.seconds;
}

namespace {

// What the parts of a surface file depend on.
std::string parts_key(const Scenario& scenario, const std::string& folder) {
  const auto& file = std::get<scenario::SurfaceFile>(scenario.tissue.shape);
  return folder + "\n" + file.file + "\n" + file.unit + (file.repair ? "\nr" : "\n") +
         number_text(file.repair_up_to) + "\n";
}

}  // namespace

const meshing::MendedSurface& SpecimenShapes::all_parts(const Scenario& scenario,
                                                        const std::string& folder) {
  AllParts& known = [&]() -> AllParts& {
    const std::lock_guard lock(looking_up_);
    return parts_[parts_key(scenario, folder)];
  }();
  const std::lock_guard lock(known.reading);
  if (!known.mended && !known.refusal) {
    try {
      known.mended = all_parts_of(scenario, folder);
    } catch (const MeshError&) {
      known.refusal = std::current_exception();
    } catch (const InputError&) {
      known.refusal = std::current_exception();
    }
  }
  if (known.refusal) std::rethrow_exception(known.refusal);
  return *known.mended;
}

int SpecimenShapes::near_part(const Scenario& scenario, const std::string& folder,
                              const Vec3& place) {
  try {
    return meshing::near_part(all_parts(scenario, folder), place);
  } catch (const MeshError&) {
  } catch (const InputError&) {
  }
  return 0;
}

SpecimenShapes::FileEntry& SpecimenShapes::file_entry(const Scenario& scenario,
                                                      const std::string& folder) {
  const auto& file = std::get<scenario::SurfaceFile>(scenario.tissue.shape);
  std::string key = parts_key(scenario, folder) + std::to_string(file.part.value_or(0)) + " " +
                    std::to_string(scenario.tissue.near_part);
  for (int i = 0; i < 9; ++i) key += " " + number_text(scenario.tissue.turn(i / 3, i % 3));
  const std::lock_guard lock(looking_up_);
  return surfaces_[key];
}

void SpecimenShapes::know_surface(const Scenario& scenario, const std::string& folder,
                                  SpecimenShapes& from) {
  FileEntry& entry = file_entry(scenario, folder);
  const std::lock_guard lock(entry.reading);
  entry.surface = from.surface(scenario, folder);
}

const SpecimenShapes::FileSurface& SpecimenShapes::surface(const Scenario& scenario,
                                                           const std::string& folder) {
  FileEntry& entry = file_entry(scenario, folder);
  const std::lock_guard lock(entry.reading);
  FileSurface& known = entry.surface;
  if (known.surface || !known.fault.empty()) return known;
  if (const Eigen::Matrix3d turn = scenario.tissue.turn; turn != Eigen::Matrix3d::Identity()) {
    Scenario plain = scenario;
    plain.tissue.turn = Eigen::Matrix3d::Identity();
    known = surface(plain, folder);
    if (!known.surface) return known;
    geometry::Surface turned = known.surface->surface();
    for (Vec3& vertex : turned.vertices) vertex = turn * vertex;
    known.surface = std::make_shared<const geometry::SmoothSurface>(std::move(turned));
    return known;
  }
  const auto refuse = [&](const std::exception& error) {
    known.fault = error.what();
    known.refusal = std::current_exception();
  };
  try {
    meshing::WholeSurface whole = part_of(all_parts(scenario, folder), scenario);
    known.warning = std::move(whole.warning);
    known.part = std::move(whole.part);
    known.surface = std::make_shared<const geometry::SmoothSurface>(std::move(whole.surface));
  } catch (const MeshError& error) {
    refuse(error);
  } catch (const InputError& error) {
    refuse(error);
  }
  return known;
}

const std::shared_ptr<const geometry::SmoothSurface>& SpecimenShapes::FileSurface::must() const {
  if (refusal) std::rethrow_exception(refusal);
  return surface;
}

namespace {

std::vector<double> numbers_of(const contact::Layer& layer) {
  std::vector<double> numbers{layer.poisson_ratio, layer.share,
                              layer.base == contact::LayerBase::bonded ? 1.0 : 0.0};
  for (const contact::Sublayer& below : layer.below)
    numbers.insert(numbers.end(), {below.thickness, below.stiffness, below.poisson_ratio});
  return numbers;
}

// Shared by the whole process, for the tests of a joint identification. A search that
// varies nu needs a new layer every time; at this number all are removed.
template <class Value>
struct KeptLayers {
  static constexpr std::size_t most = 100;
  std::mutex looking_up;
  std::map<std::vector<double>, std::shared_ptr<const Value>> all;

  // Two threads may make the same one; both have the same bits.
  std::shared_ptr<const Value> of(const contact::Layer& layer) {
    const std::vector<double> key = numbers_of(layer);
    {
      const std::lock_guard lock(looking_up);
      if (const auto known = all.find(key); known != all.end()) return known->second;
    }
    auto made = std::make_shared<const Value>(layer);
    const std::lock_guard lock(looking_up);
    if (all.size() >= most) all.clear();
    return all.emplace(key, std::move(made)).first->second;
  }
};

}  // namespace

contact::LayerLaw layer_law(const contact::Layer& layer) {
  static KeptLayers<contact::LayerLaw> stacks;
  static KeptLayers<contact::LayerTable> tables;
  if (!layer.below.empty()) return *stacks.of(layer);
  // The table of a single layer serves every finger and modulus.
  contact::Layer any = layer;
  any.share = 1.0;
  return {*tables.of(any), layer.share};
}

namespace {

// Whether the finger's path leaves the top of a cuboid.
bool leaves(const scenario::Resolved& scenario, const scenario::Cuboid& box) {
  for (const auto& [x, y] : scenario::finger_places(scenario, box))
    if (std::min({x, box.size[0] - x, y, box.size[1] - y}) < 0.0) return true;
  return false;
}

std::optional<std::string> beyond_half_space(const scenario::Resolved& scenario,
                                             const SurfaceTouch& touch) {
  // Steeper, the second order of SurfaceTouch::pressed() is not enough.
  constexpr double steepest = 60.0;  // degrees
  if (!touch.known()) return touch.cannot;
  if (!scenario.tissue.held_from_below())
    return "the base is inclined to the press by " +
           rounded_text(std::acos(std::clamp(scenario.tissue.base_up.z(), -1.0, 1.0)) * 180.0 /
                            std::numbers::pi,
                        2) +
           " degrees";
  const auto* box = std::get_if<scenario::Cuboid>(&scenario.tissue.shape);
  if (box != nullptr && leaves(scenario, *box)) return "the finger leaves the top of the body";
  if (!touch.curved() && !touch.tilted()) return std::nullopt;
  if (scenario.finger.spheres > 1) return "several spheres meet a curved surface";
  for (const scenario::Step& step : scenario.steps)
    if (std::holds_alternative<scenario::Slide>(step))
      return "the finger slides over a curved surface";
  if (touch.inclination() > steepest)
    return "the surface is inclined by " + rounded_text(touch.inclination(), 2) +
           " degrees where the finger touches it, and the formula holds up to 60";
  return std::nullopt;
}

constexpr const char* has_regions = "the body has several tissues";

}  // namespace

std::optional<std::string> beyond(scenario::Model model, const scenario::Resolved& scenario,
                                  const SurfaceTouch& touch) {
  switch (model) {
    case scenario::Model::hertz:
      if (several_tissues(scenario)) return has_regions;
      return beyond_half_space(scenario, touch);
    case scenario::Model::layer:
      if (!std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape))
        return "a layer is a `cuboid` pressed on its flat top";
      if (scenario.finger.spheres > 1 && scenario.finger.calibration == finger::Calibration::mass)
        return "several spheres share one layer";
      if (!all_slabs(scenario) && several_tissues(scenario)) return has_regions;
      return beyond_half_space(scenario, touch);
    case scenario::Model::mass_spring:
    case scenario::Model::coupled_springs:
    case scenario::Model::solid:
      if (std::holds_alternative<scenario::HalfSpace>(scenario.tissue.shape))
        return "a `half_space` is infinite and cannot be meshed";
  }
  return std::nullopt;
}

double deepest_travel(const scenario::Resolved& scenario, const contact::SphereLaw& law,
                      double yields) {
  double travel = 0.0;
  for (const scenario::Step& step : scenario.steps)
    if (const auto* indent = std::get_if<scenario::Indent>(&step)) {
      const double to = indent->to.value;
      travel =
          std::max(travel, indent->to.second
                               ? (1.0 + yields) * contact::hertz::depth(to, law.radius, law.modulus)
                               : to);
    }
  return travel;
}

}  // namespace palpate::scene
