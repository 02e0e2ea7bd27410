// Curvatures at the corners of a triangle, and between them.
#include "mechanics/skin_curvature.h"

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

SkinCurvature::SkinCurvature(const MovingPart& part)
    : part_(&part),
      skin_(&part.scene->specimen->surface->surface()),
      stars_(*skin_, part.scene->specimen->surface->neighbours(), curvature_options(*part.scene)),
      number_of_(skin_->triangles.size(), -1) {}

void SkinCurvature::make_room() {
  known_.reserve(skin_->triangles.size());
  if (on_deformed(*part_)) shape_ = *skin_;
}

std::optional<std::string> SkinCurvature::find(const geometry::SurfacePoint& at, bool& one_sided,
                                               geometry::Curvature& here) {
  std::array<geometry::CurvatureEstimate, 3> corners;
  if (on_deformed(*part_)) {
    shape_ = *skin_;
    for (std::size_t v = 0; v < shape_.vertices.size(); ++v)
      if (const int node = part_->nodes[v]; node >= 0)
        shape_.vertices[v] += part_->state.displacement.segment<3>(3 * node);
    corners = stars_.at_corners(shape_, at.triangle);
  } else {
    int& number = number_of_[as_index(at.triangle)];
    if (number < 0) {
      number = static_cast<int>(known_.size());
      known_.push_back(stars_.at_corners(*skin_, at.triangle));
    }
    corners = known_[as_index(number)];
  }
  const geometry::CurvatureEstimate found =
      geometry::between(corners, {at.weights[0], at.weights[1], at.weights[2]});
  if (!found.known())
    return "the skin's curvature at the contact cannot be estimated: " +
           std::string(geometry::explanation(found.status)) + "; use a finer mesh";
  one_sided = one_sided || found.status == geometry::StarStatus::one_sided;
  here = found.curvature;
  return std::nullopt;
}

}  // namespace palpate::mechanics
