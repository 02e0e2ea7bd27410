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
      number_of_(skin_->triangles.size(), -1) {
  if (const auto& file = part.scene->of_file) of_file_.emplace(file->surface());
}

// A place near each corner, within the triangle: at a crease the surface has another curvature on
// either side.
SkinCurvature::Corners SkinCurvature::on_file(int triangle) const {
  constexpr double inwards = 0.1;
  const geometry::SmoothSurface& file = *part_->scene->of_file;
  const auto& numbers = skin_->triangles[as_index(triangle)];
  Vec3 middle = Vec3::Zero();
  for (const int number : numbers) middle += skin_->vertices[as_index(number)] / 3.0;
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& corner = skin_->vertices[as_index(numbers[i])];
    const geometry::Near near = of_file_->nearest(corner + inwards * (middle - corner));
    const geometry::SurfacePoint at{near.triangle, near.weights};
    corners[i] = scene::curvature_of_file(file, at, part_->scene->scenario);
    // A coarse file, as a box of twelve triangles, has too few neighbours.
    if (!corners[i].known()) return stars_.at_corners(*skin_, triangle);
    corners[i].curvature = geometry::turned_to(corners[i].curvature, file.normal(at));
  }
  return corners;
}

const SkinCurvature::Corners& SkinCurvature::at_rest(int triangle) {
  int& number = number_of_[as_index(triangle)];
  if (number < 0) {
    number = static_cast<int>(known_.size());
    known_.push_back(of_file_ ? on_file(triangle) : stars_.at_corners(*skin_, triangle));
  }
  return known_[as_index(number)];
}

void SkinCurvature::make_room() {
  known_.reserve(skin_->triangles.size());
  if (on_deformed(*part_))
    shape_ = *skin_;
  else if (of_file_)
    for (std::size_t triangle = 0; triangle < skin_->triangles.size(); ++triangle)
      (void)at_rest(static_cast<int>(triangle));
}

std::optional<std::string> SkinCurvature::find(const geometry::SurfacePoint& at, bool& one_sided,
                                               geometry::Curvature& here) {
  Corners corners;
  if (on_deformed(*part_)) {
    shape_ = *skin_;
    for (std::size_t v = 0; v < shape_.vertices.size(); ++v)
      if (const int node = part_->nodes[v]; node >= 0)
        shape_.vertices[v] += part_->state.displacement.segment<3>(3 * node);
    corners = stars_.at_corners(shape_, at.triangle);
  } else {
    corners = at_rest(at.triangle);
  }
  const geometry::CurvatureEstimate found =
      geometry::between(corners, {at.weights[0], at.weights[1], at.weights[2]});
  if (!found.known())
    return "the surface's curvature at the contact cannot be estimated: " +
           std::string(geometry::explanation(found.status)) + "; use a finer mesh";
  one_sided = one_sided || found.status == geometry::StarStatus::one_sided;
  here = found.curvature;
  return std::nullopt;
}

}  // namespace palpate::mechanics
