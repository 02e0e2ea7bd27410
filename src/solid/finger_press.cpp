// Points of the curve, and interpolation between them.
#include "solid/finger_press.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/doing.h"
#include "base/text.h"
#include "base/units.h"
#include "geometry/box_tree.h"

namespace palpate::solid {
namespace {

using Pairs =
    std::vector<std::pair<double, double>>;  // of a travel and another quantity, ascending

// The parabola through the three points nearest to x in logarithms. Below the first its slope there
// goes over to `power`, that of the smallest contacts.
double between(const Pairs& points, double x, double power) {
  if (!(x > 0.0)) return 0.0;
  const auto parabola = [&](double at) {
    std::size_t first = 0;
    while (first + 3 < points.size() && at > points[first + 1].first) ++first;
    const std::size_t count = std::min<std::size_t>(3, points.size() - first);
    double sum = 0.0;
    for (std::size_t i = first; i < first + count; ++i) {
      double weight = 1.0;
      for (std::size_t j = first; j < first + count; ++j)
        if (j != i)
          weight *= std::log(at / points[j].first) / std::log(points[i].first / points[j].first);
      sum += weight * std::log(points[i].second);
    }
    return sum;
  };
  const auto& [begin, value] = points.front();
  if (points.size() > 1 && x >= begin) return std::exp(parabola(x));
  constexpr double aside = 1e-3;
  const double slope = points.size() > 1 ? (parabola(begin * (1.0 + aside)) - std::log(value)) /
                                               std::log(1.0 + aside)
                                         : power;
  return value * std::pow(x / begin, power) * std::exp((slope - power) * (x / begin - 1.0));
}

// Whether points are their own images across the plane through 0 normal to an axis.
bool mirrored(std::span<const Vec3> points, int axis, double near) {
  return std::all_of(points.begin(), points.end(), [&](const Vec3& point) {
    Vec3 image = point;
    image[axis] = -image[axis];
    return std::any_of(points.begin(), points.end(),
                       [&](const Vec3& other) { return (other - image).norm() < near; });
  });
}

}  // namespace

FingerPress::FingerPress(FingerOrder order) : order_(std::move(order)) {
  BodyOrder body = order_.body;
  body.radius = order_.radius / order_.share;
  body.travel = order_.deepest * order_.share;
  // Where the spheres meet the body on their way.
  const std::vector<Vec3>& corners = order_.corners;
  const bool several = order_.centres.size() > 1;
  std::optional<geometry::BoxTree> tree;
  if (several || corners.size() > 1) tree.emplace(order_.skin->surface());
  const double step = 0.5 * std::sqrt(order_.radius * order_.deepest);
  // A plane of symmetry passes through the finger's point, not through one of its spheres.
  body.touched = {order_.touched};
  if (several) body.touched.front().head<2>() = order_.first_touch.head<2>();
  for (const Vec3& centre : order_.centres)
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (i == 0 && !several) continue;
      const Vec3 from = corners[i == 0 ? 0 : i - 1];
      const int parts = std::max(1, static_cast<int>(std::ceil((corners[i] - from).norm() / step)));
      for (int k = 1; k <= parts; ++k) {
        const Vec3 place = order_.first_touch + centre + from +
                           (corners[i] - from) * (static_cast<double>(k) / parts);
        body.touched.push_back(order_.skin->foot(place, tree->nearest(place)).position);
      }
    }
  const double near = 1e-6 * order_.radius;
  for (const int axis : {0, 1})
    body.mirrored[as_index(axis)] =
        body.mirrored[as_index(axis)] && mirrored(order_.centres, axis, near) &&
        std::all_of(corners.begin(), corners.end(),
                    [&](const Vec3& at) { return std::abs(at[axis]) < near; });
  mirror_ = body.touched.front();
  press_ = std::make_unique<Press>(make_body(body));
  std::vector<Ball> balls;
  for (const Vec3& centre : order_.centres)
    balls.push_back({centre + (body.radius - order_.radius) * Vec3::UnitZ(), body.radius, false});
  press_->set_finger(std::move(balls));
  press_->begin(order_.first_touch);
  if (order_.ball) find_ball();
}

// The ball under a cup whose curvature is the tissue's share of 1/R.
void FingerPress::find_ball() {
  const double part = (1.0 - order_.share) * order_.deepest;
  Press press(make_ball(order_.radius, order_.deepest, *order_.ball, order_.body.per_radius));
  const double cup = order_.radius / std::max(order_.share, 1e-4);
  press.set_finger({{Vec3(0.0, 0.0, order_.radius - cup), cup, true}});
  press.begin(Vec3::Zero());
  for (const double times : {0.25, 0.5, 1.0}) {
    const double travel = times * part;
    const auto found = press.go(-travel * Vec3::UnitZ());
    if (!found) {
      reason_ = "the solid finds no equilibrium of the finger's ball beyond a travel of " +
                quantity_text(travel, unit::mm) + "; press less deep";
      return;
    }
    ball_.push_back({travel - found->lost, found->normal(), {}});
  }
}

template <class Add>
void FingerPress::with_copies(const std::array<Vec3, 3>& triangle, const Add& add) const {
  const std::array<bool, 2>& mirrored = press_->body().mirrored;
  for (int copy = 0; copy < 4; ++copy) {
    const bool across_x = (copy & 1) != 0, across_y = (copy & 2) != 0;
    if ((across_x && !mirrored[0]) || (across_y && !mirrored[1])) continue;
    std::array<Vec3, 3> image = triangle;
    for (Vec3& corner : image) {
      if (across_x) corner.x() = 2.0 * mirror_.x() - corner.x();
      if (across_y) corner.y() = 2.0 * mirror_.y() - corner.y();
    }
    if (across_x != across_y) std::swap(image[1], image[2]);
    add(image);
  }
}

FingerPress::Skin FingerPress::skin_at(double travel, const Vec3& place) {
  const Vec3 finger = order_.first_touch + place - order_.share * travel * Vec3::UnitZ();
  Skin skin;
  const auto moved = press_->look(finger);
  if (!moved) return skin;
  skin.balls = press_->balls();
  for (Ball& ball : skin.balls) ball.centre += finger;
  const Body& body = press_->body();
  const auto at = [&](int node) -> Vec3 {
    return body.mesh.nodes[as_index(node)] + moved->segment<3>(3 * node);
  };
  constexpr std::array<std::array<std::size_t, 3>, 4> parts{
      {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  for (const OuterFace& face : body.met)
    for (const auto& part : parts)
      with_copies({at(face.nodes[part[0]]), at(face.nodes[part[1]]), at(face.nodes[part[2]])},
                  [&](const auto& image) { skin.triangles.push_back(image); });
  return skin;
}

Moment FingerPress::moment_of(const Answer& answer, double force) {
  return {force, std::sqrt(answer.area / std::numbers::pi), answer.peak, answer.touching};
}

std::optional<Answer> FingerPress::go(const Vec3& place, double travel) {
  set_doing(std::to_string(press_->body().mesh.nodes.size()) + " nodes, press to " +
            quantity_text(travel / order_.share, unit::mm) + " of " +
            quantity_text(order_.deepest, unit::mm));
  auto found = press_->go(order_.first_touch + place - travel * Vec3::UnitZ());
  if (!found) {
    const double reached = (order_.first_touch.z() - press_->reached().z()) / order_.share;
    reason_ = "the solid finds no equilibrium beyond a travel of " +
              quantity_text(reached, unit::mm) + ": the tissue folds there; press less deep";
  }
  return found;
}

// The curve at a place, with points at a quarter and half of the order's travel and there, and
// beyond it by up to half more at a time: a curve does not depend on what was asked first. Null
// where no equilibrium was found.
FingerPress::Curve* FingerPress::curve_at(const Vec3& place, double travel) {
  if (!reason_.empty()) return nullptr;
  auto found = std::find_if(curves_.begin(), curves_.end(),
                            [&](const Curve& one) { return one.place == place; });
  if (found == curves_.end()) found = curves_.insert(found, {.place = place});
  Curve& curve = *found;
  const double deepest = order_.share * order_.deepest;
  if (curve.points.empty()) press_->begin(order_.first_touch + place);
  while (curve.reached < std::max(deepest, travel)) {
    double next = curve.points.empty() ? 0.25 * deepest : 2.0 * curve.reached;
    if (curve.reached >= deepest) next = std::min(next, 1.5 * curve.reached);
    const auto answer = go(place, next);
    if (!answer) return nullptr;
    curve.reached = next;
    if (answer->normal() > 0.0)
      curve.points.push_back(
          {next - answer->lost, answer->normal(), moment_of(*answer, answer->normal())});
  }
  return &curve;
}

// The tissue's part of the finger's travel: the ball takes the rest at the same force.
double FingerPress::tissue_travel(const Curve& tissue, double travel) const {
  if (ball_.empty()) return order_.share * travel;
  Pairs of_tissue;
  Pairs of_ball;
  for (const Point& point : tissue.points) of_tissue.emplace_back(point.travel, point.force);
  for (const Point& point : ball_) of_ball.emplace_back(point.travel, point.force);
  double low = 0.0;
  double high = travel;
  constexpr int halvings = 60;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (between(of_tissue, middle, 1.5) < between(of_ball, travel - middle, 1.5) ? low : high) =
        middle;
  }
  return 0.5 * (low + high);
}

std::optional<Moment> FingerPress::at_travel(double travel, const Vec3& place) {
  if (!(travel > 0.0)) return Moment{};
  const Curve* curve = curve_at(place, order_.share * travel);
  if (curve == nullptr) return std::nullopt;
  if (curve->points.empty()) return Moment{};
  const double own = tissue_travel(*curve, travel);
  Pairs force;
  Pairs radius;
  Pairs pressure;
  for (const Point& point : curve->points) {
    force.emplace_back(point.travel, point.force);
    radius.emplace_back(point.travel, point.moment.contact_radius);
    pressure.emplace_back(point.travel, point.moment.peak_pressure);
  }
  const auto nearest = std::find_if(curve->points.begin(), curve->points.end(),
                                    [&](const Point& point) { return point.travel >= own; });
  const Point& at = nearest == curve->points.end() ? curve->points.back() : *nearest;
  return Moment{between(force, own, 1.5), between(radius, own, 0.5), between(pressure, own, 0.5),
                at.moment.touching};
}

std::optional<Moment> FingerPress::at_slide(double travel, const Vec3& start, const Vec3& end,
                                            double slid) {
  const double length = (end - start).norm();
  if (slid_.empty() || slide_start_ != start || slide_end_ != end || slide_travel_ != travel) {
    const Curve* curve = travel > 0.0 ? curve_at(start, order_.share * travel) : nullptr;
    if (curve == nullptr || curve->points.empty()) {
      if (reason_.empty()) return Moment{};
      return std::nullopt;
    }
    std::tie(slide_start_, slide_end_, slide_travel_) = std::tuple(start, end, travel);
    slid_.clear();
    const double own = tissue_travel(*curve, travel);
    const double step = 0.5 * std::sqrt(order_.radius * travel);
    const int parts = std::clamp(static_cast<int>(std::ceil(length / step)), 4, 60);
    // The exponent of the force at this depth, by which the penalty's depth is taken out.
    const std::vector<Point>& points = curve->points;
    const Point& last = points.back();
    const double power = points.size() > 1
                             ? std::log(last.force / points[points.size() - 2].force) /
                                   std::log(last.travel / points[points.size() - 2].travel)
                             : 1.5;
    for (int k = 0; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      const auto found = go(start + share * (end - start), own);
      if (!found) return std::nullopt;
      slid_.emplace_back(share * length,
                         moment_of(*found, found->normal() * (1.0 + power * found->lost / own)));
    }
  }
  // The parabola through the three nearest points.
  std::size_t first = 0;
  while (first + 3 < slid_.size() && slid_[first + 1].first + slid_[first + 2].first < 2.0 * slid)
    ++first;
  Moment sum;
  for (std::size_t i = first; i < first + 3; ++i) {
    double weight = 1.0;
    for (std::size_t j = first; j < first + 3; ++j)
      if (j != i) weight *= (slid - slid_[j].first) / (slid_[i].first - slid_[j].first);
    sum.force += weight * slid_[i].second.force;
    sum.contact_radius += weight * slid_[i].second.contact_radius;
    sum.peak_pressure += weight * slid_[i].second.peak_pressure;
    sum.touching = std::max(sum.touching, slid_[i].second.touching);
  }
  return sum;
}

Extrapolated extrapolated(std::span<const double> per_radius, std::span<const double> forces) {
  const std::size_t n = forces.size();
  if (n == 1) return {forces[0], error_of_one_mesh * std::abs(forces[0])};
  // The line through the forces over the squared sizes x of elements; what scatters on a mesh
  // shrinks with x as well, so that the weights are 1/x^2.
  double weights = 0.0, mean_x = 0.0, mean_force = 0.0;
  const auto square = [&](std::size_t i) { return 1.0 / (per_radius[i] * per_radius[i]); };
  for (std::size_t i = 0; i < n; ++i) {
    const double x = square(i);
    weights += 1.0 / (x * x);
    mean_x += 1.0 / x;
    mean_force += forces[i] / (x * x);
  }
  mean_x /= weights;
  mean_force /= weights;
  double above = 0.0, below = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = square(i);
    above += (x - mean_x) * (forces[i] - mean_force) / (x * x);
    below += (x - mean_x) * (x - mean_x) / (x * x);
  }
  Extrapolated found{mean_force - above / below * mean_x, 0.0};
  found.error =
      std::max((n == 2 ? error_of_two_meshes : error_of_three_meshes) * std::abs(found.force),
               0.5 * std::abs(found.force - forces[n - 1]));
  if (n > 2)  // the last two alone say it as well
    found.error =
        std::max(found.error,
                 std::abs(found.force -
                          extrapolated(per_radius.subspan(n - 2), forces.subspan(n - 2)).force));
  return found;
}

}  // namespace palpate::solid
