// Meshes, skins and fits behind the text that says what they depend on.
#include "scene/specimen_shape.h"

#include <cmath>
#include <utility>

#include "base/field_writer.h"
#include "geometry/surface.h"
#include "scene/specimen_mesh.h"

namespace palpate::scene {
namespace {

using scenario::Scenario;

// The area of the skin's triangles that lie in the plane at height `z`, m^2.
double flat_area(const geometry::Skin& skin, double z, double tolerance) {
  double sum = 0.0;
  for (std::size_t t = 0; t < skin.surface.triangles.size(); ++t) {
    bool inside = true;
    for (const int v : skin.surface.triangles[t])
      inside = inside &&
               std::abs(skin.surface.vertices[static_cast<std::size_t>(v)].z() - z) <= tolerance;
    if (inside) sum += 0.5 * geometry::twice_area(skin.surface, static_cast<int>(t)).norm();
  }
  return sum;
}

SpecimenShape make_shape(const Scenario& scenario, const std::string& folder) {
  geometry::TetMesh mesh = specimen_mesh(scenario, folder);
  geometry::Skin skin = geometry::skin(mesh);
  double low = mesh.nodes.front().z();
  double high = low;
  for (const Vec3& node : mesh.nodes) {
    low = std::min(low, node.z());
    high = std::max(high, node.z());
  }
  const double flat = 1e-9 * geometry::diagonal(mesh);
  const double top_area = flat_area(skin, high, flat);
  const double bottom_area = flat_area(skin, low, flat);
  return {std::move(mesh), std::move(skin.nodes), geometry::SmoothSurface(std::move(skin.surface)),
          top_area, bottom_area};
}

// Lattices are finer under the finger where they are graded; other meshes do not know it.
bool knows_finger(const scenario::Mesh& mesh) {
  if (const auto* kuhn = std::get_if<scenario::Kuhn>(&mesh)) return kuhn->grading != 1.0;
  if (const auto* mirrored = std::get_if<scenario::Mirrored>(&mesh))
    return mirrored->grading != 1.0;
  return false;
}

}  // namespace

std::string shape_key(const Scenario& scenario) {
  Scenario only = scenario;
  const scenario::Tissue& tissue = scenario.tissue;
  only.title.clear();
  only.tissue = {};
  only.tissue.shape = tissue.shape;
  only.tissue.mesh = tissue.mesh;
  for (scenario::Region& region : only.regions)
    std::visit([](auto& one) { one.substance = {}; }, region);
  only.finger = {};
  if (knows_finger(tissue.mesh)) {
    only.finger.x = scenario.finger.x;
    only.finger.y = scenario.finger.y;
  }
  only.contact = {};
  only.solver = {};
  only.solver.model = scenario::Solver::Model::coupled_springs;  // it takes all that has a mesh
  only.output = {};
  // A uniform test stands shapes on their ends.
  only.steps.clear();
  if (scenario.uniform())
    only.steps.emplace_back(scenario::Creep{});
  else
    only.steps.emplace_back(scenario::Indent{});
  return fields_as_toml([&](FieldVisitor& visitor) { scenario::fields(visitor, only); });
}

SpecimenShapes::Entry& SpecimenShapes::entry(const Scenario& scenario) {
  const std::string key = shape_key(scenario);
  const std::lock_guard lock(looking_up_);
  return entries_[key];
}

std::size_t SpecimenShapes::size() {
  const std::lock_guard lock(looking_up_);
  return entries_.size();
}

const SpecimenShape& SpecimenShapes::shape(const Scenario& scenario, const std::string& folder) {
  Entry& known = entry(scenario);
  const std::lock_guard lock(known.building);
  if (!known.shape) known.shape = std::make_unique<SpecimenShape>(make_shape(scenario, folder));
  return *known.shape;
}

const tissue::SpringFit& SpecimenShapes::fit(const Scenario& scenario, const std::string& folder) {
  const geometry::TetMesh& mesh = shape(scenario, folder).mesh;
  Entry& known = entry(scenario);
  const std::lock_guard lock(known.building);
  if (!known.fit) known.fit = std::make_unique<tissue::SpringFit>(tissue::fit_springs(mesh));
  return *known.fit;
}

namespace {

std::vector<double> numbers_of(const contact::Layer& layer) {
  std::vector<double> numbers{layer.poisson_ratio, layer.share,
                              layer.base == contact::LayerBase::bonded ? 1.0 : 0.0};
  for (const contact::Sublayer& below : layer.below)
    numbers.insert(numbers.end(), {below.thickness, below.stiffness, below.poisson_ratio});
  return numbers;
}

// A search that varies nu asks for a new layer every time: the oldest tables are not kept for it.
constexpr std::size_t most_layers = 100;

template <class Table>
Table cached(std::map<std::vector<double>, Table>& tables, std::mutex& mutex,
             const contact::Layer& layer) {
  const std::vector<double> key = numbers_of(layer);
  {
    const std::lock_guard lock(mutex);
    if (const auto known = tables.find(key); known != tables.end()) return known->second;
  }
  Table table(layer);  // two threads may build the same one: it has the same bits
  const std::lock_guard lock(mutex);
  if (tables.size() >= most_layers) tables.clear();
  tables.emplace(key, table);
  return table;
}

}  // namespace

contact::LayerLaw SpecimenShapes::layer_law(const contact::Layer& layer) {
  return cached(laws_, looking_up_layer_, layer);
}

contact::LayerSinking SpecimenShapes::layer_sinking(const contact::Layer& layer) {
  return cached(sinkings_, looking_up_layer_, layer);
}

}  // namespace palpate::scene
