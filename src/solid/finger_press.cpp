// Points of the curve, what lies between them, and the shares of an elastic finger.
#include "solid/finger_press.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/doing.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "contact/hertz.h"
#include "geometry/box.h"
#include "geometry/box_tree.h"
#include "geometry/surface.h"

namespace palpate::solid {
namespace {

constexpr double aside = 1e-3;  // for slopes

// In logarithms a parabola through three points, which goes over to the next one between the points
// that both pass through, so that the slope has no jumps. Below the first point its slope there
// goes over to `power`, that of the smallest contacts; beyond the last one it goes on straight.
double between(const Pairs& points, double x, double power) {
  if (!(x > 0.0)) return 0.0;
  const std::size_t count = std::min<std::size_t>(3, points.size());
  const auto through = [&](std::size_t first, double at) {
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
  const auto parabola = [&](double at) {
    std::size_t i = 0;  // of the point below
    while (i + 2 < points.size() && at > points[i + 1].first) ++i;
    const std::size_t last = points.size() - count;
    const std::size_t before = std::min(i > 0 ? i - 1 : 0, last), after = std::min(i, last);
    const double low = through(before, at);
    if (before == after) return low;
    const double part =
        std::log(at / points[i].first) / std::log(points[i + 1].first / points[i].first);
    return low + part * (through(after, at) - low);
  };
  const auto& [begin, value] = points.front();
  const auto& [end, last] = points.back();
  if (points.size() == 1) return value * std::pow(x / begin, power);
  if (x >= begin && x <= end) return std::exp(parabola(x));
  if (x > end) {
    const double slope = (std::log(last) - parabola(end * (1.0 - aside))) / -std::log(1.0 - aside);
    return last * std::pow(x / end, slope);
  }
  const double slope = (parabola(begin * (1.0 + aside)) - std::log(value)) / std::log(1.0 + aside);
  return value * std::pow(x / begin, power) * std::exp((slope - power) * (x / begin - 1.0));
}

// Where `below` changes from true to false between 0 and `most`.
template <class Below>
double root(double most, const Below& below) {
  double low = 0.0;
  double high = most;
  constexpr int halvings = 60;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (below(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
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

// What a share of the gap may add to the force before it is found anew.
constexpr double enough_excess = error_of_two_meshes;

}  // namespace

FingerPress::FingerPress(FingerOrder order)
    : order_(std::move(order)), settled_(!order_.ball.has_value()) {
  BodyOrder body = order_.body;
  body.radius = order_.radius / order_.share;
  body.travel = order_.deepest * order_.share;
  body.touched = {order_.touch.touched};
  if (order_.centres.size() > 1) {
    // A plane of symmetry passes through the finger's point, not through one of its spheres.
    body.touched.front().head<2>() = order_.touch.finger.head<2>();
    const geometry::BoxTree tree(order_.outer_surface->surface());
    for (const Vec3& centre : order_.centres) {
      const Vec3 place = order_.touch.finger + centre;
      body.touched.push_back(
          order_.outer_surface->closest_point(place, tree.nearest(place)).position);
    }
  }
  for (const int axis : {0, 1})
    body.mirrored[as_index(axis)] =
        body.mirrored[as_index(axis)] && mirrored(order_.centres, axis, 1e-6 * order_.radius);
  mirror_ = body.touched.front();
  press_ = std::make_unique<Press>(make_body(body));
  std::vector<Indenter> finger;
  for (const Vec3& centre : order_.centres)
    finger.push_back(Indenter::sphere(centre, order_.radius, order_.share));
  press_->set_finger(std::move(finger));
  begin(order_.in_steps);
}

void FingerPress::renew(double share) {
  FingerOrder order = order_;
  order.share = share;
  *this = FingerPress(std::move(order));
}

FingerPress::Mismatch FingerPress::mismatch(double travel) {
  const double own = tissue_travel(travel);
  if (tissue_.points.empty() || ball_.points.empty()) return {};
  Pairs ball;
  for (const Point& point : ball_.points)
    ball.emplace_back(point.travel / upright(), point.moment.spread);
  const double wider =
      between(of_tissue(&Moment::spread), own, 0.5) / between(ball, travel - own, 0.5);
  const double part = own / travel;
  return {wider, 1.5 * part * (1.0 - part) * std::pow(std::log(wider), 2)};
}

// Half-spaces would take the cube, which overshoots on a body whose curvature matters less.
double FingerPress::better_share(double wider) const {
  const double odds = order_.share / (1.0 - order_.share) * wider * wider;
  return odds / (1.0 + odds);
}

void FingerPress::settle_share() {
  constexpr int most_times = 5;
  double before = order_.share;
  double farthest = 0.0;
  for (int times = 0; !settled_ && order_.deepest > 0.0 && times < most_times; ++times) {
    (void)tissue_travel(order_.deepest);
    const double end = std::min(order_.deepest, found_to());
    if (end < farthest) {  // tissue that folds sooner under a flatter surface
      renew(before);
      break;
    }
    const Mismatch found = mismatch(end);
    if (found.excess <= enough_excess) break;
    before = order_.share;
    farthest = end;
    renew(better_share(found.wider));
  }
  settled_ = true;
}

void FingerPress::take_share(double share) {
  if (share != order_.share) renew(share);
  settled_ = true;
}

void FingerPress::begin(bool in_steps) {
  in_steps_ = in_steps;
  tissue_ = {};
  press_->begin(order_.touch.finger);
}

FingerPress* FingerPress::at(const Vec3& place) {
  if (place == Vec3::Zero()) return this;
  if (place_ == place) return beside_.get();
  place_ = place;
  const double share = beside_ ? beside_->order_.share : order_.share;
  beside_.reset();
  const auto touch = order_.beside(place);
  if (!touch) return nullptr;
  FingerOrder there = order_;
  there.share = share;
  there.deepest += touch->finger.z() - order_.touch.finger.z();
  there.touch = *touch;
  if (there.deepest > 0.0) beside_ = std::make_unique<FingerPress>(std::move(there));
  return beside_.get();
}

// The ball is pressed along the normal, the finger straight down; spheres of several are taken as
// pressed straight down.
double FingerPress::upright() const {
  if (order_.centres.size() > 1) return 1.0;
  return (order_.touch.finger - order_.touch.touched).z() / order_.radius;
}

// Presses the ball of an elastic finger, by the undeformed tissue, until it bears a force (N,
// upwards), or as far as there is an equilibrium.
void FingerPress::press_ball(double force) {
  const double part = (1.0 - order_.share) * order_.deepest;
  if (!ball_press_) {
    ball_press_ = std::make_unique<Press>(
        make_ball(order_.radius, order_.deepest, part, *order_.ball, order_.body.per_radius));
    ball_press_->set_finger({{.pole = order_.radius * Vec3::UnitZ(),
                              .curvature = order_.curvatures,
                              .share = 1.0 - order_.share}});
    ball_press_->begin(Vec3::Zero());
  }
  const auto bears = [&] {
    return !ball_.points.empty() && ball_.points.back().force * upright() >= force;
  };
  // Hertz's depth, but for a factor: a finger on a soft wall hardly yields.
  const double modulus = order_.ball->young_modulus;
  const double expected = std::pow(force / (modulus * std::sqrt(order_.radius)), 2.0 / 3.0);
  while (ball_.end == End::open &&
         ((ball_.points.size() < 3 && ball_.reached < part) || !bears())) {
    const double next = ball_.reached == 0.0   ? std::min(0.25 * part, expected)
                        : ball_.reached < part ? 2.0 * ball_.reached
                                               : 1.5 * ball_.reached;
    const auto found = ball_press_->go(-next / (1.0 - order_.share) * Vec3::UnitZ());
    if (!found && bears()) return;
    if (!found) {
      ball_.end = End::folds;
      return;
    }
    ball_.reached = next;
    // A small contact may touch no point of the ball's elements, or lose its travel in the penalty;
    // so may one around the whole ball, which no soft tissue reaches.
    constexpr double least = 0.1;
    const double travel = std::max(next - found->lost, least * next);
    if (found->normal() > 0.0 && (ball_.points.empty() || travel > ball_.points.back().travel))
      ball_.points.push_back({travel, found->normal(), moment_of(*found, found->normal())});
  }
}

FingerPress::OuterSurface FingerPress::surface_at(double travel, const Vec3& place) {
  OuterSurface outer_surface;
  FingerPress* const there = at(place);
  if (there == nullptr) return outer_surface;
  if (there != this) return there->surface_at(travel + higher(*there), Vec3::Zero());
  const Vec3 finger = order_.touch.finger - travel * Vec3::UnitZ();
  const auto moved = press_->look(finger);
  if (!moved) return outer_surface;
  outer_surface.finger = press_->finger_at(finger);
  const Body& body = press_->body();
  const std::vector<Vec3> tractions = press_->tractions(*moved, finger);
  constexpr std::array<std::size_t, 6> turned_over{0, 2, 1, 5, 4, 3};
  for (const OuterFace& face : body.met) {
    std::array<Vec3, 6> places;
    for (std::size_t i = 0; i < 6; ++i) places[i] = body.mesh.nodes[as_index(face.nodes[i])];
    const Vec3 normal = (places[1] - places[0]).cross(places[2] - places[0]).normalized();
    std::array<double, 6> lifts{};
    std::array<Vec3, 6> changes;
    for (std::size_t i = 0; i < 6; ++i) {
      changes[i] = moved->segment<3>(3 * face.nodes[i]);
      lifts[i] = normal.dot(changes[i]);
      places[i] += changes[i];
    }
    for (int copy = 0; copy < 4; ++copy) {
      const std::array<bool, 2> across{(copy & 1) != 0, (copy & 2) != 0};
      if ((across[0] && !body.mirrored[0]) || (across[1] && !body.mirrored[1])) continue;
      std::array<Vec3, 6>& image = outer_surface.faces.emplace_back();
      std::array<Vec3, 6>& its_changes = outer_surface.displacements.emplace_back();
      std::array<double, 6>& its_lifts = outer_surface.lifts.emplace_back();
      std::array<Vec3, 6>& its_tractions = outer_surface.tractions.emplace_back();
      for (std::size_t i = 0; i < 6; ++i) {
        const std::size_t from = across[0] != across[1] ? turned_over[i] : i;
        const int node = face.nodes[from];
        image[i] = places[from];
        its_changes[i] = changes[from];
        its_lifts[i] = lifts[from];
        its_tractions[i] = tractions[as_index(node)];
        for (std::size_t axis = 0; axis < 2; ++axis) {
          const auto along = static_cast<Eigen::Index>(axis);
          const double mirror = mirror_[along];
          if (across[axis]) {
            image[i][along] = 2.0 * mirror - image[i][along];
            its_changes[i][along] *= -1.0;
            its_tractions[i][along] *= -1.0;
          }
          if (body.mirrored[axis] && body.mesh.nodes[as_index(node)][along] == mirror)
            its_tractions[i][along] = 0.0;  // by both sides of the mirror
        }
      }
    }
  }
  return outer_surface;
}

Moment FingerPress::moment_of(const Answer& answer, double force) {
  return {force, std::sqrt(answer.area / std::numbers::pi), answer.peak, answer.touching,
          answer.spread};
}

std::optional<Answer> FingerPress::go(double travel) {
  const double share = std::min(1.0, tissue_.reached / (order_.share * order_.deepest));
  const double done = order_.done[0] + share * (order_.done[1] - order_.done[0]);
  set_doing({order_.part + std::to_string(press_->body().mesh.nodes.size()) + " nodes, press to " +
                 rounded_text(unit::mm.from_si(travel / order_.share), 3) + " of " +
                 rounded_text(unit::mm.from_si(order_.deepest), 3) + " mm",
             static_cast<std::size_t>(100.0 * done), 100});
  auto found = press_->go(order_.touch.finger - travel / order_.share * Vec3::UnitZ());
  if (!found) tissue_.end = press_->walls_meet() ? End::closes : End::folds;
  return found;
}

// The finger's travel at the end of the curves: where the ball bears the tissue's last force, or
// the tissue that of a ball that bears no more, m.
double FingerPress::found_to() const {
  if (!order_.ball) return tissue_.reached;
  if (tissue_.points.empty() || ball_.points.empty())  // Hertz's shares
    return std::max(tissue_.reached / order_.share, ball_.reached / (1.0 - order_.share));
  const Pairs tissue = of_tissue(&Moment::force);
  const Pairs ball = of_balls(tissue_.points.back().moment.touching);
  const double ball_end = ball_.reached / upright();
  if (ball_.end == End::open) {
    const double force = between(tissue, tissue_.reached, 1.5);
    return tissue_.reached +
           root(ball_end, [&](double at) { return between(ball, at, 1.5) < force; });
  }
  const double force = between(ball, ball_end, 1.5);
  return ball_end +
         root(tissue_.reached, [&](double at) { return between(tissue, at, 1.5) < force; });
}

std::string FingerPress::end_text() const {
  if (ball_.end == End::open && !(tissue_.reached > 0.0))
    return "the body gives way sideways as soon as the finger touches it: press it nearer to where "
           "it is fixed, or across its length (`finger.towards`), or fix more of it "
           "(`tissue.base_height`, `tissue.base_side`)";
  const std::string beyond =
      " beyond a displacement of " + rounded_text(unit::mm.from_si(found_to()), 3) + " mm";
  if (ball_.end != End::open)
    return "the solid finds no equilibrium of the finger's ball" + beyond + "; press less deep";
  if (tissue_.end == End::closes)
    return "the walls of the hollow under the finger meet" + beyond +
           ", and the solid has no contact between them; press less deep";
  if (tissue_.end == End::snaps)
    return "a wall snaps away from the finger" + beyond + "; press less deep";
  return "the solid finds no equilibrium" + beyond +
         ": the tissue folds, or a wall buckles there; press less deep";
}

// Points at a quarter and half of the order's travel and there, and beyond it by up to half more at
// a time: the curve does not depend on what was asked first. Where it is no power law, it is found
// again in steps of a sixteenth, after two shorter ones. Where there is no equilibrium, the last
// point is as deep as one was found.
bool FingerPress::reach(double travel) {
  // Below this the finger touches nothing: the wall has jumped to its other side.
  constexpr double bearing = 1e-8;  // of E, radius and travel
  const double modulus = order_.body.tissues.front().young_modulus;
  bool lost = false;
  const auto take = [&](double at, const std::optional<Answer>& answer) {
    if (!answer) return;
    lost = answer->normal() < bearing * modulus * order_.radius * at;
    if (lost && in_steps_ && !tissue_.points.empty()) {
      tissue_.end = End::snaps;
      return;
    }
    tissue_.reached = at;
    if (!lost && at > answer->lost)
      tissue_.points.push_back(
          {at - answer->lost, answer->normal(), moment_of(*answer, answer->normal())});
  };
  const double deepest = order_.share * order_.deepest;
  while (tissue_.end == End::open && tissue_.reached < std::max(deepest, travel)) {
    double next = tissue_.reached > 0.0 ? 2.0 * tissue_.reached : 0.25 * deepest;
    if (tissue_.reached >= deepest) next = std::min(next, 1.5 * tissue_.reached);
    if (in_steps_) {
      constexpr double steps = 16.0;
      const double step = deepest / steps;
      const double after = (std::round(tissue_.reached / step) + 1.0) * step;
      // A force may need many times the displacement that Hertz's law has.
      const double beyond = (1.0 + 1.0 / steps) * tissue_.reached;
      next = tissue_.reached > 0.0 ? std::min(2.0 * tissue_.reached, std::max(after, beyond))
                                   : 0.25 * step;
    }
    take(next, go(next));
    if (!in_steps_ && (lost || !is_power_law() || tissue_.points.empty())) {
      begin(true);
      continue;
    }
    if (tissue_.end == End::open) continue;
    if (lost) break;
    constexpr double farther = 1.02;
    const double found = order_.share * (order_.touch.finger.z() - press_->reached().z());
    if (found > farther * tissue_.reached) take(found, press_->go(press_->reached()));
  }
  return travel <= tissue_.reached;
}

// The exponent of the force over the travel is 1.5 of a small contact, 1 of a plate that bends, and
// rises with depth; less, or a sudden rise, is a wall that gives way.
bool FingerPress::is_power_law() const {
  constexpr double least = 0.8;
  constexpr double most_change = 1.0;
  double before = HUGE_VAL;
  for (std::size_t i = 1; i < tissue_.points.size(); ++i) {
    const Point& one = tissue_.points[i - 1];
    const Point& next = tissue_.points[i];
    const double power = std::log(next.force / one.force) / std::log(next.travel / one.travel);
    if (power < least || power > before + most_change) return false;
    before = power;
  }
  return true;
}

std::optional<std::pair<double, double>> FingerPress::snap() const {
  constexpr double least = 0.02;  // more than what Newton's steps leave
  const std::vector<Point>& points = tissue_.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::size_t end = i;
    while (end + 1 < points.size() && points[end + 1].force < points[end].force) ++end;
    if (points[end].force < (1.0 - least) * points[i].force)
      return std::pair(points[i].travel, points[end].travel);
    i = end;
  }
  return std::nullopt;
}

// On a half-space of the tissue at the surface, with its share of the curvatures of the gap; of a
// sphere with the product of these, nearly as an ellipse has it.
Moment FingerPress::by_hertz(double travel) const {
  namespace hertz = contact::hertz;
  const tissue::Isotropic& tissue = tissue_at_top(press_->body());
  const contact::Elastic elastic{tissue.young_modulus, tissue.poisson_ratio};
  const auto& [along_x, along_y] = order_.curvatures;
  const double radius = contact::geometric_radius(order_.radius, along_x, along_y) / order_.share;
  const double force =
      hertz::force(travel, radius, hertz::effective_modulus(0.0, elastic.compliance()));
  const double a = hertz::contact_radius(travel, radius);
  return {force, a, hertz::peak_pressure(force, a), 1, std::sqrt(0.4) * a};
}

// A quantity over the tissue's travel. The elements are too large for a contact much smaller than
// that of the first point: what size, base and layers change there fades with the contact radius.
Pairs FingerPress::of_tissue(double Moment::*value) const {
  Pairs found;
  const Point& first = tissue_.points.front();
  if (order_.smooth) {
    // The depth at which Hertz's contact has the force of the first point.
    const double depth =
        first.travel * std::pow(first.moment.force / by_hertz(first.travel).force, 2.0 / 3.0);
    const double other = first.moment.*value / (by_hertz(depth).*value);
    for (const double part : {1.0 / 16.0, 1.0 / 4.0}) {
      const double travel = part * first.travel;
      // A body that yields is a spring behind the contact.
      const double at =
          depth < first.travel
              ? root(travel,
                     [&](double trial) {
                       return trial + (first.travel - depth) * std::pow(trial / depth, 1.5) <
                              travel;
                     })
              : travel * std::pow(depth / first.travel, std::sqrt(part));
      found.emplace_back(travel, by_hertz(at).*value * std::pow(other, std::sqrt(part)));
    }
  }
  for (const Point& point : tissue_.points) found.emplace_back(point.travel, point.moment.*value);
  return found;
}

Pairs FingerPress::of_balls(int number) const {
  Pairs found;
  for (const Point& point : ball_.points)
    found.emplace_back(point.travel / upright(), point.force * upright() * std::max(1, number));
  return found;
}

double FingerPress::shared(const Pairs& tissue, const Pairs& balls, double travel, double power) {
  return root(travel, [&](double own) {
    return between(tissue, own, power) < between(balls, travel - own, 1.5);
  });
}

// Both curves are found as far as that takes; the last few per cent go on straight.
double FingerPress::tissue_travel(double travel) {
  const double expected = order_.share * travel;
  (void)reach(expected);
  if (!order_.ball || tissue_.points.empty()) return expected;
  for (;;) {
    const Point& last = tissue_.points.back();
    press_ball(last.force / std::max(1, last.moment.touching));
    if (ball_.points.empty()) return expected;
    const double own =
        shared(of_tissue(&Moment::force), of_balls(last.moment.touching), travel, 1.5);
    constexpr double straight = 1.05;
    if (ball_.end != End::open || own <= straight * tissue_.reached || !reach(own)) return own;
  }
}

std::optional<Moment> FingerPress::once(double travel, double power) {
  if (!(travel > 0.0)) return Moment{};
  const double own = order_.share * travel;
  const auto answer = go(own);
  if (!answer) {
    tissue_.reached = order_.share * (order_.touch.finger.z() - press_->reached().z());
    reason_ = end_text();
    return std::nullopt;
  }
  if (!(answer->normal() > 0.0)) return Moment{};
  const Pairs alone{{own - answer->lost, answer->normal()}};
  if (order_.ball) press_ball(answer->normal() / std::max(1, answer->touching));
  if (ball_.end != End::open) {
    reason_ = end_text();
    return std::nullopt;
  }
  const double met = order_.ball ? shared(alone, of_balls(answer->touching), travel, power) : own;
  return moment_of(*answer, between(alone, met, power));
}

std::optional<Moment> FingerPress::at_travel(double travel, const Vec3& place) {
  FingerPress* const there = at(place);
  if (there == nullptr) return Moment{};
  if (there != this) {
    auto found = there->at_travel(travel + there->order_.touch.finger.z() - order_.touch.finger.z(),
                                  Vec3::Zero());
    if (!found) reason_ = there->reason_;
    return found;
  }
  if (!(travel > 0.0)) return Moment{};
  settle_share();
  auto found = on_curve(travel);
  if (!found || !order_.ball || order_.shallower) return found;
  if (!has_knots_) find_knots();
  if (knots_.empty()) return found;
  const Knot& first = knots_.front();
  if (travel <= first.travel) return first.press->on_curve(travel);
  // Factors between the knots, and 1 at the deepest travel.
  auto next = std::find_if(knots_.begin(), knots_.end(),
                           [&](const Knot& knot) { return knot.travel >= travel; });
  const Knot& before = *std::prev(next);
  const double end = next == knots_.end() ? order_.deepest : next->travel;
  const double part =
      std::min(1.0, std::log(travel / before.travel) / std::log(end / before.travel));
  const auto correct = [&](double Moment::*value) {
    const double last = next == knots_.end() ? 1.0 : next->factor.*value;
    const double factor = std::pow(before.factor.*value, 1.0 - part) * std::pow(last, part);
    (*found).*value *= factor;
    return factor;
  };
  found->excess = std::max(0.0, found->excess - std::abs(1.0 - correct(&Moment::force)));
  (void)correct(&Moment::contact_radius);
  (void)correct(&Moment::peak_pressure);
  return found;
}

// Where the share of the deepest travel is not that of a smaller one.
void FingerPress::find_knots() {
  has_knots_ = true;
  for (const double part : {0.25, 0.5}) {
    const double travel = part * order_.deepest;
    const auto own = on_curve(travel);
    if (!own || own->excess <= enough_excess) continue;
    FingerOrder order = order_;
    order.deepest = travel;
    order.share = better_share(mismatch(travel).wider);
    order.shallower = true;
    Knot knot{travel, std::make_unique<FingerPress>(std::move(order)), {}};
    const auto best = knot.press->at_travel(travel);
    if (!best || !(best->force > 0.0)) continue;
    for (double Moment::*const value :
         {&Moment::force, &Moment::contact_radius, &Moment::peak_pressure})
      knot.factor.*value = (*best).*value / (*own).*value;
    knots_.push_back(std::move(knot));
  }
}

std::optional<Moment> FingerPress::on_curve(double travel) {
  const double own = tissue_travel(travel);
  if ((tissue_.end != End::open && own > tissue_.reached) ||
      (ball_.end != End::open && (travel - own) * upright() > ball_.reached)) {
    reason_ = end_text();
    return std::nullopt;
  }
  if (tissue_.points.empty()) {
    reason_ = "the finger meets nothing of the mesh up to a displacement of " +
              rounded_text(unit::mm.from_si(found_to()), 3) +
              " mm: the body is narrower there than its elements; press it at another place, or "
              "give its surface finer triangles there";
    return std::nullopt;
  }
  const auto nearest = std::find_if(tissue_.points.begin(), tissue_.points.end(),
                                    [&](const Point& point) { return point.travel >= own; });
  const Point& near = nearest == tissue_.points.end() ? tissue_.points.back() : *nearest;
  const auto now = [&](double Moment::*value, double power) {
    return between(of_tissue(value), own, power);
  };
  Moment found{now(&Moment::force, 1.5), now(&Moment::contact_radius, 0.5),
               now(&Moment::peak_pressure, 0.5), near.moment.touching};
  if (order_.ball) found.excess = mismatch(travel).excess;
  return found;
}

std::optional<Moment> FingerPress::at_slide(double travel, const Vec3& start, const Vec3& end,
                                            double slid) {
  const double length = (end - start).norm();
  if (slid_.empty() || slide_start_ != start || slide_end_ != end || slide_travel_ != travel) {
    std::tie(slide_start_, slide_end_, slide_travel_) = std::tuple(start, end, travel);
    slid_.clear();
    const double step = std::sqrt(order_.radius * std::max(travel, 0.0));
    const int parts =
        std::clamp(static_cast<int>(std::ceil(length / std::max(step, 1e-3 * length))), 4, 60);
    const auto begun = at_travel(travel, start);
    if (!begun) return std::nullopt;
    slid_.emplace_back(0.0, *begun);
    // The exponent of the force at this depth.
    double power = 1.5;
    if (const auto less = at_travel((1.0 - aside) * travel, start); less && begun->force > 0.0)
      power = std::log(less->force / begun->force) / std::log(1.0 - aside);
    for (int k = 1; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      order_.part = "place " + std::to_string(k + 1) + " of " + std::to_string(parts + 1) + ", ";
      FingerPress* const there = at(start + share * (end - start));
      order_.part.clear();
      const auto found = there == nullptr ? std::optional(Moment{})
                         : there == this  ? at_travel(travel, Vec3::Zero())
                                          : there->once(travel + higher(*there), power);
      if (!found) {
        reason_ = there->reason_;
        return std::nullopt;
      }
      slid_.emplace_back(share * length, *found);
    }
  }
  // The cubic through the four nearest points.
  constexpr std::size_t count = 4;
  std::size_t first = 0;
  while (first + count < slid_.size() &&
         slid_[first + 1].first + slid_[first + 2].first < slid * 2.0)
    ++first;
  Moment sum;
  for (std::size_t i = first; i < first + count; ++i) {
    double weight = 1.0;
    for (std::size_t j = first; j < first + count; ++j)
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
  // Finer elements are softer. Where a force rises it scatters from mesh to mesh, as that of a wall
  // of few elements does, and two are as good as one.
  if (n == 2 && forces[1] - forces[0] > error_of_three_meshes * std::abs(found.force))
    found.error = std::max(found.error, error_of_one_mesh * std::abs(found.force));
  if (n > 2)  // the last two alone say it as well
    found.error =
        std::max(found.error,
                 std::abs(found.force -
                          extrapolated(per_radius.subspan(n - 2), forces.subspan(n - 2)).force));
  return found;
}

}  // namespace palpate::solid
