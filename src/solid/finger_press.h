// A finger on a solid: the force at any travel and on the way of slides.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geometry/smooth_surface.h"
#include "solid/press.h"
#include "solid/pressed_body.h"

namespace palpate::solid {

// Where the finger comes down: its point at travel 0, and the place of the body that it touches, m.
struct Touch {
  Vec3 finger = Vec3::Zero();
  Vec3 touched = Vec3::Zero();
};

// A press: the body, the finger and its way.
struct FingerOrder {
  // Its radius, travel, touched places and mirrors are set by FingerPress.
  BodyOrder body;
  const geometry::SmoothSurface* outer_surface = nullptr;  // of the body, for several spheres
  std::vector<Vec3> centres{Vec3::Zero()};     // m, of the spheres, from the finger's point
  double radius = 0.0;                         // m, of each
  std::optional<tissue::Isotropic> ball = {};  // an elastic finger's; of one sphere
  double share = 1.0;    // a first guess of the tissue's share of the gap; 1 if the finger is rigid
  double deepest = 0.0;  // m, travel of the finger
  bool in_steps = false;  // from the beginning, where a wall may buckle
  Touch touch;
  std::array<double, 2> curvatures{};  // 1/m, of the body there along x and y, above 0 if convex
  bool smooth = false;     // whether these are known, and a small contact of one sphere is Hertz's
  bool shallower = false;  // the press is a knot of a deeper one
  // The touch with the finger at a place beside it (m); nothing where it passes beside the body.
  std::function<std::optional<Touch>(const Vec3& place)> beside = {};
  std::string part = {};                 // of a longer way, for the progress of the run
  std::array<double, 2> done{0.0, 1.0};  // of all meshes' work, before and after this press
};

// Of a travel (m) and another quantity, ascending.
using Pairs = std::vector<std::pair<double, double>>;

// Force over travel or slide by a few equilibria and what lies between them.
struct Moment {
  double force = 0.0;           // N, upwards
  double contact_radius = 0.0;  // m, of the circle with the area of the contact
  double peak_pressure = 0.0;   // Pa
  int touching = 0;             // spheres in contact
  double spread = 0.0;          // m, root mean square distance of the pressure from the pole
  double excess = 0.0;  // a fraction of the force, what the share of an elastic finger's gap adds
};

// Nothing depends on time, so that a press is one curve of force over travel: Newton's method finds
// its points at a quarter and half of the deepest travel and there, or where a wall buckles in
// short steps, and the logarithm of the force is a parabola of that of the travel between them.
// Below the first point the contact becomes Hertz's on the tissue at the surface.
// An elastic finger is a ball of its own radius: each body takes its share of the curvature of the
// gap between them, ball and tissue are pressed by the rigid surface between their shares, and
// their travels at equal forces add. Of all shares those have the least energy, and so the force,
// with which the pressures on both are equally wide.               docs/theory.md [solid_force]
class FingerPress {
 public:
  // What the order points to must outlive the call. Throws MeshError.
  explicit FingerPress(FingerOrder order);

  // At a place beside the first touch (m). Nothing beyond the last equilibrium that was found;
  // reason() then says why. Throws Stopped.
  [[nodiscard]] std::optional<Moment> at_travel(double travel, const Vec3& place = Vec3::Zero());
  // At one travel after `slid` m of a slide from `start` to `end`, which are places beside the
  // first touch (m): presses at places a contact radius apart, and cubics between them. They are
  // found with the first call.
  [[nodiscard]] std::optional<Moment> at_slide(double travel, const Vec3& start, const Vec3& end,
                                               double slid);
  [[nodiscard]] const std::string& reason() const { return reason_; }
  // Finds the tissue's share of the gap by some presses to the deepest travel; it is the order's if
  // the finger is rigid. Throws MeshError, Stopped.
  void settle_share();
  void take_share(double share);  // of another mesh. Throws MeshError.
  [[nodiscard]] double share() const { return order_.share; }
  // Whether a wall gives way, as far as the curve has been found, so that it is found in steps.
  [[nodiscard]] bool buckles() const { return in_steps_ && !(order_.in_steps && is_power_law()); }
  // The displacements (m) between which the force first falls by 2 % or more, as far as the
  // curve has been found: the wall snaps through.
  [[nodiscard]] std::optional<std::pair<double, double>> snap() const;

  // The surface that may be met at a place beside the first touch, displaced, with all copies that
  // the mirrors make: the nodes of its faces, in the order of solid::Face. With the finger there.
  // Empty where no equilibrium is found.
  struct OuterSurface {
    std::vector<std::array<Vec3, 6>> faces;          // m
    std::vector<std::array<Vec3, 6>> displacements;  // m, of these
    std::vector<std::array<double, 6>> lifts;    // m, of these along the face's undeformed normal
    std::vector<std::array<Vec3, 6>> tractions;  // Pa, on the tissue at these
    std::vector<Indenter> finger;
  };
  [[nodiscard]] OuterSurface surface_at(double travel, const Vec3& place);

  [[nodiscard]] const Press& press() const { return *press_; }

 private:
  struct Point {
    double travel = 0.0;  // m, without what the penalty lets through
    double force = 0.0;   // N
    Moment moment;
  };
  // Why a curve has no more points.
  enum class End { open, folds, snaps, closes };
  // The force on the tissue, or on the ball, over its part of the travel.
  struct Curve {
    std::vector<Point> points = {};
    double reached = 0.0;  // m, travel at the last of them, with what is lost
    End end = End::open;
  };
  [[nodiscard]] Pairs of_tissue(double Moment::*value) const;
  [[nodiscard]] Moment by_hertz(double travel) const;
  // Of so many balls, of which each bears its part of the force.
  [[nodiscard]] Pairs of_balls(int number) const;
  // Finds the curve of the tissue up to a travel of its own (m); false where it ends before.
  [[nodiscard]] bool reach(double travel);
  [[nodiscard]] double found_to() const;
  [[nodiscard]] std::string end_text() const;  // why there is no equilibrium, and from where on
  [[nodiscard]] bool is_power_law() const;
  [[nodiscard]] std::optional<Answer> go(double travel);
  [[nodiscard]] static Moment moment_of(const Answer& answer, double force);
  // The press at a place beside the touch, made when it is first asked for; null where the finger
  // passes beside the body.
  [[nodiscard]] FingerPress* at(const Vec3& place);
  // How much higher the finger first touches there than here, m.
  [[nodiscard]] double higher(const FingerPress& there) const {
    return there.order_.touch.finger.z() - order_.touch.finger.z();
  }
  void renew(double share);  // all anew, by another share
  void begin(bool in_steps);
  void press_ball(double force);
  [[nodiscard]] double upright() const;
  // The tissue's part of a travel with which both bodies have one force. Forces of one point go on
  // with `power`.
  [[nodiscard]] double tissue_travel(double travel);
  // The force at a travel by the share at hand.
  [[nodiscard]] std::optional<Moment> on_curve(double travel);
  // The share of the deepest travel may not be that of smaller ones: presses to a quarter and half
  // of it with their own, whose values over those of the curve at hand are kept.
  struct Knot {
    double travel = 0.0;  // m
    std::unique_ptr<FingerPress> press;
    Moment factor;
  };
  void find_knots();
  // At a travel: the width of the pressure on the tissue over that on the ball, and what that adds
  // to the force, a fraction; of two half-spaces.                  docs/theory.md [solid_force]
  struct Mismatch {
    double wider = 1.0;
    double excess = 0.0;
  };
  [[nodiscard]] Mismatch mismatch(double travel);
  [[nodiscard]] double better_share(double wider) const;
  [[nodiscard]] static double shared(const Pairs& tissue, const Pairs& balls, double travel,
                                     double power);
  // The force at one travel alone, with the exponent of the force there.
  [[nodiscard]] std::optional<Moment> once(double travel, double power);

  FingerOrder order_;
  bool settled_ = false;        // its share
  Vec3 mirror_ = Vec3::Zero();  // m, a point of the planes of symmetry
  std::unique_ptr<Press> press_;
  Curve tissue_;
  bool in_steps_ = false;
  std::unique_ptr<Press> ball_press_;  // of an elastic finger
  Curve ball_;
  std::vector<Knot> knots_;
  bool has_knots_ = false;
  Vec3 place_ = Vec3::Zero();  // m, of the last press beside the touch
  std::unique_ptr<FingerPress> beside_;
  std::string reason_;
  // The slide at hand.
  Vec3 slide_start_ = Vec3::Zero(), slide_end_ = Vec3::Zero();
  double slide_travel_ = 0.0;
  std::vector<std::pair<double, Moment>> slid_;
};

// What the meshes of SolidPress state at least, a fraction of the force: counted on the bodies of
// docs/accuracy.md.                                                      docs/theory.md
// [solid_force]
inline constexpr double error_of_one_mesh = 0.03;
inline constexpr double error_of_two_meshes = 0.01;
inline constexpr double error_of_three_meshes = 0.005;
// Elements follow the width of the contact on a sharp edge down to this, over that on a flat: finer
// meshes take minutes. The stated error grows beyond.
inline constexpr double most_narrowed = 0.5;

// A force on finer and finer meshes: that of an infinitely fine one, with its error, N. Errors fall
// with the square of the elements' size; `per_radius` are the numbers of elements in a contact
// radius, ascending, one per force.                                      docs/theory.md
// [solid_force]
struct Extrapolated {
  double force = 0.0;
  double error = 0.0;
};
[[nodiscard]] Extrapolated extrapolated(std::span<const double> per_radius,
                                        std::span<const double> forces);

}  // namespace palpate::solid
