// Places by body and vertex.
#include "scene/surface_displacement_store.h"

namespace palpate::scene {

std::optional<SunkPlace> SurfaceDisplacementStore::find(const std::string& body, int vertex,
                                                        const Vec3& normal) {
  const std::lock_guard lock(looking_up_);
  const auto known = places_.find({body, vertex});
  if (known == places_.end()) return std::nullopt;
  for (const SunkPlace& place : known->second)
    if (place.normal == normal) return place;
  return std::nullopt;
}

void SurfaceDisplacementStore::keep(const std::string& body, int vertex, const SunkPlace& place) {
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

}  // namespace palpate::scene
