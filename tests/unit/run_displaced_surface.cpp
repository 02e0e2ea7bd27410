// The error of a displaced surface is the root mean square of differences over the largest one.
#include "run/displaced_surface.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "geometry/cuboid.h"

namespace palpate::run {
namespace {

Vec3 bent(const Vec3& x) { return {0.1 * x.y(), 0.0, -0.2 * x.x() + 0.3 * x.y()}; }

// A block whose nodes move as `bent` does, pressed to 1 mm in its first step and held.
record::CaseRecord pressed_block() {
  record::CaseRecord record;
  record.mesh =
      geometry::cuboid(Vec3(0.02, 0.02, 0.01), {4, 4, 2}, geometry::CellPattern::mirrored);
  record::TissueFrame frame{.step = 1, .time = 1.0, .displacement = {}, .contact_pressure = {}};
  for (const Vec3& node : record.mesh.nodes) frame.displacement.push_back(bent(node));
  record.frames.push_back(frame);
  for (Vec3& moved : frame.displacement) moved *= 2.0;
  frame.step = 2;
  record.frames.push_back(frame);
  record.contact = {{.step = 1, .time = 0.0},
                    {.step = 1, .time = 1.0, .travel = 1e-3},
                    {.step = 2, .time = 2.0, .travel = 1e-3}};
  return record;
}

std::vector<DisplacedPiece> reference() {
  std::vector<DisplacedPiece> pieces;
  for (const double x : {0.003, 0.011, 0.017})
    for (const double y : {0.004, 0.013}) {
      const Vec3 place(x, y, 0.01);
      pieces.push_back({place, bent(place), x});
    }
  return pieces;
}

TEST(DisplacedSurface, AnEqualOneHasNoError) {
  // A linear field is that of the flat triangles; the frame is that of the first step at that
  // travel.
  EXPECT_NEAR(surface_error(pressed_block(), reference()).value(), 0.0, 1e-15);
}

TEST(DisplacedSurface, ErrorsAreWeightedByTheirArea) {
  std::vector<DisplacedPiece> pieces = reference();
  double largest = 0.0;
  double area = 0.0;
  for (const DisplacedPiece& piece : pieces) {
    largest = std::max(largest, piece.displacement.norm());
    area += piece.area;
  }
  const double off = 1e-5;
  pieces[2].displacement += off * Vec3::UnitY();  // which stays smaller than the largest
  EXPECT_NEAR(surface_error(pressed_block(), pieces).value(),
              off * std::sqrt(pieces[2].area / area) / largest, 1e-12);
}

TEST(DisplacedSurface, NothingToCompare) {
  EXPECT_FALSE(surface_error(pressed_block(), {}));
  record::CaseRecord without = pressed_block();
  without.frames.clear();
  EXPECT_FALSE(surface_error(without, reference()));
  record::CaseRecord slid = pressed_block();
  for (record::ContactRow& row : slid.contact) row.slide = 1e-3;
  EXPECT_FALSE(surface_error(slid, reference()));
  record::CaseRecord ended = pressed_block();
  ended.outcome = record::Outcome::diverged;
  EXPECT_FALSE(surface_error(ended, reference()));
}

}  // namespace
}  // namespace palpate::run
