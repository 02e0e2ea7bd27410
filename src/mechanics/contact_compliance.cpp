// The compliances C_ij of the coupled contact equations, docs/theory.md (15).
#include <algorithm>
#include <cmath>

#include "contact/half_space.h"
#include "mechanics/body_sinking.h"
#include "mechanics/contacts.h"

namespace palpate::mechanics {
namespace {

using contact::Coupling;

// The radius of the contact divided by the square root of its depth, sqrt(m).
double radius_per_root(const contact::ContactLaw& law) {
  const contact::LayerContact* layer = law.point.layer;
  return layer != nullptr ? law.radius_share * std::sqrt(layer->radius) : std::sqrt(law.a * law.b);
}

}  // namespace

bool Contacts::presses_as_one() const {
  return scene_->finger.centres.size() > 1 &&
         scene_->scenario.finger.calibration == finger::Calibration::force;
}

// Fills compliance_ (m/N).                                                 docs/theory.md (15)
void Contacts::find_compliance(const MeshAnswer& mesh, KeptList<SphereContact>& contacts) {
  clear_corner(compliance_, static_cast<Eigen::Index>(contacts.size()));
  if (scene_->scenario.contact.coupling == Coupling::consistent) {
    if (mesh.beyond != nullptr) find_body_sinking(mesh, contacts);
  } else if (mesh.influence != nullptr) {
    find_mesh_sinking(mesh, contacts);
  }
}

// Of the single sphere that spheres with `calibration = "force"` replace: its patch is `joint`, and
// it lies at all their contacts, in proportion to how far they are below the skin.
BodySinking::Value Contacts::joint_sinking(const MeshAnswer& mesh,
                                           const KeptList<SphereContact>& contacts,
                                           contact::Patch& joint) const {
  double approaches = 0.0;
  for (const SphereContact& contact : contacts) {
    approaches += std::max(0.0, contact.approach);
    if (contact.patch.radius() > joint.radius()) joint = contact.patch;
  }
  // a^2 = R h, and R is n^(1/3) times a sphere's radius.
  const double wider = std::pow(static_cast<double>(scene_->finger.centres.size()), 1.0 / 6.0);
  joint.a *= wider;
  joint.b *= wider;
  BodySinking::Value sum;
  if (!(approaches > 0.0)) return sum;
  for (const SphereContact& contact : contacts) {
    if (contact.approach <= 0.0) continue;
    contact::Patch here = contact.patch;
    here.a = joint.a;
    here.b = joint.b;
    const BodySinking::Value own = mesh.beyond->at(here);
    const double weight = contact.approach / approaches;
    sum.sinking += weight * own.sinking;
    sum.slope += weight * own.slope;
    sum.error += weight * own.error;
    sum.boundary += weight * own.boundary;
  }
  return sum;
}

// The contact radius a is the one that stores the most energy, docs/theory.md (13):
//   F = F_Hertz(a) / (1 - (5/3) E* a^2 s'(a)),   travel = a^2 / R + (s + a s') F.
// Both take the form of the contact equations: the law times a factor, and a compliance.
void Contacts::find_body_sinking(const MeshAnswer& mesh, KeptList<SphereContact>& contacts) {
  constexpr double most_stiffening = 0.8;
  const auto count = static_cast<Eigen::Index>(contacts.size());
  const bool as_one = presses_as_one();
  contact::Patch joint;
  BodySinking::Value of_all;
  if (as_one) of_all = joint_sinking(mesh, contacts, joint);
  for (Eigen::Index i = 0; i < count; ++i) {
    SphereContact& own = contacts[as_index(i)];
    const BodySinking::Value value = as_one ? of_all : mesh.beyond->at(own.patch);
    const double radius = (as_one ? joint : own.patch).radius();
    // F_Hertz = 4/3 E* a h, for an ellipse with a modulus that makes this so. A layer's law knows
    // its own contact radius.
    const double modulus = as_one ? scene_->finger.whole.modulus
                                  : 0.75 * own.law.point.coefficient / radius_per_root(own.law);
    const double stiffening =
        std::min(most_stiffening, 5.0 / 3.0 * modulus * radius * radius * value.slope);
    own.sinking_error = value.error;
    own.sinking_doubt = value.boundary;
    double sinking = value.sinking;
    if (own.law.point.layer == nullptr) {
      own.law.point.part /= 1.0 - stiffening;
      sinking += radius * value.slope;
    }
    if (as_one) {
      compliance_.row(i).head(count).setConstant(sinking);
      continue;
    }
    compliance_(i, i) = sinking;
    // Half the sum over both directions, because the rest is read at points.
    for (Eigen::Index j = 0; j < count; ++j) {
      if (i == j) continue;
      const SphereContact& other = contacts[as_index(j)];
      const double between =
          own.patch.normal.dot(other.patch.normal) *
              contact::half_space_sinking((own.patch.position - other.patch.position).norm(), 1.0,
                                          other.patch.radius(), plane_modulus()) +
          mesh.beyond->rest(own.patch.normal, own.load, mesh.nodes, other.patch);
      compliance_(i, j) += 0.5 * between;
      compliance_(j, i) += 0.5 * between;
    }
  }
}

// The sinking of the mesh under each contact per newton on each other, m/N.
void Contacts::find_mesh_sinking(const MeshAnswer& mesh, const KeptList<SphereContact>& contacts) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      const SphereContact& own = contacts[as_index(i)];
      const SphereContact& pressed = contacts[as_index(j)];
      PairTable& kept = mesh.influence->kept;
      kept.look(own.patch.normal, pressed.patch.normal);
      double sum = 0.0;
      for (std::size_t k = 0; k < own.load.vertices.size(); ++k) {
        const int vertex = own.load.vertices[k];
        double moved = 0.0;
        for (std::size_t l = 0; l < pressed.load.vertices.size(); ++l) {
          const int loaded = pressed.load.vertices[l];
          moved += pressed.load.shares[l] * kept.at(vertex, loaded, [&] {
            return mesh.influence->block(mesh.node_of(vertex), mesh.node_of(loaded), mesh.freedoms);
          });
        }
        sum += own.load.shares[k] * moved;
      }
      compliance_(i, j) = sum;
    }
}

double Contacts::plane_modulus() const {
  const auto& tissue = scene_->scenario.tissue;
  return tissue.young_modulus / (1.0 - tissue.poisson_ratio * tissue.poisson_ratio);
}

}  // namespace palpate::mechanics
