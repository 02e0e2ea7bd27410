// Detection, laws, patches and the balance of several contacts, in turn.
#include "run/contacts.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "contact/half_space.h"

namespace palpate::run {
namespace {

using contact::Coupling;
using integrate::Vector;

constexpr int most_patches = 100;

geometry::CurvatureOptions curvature_options(const scene::Scene& scene) {
  geometry::CurvatureOptions options;
  options.method = scene.scenario.contact.curvature;
  options.rings = scene.scenario.contact.curvature_rings;
  return options;
}

std::vector<int> nodes_of(const MeshAnswer& mesh, const contact::Spread& spread) {
  std::vector<int> nodes;
  for (const int vertex : spread.vertices)
    nodes.push_back(mesh.nodes[static_cast<std::size_t>(vertex)]);
  return nodes;
}

}  // namespace

const SphereContact* Touch::deepest() const {
  const auto found =
      std::max_element(contacts.begin(), contacts.end(),
                       [](const auto& a, const auto& b) { return a.depth < b.depth; });
  return found == contacts.end() ? nullptr : &*found;
}

double Touch::normal_force() const {
  double sum = 0.0;
  for (const SphereContact& contact : contacts) sum += contact.force * contact.patch.normal.z();
  return sum;
}

double Touch::force() const { return normal_force() - drag().z(); }

Vec3 Touch::drag() const {
  Vec3 sum = Vec3::Zero();
  for (const SphereContact& contact : contacts) sum += contact.drag;
  return sum;
}

double Touch::pressed() const {
  double sum = 0.0;
  for (const SphereContact& contact : contacts) sum += contact.force;
  return sum;
}

Contacts::Contacts(const scene::Scene& scene)
    : scene_(&scene),
      surface_(&*scene.specimen->surface),
      detector_(*surface_),
      spreader_(*surface_),
      rings_(*surface_),
      stars_(surface_->surface(), surface_->neighbours(), curvature_options(scene)),
      shares_(surface_->surface().vertices.size(), 0.0) {}

void Contacts::detect(const Vec3& finger, const MeshAnswer& mesh,
                      std::vector<SphereContact>& found) {
  moving_ = mesh.displacement != nullptr;
  moved_.clear();
  if (moving_) {
    for (const int node : mesh.nodes)
      moved_.push_back(node < 0 ? Vec3(Vec3::Zero())
                                : Vec3(mesh.displacement->segment<3>(3 * node)));
    detector_.refit(moved_);
  }
  const double radius = scene_->finger.sphere_radius;
  found.clear();
  for (std::size_t i = 0; i < scene_->finger.centres.size(); ++i) {
    detector_.find(finger + scene_->finger.centres[i], radius, moved_, feet_);
    for (const auto& foot : feet_) {
      SphereContact contact;
      contact.sphere = static_cast<int>(i);
      contact.patch.at = foot.at;
      contact.patch.position = foot.position;
      contact.patch.normal = foot.normal;
      contact.approach = radius - foot.height;
      contact.on_crease = foot.on_crease;
      found.push_back(std::move(contact));
    }
  }
}

std::optional<std::string> Contacts::give_law(const MeshAnswer& mesh, SphereContact& contact) {
  const int triangle = contact.patch.at.triangle;
  std::array<geometry::CurvatureEstimate, 3> corners;
  const auto estimate = [&](const geometry::Surface& now) {
    for (std::size_t i = 0; i < 3; ++i)
      corners[i] = stars_.at_vertex(
          now, surface_->surface().triangles[static_cast<std::size_t>(triangle)][i], triangle);
  };
  if (mesh.shape != nullptr) {
    geometry::Surface now = surface_->surface();
    for (std::size_t v = 0; v < now.vertices.size(); ++v)
      if (mesh.nodes[v] >= 0) now.vertices[v] += mesh.shape->segment<3>(3 * mesh.nodes[v]);
    estimate(now);
  } else {
    const auto known = known_curvature_.find(triangle);
    if (known != known_curvature_.end()) {
      corners = known->second;
    } else {
      estimate(surface_->surface());
      known_curvature_[triangle] = corners;
    }
  }
  // Corners that tell nothing leave their part to the others.
  std::array<geometry::Curvature, 3> curvatures;
  std::array<double, 3> weights{};
  double sum = 0.0;
  geometry::StarStatus worst = geometry::StarStatus::full;
  const geometry::Curvature* any = nullptr;
  for (std::size_t i = 0; i < 3; ++i) {
    if (corners[i].status != geometry::StarStatus::full) worst = corners[i].status;
    if (corners[i].known()) any = &corners[i].curvature;
  }
  if (any == nullptr)
    return "the skin's curvature at the contact cannot be told: " +
           std::string(geometry::explanation(worst)) + "; use a finer mesh";
  for (std::size_t i = 0; i < 3; ++i) {
    curvatures[i] = corners[i].known() ? corners[i].curvature : *any;
    weights[i] = corners[i].known() ? contact.patch.at.weights[static_cast<Eigen::Index>(i)] : 0.0;
    sum += weights[i];
  }
  if (sum <= 0.0) weights = {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
  else
    for (double& weight : weights) weight /= sum;
  contact.one_sided = worst != geometry::StarStatus::full;
  const geometry::Curvature here = geometry::between(curvatures, weights);
  const auto law = contact::contact_law(
      scene_->scenario.contact.law,
      {scene_->finger.sphere_radius, scene_->finger.sphere_modulus}, here);
  if (!law)
    return "the tissue is hollow and conforms to the finger (curvature " +
           rounded_text(here.kappa_2) + " 1/m): Hertz does not hold there";
  contact.law = *law;
  // The curvature's axis turned into the patch's own tangent plane.
  Vec3 axis = law->axis - law->axis.dot(contact.patch.normal) * contact.patch.normal;
  contact.patch.axis =
      axis.norm() > 1e-6 ? Vec3(axis.normalized()) : contact.patch.normal.unitOrthogonal();
  return std::nullopt;
}

// The same sphere's nearest contact of the moment before: its depth is the first guess.
void Contacts::carry_on(const Touch& before, SphereContact& contact) const {
  contact.depth = std::max(0.0, contact.approach);
  double nearest = scene_->finger.sphere_radius;
  for (const SphereContact& old : before.contacts) {
    const double distance = (old.patch.position - contact.patch.position).norm();
    if (old.sphere != contact.sphere || distance >= nearest) continue;
    nearest = distance;
    contact.depth = old.depth;
    contact.stretch = old.stretch;
  }
}

void Contacts::shape_patches(std::vector<SphereContact>& contacts) {
  for (SphereContact& contact : contacts) {
    const double root = std::sqrt(std::max(0.0, contact.depth));
    contact.patch.a = contact.law.a * root;
    contact.patch.b = contact.law.b * root;
    spreader_.spread(contact.patch, contact.load);
  }
}

// The sphere carried back by the mean displacement under its patch, against the skin at rest.
void Contacts::approach_moving_skin(const Vec3& finger, SphereContact& contact) {
  Vec3 mean = Vec3::Zero();
  for (std::size_t k = 0; k < contact.load.vertices.size(); ++k)
    mean += contact.load.shares[k] * moved_[static_cast<std::size_t>(contact.load.vertices[k])];
  const Vec3 centre =
      finger + scene_->finger.centres[static_cast<std::size_t>(contact.sphere)] - mean;
  const auto foot = surface_->foot(
      centre, {.triangle = contact.patch.at.triangle, .weights = contact.patch.at.weights});
  contact.approach = scene_->finger.sphere_radius - foot.height;
}

// Where `consistent` reads the mesh for a contact: around its own patch; spheres that are calibrated
// to press as one are read as that one, around the patch which it would have.
contact::Patch Contacts::read_patch(const std::vector<SphereContact>& contacts,
                                    const SphereContact& own) const {
  if (!presses_as_one() || contacts.size() == 1) return own.patch;
  contact::Patch joint = own.patch;
  joint.position.setZero();
  joint.normal.setZero();
  double sum = 0.0;
  double widest = 0.0;
  for (const SphereContact& contact : contacts) {
    const double weight = std::max(contact.depth, 1e-9 * scene_->finger.sphere_radius);
    sum += weight;
    joint.position += weight * contact.patch.position;
    joint.normal += weight * contact.patch.normal;
    if (contact.patch.radius() < widest) continue;
    widest = contact.patch.radius();
    joint.at = contact.patch.at;
  }
  joint.position /= sum;
  joint.normal.normalize();
  // a^2 = R h, and R is n^(1/3) times a sphere's radius.
  joint.a = joint.b =
      widest * std::pow(static_cast<double>(scene_->finger.centres.size()), 1.0 / 6.0);
  return joint;
}

bool Contacts::presses_as_one() const {
  return scene_->finger.centres.size() > 1 &&
         scene_->scenario.finger.calibration == finger::Calibration::force;
}

// How far the skin at each contact gives way to a newton on each.          docs/theory.md (44)
void Contacts::find_compliance(const MeshAnswer& mesh,
                               const std::vector<SphereContact>& contacts) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  compliance_.setZero(count, count);
  if (mesh.influence == nullptr) return;
  const bool consistent = scene_->scenario.contact.coupling == Coupling::consistent;
  if (consistent)
    for (const SphereContact& contact : contacts)
      for (std::size_t k = 0; k < contact.load.vertices.size(); ++k) {
        double& share = shares_[static_cast<std::size_t>(contact.load.vertices[k])];
        share = std::max(share, contact.load.shares[k]);
      }
  contact::Reading reading;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (i > 0 && consistent && presses_as_one()) {
      compliance_.row(i) = compliance_.row(0);
      continue;
    }
    const SphereContact& own = contacts[static_cast<std::size_t>(i)];
    const contact::Patch patch = read_patch(contacts, own);
    if (consistent) {
      rings_.read(patch, shares_, reading);
    } else {
      reading.vertices = own.load.vertices;
      reading.weights = own.load.shares;
    }
    for (Eigen::Index j = 0; j < count; ++j) {
      const SphereContact& pressed = contacts[static_cast<std::size_t>(j)];
      compliance_(i, j) = sinking(mesh, patch, reading, pressed);
      if (i != j && !presses_as_one()) compliance_(i, j) += unknown_to_hertz(patch, pressed);
    }
  }
  if (consistent)
    for (const SphereContact& contact : contacts)
      for (const int vertex : contact.load.vertices) shares_[static_cast<std::size_t>(vertex)] = 0.0;
}

// What a reading says of the sinking under a patch per newton on a contact, m/N; with `consistent`
// less what a half-space would sink there under the same loads.
double Contacts::sinking(const MeshAnswer& mesh, const contact::Patch& patch,
                         const contact::Reading& reading, const SphereContact& pressed) const {
  const bool consistent = scene_->scenario.contact.coupling == Coupling::consistent;
  const double aligned = patch.normal.dot(pressed.patch.normal);
  const double spacing = rings_.spacing(patch);
  const std::vector<int> nodes = nodes_of(mesh, pressed.load);
  double sum = 0.0;
  for (std::size_t a = 0; a < reading.vertices.size(); ++a) {
    const int vertex = reading.vertices[a];
    double moved = mesh.influence->between(
        -patch.normal, mesh.nodes[static_cast<std::size_t>(vertex)], -pressed.patch.normal, nodes,
        pressed.load.shares, mesh.freedoms);
    if (consistent)
      moved -= aligned * rings_.half_space(vertex, pressed.load, plane_modulus(), spacing);
    sum += reading.weights[a] * moved;
  }
  return sum;
}

// What another contact makes the half-space sink under a patch, per newton: Hertz's law of a
// single contact does not know it.
double Contacts::unknown_to_hertz(const contact::Patch& patch, const SphereContact& other) const {
  if (scene_->scenario.contact.coupling != Coupling::consistent) return 0.0;
  return patch.normal.dot(other.patch.normal) *
         contact::half_space_sinking((patch.position - other.patch.position).norm(), 1.0,
                                     other.patch.radius(), plane_modulus());
}

double Contacts::plane_modulus() const {
  const tissue::Uniaxial& measured = scene_->specimen->measured;
  return measured.young_modulus / (1.0 - measured.poisson_ratio * measured.poisson_ratio);
}

// Contacts at one place press it once: each gets its part, without a jump as they come together.
void Contacts::share_places(std::vector<SphereContact>& contacts) {
  std::vector<double> parts(contacts.size(), 1.0);
  for (std::size_t i = 0; i < contacts.size(); ++i)
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      if (i == j) continue;
      const double reach =
          0.5 * std::max(contacts[i].patch.radius(), contacts[j].patch.radius());
      const double apart = (contacts[i].patch.position - contacts[j].patch.position).norm();
      if (apart >= reach) continue;
      const double overlap = 1.0 - apart / reach;
      parts[i] += overlap * overlap;
    }
  for (std::size_t i = 0; i < contacts.size(); ++i)
    contacts[i].law.point.coefficient /= parts[i];
}

std::optional<std::string> Contacts::settle(const MeshAnswer& mesh, Touch& touch) {
  std::vector<SphereContact>& contacts = touch.contacts;
  const std::size_t count = contacts.size();
  std::vector<contact::PointLaw> laws(count);
  std::vector<double> coefficients(count);
  for (std::size_t i = 0; i < count; ++i) coefficients[i] = contacts[i].law.point.coefficient;
  std::vector<double> approaches(count);
  std::vector<double> depths(count);
  const double settled = 1e-12 * scene_->finger.sphere_radius;
  // Explicit steps read the mesh once, over the patch of the step before.
  const int passes = moving_ && mesh.influence == nullptr ? 1 : most_patches;
  for (int pass = 0; pass < passes; ++pass) {
    shape_patches(contacts);
    for (std::size_t i = 0; i < count; ++i) contacts[i].law.point.coefficient = coefficients[i];
    share_places(contacts);
    for (std::size_t i = 0; i < count; ++i) {
      if (moving_) approach_moving_skin(touch.finger, contacts[i]);
      laws[i] = contacts[i].law.point;
      approaches[i] = contacts[i].approach;
      depths[i] = contacts[i].depth;
    }
    find_compliance(mesh, contacts);
    if (!contact::balance(laws, approaches, compliance_, depths))
      return "no penetration balances the contact: the layer is too thin for this coupling";
    double change = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      change = std::max(change, contacts[i].law.a * std::abs(std::sqrt(depths[i]) -
                                                             std::sqrt(std::max(
                                                                 0.0, contacts[i].depth))));
      contacts[i].depth = depths[i];
      contacts[i].force = laws[i].force(depths[i]);
    }
    if (change <= settled || passes == 1) return std::nullopt;
  }
  return "the contact radius did not settle in 100 iterations";
}

void rub(const scene::Scene& scene, const Vec3& move, Touch& touch) {
  const double friction = scene.scenario.contact.friction;
  for (SphereContact& contact : touch.contacts) {
    contact.drag.setZero();
    const double limit = friction * contact.force;
    if (!(limit > 0.0)) {
      contact.stretch.setZero();
      continue;
    }
    const Vec3& normal = contact.patch.normal;
    contact.stretch += move;
    contact.stretch -= contact.stretch.dot(normal) * normal;
    // The stretch at which the whole patch slips: 3 mu F q / (16 a).
    const double most =
        3.0 * limit * scene.finger.shear_compliance / (16.0 * contact.patch.radius());
    const double stretch = contact.stretch.norm();
    if (stretch <= 0.0) continue;
    const Vec3 direction = contact.stretch / stretch;
    if (stretch > most) contact.stretch = most * direction;
    // Q = mu F [1 - (1 - stretch / most)^(3/2)]
    const double left = std::max(0.0, 1.0 - stretch / most);
    contact.drag = limit * (1.0 - left * std::sqrt(left)) * direction;
  }
}

std::optional<std::string> Contacts::find(const Vec3& finger, const MeshAnswer& mesh,
                                          Touch& touch) {
  std::vector<SphereContact> found;
  detect(finger, mesh, found);
  for (SphereContact& contact : found) {
    if (auto wrong = give_law(mesh, contact)) return wrong;
    carry_on(touch, contact);
  }
  const Vec3 move = finger - touch.finger;
  touch.finger = finger;
  touch.contacts = std::move(found);
  if (auto wrong = settle(mesh, touch)) return wrong;
  std::erase_if(touch.contacts, [](const SphereContact& contact) { return contact.depth <= 0.0; });
  shape_patches(touch.contacts);
  rub(*scene_, move, touch);
  return std::nullopt;
}

Vector Contacts::load(const Touch& touch, const MeshAnswer& mesh) {
  Vector load = Vector::Zero(mesh.freedoms);
  for (const SphereContact& contact : touch.contacts) {
    const Vec3 push = contact.drag - contact.force * contact.patch.normal;
    for (std::size_t k = 0; k < contact.load.vertices.size(); ++k) {
      const int node = mesh.nodes[static_cast<std::size_t>(contact.load.vertices[k])];
      if (node >= 0) load.segment<3>(3 * node) += contact.load.shares[k] * push;
    }
  }
  return load;
}

}  // namespace palpate::run
