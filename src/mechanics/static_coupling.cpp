// The compliances C_ij of `consistent`, docs/theory.md (15), and steps under known forces.
#include "mechanics/couplings.h"

#include <algorithm>
#include <cmath>

#include "contact/half_space.h"
#include "contact/hertz.h"

namespace palpate::mechanics {
namespace {

using integrate::Vector;

// The radius of the contact divided by the square root of its depth, sqrt(m).
double radius_per_root(const contact::ContactLaw& law) {
  const contact::LayerContact* layer = law.point.layer;
  return layer != nullptr ? law.radius_share * std::sqrt(layer->radius) : std::sqrt(law.a * law.b);
}

// How far from its first touch the programme lets the finger press, with room for a hand that does
// not follow it closely, m.
double farthest_reach(const scene::Scene& scene) {
  double path = 4.0 * contact::hertz::contact_radius(
                          scene::deepest_travel(scene.scenario, scene.law()), scene.law().radius);
  path += scene.law().radius;
  for (const scenario::Step& step : scene.scenario.steps)
    if (const auto* slide = std::get_if<scenario::Slide>(&step)) path += std::abs(slide->by);
  return path;
}

}  // namespace

std::optional<std::string> OneWay::find(const Vec3& finger, Touch& touch) {
  skin->detect(finger, nullptr);
  return skin->find(finger, touch, [this](Touch& now) {
    SkinContacts::guess_depth(now.contacts);
    return skin->settle(
        now, [](auto&, auto& compliance) -> auto& { return compliance; });
  });
}

std::optional<std::string> OneWay::step(const StepTo& to) {
  if (auto wrong = find(to.finger, to.touch)) return wrong;
  to.history.pass(*part->scene, to.duration, to.touch);
  return part->move(to.touch);
}

void Consistent::begin_part(const std::vector<Eigen::Index>& /*from*/) {
  const scene::Scene& scene = *part->scene;
  beyond_.emplace(scene, part->part, part->body->held(),
                  scene::deepest_travel(scene.scenario, scene.law()));
  finer_.resize(0);
}

void Consistent::make_ready() { beyond_->make_ready(farthest_reach(*part->scene)); }

std::optional<std::string> Consistent::find(const Vec3& finger, Touch& touch) {
  skin->detect(finger, nullptr);
  return skin->find(
      finger, touch,
      [this](Touch& now) {
        // Steps in modes alone are frames in which every loaded node costs time.
        if (!part->in_modes)
          for (SphereContact& contact : now.contacts) skin->spread_wide(contact);
        SkinContacts::guess_depth(now.contacts);
        return skin->settle(
            now, [&](auto&, Eigen::MatrixXd& compliance) -> auto& {
              find_sinking(now.contacts, compliance);
              return compliance;
            });
      },
      body());
}

std::optional<std::string> Consistent::step(const StepTo& to) {
  if (auto wrong = find(to.finger, to.touch)) return wrong;
  to.history.pass(*part->scene, to.duration, to.touch);
  if (!part->in_modes) load_finely(to.touch);
  return part->move(to.touch);
}

// Of the single sphere that spheres with `calibration = "force"` replace: its patch is `joint`, and
// it lies at all their contacts, in proportion to how far they are below the skin.
BodySinking::Value Consistent::joint_sinking(const KeptList<SphereContact>& contacts,
                                             contact::Patch& joint) {
  double approaches = 0.0;
  for (const SphereContact& contact : contacts) {
    approaches += std::max(0.0, contact.approach);
    if (contact.patch.radius() > joint.radius()) joint = contact.patch;
  }
  // a^2 = R h, and R is n^(1/3) times a sphere's radius.
  const double wider = std::pow(static_cast<double>(part->scene->finger.centres.size()), 1.0 / 6.0);
  joint.a *= wider;
  joint.b *= wider;
  BodySinking::Value sum;
  if (!(approaches > 0.0)) return sum;
  for (const SphereContact& contact : contacts) {
    if (contact.approach <= 0.0) continue;
    contact::Patch here = contact.patch;
    here.a = joint.a;
    here.b = joint.b;
    const BodySinking::Value own = beyond_->at(here);
    const double weight = contact.approach / approaches;
    sum.sinking += weight * own.sinking;
    sum.slope += weight * own.slope;
    sum.error += weight * own.error;
    sum.doubt += weight * own.doubt;
  }
  return sum;
}

// The contact radius a is the one that stores the most energy, docs/theory.md (13):
//   F = F_Hertz(a) / (1 - (5/3) E* a^2 s'(a)),   travel = a^2 / R + (s + a s') F.
// Both take the form of the contact equations: the law times a factor, and a compliance.
void Consistent::find_sinking(KeptList<SphereContact>& contacts, Eigen::MatrixXd& compliance) {
  constexpr double most_stiffening = 0.8;
  const auto count = static_cast<Eigen::Index>(contacts.size());
  const bool as_one = presses_as_one(*part->scene);
  const auto& tissue = part->scene->scenario.tissue;
  const double plane_modulus =
      tissue.young_modulus / (1.0 - tissue.poisson_ratio * tissue.poisson_ratio);
  contact::Patch joint;
  BodySinking::Value of_all;
  if (as_one) of_all = joint_sinking(contacts, joint);
  for (Eigen::Index i = 0; i < count; ++i) {
    SphereContact& own = contacts[as_index(i)];
    const BodySinking::Value value = as_one ? of_all : beyond_->at(own.patch);
    const double radius = (as_one ? joint : own.patch).radius();
    // F_Hertz = 4/3 E* a h, for an ellipse with a modulus that makes this so. A layer's law knows
    // its own contact radius.
    const double modulus = as_one ? part->scene->finger.whole.modulus
                                  : 0.75 * own.law.point.coefficient / radius_per_root(own.law);
    const double stiffening =
        std::min(most_stiffening, 5.0 / 3.0 * modulus * radius * radius * value.slope);
    // The mesh is linear: it sinks by the force without the factor of a deep press.
    own.sinking_error = value.error / own.deep;
    own.sinking_doubt = value.doubt / own.deep;
    double sinking = value.sinking / own.deep;
    if (own.law.point.layer == nullptr) {
      own.law.point.part /= 1.0 - stiffening;
      sinking += radius * value.slope / own.deep;
    }
    if (as_one) {
      compliance.row(i).head(count).setConstant(sinking);
      continue;
    }
    compliance(i, i) = sinking;
    // Half the sum over both directions, because the rest is read at points.
    for (Eigen::Index j = 0; j < count; ++j) {
      if (i == j) continue;
      const SphereContact& other = contacts[as_index(j)];
      const double between =
          own.patch.normal.dot(other.patch.normal) *
              contact::half_space_sinking((own.patch.position - other.patch.position).norm(), 1.0,
                                          other.patch.radius(), plane_modulus) +
          beyond_->rest(own.patch.normal, own.load, part->nodes, other.patch);
      compliance(i, j) += 0.5 * between / other.deep;
      compliance(j, i) += 0.5 * between / own.deep;
    }
  }
}

std::vector<double> Consistent::errors(const SphereContact& contact) {
  contact::Patch patch = contact.patch;
  patch.a = patch.b = patch.radius();
  return beyond_->errors(patch);
}

Vector Consistent::displacement() {
  if (finer_.size() == 0) return part->state.displacement;
  Vector further;
  part->respond(Response::statics, finer_, further);
  return part->state.displacement + further;
}

}  // namespace palpate::mechanics
