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
double radius_per_root(const contact::ContactLaw& law) { return std::sqrt(law.a * law.b); }

}  // namespace

// The patch at which `consistent` evaluates the body for the contact `own`: its own patch or, for
// spheres with `calibration = "force"`, the patch that the single sphere would have.
contact::Patch Contacts::joint_patch(const KeptList<SphereContact>& contacts,
                                     const SphereContact& own) const {
  if (!presses_as_one() || contacts.size() == 1) return own.patch;
  const SphereContact& widest = *std::max_element(
      contacts.begin(), contacts.end(),
      [](const auto& one, const auto& other) { return one.patch.radius() < other.patch.radius(); });
  contact::Patch joint = widest.patch;
  // a^2 = R h, and R is n^(1/3) times a sphere's radius.
  const double wider = std::pow(static_cast<double>(scene_->finger.centres.size()), 1.0 / 6.0);
  joint.a *= wider;
  joint.b *= wider;
  return joint;
}

bool Contacts::presses_as_one() const {
  return scene_->finger.centres.size() > 1 &&
         scene_->scenario.finger.calibration == finger::Calibration::force;
}

// Fills compliance_ (m/N).                                                 docs/theory.md (15)
void Contacts::find_compliance(const MeshAnswer& mesh, KeptList<SphereContact>& contacts) {
  clear_corner(compliance_, static_cast<Eigen::Index>(contacts.size()));
  if (scene_->scenario.contact.coupling == Coupling::consistent)
    find_body_sinking(mesh, contacts);
  else if (mesh.influence != nullptr)
    find_mesh_sinking(mesh, contacts);
}

// The contact radius a is the one that stores the most energy, docs/theory.md (99):
//   F = F_Hertz(a) / (1 - (5/3) E* a^2 s'(a)),   travel = a^2 / R + (s + a s') F.
// Both take the form of the contact equations: the law times a factor, and a compliance.
void Contacts::find_body_sinking(const MeshAnswer& mesh, KeptList<SphereContact>& contacts) {
  constexpr double most_stiffening = 0.8;
  const auto count = static_cast<Eigen::Index>(contacts.size());
  const double wider = presses_as_one()
                           ? std::pow(static_cast<double>(scene_->finger.centres.size()), 1.0 / 6.0)
                           : 1.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    SphereContact& own = contacts[as_index(i)];
    const contact::Patch patch = joint_patch(contacts, own);
    const BodySinking::Value value = mesh.beyond->at(patch, wider * radius_per_root(own.law));
    const double radius = patch.radius();
    // F_Hertz = 4/3 E* a h, for an ellipse with a modulus that makes this so.
    const double modulus = presses_as_one()
                               ? scene_->finger.whole.modulus
                               : 0.75 * own.law.point.coefficient / radius_per_root(own.law);
    const double stiffening =
        std::min(most_stiffening, 5.0 / 3.0 * modulus * radius * radius * value.slope);
    own.law.point.part /= 1.0 - stiffening;
    own.sinking_error = value.error;
    const double sinking = value.sinking + radius * value.slope;
    if (presses_as_one()) {
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
          mesh.beyond->rest(own.patch.normal, own.load, mesh.nodes, other.patch,
                            radius_per_root(other.law));
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
      kept.look(own.patch.normal, pressed.patch.normal, 0.0);
      double sum = 0.0;
      for (std::size_t k = 0; k < own.load.vertices.size(); ++k) {
        const int vertex = own.load.vertices[k];
        double moved = 0.0;
        for (std::size_t l = 0; l < pressed.load.vertices.size(); ++l) {
          const int loaded = pressed.load.vertices[l];
          moved += pressed.load.shares[l] * kept.at(vertex, loaded, [&] {
            return PairBlock{.moved = mesh.influence->block(mesh.node_of(vertex),
                                                            mesh.node_of(loaded), mesh.freedoms)};
          });
        }
        sum += own.load.shares[k] * moved;
      }
      compliance_(i, j) = sum;
    }
}

double Contacts::plane_modulus() const {
  const tissue::Uniaxial& measured = scene_->specimen->measured;
  return measured.young_modulus / (1.0 - measured.poisson_ratio * measured.poisson_ratio);
}

}  // namespace palpate::mechanics
