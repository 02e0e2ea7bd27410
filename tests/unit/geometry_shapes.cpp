// Every shape's surface is closed, lies on the shape and tends to it; limbs share their end faces.
#include "geometry/shapes.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>

#include "base/error.h"

namespace palpate::geometry {
namespace {

constexpr double pi = std::numbers::pi;

const std::vector<Shape> shapes_given{Cuboid{},    Cylinder{},    Ellipsoid{}, Ligament{},
                                      BoneShaft{}, LayeredLimb{}, Disc{}};

Surface outer(const Shape& shape, double spacing) {
  return sampled(shape, {spacing, spacing}).parts.front().surface;
}

// An edge length that suits any of the shapes: this many to the smallest extent.
double spacing(const Shape& shape, double edges) { return extent(shape).minCoeff() / edges; }

// Every edge is run along once in each direction.
bool closed(const Surface& surface) {
  std::map<std::array<int, 2>, int> runs;
  for (const auto& triangle : surface.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++runs[{triangle[i], triangle[(i + 1) % 3]}];
  return std::all_of(runs.begin(), runs.end(), [&](const auto& run) {
    const auto back = runs.find({run.first[1], run.first[0]});
    return run.second == 1 && back != runs.end() && back->second == 1;
  });
}

// A closed surface without handles has two vertices more than half its triangles (Euler).
bool like_a_ball(const Surface& surface) {
  return closed(surface) && surface.triangles.size() == 2 * surface.vertices.size() - 4;
}

struct Extremes {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
};

Extremes angles(const Surface& surface) {
  Extremes found;
  for (const auto& triangle : surface.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = [&](std::size_t corner) {
        return surface.vertices[static_cast<std::size_t>(triangle[(i + corner) % 3])];
      };
      const Vec3 left = at(1) - at(0);
      const Vec3 right = at(2) - at(0);
      const double angle = std::atan2(left.cross(right).norm(), left.dot(right)) * 180.0 / pi;
      found.low = std::min(found.low, angle);
      found.high = std::max(found.high, angle);
    }
  return found;
}

double simpson(const std::function<double(double)>& f, double to) {
  constexpr int cells = 1000;
  double sum = 0.0;
  for (int i = 0; i < cells; ++i)
    sum += f(to * i / cells) + 4.0 * f(to * (i + 0.5) / cells) + f(to * (i + 1) / cells);
  return sum * to / (6.0 * cells);
}

// The shapes' own volumes, from their description.
struct Volume {
  double operator()(const Cuboid& c) const { return c.size.prod(); }
  double operator()(const Cylinder& c) const { return pi * c.radius * c.radius * c.length; }
  double operator()(const Ellipsoid& e) const { return pi / 6.0 * e.size.prod(); }
  double operator()(const Ligament& l) const {
    return simpson(
        [&](double y) {
          const double factor = 1.0 + 0.2 * std::pow(2.0 * y / l.length - 1.0, 2);
          const double w = factor * l.width;
          const double t = factor * l.thickness;
          return (w - t) * t + 0.25 * pi * t * t;
        },
        l.length);
  }
  double operator()(const BoneShaft& b) const {
    return simpson(
        [&](double y) {
          const double flare = std::pow(2.0 * y / b.length - 1.0, 4);
          const double r = b.radius + (b.end_radius - b.radius) * flare;
          return pi * r * r;
        },
        b.length);
  }
  double operator()(const Disc& d) const { return pi * d.radius * d.radius * d.height; }
  double operator()(const LayeredLimb& l) const {
    const double a = l.radius;
    const double b = l.end_radius;
    return pi / 3.0 * l.length * (a * a + a * b + b * b);
  }
};

TEST(Shapes, surfaces_are_closed_and_look_outwards) {
  for (const Shape& shape : shapes_given)
    for (const double edges : {0.7, 2.0, 5.0, 11.0})
      for (const Part& part :
           sampled(shape, {spacing(shape, edges), spacing(shape, edges)}).parts) {
        EXPECT_TRUE(like_a_ball(part.surface)) << shape.index() << ", " << edges;
        EXPECT_GT(enclosed(part.surface).volume, 0.0);
      }
}

TEST(Shapes, any_size_and_spacing_closes) {
  EXPECT_TRUE(rc::check([] {
    const auto length = [] { return 1e-3 * *rc::gen::inRange(2, 200); };
    const auto other = [&](double above) {
      return above * (1.0 + 0.01 * *rc::gen::inRange(1, 300));
    };
    const double a = length();
    const double b = other(a);
    const double c = length();
    const double h = 1e-3 * *rc::gen::inRange(10, 300);
    for (const Shape& shape :
         {Shape(Cylinder{a, c}), Shape(Disc{a, c}), Shape(Ellipsoid{{a, b, c}}),
          Shape(Ligament{c, b, a}), Shape(BoneShaft{c, a, b}),
          Shape(LayeredLimb{c, b, a, 0.3 * a, 0.4 * a})})
      for (const Part& part : sampled(shape, {h, 1.7 * h}).parts) {
        RC_ASSERT(like_a_ball(part.surface));
        RC_ASSERT(enclosed(part.surface).volume > 0.0);
      }
  }));
}

TEST(Shapes, bounding_boxes_begin_at_the_origin) {
  for (const Shape& shape : shapes_given) {
    const Surface surface = outer(shape, spacing(shape, 12.0));
    Vec3 low = surface.vertices.front();
    Vec3 high = low;
    for (const Vec3& vertex : surface.vertices) {
      low = low.cwiseMin(vertex);
      high = high.cwiseMax(vertex);
    }
    const Vec3 size = extent(shape);
    EXPECT_GE(low.minCoeff(), -1e-15);                  // rounding
    EXPECT_LE((high - size).maxCoeff(), 1e-15);         // rounding
    EXPECT_LT(low.maxCoeff(), 0.02 * size.maxCoeff());  // between two vertices around
    EXPECT_LT((size - high).maxCoeff(), 0.02 * size.maxCoeff());
    if (std::holds_alternative<Ellipsoid>(shape)) continue;  // all others end flat
    const int axis = axis_of(shape);
    EXPECT_EQ(low[axis], 0.0);
    EXPECT_EQ(high[axis], size[axis]);
  }
  EXPECT_EQ(outer(Ellipsoid{}, 0.02).vertices.front(), Vec3(0.077, 0.0995, 0.0));
}

// Distance from the axis over the radius there: 1 on the side of a round shape along y.
void expect_round(const Shape& shape, const std::function<double(double)>& radius) {
  const Vec3 size = extent(shape);
  int on_side = 0;
  for (const Vec3& vertex : outer(shape, spacing(shape, 7.0)).vertices) {
    const double from_axis = std::hypot(vertex.x() - 0.5 * size.x(), vertex.z() - 0.5 * size.z());
    const bool on_end = vertex.y() == 0.0 || vertex.y() == size.y();
    if (on_end && from_axis < 0.99 * radius(vertex.y())) continue;
    EXPECT_NEAR(from_axis, radius(vertex.y()), 1e-15);  // rounding
    ++on_side;
  }
  EXPECT_GT(on_side, 50);
}

TEST(Shapes, vertices_lie_on_the_sides) {
  expect_round(Cylinder{}, [](double) { return 0.030; });
  expect_round(BoneShaft{},
               [](double y) { return 0.014 + 0.008 * std::pow(2.0 * y / 0.200 - 1.0, 4); });
  expect_round(LayeredLimb{}, [](double y) { return 0.090 - 0.025 * y / 0.350; });
  const Ellipsoid head;
  for (const Vec3& vertex : outer(head, 0.02).vertices)
    EXPECT_NEAR(((2.0 * vertex - head.size).cwiseQuotient(head.size)).norm(), 1.0,
                1e-14);  // rounding
}

TEST(Shapes, a_disc_stands) {
  const Disc disc{0.010, 0.004};
  for (const Vec3& vertex : outer(disc, 0.001).vertices) {
    const double from_axis = std::hypot(vertex.x() - 0.010, vertex.y() - 0.010);
    if (vertex.z() > 0.0 && vertex.z() < 0.004) {
      EXPECT_NEAR(from_axis, 0.010, 1e-15);  // rounding
    }
  }
  const Vec3 there = onto(disc, {0.015, 0.010, 0.001});
  EXPECT_NEAR((there - Vec3(0.020, 0.010, 0.001)).norm(), 0.0, 1e-15);  // rounding
}

TEST(Shapes, a_ligament_is_a_strap_with_round_edges) {
  const Vec3 size = extent(Ligament{});
  for (const Vec3& vertex : outer(Ligament{}, 0.002).vertices) {
    const double factor = 1.0 + 0.2 * std::pow(2.0 * vertex.y() / 0.044 - 1.0, 2);
    const double beyond =
        std::max(std::abs(vertex.x() - 0.5 * size.x()) - 0.5 * factor * (0.027 - 0.005), 0.0);
    const double from_middle = std::hypot(beyond, vertex.z() - 0.5 * size.z());
    const bool on_end = vertex.y() == 0.0 || vertex.y() == 0.044;
    if (on_end) {
      EXPECT_LE(from_middle, 0.5 * factor * 0.005 + 1e-15);
    } else {
      EXPECT_NEAR(from_middle, 0.5 * factor * 0.005, 1e-15);  // rounding
    }
  }
}

// Chords cut off a part that falls with the square of the spacing.
TEST(Shapes, volumes_tend_to_the_shapes_with_the_square_of_the_spacing) {
  for (const Shape& shape : shapes_given) {
    const double exact = std::visit(Volume{}, shape);
    const auto lost = [&](double edges) {
      return 1.0 - enclosed(outer(shape, spacing(shape, edges))).volume / exact;
    };
    if (std::holds_alternative<Cuboid>(shape)) {
      EXPECT_NEAR(lost(5.0), 0.0, 1e-14);  // rounding: a box has no round faces
      continue;
    }
    EXPECT_GT(lost(16.0), 0.0);
    EXPECT_LT(lost(16.0), 0.006);  // measured at most 0.0041
    const double ratio = lost(16.0) / lost(32.0);
    EXPECT_NEAR(ratio, 4.0, 0.3) << shape.index();  // counts around are rounded
  }
}

// Where a ring has more points than the last, and on end faces, angles of 60 degrees cannot be.
TEST(Shapes, triangles_are_nearly_equilateral) {
  for (const Shape& shape : shapes_given) {
    const Extremes found = angles(outer(shape, spacing(shape, 16.0)));
    EXPECT_GT(found.low, 33.0) << shape.index();    // degrees; measured 37 to 45
    EXPECT_LT(found.high, 103.0) << shape.index();  // measured 90 to 100
  }
}

TEST(Shapes, sides_along_y_have_equilateral_triangles) {
  for (const Shape& shape :
       {Shape(Cylinder{}), Shape(Ligament{}), Shape(BoneShaft{}), Shape(LayeredLimb{})}) {
    const double wanted = spacing(shape, 16.0);
    const double length = extent(shape).y();
    for (const Part& part : sampled(shape, {wanted, 0.9 * wanted}).parts) {
      Surface side = part.surface;
      const auto middle = [&](const std::array<int, 3>& triangle) {
        double sum = 0.0;
        for (const int corner : triangle)
          sum += side.vertices[static_cast<std::size_t>(corner)].y();
        return sum / 3.0;
      };
      std::erase_if(side.triangles, [&](const auto& triangle) {
        return middle(triangle) < 1e-9 || middle(triangle) > length - 1e-9;
      });
      const Extremes found = angles(side);
      EXPECT_GT(found.low, 50.0) << shape.index();   // degrees; measured 52 to 60
      EXPECT_LT(found.high, 72.0) << shape.index();  // measured 60 to 69
    }
  }
}

TEST(Shapes, edges_are_about_as_long_as_asked) {
  for (const Shape& shape : shapes_given) {
    const double wanted = spacing(shape, 16.0);
    const Surface surface = outer(shape, wanted);
    for (const auto& triangle : surface.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const double length = (surface.vertices[static_cast<std::size_t>(triangle[i])] -
                               surface.vertices[static_cast<std::size_t>(triangle[(i + 1) % 3])])
                                  .norm();
        EXPECT_GT(length, 0.6 * wanted);
        EXPECT_LT(length, 1.7 * wanted);
      }
  }
}

// The inner surfaces' end faces are parts of the outer one's, whatever the two spacings.
TEST(Shapes, limb_parts_share_their_end_faces) {
  for (const double inner : {0.5, 1.0, 2.0, 3.0}) {
    const Body body = sampled(LayeredLimb{}, {0.02, 0.02 * inner});
    ASSERT_EQ(body.parts.size(), 3u);
    const auto on_side = [](const Surface& surface) {
      return std::count_if(
          surface.triangles.begin(), surface.triangles.end(), [&](const auto& triangle) {
            const auto on_end = [&](double y) {
              return std::all_of(triangle.begin(), triangle.end(), [&](int corner) {
                return surface.vertices[static_cast<std::size_t>(corner)].y() == y;
              });
            };
            return !on_end(0.0) && !on_end(0.350);
          });
    };
    const auto all = static_cast<std::ptrdiff_t>(body.parts[0].surface.triangles.size()) +
                     on_side(body.parts[1].surface) + on_side(body.parts[2].surface);
    EXPECT_EQ(facets(body).triangles.size(), static_cast<std::size_t>(all)) << inner;
  }
}

TEST(Shapes, regions_of_a_limb_are_skin_muscle_and_bone) {
  const Body body = sampled(LayeredLimb{}, {0.02, 0.02});
  EXPECT_EQ(region_at(body, {0.090, 0.175, 0.090}), 2);  // its axis
  EXPECT_EQ(region_at(body, {0.130, 0.175, 0.090}), 1);
  EXPECT_EQ(region_at(body, {0.161, 0.175, 0.090}), 0);
  EXPECT_EQ(region_at(body, {0.175, 0.340, 0.090}), std::nullopt);  // beside the thin end
}

TEST(Shapes, a_limb_may_lack_skin_or_bone) {
  LayeredLimb limb;
  limb.skin_thickness = 0.0;
  EXPECT_EQ(sampled(limb, {0.02, 0.02}).parts.front().region, 1);
  EXPECT_EQ(sampled(limb, {0.02, 0.02}).parts.size(), 2u);
  limb.bone_radius = 0.0;
  EXPECT_EQ(sampled(limb, {0.02, 0.02}).parts.size(), 1u);
}

TEST(Shapes, a_coarse_limb_keeps_its_skin_apart_from_its_muscle) {
  LayeredLimb limb;
  limb.skin_thickness = 0.002;
  const Body body = sampled(limb, {0.5, 0.5});
  const Surface& inside = body.parts[1].surface;
  for (const Vec3& vertex : inside.vertices)
    if (vertex.y() > 0.0 && vertex.y() < 0.350) {
      EXPECT_NE(region_at(body, vertex + Vec3(1e-9, 0, 0)), std::nullopt);
    }
}

TEST(Shapes, refuses_a_limb_without_muscle) {
  LayeredLimb limb;
  limb.bone_radius = 0.053;
  try {
    (void)sampled(limb, {0.02, 0.02});
    FAIL() << "no error";
  } catch (const MeshError& error) {
    EXPECT_STREQ(error.what(),
                 "a limb of radius 65 mm has no room for muscle between a skin of 12 mm and a bone "
                 "of radius 53 mm; make one of them thinner");
  }
}

}  // namespace
}  // namespace palpate::geometry
