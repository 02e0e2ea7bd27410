// Detection of contacts, their laws and patches, and the solution of the contact equations.
#include "mechanics/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "mechanics/resolved_contact.h"

namespace palpate::mechanics {
namespace {

using integrate::Vector;

constexpr int most_patches = 100;

geometry::CurvatureOptions curvature_options(const scene::Scene& scene) {
  geometry::CurvatureOptions options;
  options.method = scene.scenario.contact.curvature;
  options.rings = scene.scenario.contact.curvature_rings;
  return options;
}

}  // namespace

Contacts::Contacts(const scene::Scene& scene)
    : scene_(&scene),
      surface_(&*scene.specimen->surface),
      detector_(*surface_),
      spreader_(*surface_),
      spacing_(*surface_),
      stars_(surface_->surface(), surface_->neighbours(), curvature_options(scene)),
      curvature_of_(surface_->surface().triangles.size(), -1) {
  if (scene.scenario.contact.coupling == contact::Coupling::resolved)
    resolved_ = std::make_unique<ResolvedContact>(scene);
  radiation_ = scene::radiation_compliance(scene);
}

Contacts::~Contacts() = default;

std::string hollow_text(double kappa_2) {
  return "the tissue is hollow and conforms to the finger (curvature " + rounded_text(kappa_2) +
         " 1/m): Hertz does not hold there";
}

void clear_corner(Eigen::MatrixXd& matrix, Eigen::Index count) {
  if (matrix.rows() < count) matrix.resize(count, count);
  matrix.topLeftCorner(count, count).setZero();
}

void Contacts::make_room(Touch& touch) {
  constexpr std::size_t contacts_a_sphere = 4;  // a finger over folds and edges
  const geometry::Surface& skin = surface_->surface();
  const std::size_t count = contacts_a_sphere * scene_->finger.centres.size();
  const std::size_t nodes = std::min(contact::most_shares, skin.vertices.size());
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
  moved_.reserve(skin.vertices.size());
  feet_.reserve(count);
  laws_.reserve(count);
  known_curvature_.reserve(skin.triangles.size());
  if (scene_->scenario.contact.curvature_on == scenario::Contact::CurvatureOn::deformed)
    shape_ = skin;
  for (std::vector<double>* values : {&approaches_, &depths_, &parts_}) values->reserve(count);
  const auto size = static_cast<Eigen::Index>(count);
  for (Eigen::MatrixXd* matrix :
       {&compliance_, &whole_compliance_, &moving_by_force_, &still_by_force_})
    clear_corner(*matrix, size);
  for (Eigen::VectorXd* vector : {&softness_, &motion_}) vector->setZero(size);
  near_.reserve(count);
  past_.reserve(2 * count);
  parted_.reserve(count);
}

void Contacts::detect(const Vec3& finger, const MeshAnswer& mesh, KeptList<SphereContact>& found) {
  moving_ = mesh.displacement != nullptr;
  moved_.clear();
  if (moving_) {
    for (const int node : mesh.nodes)
      moved_.push_back(node < 0 ? Vec3(Vec3::Zero())
                                : Vec3(mesh.displacement->segment<3>(3 * node)));
    detector_.refit(moved_);
  }
  const double radius = scene_->finger.sphere_radius;
  // Oscillating skin may reach a finger that does not touch it at rest.
  const double reach = radius + rise(mesh);
  found.clear();
  for (std::size_t i = 0; i < scene_->finger.centres.size(); ++i) {
    detector_.find(finger + scene_->finger.centres[i], reach, moved_, feet_);
    for (const auto& foot : feet_) {
      SphereContact& contact = found.add();
      contact.sphere = static_cast<int>(i);
      contact.patch.at = foot.at;
      contact.patch.position = foot.position;
      contact.patch.normal = foot.normal;
      contact.approach = radius - foot.height;
      contact.on_crease = foot.on_crease;
      contact.patch.beyond = foot.beyond;
      contact.patch.turned = foot.turned;
    }
  }
}

std::optional<std::string> Contacts::find_curvature(const MeshAnswer& mesh,
                                                    const geometry::SurfacePoint& at,
                                                    SphereContact& contact,
                                                    geometry::Curvature& here) {
  std::array<geometry::CurvatureEstimate, 3> corners;
  if (mesh.shape != nullptr) {
    shape_ = surface_->surface();
    for (std::size_t v = 0; v < shape_.vertices.size(); ++v)
      if (mesh.nodes[v] >= 0) shape_.vertices[v] += mesh.shape->segment<3>(3 * mesh.nodes[v]);
    corners = stars_.at_corners(shape_, at.triangle);
  } else {
    int& known = curvature_of_[as_index(at.triangle)];
    if (known < 0) {
      known = static_cast<int>(known_curvature_.size());
      known_curvature_.push_back(stars_.at_corners(surface_->surface(), at.triangle));
    }
    corners = known_curvature_[as_index(known)];
  }
  const geometry::CurvatureEstimate found =
      geometry::between(corners, {at.weights[0], at.weights[1], at.weights[2]});
  if (!found.known())
    return "the skin's curvature at the contact cannot be estimated: " +
           std::string(geometry::explanation(found.status)) + "; use a finer mesh";
  contact.one_sided = contact.one_sided || found.status == geometry::StarStatus::one_sided;
  here = found.curvature;
  return std::nullopt;
}

std::optional<std::string> Contacts::give_law(const MeshAnswer& mesh, SphereContact& contact) {
  geometry::Curvature here;
  if (auto wrong = find_curvature(mesh, contact.patch.at, contact, here)) return wrong;
  if (contact.patch.turned > 0.0) {
    // At a crease the curvature changes from one side's to the other's as the perpendicular turns.
    geometry::Curvature there;
    if (auto wrong = find_curvature(mesh, contact.patch.beyond, contact, there)) return wrong;
    here = geometry::between({here, there, there},
                             {1.0 - contact.patch.turned, contact.patch.turned, 0.0});
  }
  const auto law = contact::contact_law(
      scene_->scenario.contact.law, {scene_->finger.sphere_radius, scene_->finger.sphere_modulus},
      here, scene_->layer ? &*scene_->layer : nullptr);
  if (!law) return hollow_text(here.kappa_2);
  contact.law = *law;
  if (contact.law.point.layer != nullptr && presses_as_one()) {
    // The law of the single sphere that these spheres represent; a^2 = R h with its R, which is
    // n^(1/3) times the radius of a sphere.
    const auto count = static_cast<double>(scene_->finger.centres.size());
    contact.law.point.share = 1.0 / count;
    contact.law.radius_share = std::pow(count, -1.0 / 6.0);
  }
  // The curvature's axis, projected into the patch's tangent plane.
  Vec3 axis = law->axis - law->axis.dot(contact.patch.normal) * contact.patch.normal;
  contact.patch.axis =
      axis.norm() > 1e-6 ? Vec3(axis.normalized()) : contact.patch.normal.unitOrthogonal();
  return std::nullopt;
}

// Takes depth (first guess), compliance and stretch from the sphere's nearest previous contact.
void Contacts::carry_on(const Touch& before, SphereContact& contact) const {
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

// First guess for a single contact, with the compliance of the previous step.
void Contacts::guess_depth(SphereContact& contact) const {
  const auto depth = contact::penetration(contact.law.point, contact.approach, contact.compliance);
  if (depth && *depth > 0.0) contact.depth = *depth;
}

void Contacts::shape_patches(KeptList<SphereContact>& contacts) {
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
void Contacts::load_nearest_node(SphereContact& contact) const {
  const auto& weights = contact.patch.at.weights;
  const auto most = std::max_element(weights.begin(), weights.end()) - weights.begin();
  const auto& corners = surface_->surface().triangles[as_index(contact.patch.at.triangle)];
  contact.load.vertices.assign(1, corners[as_index(most)]);
  contact.load.shares.assign(1, 1.0);
}

// The approach of the sphere, minus the mean displacement under its patch, to the skin at rest.
void Contacts::approach_moving_skin(const Vec3& finger, SphereContact& contact) {
  Vec3 mean = Vec3::Zero();
  for (std::size_t k = 0; k < contact.load.vertices.size(); ++k)
    mean += contact.load.shares[k] * moved_[as_index(contact.load.vertices[k])];
  const Vec3 centre = finger + scene_->finger.centres[as_index(contact.sphere)] - mean;
  const auto foot = surface_->foot(
      centre, {.triangle = contact.patch.at.triangle, .weights = contact.patch.at.weights});
  contact.approach = scene_->finger.sphere_radius - foot.height;
}

// Contacts at the same place share its force, without a jump as they come together: `part` is
// 1 / (1 + sum_j (1 - 2 s_ij / max(a_i, a_j))^2).                    docs/theory.md, below (15)
void Contacts::share_places(KeptList<SphereContact>& contacts) {
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
  for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i].law.point.part = 1.0 / parts_[i];
}

std::optional<std::string> Contacts::settle(const MeshAnswer& mesh, Touch& touch) {
  KeptList<SphereContact>& contacts = touch.contacts;
  const std::size_t count = contacts.size();
  laws_.resize(count);
  approaches_.resize(count);
  depths_.resize(count);
  const double settled = 1e-12 * scene_->finger.sphere_radius;
  if (count == 1 && !moving_ && mesh.moving == nullptr) guess_depth(contacts.front());
  if (mesh.moving != nullptr) find_motion(mesh, contacts);
  // Explicit steps read the mesh once, over the patch of the previous step.
  const int passes = moving_ && mesh.influence == nullptr ? 1 : most_patches;
  // Each pass takes this part of the way to the depths for the radii of the pass before: less after
  // a pass that did not come nearer.
  double part_of_way = 1.0;
  double change_before = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < passes; ++pass) {
    shape_patches(contacts);
    share_places(contacts);
    for (std::size_t i = 0; i < count; ++i) {
      if (moving_) approach_moving_skin(touch.finger, contacts[i]);
      approaches_[i] = contacts[i].approach;
      depths_[i] = contacts[i].depth;
    }
    find_compliance(mesh, contacts);
    for (std::size_t i = 0; i < count; ++i) laws_[i] = contacts[i].law.point;
    if (mesh.moving != nullptr) add_motion(*mesh.moving, contacts, approaches_);
    const Eigen::MatrixXd& all = mesh.moving != nullptr ? whole_compliance_ : compliance_;
    const auto size = static_cast<Eigen::Index>(count);
    if (!contact::balance(laws_, approaches_, all.topLeftCorner(size, size), depths_))
      return "no penetration balances the contact: the layer is too thin for this depth";
    double change = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      change = std::max(change, std::abs(contacts[i].law.semi_axes(depths_[i])[0] -
                                         contacts[i].law.semi_axes(contacts[i].depth)[0]));
      if (part_of_way < 1.0)
        depths_[i] = contacts[i].depth + part_of_way * (depths_[i] - contacts[i].depth);
      contacts[i].depth = depths_[i];
      contacts[i].force = contacts[i].elastic = laws_[i].force(depths_[i]);
      contacts[i].stiffness = laws_[i].stiffness(depths_[i]);
      contacts[i].compliance =
          compliance_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i));
    }
    if (change <= settled) return std::nullopt;
    if (change > 0.7 * change_before) part_of_way *= 0.6;
    change_before = change;
  }
  if (passes == 1) {
    shape_patches(contacts);
    return std::nullopt;
  }
  return "the contact radius did not settle in 100 iterations";
}

std::optional<std::string> Contacts::find(const Vec3& finger, const MeshAnswer& mesh,
                                          Touch& touch) {
  if (resolved_) return resolved_->find(finger, mesh, touch);
  detect(finger, mesh, found_);
  if (mesh.moving != nullptr) leave_apart(mesh, found_);
  for (SphereContact& contact : found_) {
    if (auto wrong = give_law(mesh, contact)) return wrong;
    carry_on(touch, contact);
    if (mesh.wide) spread_wide(contact);
  }
  const Vec3 move = finger - touch.finger;
  touch.finger = finger;
  touch.contacts.swap(found_);
  if (auto wrong = settle(mesh, touch)) return wrong;
  if (mesh.moving != nullptr) {
    while (release(*mesh.moving, touch.contacts))
      if (auto wrong = settle(mesh, touch)) return wrong;
    remember(*mesh.moving, touch.contacts);
  }
  touch.contacts.erase_if([](const SphereContact& contact) { return contact.depth <= 0.0; });
  rub(*scene_, move, touch, mesh.beyond);
  return std::nullopt;
}

Vector Contacts::load(const Touch& touch, const MeshAnswer& mesh) {
  Vector sum;
  load(touch, mesh, sum);
  return sum;
}

void Contacts::load(const Touch& touch, const MeshAnswer& mesh, Vector& load) {
  load.setZero(mesh.freedoms);
  push(touch, mesh, [&](int node, const Vec3& force) { load.segment<3>(3 * node) += force; });
}

}  // namespace palpate::mechanics
