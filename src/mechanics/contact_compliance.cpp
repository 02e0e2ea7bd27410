// The compliances C_ij of the coupled contact equations, docs/theory.md (15).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact/half_space.h"
#include "mechanics/contacts.h"

namespace palpate::mechanics {
namespace {

using contact::Coupling;

}  // namespace

// The patch around which `consistent` reads the mesh for the contact `own`: its own patch or, for
// spheres with `calibration = "force"`, the patch that the single sphere would have.
contact::Patch Contacts::read_patch(const KeptList<SphereContact>& contacts,
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

// Fills compliance_ (m/N).                                                 docs/theory.md (15)
void Contacts::find_compliance(const MeshAnswer& mesh, const KeptList<SphereContact>& contacts) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  clear_corner(compliance_, count);
  if (mesh.influence == nullptr) return;
  const bool consistent = scene_->scenario.contact.coupling == Coupling::consistent;
  if (consistent)
    for (const SphereContact& contact : contacts)
      for (std::size_t k = 0; k < contact.load.vertices.size(); ++k) {
        double& share = shares_[as_index(contact.load.vertices[k])];
        share = std::max(share, contact.load.shares[k]);
      }
  contact::Reading& reading = reading_;
  for (Eigen::Index i = 0; i < count; ++i) {
    const SphereContact& own = contacts[as_index(i)];
    const contact::Patch patch = read_patch(contacts, own);
    if (i > 0 && consistent && presses_as_one()) {
      compliance_.row(i) = compliance_.row(0);
      continue;
    }
    if (consistent) {
      // Beyond the layer's law the displacement comes from the sides, and is smooth over a distance
      // of one thickness.                                                  docs/theory.md (61)
      rings_.read(patch, shares_, scene_->layer ? scene_->layer->thickness : 0.0, reading);
    } else {
      reading.vertices = own.load.vertices;
      reading.weights = own.load.shares;
    }
    for (Eigen::Index j = 0; j < count; ++j) {
      const SphereContact& pressed = contacts[as_index(j)];
      compliance_(i, j) = sinking(mesh, patch, reading, pressed);
      // A block cannot be stiffer than the infinite layer from which it is cut: a negative
      // compliance is an error of a coarse mesh.
      if (cut_from_layer(mesh) && i == j) compliance_(i, j) = std::max(0.0, compliance_(i, j));
      if (i != j && !presses_as_one()) compliance_(i, j) += unknown_to_hertz(patch, pressed);
    }
  }
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      compliance_(i, j) += other_tissues(mesh, contacts[as_index(i)], contacts[as_index(j)]);
  if (consistent)
    for (const SphereContact& contact : contacts)
      for (const int vertex : contact.load.vertices) shares_[as_index(vertex)] = 0.0;
}

// The reading's sinking under `patch` per newton on the contact `pressed`, m/N; for `consistent`
// minus the part that the law contains.
double Contacts::sinking(const MeshAnswer& mesh, const contact::Patch& patch,
                         const contact::Reading& reading, const SphereContact& pressed) const {
  const bool consistent = scene_->scenario.contact.coupling == Coupling::consistent;
  Influence& read = mesh.one_tissue != nullptr ? *mesh.one_tissue : *mesh.influence;
  const contact::Spread& load = pressed.load;
  const double spacing = rings_.spacing(patch);
  read.kept.look(patch.normal, pressed.patch.normal, spacing);
  double sum = 0.0;
  for (std::size_t a = 0; a < reading.vertices.size(); ++a) {
    const int vertex = reading.vertices[a];
    double moved = 0.0;
    for (std::size_t k = 0; k < load.vertices.size(); ++k)
      moved += load.shares[k] * read.kept.at(vertex, load.vertices[k], [&] {
        return PairBlock{
            .moved =
                read.block(mesh.node_of(vertex), mesh.node_of(load.vertices[k]), mesh.freedoms),
            .known = consistent ? known_to_law(vertex, load.vertices[k], spacing) : 0.0};
      });
    sum += reading.weights[a] * moved;
  }
  return sum;
}

// The sinking of one vertex of the skin per newton on another that the law contains, m/N: that of a
// half-space or, with the layer's law, of a layer.                   docs/theory.md (11), (60)
double Contacts::known_to_law(int read, int pressed, double spacing) const {
  const double sinking = rings_.half_space(read, pressed, plane_modulus(), spacing);
  if (!scene_->layer) return sinking;
  const auto& vertices = surface_->surface().vertices;
  const double r = (vertices[as_index(read)] - vertices[as_index(pressed)]).norm();
  const double thickness = scene_->layer->thickness;
  return sinking - scene_->specimen->sinking->gamma(r / thickness) /
                       (std::numbers::pi * plane_modulus() * thickness);
}

// The effect of the other tissues on the sinking under a contact per newton on another, m/N. It is
// evaluated under the contact itself, because errors of the mesh cancel in the difference.
double Contacts::other_tissues(const MeshAnswer& mesh, const SphereContact& own,
                               const SphereContact& pressed) const {
  if (mesh.one_tissue == nullptr) return 0.0;
  PairTable& kept = mesh.influence->kept;
  kept.look(own.patch.normal, pressed.patch.normal, 0.0);
  double sum = 0.0;
  for (std::size_t k = 0; k < own.load.vertices.size(); ++k) {
    double moved = 0.0;
    for (std::size_t j = 0; j < pressed.load.vertices.size(); ++j)
      moved +=
          pressed.load.shares[j] * kept.at(own.load.vertices[k], pressed.load.vertices[j], [&] {
            const int at = mesh.node_of(own.load.vertices[k]);
            const int node = mesh.node_of(pressed.load.vertices[j]);
            return PairBlock{.moved = mesh.influence->block(at, node, mesh.freedoms) -
                                      mesh.one_tissue->block(at, node, mesh.freedoms)};
          });
    sum += own.load.shares[k] * moved;
  }
  return sum;
}

// The sinking of the half-space (or layer) under `patch` per newton on another contact, m/N, which
// Hertz's law of a single contact does not contain.                       docs/theory.md (16)
double Contacts::unknown_to_hertz(const contact::Patch& patch, const SphereContact& other) const {
  if (scene_->scenario.contact.coupling != Coupling::consistent) return 0.0;
  return patch.normal.dot(other.patch.normal) *
             contact::half_space_sinking((patch.position - other.patch.position).norm(), 1.0,
                                         other.patch.radius(), plane_modulus()) -
         stiffer_layer(patch.normal.dot(other.patch.normal), patch.position, other);
}

// Whether `consistent` uses the layer's law on a specimen of one tissue, all of which moves.
bool Contacts::cut_from_layer(const MeshAnswer& mesh) const {
  return scene_->layer && mesh.whole && !scene_->specimen->one_tissue &&
         scene_->scenario.contact.coupling == Coupling::consistent;
}

// The sinking of a half-space minus that of the layer at the point `at`, per newton on a contact,
// m/N. `aligned` is the cosine between the two normals.                   docs/theory.md (60)
double Contacts::stiffer_layer(double aligned, const Vec3& at, const SphereContact& pressed) const {
  if (!scene_->layer) return 0.0;
  const double thickness = scene_->layer->thickness;
  const auto& vertices = surface_->surface().vertices;
  double sum = 0.0;
  for (std::size_t j = 0; j < pressed.load.vertices.size(); ++j) {
    const double r = (at - vertices[as_index(pressed.load.vertices[j])]).norm();
    sum += pressed.load.shares[j] * scene_->specimen->sinking->gamma(r / thickness);
  }
  return aligned * sum / (std::numbers::pi * plane_modulus() * thickness);
}

double Contacts::plane_modulus() const {
  const tissue::Uniaxial& measured = scene_->specimen->measured;
  return measured.young_modulus / (1.0 - measured.poisson_ratio * measured.poisson_ratio);
}

}  // namespace palpate::mechanics
