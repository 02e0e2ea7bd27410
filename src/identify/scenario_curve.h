// The curve that a scenario computes, at the points of a measurement, to whose end its loading
// history is lengthened; and the one model for a whole search: a change of model would make the
// curve discontinuous.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/units.h"
#include "identify/unknowns.h"
#include "scenario/resolved.h"
#include "scene/specimen_shape.h"

namespace palpate::identify {

struct FixedModel {
  scenario::Case one;  // every `auto` is replaced by the choice made for it
  scenario::Model model = scenario::Model::hertz;
  bool given = false;        // the scenario names the model
  double worst_error = 0.0;  // relative; the largest estimate at the corners and the middle

  // The case at these values of the unknowns (SI, in their order).
  [[nodiscard]] scenario::Case at(std::span<const Unknown> unknowns,
                                  std::span<const double> values) const;
};

// Returns the cheapest model whose estimated error is within `solver.tolerance` at the corners and
// in the middle of the box (more than 5 unknowns: at the ends of each, the others in the middle);
// if there is none, the model with the smallest worst error. Viscosity in the contact, inertia or
// the factor of deep presses is used throughout if any of these points needs it; inertia is
// neglected of the flow between platens. `document` gives messages their place. Throws InputError
// with the problems of the middle if the scenario is invalid at all of these points.
[[nodiscard]] FixedModel fix_model(const scenario::Case& one, const Node& document,
                                   std::span<const Unknown> unknowns);

// Relative change of a specimen's flow by its lowest axial wave, 1 / (omega_1 tau)^2 with omega_1
// of theory.md [damping]. Nothing unless a cuboid of Kelvin-Voigt or SLS tissue is between platens.
[[nodiscard]] std::optional<double> inertia_of_flow(const scenario::Resolved& scenario);

// Estimated relative error of the model that this case names; nothing if there is no estimate.
[[nodiscard]] std::optional<double> predicted_error(const scenario::Case& fixed);

// Relative change of the force at the deepest travel by the factor of deep presses (docs/theory.md
// [deep]); nothing where the case does not use it.
[[nodiscard]] std::optional<double> deep_effect(const scenario::Case& fixed);

struct Measurement {
  std::vector<double> x, y;    // SI
  std::string x_name, y_name;  // of the columns, as given by the user
  Dimension x_dimension = {}, y_dimension = {};
  std::vector<double> starts = {};  // of x, other than 0, that the rows leave open: a step's
};

// The curve of a scenario that was measured.
enum class CurveKind {
  force_travel,
  force_time,
  tangential_slide,
  strain_time,
  stress_time,
  stress_strain
};

struct CurveWords {
  const char* sentence;  // such as "normal force over time"
  Unit x, y;             // in tables; a strain has an empty symbol
  const char *x_column, *y_column;
};
[[nodiscard]] const CurveWords& words_of(CurveKind kind);

// Chooses the curve by the dimensions of the columns and the steps of the scenario. For force over
// a length and a scenario with a slide it is the tangential force if `contact.friction` is an
// unknown or a column's name contains tangential, friction, shear, lateral or slide. Throws
// InputError if the scenario has no such curve.
[[nodiscard]] CurveKind curve_of(const Measurement& measured, const scenario::Scenario& scenario,
                                 std::span<const Unknown> unknowns);

// The part of the scenario that must run for the curve: without later steps and without maps. For
// force over travel, a press to a force goes to the travel `farthest` (m; at most the finger's
// radius) instead, because the travel at a force depends on the unknowns.
[[nodiscard]] scenario::Scenario part_for(CurveKind kind, const scenario::Scenario& scenario,
                                          double farthest);

// A curve that has a formula.
struct ClosedCurve {
  enum class Form {
    hertz_press,
    voigt_creep,
    solid_creep,
    solid_relaxation,
    voigt_compression,
    solid_compression
  };
  // The parameters of the formulas; each is an unknown or has its value in `known`.
  enum Slot { modulus, poisson, time, ratio, contact_point, force_offset, slots };
  using Parameters = std::array<double, slots>;  // SI

  Form form = Form::hertz_press;
  Parameters known{};
  std::vector<Slot> slot_of;  // one per unknown

  double radius = 0.0;             // m, of the finger
  double finger_compliance = 0.0;  // 1/Pa, lambda_1
  double load = 0.0;               // creep: stress, Pa; otherwise strain
  double load_time = 0.0;          // s, duration of the stress, or of the growth of the strain
  bool over_strain = false;        // compression: x is the strain while it grows

  [[nodiscard]] double value(const Parameters& p, double x) const;  // SI
};

class ScenarioCurve {
 public:
  // Keeps references to family and unknowns.
  ScenarioCurve(CurveKind kind, FixedModel model, const scenario::Family& family,
                std::span<const Unknown> unknowns);

  void set_points(std::vector<double> x) { x_ = std::move(x); }
  // From now on every run of the loading history reaches this x of the measurement (SI).
  void set_farthest(double farthest) { farthest_ = farthest; }
  // Shifts the contact point, or time zero, to a later x by `shift` (SI). Points that then lie
  // beyond the last row are extrapolated from the last two rows.
  void set_shift(double shift) { shift_ = shift; }

  // Runs the scenario with these values of the unknowns (SI) and returns its rows, SI, by ascending
  // x. Nothing if the scenario is invalid with these values, diverges or is interrupted.
  struct Rows {
    std::vector<double> x, y;
  };
  [[nodiscard]] std::optional<Rows> rows(std::span<const double> values);

  // Computes the curve at the points for u in [0, 1]; false, with a failure(), if it cannot. By a
  // formula, where it has one: an elastic, shallow Hertz press on a flat surface, or one creep,
  // relaxation or compression step of a cuboid of one tissue between sliding platens, whose model
  // is not named.
  [[nodiscard]] bool evaluate(std::span<const double> u, std::span<double> out);
  [[nodiscard]] bool has_formula() const { return formula_.has_value(); }
  // The same by running the scenario.
  [[nodiscard]] bool run(std::span<const double> u, std::span<double> out);

  // Why the last evaluation failed.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  // The case with the scenario's values of the unknowns, and with `values` (SI) instead.
  [[nodiscard]] const scenario::Resolved& fixed() const { return fixed_; }
  [[nodiscard]] scenario::Case at(std::span<const double> values) const {
    return model_.at(unknowns_, values);
  }
  [[nodiscard]] CurveKind kind() const { return kind_; }

 private:
  [[nodiscard]] std::optional<ClosedCurve> formula() const;

  CurveKind kind_;
  FixedModel model_;
  scenario::Resolved fixed_;
  const scenario::Family* family_;
  std::span<const Unknown> unknowns_;
  std::vector<double> x_;
  std::optional<ClosedCurve> formula_;
  scene::SpecimenShapes shapes_;
  double shift_ = 0.0;
  std::optional<double> farthest_;
  bool shape_varies_ = false;
  std::string failure_;
};

// Lengthens the step that ends the curve so that the loading history reaches `farthest` (a travel
// or a slide, m, or a time, s): the first `indent` with a travel, the first `slide`, or a last
// `hold`, `relax`, `creep` (its recovery) or `indent`. Nothing is shortened. Returns whether a step
// has changed; a step that ends at a force, and a last `retract` or `slide` over time, stay.
bool lengthen(CurveKind kind, scenario::Scenario& scenario, double farthest);

// The duration of the loading history, s; nothing if a step ends at a force, at a time that is not
// known.
[[nodiscard]] std::optional<double> duration(const scenario::Scenario& scenario);

// On the default block where the scenario of a press names no body, and by how much its force at
// the deepest is above that of a half-space, with these values of the unknowns (SI), if by over 2
// %. Empty otherwise. What nobody has said belongs to the intervals.
struct DefaultBody {
  std::string text;
  double change = 0.0;
};
[[nodiscard]] DefaultBody default_body(ScenarioCurve& curve, const scenario::Family& family,
                                       std::span<const double> values);

}  // namespace palpate::identify
