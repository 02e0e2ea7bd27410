// The contacts of the finger's spheres with the tissue, and what is summed over them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "contact/law.h"
#include "contact/patch.h"
#include "scene/scene.h"

namespace palpate::mechanics {

// Element::renew() resets an element but keeps the memory of its own lists. Nothing is allocated
// unless the list becomes longer than it has ever been.
template <class Element>
class KeptList {
 public:
  KeptList() = default;
  ~KeptList() = default;
  KeptList(const KeptList& other) : all_(other.begin(), other.end()), size_(other.size_) {}
  KeptList(KeptList&& other) noexcept
      : all_(std::move(other.all_)), size_(std::exchange(other.size_, 0)) {}
  KeptList& operator=(const KeptList& other) {
    if (this == &other) return *this;
    resize(other.size_);
    std::ranges::copy(other, begin());
    return *this;
  }
  // Both lists keep the memory of their elements.
  KeptList& operator=(KeptList&& other) noexcept {
    swap(other);
    other.clear();
    return *this;
  }
  void swap(KeptList& other) noexcept {
    all_.swap(other.all_);
    std::swap(size_, other.size_);
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t room() const { return all_.size(); }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] auto begin() { return all_.begin(); }
  [[nodiscard]] auto begin() const { return all_.begin(); }
  [[nodiscard]] auto end() { return all_.begin() + static_cast<std::ptrdiff_t>(size_); }
  [[nodiscard]] auto end() const { return all_.begin() + static_cast<std::ptrdiff_t>(size_); }
  [[nodiscard]] Element& operator[](std::size_t i) { return all_[i]; }
  [[nodiscard]] const Element& operator[](std::size_t i) const { return all_[i]; }
  [[nodiscard]] Element& front() { return all_.front(); }
  [[nodiscard]] const Element& front() const { return all_.front(); }

  // Appends a reset element.
  Element& add() {
    if (size_ == all_.size())
      all_.emplace_back();
    else
      all_[size_].renew();
    return all_[size_++];
  }
  void resize(std::size_t size) {
    size_ = std::min(size, size_);
    while (size_ < size) (void)add();
  }
  void clear() { size_ = 0; }
  void erase(std::size_t i) {
    for (; i + 1 < size_; ++i) std::swap(all_[i], all_[i + 1]);
    --size_;
  }
  // Calls leaves(element) once per element, in order, and removes those for which it returns true.
  template <class Leaves>
  void erase_if(const Leaves& leaves) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      if (leaves(all_[i])) continue;
      if (kept != i) std::swap(all_[kept], all_[i]);
      ++kept;
    }
    size_ = kept;
  }
  // Allocates at least `count` elements and calls reserve(element) for every allocated element.
  template <class Reserve>
  void make_room(std::size_t count, const Reserve& reserve) {
    if (all_.size() < count) all_.resize(count);
    for (Element& one : all_) reserve(one);
  }

 private:
  std::vector<Element> all_;  // elements beyond size_ are kept for their memory
  std::size_t size_ = 0;
};

class BodySurfaceDisplacement;

// The nodal forces and gaps of a contact with the coupling `resolved`.
struct NodalContact {
  std::vector<Vec3> push;      // per newton of the contact's force: one per vertex of its `load`
  double peak_pressure = 0.0;  // Pa, largest nodal pressure, docs/theory.md [nodal_pressure]
  std::vector<int> vertices;   // of the surface near the sphere, ascending
  std::vector<double> gap;     // m, between these vertices and the sphere

  void renew();  // clears all, but keeps the memory of the lists
};

// The contact of one sphere at one place of the surface.
struct SphereContact {
  int sphere = 0;
  contact::Patch patch;
  contact::ContactLaw law;
  double approach = 0.0;    // m, A of theory.md [one_contact]: the sphere below the surface
  double depth = 0.0;       // m, h of eq. (2)
  double force = 0.0;       // N, along the patch's normal
  double elastic = 0.0;     // N, the part of `force` that the law gives for relaxed tissue
  double radiated = 0.0;    // N, the part of `force` for waves that the mesh cannot resolve
  double deep = 1.0;        // the factor [deep] of a deep press, in the law's `part` too
  double compliance = 0.0;  // m/N, C_ii of docs/theory.md [contacts]
  double surface_displacement_error = 0.0;  // m/N, e of docs/theory.md [compliance]
  double surface_displacement_doubt = 0.0;  // m/N, BeyondHalfSpace::doubt
  double stiffness = 0.0;       // N/m, derivative of `force` with respect to `depth`; where inertia
                                // reaches the force, to the finger's position, within a step
  Vec3 drag = Vec3::Zero();     // N, tangential, on the tissue
  Vec3 stretch = Vec3::Zero();  // m, of the finger relative to the tissue since the last slip
  contact::Spread load;         // of the pressure
  contact::Spread wide;         // over the wide patch [inertia], which loads the mesh; or empty
  NodalContact nodal;           // with `resolved`; otherwise empty
  bool on_crease = false;
  bool one_sided = false;  // its curvature has StarStatus::one_sided

  // m/N: the tangential displacement beyond the half-space's is this tensor times the drag.
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero();

  void renew();  // resets all members, but keeps the memory of the lists
};

// The pressure in the middle of the contact, Pa: for Hertz 3/2 of the mean, for a layer from its
// law [layer_pressure], with `resolved` the largest nodal pressure.
[[nodiscard]] double peak_pressure(const SphereContact& contact);

// The mesh's own error in the contact's force, a fraction of it; 0 where the law alone gives it.
//                                                                docs/theory.md [compliance]
[[nodiscard]] double mesh_error(const SphereContact& contact);

// Position of the finger and the state of its contacts at one moment.
struct Touch {
  Vec3 finger = Vec3::Zero();  // m, the finger's reference point
  double travel = 0.0;         // m, below the first touch
  double slide = 0.0;          // m, sideways
  KeptList<SphereContact> contacts;

  [[nodiscard]] const SphereContact* deepest() const;  // null without contacts
  [[nodiscard]] double normal_force() const;           // N, upwards on the finger, without friction
  [[nodiscard]] double force() const;                  // N, upwards on the finger, with friction
  [[nodiscard]] Vec3 drag() const;       // N, sum of the tangential forces on the tissue
  [[nodiscard]] double pressed() const;  // N, sum of the magnitudes of the normal forces
};

// Whether the spheres of the finger represent one sphere, with `calibration = "force"`.
[[nodiscard]] bool presses_as_one(const scene::Scene& scene);
// Gives each of several spheres that stand for one its share of a layer's law.
void share_layer(const scene::Scene& scene, contact::ContactLaw& law);

// Friction of all contacts after the finger has moved by `move` (m). The stretch grows by the
// tangential part of `move`, and Cattaneo and Mindlin's partial slip gives the drag, at most mu F;
// with `contact.slip = "coulomb"` the drag is mu F along `move`. `beyond` renews the contacts'
// `shear`; without it they keep it.                                      docs/theory.md [stick]
void rub(const scene::Scene& scene, const Vec3& move, Touch& touch,
         BodySurfaceDisplacement* beyond = nullptr);

// Why Hertz's law does not apply to tissue of the curvature `kappa_2` (1/m).
[[nodiscard]] std::string hollow_text(double kappa_2);

}  // namespace palpate::mechanics
