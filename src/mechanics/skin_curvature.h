// The surface's curvature at a point, at rest or as the mesh deforms it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geometry/box_tree.h"
#include "geometry/curvature.h"
#include "mechanics/moving_part.h"

namespace palpate::mechanics {

class SkinCurvature {
 public:
  // The part must outlive this.
  explicit SkinCurvature(const MovingPart& part);

  // Sets `here` (1/m) to the curvature at a point: of the mesh's surface or, for a surface file, of
  // its triangles where they suffice, which a mesh may have coarsened. With `contact.curvature_on =
  // "deformed"` it is that of the displaced skin. Sets `one_sided` if its estimate is
  // StarStatus::one_sided. Returns a sentence if it cannot be estimated.
  [[nodiscard]] std::optional<std::string> find(const geometry::SurfacePoint& at, bool& one_sided,
                                                geometry::Curvature& here);
  void make_room();  // after which find() allocates nothing

 private:
  using Corners = std::array<geometry::CurvatureEstimate, 3>;
  [[nodiscard]] const Corners& at_rest(int triangle);
  [[nodiscard]] Corners on_file(int triangle) const;

  const MovingPart* part_;
  const geometry::Surface* skin_;
  geometry::CurvatureStars stars_;
  std::vector<int> number_of_;                // per triangle: index into known_; -1: not computed
  std::vector<Corners> known_;                // at rest
  std::optional<geometry::BoxTree> of_file_;  // of Scene::of_file
  geometry::Surface shape_;                   // the deformed surface
};

}  // namespace palpate::mechanics
