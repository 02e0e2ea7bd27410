// Detection of contacts, their laws and patches, and one pass of the contact equations.
#include "mechanics/surface_contacts.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace palpate::mechanics {
namespace {

geometry::CurvatureOptions curvature_options(const scene::Scene& scene) {
  geometry::CurvatureOptions options;
  options.method = scene.scenario.contact.curvature;
  options.rings = scene.scenario.contact.curvature_rings;
  return options;
}

bool on_deformed(const MovingPart& part) {
  return part.scene->scenario.contact.curvature_on == scenario::Contact::CurvatureOn::deformed;
}

}  // namespace

SurfaceCurvature::SurfaceCurvature(const MovingPart& part)
    : part_(&part),
      outer_surface_(&part.scene->specimen->surface->surface()),
      stars_(*outer_surface_, part.scene->specimen->surface->neighbours(),
             curvature_options(*part.scene)),
      number_of_(outer_surface_->triangles.size(), -1) {
  if (const auto& file = part.scene->of_file) of_file_.emplace(file->surface());
}

// A place near each corner, within the triangle: at a crease the surface has another curvature on
// either side.
SurfaceCurvature::Corners SurfaceCurvature::on_file(int triangle) const {
  constexpr double inwards = 0.1;
  const geometry::SmoothSurface& file = *part_->scene->of_file;
  const auto& numbers = outer_surface_->triangles[as_index(triangle)];
  Vec3 middle = Vec3::Zero();
  for (const int number : numbers) middle += outer_surface_->vertices[as_index(number)] / 3.0;
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& corner = outer_surface_->vertices[as_index(numbers[i])];
    const geometry::Near near = of_file_->nearest(corner + inwards * (middle - corner));
    const geometry::SurfacePoint at{near.triangle, near.weights};
    corners[i] = scene::curvature_of_file(file, at, part_->scene->scenario);
    // A coarse file, as a box of twelve triangles, has too few neighbours.
    if (!corners[i].known()) return stars_.at_corners(*outer_surface_, triangle);
    corners[i].curvature = geometry::turned_to(corners[i].curvature, file.normal(at));
  }
  return corners;
}

const SurfaceCurvature::Corners& SurfaceCurvature::at_rest(int triangle) {
  int& number = number_of_[as_index(triangle)];
  if (number < 0) {
    number = static_cast<int>(known_.size());
    known_.push_back(of_file_ ? on_file(triangle) : stars_.at_corners(*outer_surface_, triangle));
  }
  return known_[as_index(number)];
}

void SurfaceCurvature::make_room() {
  known_.reserve(outer_surface_->triangles.size());
  if (on_deformed(*part_))
    shape_ = *outer_surface_;
  else if (of_file_)
    for (std::size_t triangle = 0; triangle < outer_surface_->triangles.size(); ++triangle)
      (void)at_rest(static_cast<int>(triangle));
}

std::optional<std::string> SurfaceCurvature::find(const geometry::SurfacePoint& at, bool& one_sided,
                                                  geometry::Curvature& here) {
  Corners corners;
  if (on_deformed(*part_)) {
    shape_ = *outer_surface_;
    for (std::size_t v = 0; v < shape_.vertices.size(); ++v)
      if (const int node = part_->nodes[v]; node >= 0)
        shape_.vertices[v] += part_->state.displacement.segment<3>(3 * node);
    corners = stars_.at_corners(shape_, at.triangle);
  } else {
    corners = at_rest(at.triangle);
  }
  const geometry::CurvatureEstimate found =
      geometry::between(corners, {at.weights[0], at.weights[1], at.weights[2]});
  if (!found.known())
    return "the surface's curvature at the contact cannot be estimated: " +
           std::string(geometry::explanation(found.status)) + "; use a finer mesh";
  one_sided = one_sided || found.status == geometry::StarStatus::one_sided;
  here = found.curvature;
  return std::nullopt;
}

std::string hollow_text(double kappa_2) {
  return "the tissue is hollow and conforms to the finger (curvature " + rounded_text(kappa_2) +
         " 1/m): Hertz does not hold there; take a smaller `finger.radius`, or press elsewhere "
         "(`finger.x`, `finger.y`)";
}

void clear_corner(Eigen::MatrixXd& matrix, Eigen::Index count) {
  if (matrix.rows() < count) matrix.resize(count, count);
  matrix.topLeftCorner(count, count).setZero();
}

SurfaceContacts::SurfaceContacts(const MovingPart& part)
    : scene_(part.scene),
      part_(&part),
      surface_(&*part.scene->specimen->surface),
      detector_(*surface_),
      spreader_(*surface_),
      spacing_(*surface_),
      curvature_(part) {}

void SurfaceContacts::make_room(Touch& touch) {
  const std::size_t count = most_contacts();
  const std::size_t vertices = surface_->surface().vertices.size();
  const std::size_t nodes = std::min(contact::most_shares, vertices);
  const auto reserve = [&](SphereContact& contact) {
    for (contact::Spread* spread : {&contact.load, &contact.wide}) {
      spread->vertices.reserve(nodes);
      spread->shares.reserve(nodes);
    }
  };
  found_.make_room(count, reserve);
  touch.contacts.make_room(count, reserve);
  detector_.make_room();
  spreader_.make_room();
  curvature_.make_room();
  moved_.reserve(vertices);
  feet_.reserve(count);
  laws_.reserve(count);
  for (std::vector<double>* values : {&approaches_, &depths_, &parts_}) values->reserve(count);
  clear_corner(compliance_, static_cast<Eigen::Index>(count));
}

KeptList<SphereContact>& SurfaceContacts::detect(const Vec3& finger,
                                                 const integrate::Vector* displacement,
                                                 double beyond) {
  moved_.clear();
  if (displacement != nullptr) {
    for (const int node : part_->nodes)
      moved_.push_back(node < 0 ? Vec3(Vec3::Zero()) : Vec3(displacement->segment<3>(3 * node)));
    detector_.refit(moved_);
  }
  const double radius = scene_->finger.sphere_radius;
  const double reach = radius + beyond;
  found_.clear();
  for (std::size_t i = 0; i < scene_->finger.centres.size(); ++i) {
    detector_.find(finger + scene_->finger.centres[i], reach, moved_, feet_);
    for (const auto& closest_point : feet_) {
      SphereContact& contact = found_.add();
      contact.sphere = static_cast<int>(i);
      contact.patch.at = closest_point.at;
      contact.patch.position = closest_point.position;
      contact.patch.normal = closest_point.normal;
      contact.approach = radius - closest_point.height;
      contact.on_crease = closest_point.on_crease;
      contact.patch.beyond = closest_point.beyond;
      contact.patch.turned = closest_point.turned;
    }
  }
  below_middle_.reset();
  if (!presses_as_one(*scene_)) return found_;
  detector_.find(finger, reach + scene_->finger.whole.radius, moved_, feet_);
  const auto nearest = std::ranges::min_element(
      feet_, [](const auto& a, const auto& b) { return a.height < b.height; });
  if (nearest != feet_.end()) {
    below_middle_ = contact::Patch{.at = nearest->at,
                                   .position = nearest->position,
                                   .normal = nearest->normal,
                                   .beyond = nearest->beyond,
                                   .turned = nearest->turned};
  }
  return found_;
}

std::optional<std::string> SurfaceContacts::give_law(SphereContact& contact) {
  geometry::Curvature here;
  if (auto wrong = curvature_.find(contact.patch.at, contact.one_sided, here)) return wrong;
  if (contact.patch.turned > 0.0) {
    // At a crease the curvature changes from one side's to the other's as the perpendicular turns.
    geometry::Curvature there;
    if (auto wrong = curvature_.find(contact.patch.beyond, contact.one_sided, there)) return wrong;
    here = geometry::between({here, there, there},
                             {1.0 - contact.patch.turned, contact.patch.turned, 0.0});
  }
  const auto law = contact::contact_law(
      scene_->scenario.contact.law, {scene_->finger.sphere_radius, scene_->finger.sphere_modulus},
      here, scene_->layer ? &*scene_->layer : nullptr);
  if (!law) return hollow_text(here.kappa_2);
  contact.law = *law;
  if (scene_->depth_ratio) contact.deep = scene_->depth_ratio->value(contact.approach);
  share_layer(*scene_, contact.law);
  // The curvature's axis, projected into the patch's tangent plane.
  Vec3 axis = law->axis - law->axis.dot(contact.patch.normal) * contact.patch.normal;
  contact.patch.axis =
      axis.norm() > 1e-6 ? Vec3(axis.normalized()) : contact.patch.normal.unitOrthogonal();
  return std::nullopt;
}

// Takes depth (first guess), compliance and stretch from the sphere's nearest previous contact.
void SurfaceContacts::carry_on(const Touch& before, SphereContact& contact) const {
  contact.depth = std::max(0.0, contact.approach);
  double nearest = scene_->finger.sphere_radius;
  for (const SphereContact& old : before.contacts) {
    const double distance = (old.patch.position - contact.patch.position).norm();
    if (old.sphere != contact.sphere || distance >= nearest) continue;
    nearest = distance;
    contact.depth = old.depth;
    contact.compliance = old.compliance;
    contact.law.point.part = old.law.point.part;
    contact.stretch = old.stretch;
  }
}

void SurfaceContacts::guess_depth(KeptList<SphereContact>& contacts) {
  if (contacts.size() != 1) return;
  SphereContact& contact = contacts.front();
  const auto depth = contact::penetration(contact.law.point, contact.approach, contact.compliance);
  if (depth && *depth > 0.0) contact.depth = *depth;
}

void SurfaceContacts::shape_patches(KeptList<SphereContact>& contacts) {
  for (SphereContact& contact : contacts) {
    const auto [a, b] = contact.law.semi_axes(contact.depth);
    contact.patch.a = a;
    contact.patch.b = b;
    spreader_.spread(contact.patch, contact.load);
    if (scene_->scenario.contact.spread == scenario::Contact::Spread::nearest_node)
      load_nearest_node(contact);
  }
}

// Loads only the corner with the largest weight of the triangle under the contact.
void SurfaceContacts::load_nearest_node(SphereContact& contact) const {
  const auto& weights = contact.patch.at.weights;
  const auto most = std::ranges::max_element(weights) - weights.begin();
  const auto& corners = surface_->surface().triangles[as_index(contact.patch.at.triangle)];
  contact.load.vertices.assign(1, corners[as_index(most)]);
  contact.load.shares.assign(1, 1.0);
}

// The approach of the sphere, minus the mean displacement under its patch, to the surface at rest.
void SurfaceContacts::approach_moved_surface(const Vec3& finger, SphereContact& contact) const {
  Vec3 mean = Vec3::Zero();
  for (std::size_t k = 0; k < contact.load.vertices.size(); ++k)
    mean += contact.load.shares[k] * moved_[as_index(contact.load.vertices[k])];
  const Vec3 centre = finger + scene_->finger.centres[as_index(contact.sphere)] - mean;
  const auto closest_point = surface_->closest_point(
      centre, {.triangle = contact.patch.at.triangle, .weights = contact.patch.at.weights});
  contact.approach = scene_->finger.sphere_radius - closest_point.height;
}

// Contacts at the same place share its force, without a jump as they come together: `part` is
// 1 / (1 + sum_j (1 - 2 s_ij / max(a_i, a_j))^2).              docs/theory.md, below [contacts]
void SurfaceContacts::share_places(KeptList<SphereContact>& contacts) {
  parts_.assign(contacts.size(), 1.0);
  for (std::size_t i = 0; i < contacts.size(); ++i)
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      if (i == j) continue;
      const double reach = 0.5 * std::max(contacts[i].patch.radius(), contacts[j].patch.radius());
      const double apart = (contacts[i].patch.position - contacts[j].patch.position).norm();
      if (apart >= reach) continue;
      const double overlap = 1.0 - apart / reach;
      parts_[i] += overlap * overlap;
    }
  for (std::size_t i = 0; i < contacts.size(); ++i)
    contacts[i].law.point.part = contacts[i].deep / parts_[i];
}

// The width depends on the finger's position alone. If it depended on the force, loading and
// reading would not be transposes of each other, and the contact could feed energy into the motion.
void SurfaceContacts::spread_wide(SphereContact& contact) {
  const auto axes = contact.law.semi_axes(std::max(0.0, contact.approach));
  spreader_.spread(contact::wide_patch(contact.patch, axes, spacing_.at(contact.patch)),
                   contact.wide);
}

// Sets patches, approaches and first guesses of the depths, and clears the compliance.
void SurfaceContacts::begin_pass(Touch& touch) {
  KeptList<SphereContact>& contacts = touch.contacts;
  shape_patches(contacts);
  share_places(contacts);
  approaches_.clear();
  depths_.clear();
  for (SphereContact& contact : contacts) {
    if (!moved_.empty()) approach_moved_surface(touch.finger, contact);
    approaches_.push_back(contact.approach);
    depths_.push_back(contact.depth);
  }
  clear_corner(compliance_, static_cast<Eigen::Index>(contacts.size()));
}

// Sets depths and forces; `part_of_way` is a share of the change of depth. Returns the largest
// change of a contact radius (m) for the whole change, or nothing without a solution.
std::optional<double> SurfaceContacts::balance(KeptList<SphereContact>& contacts,
                                               const Eigen::MatrixXd& compliance,
                                               double part_of_way) {
  const auto size = static_cast<Eigen::Index>(contacts.size());
  laws_.clear();
  for (const SphereContact& contact : contacts) laws_.push_back(contact.law.point);
  if (!contact::balance(laws_, approaches_, compliance.topLeftCorner(size, size), depths_))
    return std::nullopt;
  double change = 0.0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    SphereContact& contact = contacts[i];
    change = std::max(change, std::abs(contact.law.semi_axes(depths_[i])[0] -
                                       contact.law.semi_axes(contact.depth)[0]));
    if (part_of_way < 1.0) depths_[i] = contact.depth + part_of_way * (depths_[i] - contact.depth);
    contact.depth = depths_[i];
    contact.force = contact.elastic = laws_[i].force(depths_[i]);
    contact.stiffness = laws_[i].stiffness(depths_[i]);
    const auto own = static_cast<Eigen::Index>(i);
    contact.compliance = compliance_(own, own);
  }
  return change;
}

}  // namespace palpate::mechanics
