// What bodies of a unit modulus sink under contacts at places of their surface, for cases that
// share them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/vec3.h"

namespace palpate::scene {

// For contacts of four radii. Values are for a tissue of E = 1 Pa: divided by its modulus they are
// in m/N.                                                               docs/theory.md [energy]
struct SunkPlace {
  static constexpr std::size_t radii = 4;
  std::array<double, radii> surface_displacement{};  // 1/m, s + e
  std::array<double, radii> error{};                 // 1/m, e
  std::array<double, radii> doubt{};                 // 1/m
  std::array<Eigen::Matrix3d, radii> shear{};        // 1/m, under tangential loads
  Vec3 normal = Vec3::Zero();                        // of the patch
  Eigen::VectorXd rest;                              // 1/m, w for the third radius
  double solution_error = 0.0;                       // SymmetricSolver::error() of these values
};

// Thread-safe. A place has the same bits whoever computed it.
class SurfaceDisplacementStore {
 public:
  // The place of the body with this key at a vertex of its surface (-1: at the first contact),
  // under a patch with this normal; nothing if it is not kept.
  [[nodiscard]] std::optional<SunkPlace> find(const std::string& body, int vertex,
                                              const Vec3& normal) {
    const std::lock_guard lock(looking_up_);
    const auto known = places_.find({body, vertex});
    if (known == places_.end()) return std::nullopt;
    for (const SunkPlace& place : known->second)
      if (place.normal == normal) return place;
    return std::nullopt;
  }
  // Drops all places before it would take more than 200 MB.
  void keep(const std::string& body, int vertex, const SunkPlace& place) {
    constexpr double most_bytes = 2e8;
    const double bytes = static_cast<double>(sizeof(SunkPlace) + body.size()) +
                         sizeof(double) * static_cast<double>(place.rest.size());
    const std::lock_guard lock(looking_up_);
    if (bytes_ + bytes > most_bytes) {
      places_.clear();
      bytes_ = 0.0;
    }
    bytes_ += bytes;
    places_[{body, vertex}].push_back(place);
  }

 private:
  std::mutex looking_up_;
  std::map<std::pair<std::string, int>, std::vector<SunkPlace>> places_;
  double bytes_ = 0.0;
};

}  // namespace palpate::scene
