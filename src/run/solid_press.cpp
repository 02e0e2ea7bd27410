// Presses the solid on one or several meshes.
#include "run/solid_press.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "base/units.h"
#include "meshing/tetgen.h"
#include "run/pressure_map.h"
#include "scene/surface_touch.h"

namespace palpate::run {
namespace {

// Elements per contact radius of the meshes: as many as what they state asks for.
constexpr std::array<double, 3> per_radius{2.0, 3.2, 4.4};
// On one mesh with an inclusion: by 2.0 forces were 3 to 5 % high above inclusions near the
// surface.
constexpr double beside_inclusion = 2.6;
// A wall of less contact radii that nothing holds below is for two meshes: by one, forces were up
// to 3.4 % high.
constexpr double thin_wall = 5.0;

std::size_t meshes_for(double tolerance) {
  if (tolerance >= solid::error_of_one_mesh) return 1;
  return tolerance >= solid::error_of_two_meshes ? 2 : 3;
}

// How thin the wall under the finger is if nothing holds its other side, m.
double free_wall(const scene::Scene& scene) {
  const scene::SolidBody& body = *scene.solid;
  const double thickness = scene::thickness_under(body.outer_surface->surface(), body.touched);
  const Vec3 below = body.touched - thickness * Vec3::UnitZ();
  const double rounding = 1e-6 * thickness;
  return below.dot(scene.scenario.tissue.base_up) > body.base_level + rounding ? thickness
                                                                               : HUGE_VAL;
}

// How thick a skin is that is much stiffer than what lies below it and bends with it, m.
double stiff_skin(const scene::Scene& scene) {
  constexpr double stiffer = 15.0;  // below that, elements of the usual size serve
  const contact::Layer layer = scene::layers_of(scene.scenario, 1.0);
  double softest = 1.0;
  for (const auto& one : layer.below) softest = std::min(softest, one.stiffness);
  return stiffer * softest < 1.0 ? layer.top() * scene.choice.touch.thickness : HUGE_VAL;
}

}  // namespace

SolidPress::SolidPress(const scene::Scene& scene, double longest_search)
    : scene_(&scene), longest_search_(longest_search) {
  std::size_t count = meshes_for(scene.scenario.solver.tolerance);
  deepest_ =
      scene::deepest_travel(scene.scenario, scene.finger.whole, scene.choice.expected.yields);
  // Elements much wider than a wall make it too stiff, by 2.5 times where they are eight times as
  // wide, and so do those wider than a stiff skin that bends, by up to 14 %. They are smaller
  // there, and a second mesh says what is left of that.
  constexpr double finest = 2.0;
  constexpr double finest_on_skin = 1.3;
  const double width = std::sqrt(scene.finger.sphere_radius * deepest_);
  wall_ = free_wall(scene);
  const double skin = stiff_skin(scene);
  on_skin_ = skin < wall_ && width / skin > per_radius.front();
  if (const double wanted = width / std::min(wall_, skin); wanted > per_radius.front()) {
    finer_ = std::min(on_skin_ ? finest_on_skin : finest, wanted / per_radius.front());
    count = std::max<std::size_t>(count, 2);
  }
  if (wall_ < thin_wall * width) count = std::max<std::size_t>(count, 2);
  asked_.assign(per_radius.begin(), per_radius.begin() + static_cast<std::ptrdiff_t>(count));
  included_ = std::any_of(
      scene.scenario.regions.begin(), scene.scenario.regions.end(),
      [](const auto& region) { return std::holds_alternative<scenario::Inclusion>(region.part); });
  if (count == 1 && included_) asked_.front() = beside_inclusion;
  make();
}

// All meshes have one kind of surface and one size of inclusions, or no force could be extrapolated
// from theirs.
void SolidPress::make() {
  const Stopwatch watch;
  const auto over = [&] { return watch.seconds() > longest_search_; };
  // Again with elements a little smaller where the surface is a file's, as TetGen may fail by bad
  // luck.
  constexpr double finer = 1.07;
  const int most_tries = scene_->solid->surface ? 3 : 1;
  // Of all meshes, with as many nodes as the cube of their elements.
  const auto work = [&](std::size_t count) {
    const auto cubes = [](double sum, double elements) { return sum + std::pow(elements, 3); };
    const auto upto = asked_.begin() + static_cast<std::ptrdiff_t>(count);
    return std::accumulate(asked_.begin(), upto, 0.0, cubes) /
           std::accumulate(asked_.begin(), asked_.end(), 0.0, cubes);
  };
  do {
    width_ = scene_->finger.centres.size() > 1
                 ? 1.0
                 : scene::width_on_edge(*body().outer_surface, body().first_touch,
                                        scene_->finger.sphere_radius, deepest_);
    per_radius_ = asked_;
    presses_.clear();
    int tries = 1;
    while (presses_.size() < asked_.size()) {
      double& number = per_radius_[presses_.size()];
      try {
        solid::FingerOrder wanted = order(number);
        wanted.done = {work(presses_.size()), work(presses_.size() + 1)};
        presses_.push_back(std::make_unique<solid::FingerPress>(std::move(wanted)));
        tries = 1;
      } catch (const MeshError& error) {
        number *= finer;
        if (!over() && tries++ < most_tries) continue;
        if (!over() && simpler()) break;
        if (!scene_->solid->surface || dynamic_cast<const meshing::TetgenError*>(&error) == nullptr)
          throw;
        const std::string fault = error.what();
        throw MeshError("no mesh for the press was found, with the surface as it is or coarser (" +
                        fault.substr(0, fault.find(';')) +
                        "); remesh it with even triangles in the program it comes from");
      }
    }
  } while (presses_.size() < asked_.size());
}

// Inclusions that touch a border cannot be meshed. The smooth surface through the vertices of a
// file may cut itself where the body is thin beside their distance, and so may a coarser one.
bool SolidPress::simpler() {
  constexpr std::array<double, 3> sizes{1.0, 0.99, 0.97};
  if (included_ && inclusion_size_ > sizes.back()) {
    inclusion_size_ = *std::find_if(sizes.begin(), sizes.end(),
                                    [&](double size) { return size < inclusion_size_; });
    return true;
  }
  if (!scene_->solid->surface || surface_ == Surface::split) return false;
  inclusion_size_ = 1.0;
  surface_ = static_cast<Surface>(static_cast<int>(surface_) + 1);
  if (!flat_) flat_ = scene::flattened(*scene_->solid, *scene_);
  return true;
}

solid::FingerOrder SolidPress::order(double elements) const {
  const scenario::Resolved& scenario = scene_->scenario;
  const scene::SolidBody& given = body();
  const scene::Finger& finger = scene_->finger;
  solid::FingerOrder order;
  solid::BodyOrder& body = order.body;
  body.shape = given.shape;
  body.surface = given.surface.get();
  body.coarser = surface_ < Surface::unchanged;
  body.movable = surface_ < Surface::split;
  body.mesh = given.mesh ? &*given.mesh : nullptr;
  body.middles = given.middles.empty() ? nullptr : &given.middles;
  body.region_of = [&scenario](int part) { return scene::substance_of(scenario, part); };
  for (std::size_t i = 0; i < scenario.regions.size(); ++i) {
    solid::Inclusion one{.region = static_cast<int>(i) + 1};
    if (const auto* inclusion = std::get_if<scenario::Inclusion>(&scenario.regions[i].part))
      one.sphere = geometry::Inclusion{
          Vec3(inclusion->centre[0], inclusion->centre[1], inclusion->centre[2]),
          inclusion_size_ * inclusion->radius, one.region};
    else if (const auto* slab = std::get_if<scenario::Slab>(&scenario.regions[i].part))
      std::tie(one.bottom, one.top) = std::pair(slab->bottom, slab->top);
    else
      continue;
    body.inclusions.push_back(one);
  }
  body.tissues = scene::tissues_of(scenario);
  body.base = scenario.tissue.base;
  body.base_level = given.base_level;
  body.base_up = scenario.tissue.base_up;
  body.mirrored = {true, true};
  body.per_radius = finer_ * elements / std::clamp(width_, solid::most_narrowed, 1.0);
  order.outer_surface = given.outer_surface.get();
  order.centres = finger.centres;
  order.radius = finger.sphere_radius;
  if (scenario.finger.elastic) {
    const auto& [modulus, ratio] = *scenario.finger.elastic;
    order.ball = tissue::Isotropic{modulus, std::min(ratio, scene::most_poisson_ratio)};
    constexpr double least = 1e-4;
    order.share = std::clamp(1.0 - scene::finger_share_on_body(*scene_), least, 1.0 - least);
  }
  order.deepest = deepest_;
  order.in_steps = deepest_ > wall_;  // from about a travel of its thickness on a wall buckles
  order.touch = {given.first_touch, given.touched};
  order.beside = [this, &finger](const Vec3& place) -> std::optional<solid::Touch> {
    const auto found = scene::touch_beside(this->body(), finger, place);
    if (!found) return std::nullopt;
    return solid::Touch{found->first, found->second};
  };
  if (const scene::SurfaceTouch& touch = scene_->choice.touch; touch.known() && !flat_) {
    const geometry::Curvature& own = touch.curvature;
    const Vec3 along_y = own.normal.cross(Vec3::UnitX()).normalized();
    const std::array<Vec3, 2> axes{along_y.cross(own.normal), along_y};
    for (std::size_t i = 0; i < 2; ++i)  // Euler's formula
      order.curvatures[i] = own.kappa_1 * std::pow(own.direction_1.dot(axes[i]), 2) +
                            own.kappa_2 * std::pow(own.direction_2.dot(axes[i]), 2);
    const bool conforms = std::min(own.kappa_1, own.kappa_2) * order.radius <= -1.0;
    order.smooth = finger.centres.size() == 1 && width_ == 1.0 && !conforms;
  }
  return order;
}

std::optional<std::string> SolidPress::find(const Way& way, mechanics::Touch& touch) {
  std::vector<double> forces;
  const auto take = [&](solid::FingerPress& press) -> std::optional<std::string> {
    const auto found = way.start != way.end
                           ? press.at_slide(touch.travel, way.start, way.end, way.along)
                           : press.at_travel(touch.travel, way.start);
    if (!found) return press.reason();
    now_ = *found;
    forces.push_back(found->force);
    return std::nullopt;
  };
  try {
    presses_.front()->settle_share();
    for (const auto& press : presses_) {
      press->take_share(presses_.front()->share());
      if (auto wrong = take(*press)) return wrong;
    }
  } catch (const MeshError&) {  // at a place of a slide
    if (!simpler()) throw;
    make();
    return find(way, touch);
  }
  const solid::Extrapolated best = solid::extrapolated(per_radius_, forces);
  now_.force = best.force;
  // The meshes are made for the deepest travel, and for a width on edges; their elements are larger
  // beside smaller and narrower contacts.
  error_ = best.force > 0.0 ? best.error / best.force : 0.0;
  // Elements that are wider than a skin, and those of a wall that buckles, which do not converge
  // with the square of their size, are as good on two meshes as others on one.
  const bool buckles = presses_.back()->buckles();
  if ((on_skin_ || buckles) && presses_.size() < 3)
    error_ = std::max(error_, solid::error_of_one_mesh);
  if (buckles && forces.size() > 1 && best.force > 0.0)
    error_ = std::max(error_, std::abs(forces.back() - forces.end()[-2]) / best.force);
  error_ *= std::max(1.0, solid::most_narrowed / width_);
  if (touch.travel > 0.0) error_ *= std::max(1.0, deepest_ / touch.travel);
  error_ += now_.excess;  // the share is that of the deepest travel
  // Ball and tissue meet between their shapes at rest.            docs/theory.md [solid_force]
  constexpr double counted = 0.8;
  error_ += counted * (1.0 - presses_.front()->share()) *
            std::pow(touch.travel / scene_->finger.sphere_radius, 2);
  touch.finger = body().first_touch + way.start - touch.travel * Vec3::UnitZ();
  if (way.start != way.end) touch.finger += way.along * (way.end - way.start).normalized();
  touch.contacts.resize(now_.force > 0.0 ? 1 : 0);
  if (now_.force > 0.0) {
    mechanics::SphereContact& contact = touch.contacts[0];
    contact.renew();
    contact.force = contact.elastic = now_.force;
    contact.approach = contact.depth = touch.travel;
    contact.patch.position = touch.finger - scene_->finger.sphere_radius * Vec3::UnitZ();
    contact.patch.normal = Vec3::UnitZ();
    contact.patch.axis = Vec3::UnitX();
    contact.patch.a = contact.patch.b = now_.contact_radius;
  }
  return std::nullopt;
}

void SolidPress::complete(record::ContactRow& row) const {
  const scene::SurfaceTouch& place = scene_->choice.touch;
  if (place.known() && place.curved())
    row.tissue_radius = 2.0 / (place.curvature.kappa_1 + place.curvature.kappa_2);
  if (!(row.contact_force > 0.0)) return;
  row.peak_pressure = now_.peak_pressure * row.contact_force / now_.force;
  row.contacts = now_.touching;
  row.mesh_error = error_;
}

void SolidPress::add_findings(record::CaseRecord& record) const {
  const solid::Press& finest = presses_.back()->press();
  const auto add = [&](const char* name, double value) {
    record.findings.push_back({name, value});
  };
  add("nodes", static_cast<double>(finest.body().mesh.nodes.size()));
  add("tetrahedra", static_cast<double>(finest.body().mesh.elements.size()));
  add("mirrored_copies", static_cast<double>(finest.body().copies));
  add("meshes", static_cast<double>(presses_.size()));
  add("factorisations", static_cast<double>(finest.factorisations()));
  if (const auto snap = presses_.back()->snap())
    record.warnings.push_back(
        "the force falls from a displacement of " + rounded_text(unit::mm.from_si(snap->first), 2) +
        " mm to " + rounded_text(unit::mm.from_si(snap->second), 2) +
        " mm: a wall snaps through there, and a finger that is pressed by a force would jump");
  if (inclusion_size_ < 1.0)
    record.warnings.push_back(
        "an inclusion that touches a border is meshed with a radius that is " +
        percent_text(1.0 - inclusion_size_) + " smaller");
  if (flat_)
    record.warnings.push_back(
        "the smooth surface through the vertices of the file cannot be meshed, so that its "
        "triangles are taken as they are; a finer surface has less of a difference between the "
        "two");
}

geometry::TetMesh SolidPress::corners() const {
  const solid::Mesh& whole = presses_.back()->press().body().mesh;
  geometry::TetMesh mesh;
  mesh.regions = whole.regions;
  std::vector<int> names(whole.nodes.size(), -1);
  for (const solid::Element& element : whole.elements) {
    auto& corners = mesh.tetrahedra.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) {
      int& name = names[as_index(element[i])];
      if (name < 0) {
        name = static_cast<int>(mesh.nodes.size());
        mesh.nodes.push_back(whole.nodes[as_index(element[i])]);
      }
      corners[i] = name;
    }
  }
  return mesh;
}

solid::FingerPress::OuterSurface SolidPress::surface(std::size_t mesh,
                                                     const mechanics::Touch& touch) {
  if (touch.contacts.empty()) return {};
  Vec3 place = touch.finger - body().first_touch;
  place.z() = 0.0;
  return presses_[mesh]->surface_at(touch.travel, place);
}

record::PressureMap SolidPress::map(const mechanics::Touch& touch) {
  const double force = touch.contacts.empty() ? 0.0 : touch.normal_force();
  return draw_map(surface(meshes() - 1, touch), now_.contact_radius, force, touch.finger);
}

}  // namespace palpate::run
