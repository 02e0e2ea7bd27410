// Estimate, mark, halve, and again.
#include "run/refined_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "base/error.h"
#include "mechanics/pressed_mesh.h"
#include "meshing/bisection.h"
#include "meshing/mesh_check.h"
#include "run/choose.h"
#include "run/size_effect.h"
#include "scenario/integrators.h"
#include "scene/estimates.h"
#include "scene/first_touch.h"
#include "scene/places.h"
#include "scene/proportions.h"
#include "scene/refining_press.h"
#include "scene/specimen_mesh.h"

namespace palpate::run {
namespace {

constexpr char times = 3;               // halvings, for edges of half the length
constexpr int most_modal_nodes = 1000;  // where `modal` keeps all modes
constexpr int most_rounds = 20;

// What the mesh costs in the force, and which tetrahedra cost it.
struct Estimate {
  double error = 0.0;  // a fraction of the force
  std::vector<double> parts;
};

Estimate estimate(const scene::Scene& scene) {
  mechanics::PressedMesh mesh(scene);
  mechanics::Touch touch;
  const Vec3 first = scene::first_touch(scene).finger;
  const double deepest = scene::deepest_travel(scene.scenario, scene.law());
  Estimate sum;
  sum.parts.assign(scene.specimen->mesh.tetrahedra.size(), 0.0);
  for (const Vec3& place : finger_way(scene.scenario)) {
    // On a coarse mesh the contact may have no solution at the full depth.
    const mechanics::SphereContact* contact = nullptr;
    for (double depth = deepest; contact == nullptr && depth > 0.1 * deepest; depth *= 0.5)
      if (!mesh.try_out(first + place - depth * Vec3::UnitZ(), touch)) contact = touch.deepest();
    if (contact == nullptr) continue;
    sum.error = std::max(sum.error, mechanics::mesh_error(*contact));
    const std::vector<double> errors = mesh.errors(*contact);
    for (std::size_t t = 0; t < errors.size(); ++t) sum.parts[t] += errors[t];
  }
  return sum;
}

// Tetrahedra near the places that are too large for the waves of a fast press: the marks of those
// with an edge above `longest` (m) within four times that length.    docs/theory.md [wave_mesh]
std::vector<char> too_large(const geometry::TetMesh& mesh, std::span<const Vec3> places,
                            double longest) {
  std::vector<char> marks(mesh.tetrahedra.size(), 0);
  for (std::size_t t = 0; t < marks.size(); ++t) {
    Vec3 middle = Vec3::Zero();
    double edge = 0.0;
    for (const int a : mesh.tetrahedra[t]) {
      middle += 0.25 * mesh.nodes[as_index(a)];
      for (const int b : mesh.tetrahedra[t])
        edge = std::max(edge, (mesh.nodes[as_index(a)] - mesh.nodes[as_index(b)]).norm());
    }
    if (edge <= longest) continue;
    for (const Vec3& place : places)  // no node is farther from the middle than 3/4 of the edge
      if ((middle - place).norm() < 4.0 * longest + 0.75 * edge) marks[t] = 1;
  }
  return marks;
}

// Edges of half the length leave a quarter of a tetrahedron's error.
constexpr double removed = 0.75;

// Marks the tetrahedra with the largest errors, which have the part `share` of the sum, but at most
// `most` of them.
std::vector<char> marked(const std::vector<double>& errors, double share, std::size_t most) {
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
  const double all = std::accumulate(errors.begin(), errors.end(), 0.0);
  std::vector<char> marks(errors.size(), 0);
  double sum = 0.0;
  for (const std::size_t t : order) {
    if (sum >= share * all || most-- == 0) break;
    sum += errors[t];
    marks[t] = times;
  }
  return marks;
}

class Refining {
 public:
  Refining(const scenario::Case& one, const scenario::Family& family,
           const scenario::Resolved& scenario, scene::SpecimenShapes& shapes)
      : one_(one),
        family_(family),
        shapes_(&shapes),
        mesh_(&scenario.tissue.mesh),
        longest_(scene::longest_for_waves(scenario)) {
    trial_.given = true;
    trial_.chosen = scene::refining_press(scenario);
    most_nodes_ = scenario::refinement(*mesh_).most_nodes;
    if (scenario.solver.integrator == scenario::Solver::Integrator::modal &&
        !scenario::lowest_modes_serve(scenario))
      most_nodes_ = std::min(most_nodes_, most_modal_nodes);
  }

  [[nodiscard]] scene::SpecimenShape refined() {
    const scenario::Resolved& press = trial_.chosen;
    const auto of_file = reads_surface() ? shapes_->surface(press, family_.folder).must() : nullptr;
    scene::SpecimenShape shape = scene::make_shape(press, family_.folder, of_file.get());
    // scene_with() takes this mesh as it is.
    scenario::refinement(trial_.chosen.tissue.mesh).refine = false;
    std::vector<double> levels = scene::slab_levels(press);
    if (press.tissue.held_from_below()) levels.push_back(shape.base_level);
    meshing::TrueBoundary boundary(shape.mesh, scene::parametric(press.tissue.shape),
                                   scene::inclusions_of(press), levels);
    scene::Refined told{.start_nodes = static_cast<int>(shape.mesh.nodes.size()),
                        .wanted = scene::refined_share * press.solver.tolerance};
    const double base_level = shape.base_level;
    const auto take = [&](geometry::TetMesh mesh) {
      std::string warning = std::move(shape.warning);
      shape = scene::shape_of(std::move(mesh), base_level);
      shape.warning = std::move(warning);
    };
    if (std::isfinite(longest_)) {
      const scene::Scene scene = scene_with(shape);
      std::vector<Vec3> places = finger_way(scene.scenario);
      for (Vec3& place : places) place += scene::pressed_place(scene);
      for (;;) {
        const std::vector<char> marks = too_large(shape.mesh, places, longest_);
        if (std::ranges::count(marks, 1) == 0) break;
        auto finer = halved(shape.mesh, marks, boundary);
        if (!finer) break;
        take(std::move(*finer));
      }
    }
    for (int round = 0;; ++round) {
      const Estimate found = estimate(scene_with(shape));
      told.rounds = round;
      told.error = found.error;
      if (found.error <= told.wanted || round == most_rounds) break;
      // Half of the error at once, and near the end no more than is needed.
      const double share = std::min(0.5, 1.1 * (1.0 - told.wanted / found.error) / removed);
      std::optional<geometry::TetMesh> finer;
      for (std::size_t most = found.parts.size(); most > 0 && !finer;) {
        const std::vector<char> marks = marked(found.parts, share, most);
        finer = halved(shape.mesh, marks, boundary);
        most = static_cast<std::size_t>(std::ranges::count(marks, times)) / 2;
      }
      if (!finer) break;
      take(std::move(*finer));
    }
    shape.refined = told;
    return shape;
  }

 private:
  [[nodiscard]] bool reads_surface() const {
    return std::holds_alternative<scenario::SurfaceFile>(trial_.chosen.tissue.shape);
  }

  [[nodiscard]] scene::Scene scene_with(const scene::SpecimenShape& shape) const {
    scene::SpecimenShapes shapes;
    if (reads_surface()) shapes.know_surface(trial_.chosen, family_.folder, *shapes_);
    (void)shapes.shape(trial_.chosen, [&] { return shape; });
    return scene::build(one_, family_, shapes, trial_);
  }

  // Nothing if the mesh would have too many nodes.
  [[nodiscard]] std::optional<geometry::TetMesh> halved(const geometry::TetMesh& mesh,
                                                        const std::vector<char>& marks,
                                                        meshing::TrueBoundary& boundary) const {
    meshing::TrueBoundary trial = boundary;
    meshing::Bisection bisection(
        mesh, [&](const meshing::Bisection::Middle& edge) { return trial.place(edge); });
    bisection.halve(marks);
    geometry::TetMesh finer = bisection.mesh();
    if (static_cast<int>(finer.nodes.size()) > most_nodes_) return std::nullopt;
    trial.restore_inclusions(finer);
    meshing::check(finer, "the refined mesh", 0.0);
    boundary = std::move(trial);
    return finer;
  }

  const scenario::Case& one_;
  const scenario::Family& family_;
  scene::SpecimenShapes* shapes_;
  const scenario::Mesh* mesh_;
  double longest_;  // m, near the finger, scene::longest_for_waves()
  scene::Choice trial_;
  int most_nodes_ = 0;
};

}  // namespace

scene::Scene build_scene(const scenario::Case& one, const scenario::Family& family) {
  scene::SpecimenShapes shapes;
  return build_scene(one, family, shapes);
}

scene::Scene build_scene(const scenario::Case& one, const scenario::Family& family,
                         scene::SpecimenShapes& shapes) {
  return build_scene(one, family, shapes,
                     scenario::at_its_key(family.document, [&] { return choose(one, shapes); }));
}

scene::Scene build_scene(const scenario::Case& one, const scenario::Family& family,
                         scene::SpecimenShapes& shapes, scene::Choice choice) {
  if (!choice.chosen.uniform()) {
    scene::refuse_beside(choice.chosen, choice.touch, family);
    scene::refuse_through(choice.chosen, choice.touch, choice.expected, family);
  }
  try {
    return scenario::at_its_key(family.document, [&] {
      if (scene::refines(choice.chosen)) {
        scene::refuse_misplaced(choice.chosen, family, shapes);
        (void)shapes.shape(choice.chosen,
                           [&] { return Refining(one, family, choice.chosen, shapes).refined(); });
      }
      return scene::build(one, family, shapes, choice);
    });
  } catch (const MeshError& error) {
    const auto* file = std::get_if<scenario::SurfaceFile>(&choice.chosen.tissue.shape);
    const std::string part =
        file == nullptr ? "" : shapes.surface(choice.chosen, family.folder).part;
    if (part.empty()) throw;
    throw MeshError(std::string(error.what()) + " (the body is " + part + " of " + file->file +
                    ")");
  }
}

}  // namespace palpate::run
