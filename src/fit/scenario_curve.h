// What a scenario would have measured, at the places where something was measured.
#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/units.h"
#include "fit/closed_curve.h"
#include "fit/unknowns.h"
#include "scenario/family.h"
#include "scene/specimen_shape.h"

namespace palpate::fit {

struct Measurement {
  std::vector<double> x, y;    // SI
  std::string x_name, y_name;  // of the columns, as they were asked for
  Dimension x_dimension = {}, y_dimension = {};
};

// Which of a scenario's curves was measured.
enum class CurveKind { force_travel, force_time, tangential_slide, strain_time, stress_time };

struct CurveWords {
  const char* sentence;  // "normal force over the travel of step 1's indent"
  Unit x, y;             // of the tables; the symbol is empty for a strain
  const char *x_column, *y_column;
};
[[nodiscard]] const CurveWords& words_of(CurveKind kind);

// By the columns' dimensions and the scenario's steps: of a press with a slide the tangential force
// where friction is unknown or a column says tangential, friction, shear, lateral or slide.
// Throws InputError where the scenario has no such curve.
[[nodiscard]] CurveKind curve_of(const Measurement& measured, const scenario::Scenario& scenario,
                                 std::span<const Unknown> unknowns);

// The part of the scenario that is run for the curve: what comes after it is left out, and a press
// to a force goes to the `farthest` travel instead (SI), because the force follows the unknowns.
[[nodiscard]] scenario::Scenario part_for(CurveKind kind, const scenario::Scenario& scenario,
                                          double farthest);

class ScenarioCurve {
 public:
  // `fixed` has no `auto` left. `x`, SI. Keeps references to family, unknowns and stop.
  ScenarioCurve(CurveKind kind, scenario::Scenario fixed, const scenario::Family& family,
                std::span<const Unknown> unknowns, const std::atomic<bool>& stop);

  void set_points(std::vector<double> x) { x_ = std::move(x); }
  // As if the contact point, or time's zero, lay later by this, SI. Points that it carries beyond
  // the last row lie on the line through the last two.
  void set_shift(double shift) { shift_ = shift; }

  // Rows of a run at these values (SI): ascending x, from where the programme begins to where it
  // ends. Nothing where the scenario is not valid there, or diverges.
  struct Rows {
    std::vector<double> x, y;
  };
  [[nodiscard]] std::optional<Rows> rows(std::span<const double> values);

  // The curve at the points, at u of the box.
  [[nodiscard]] bool evaluate(std::span<const double> u, std::span<double> out);

  // The same as a formula, where it is one: a Hertz press that is elastic and shallow, a uniform
  // specimen of one tissue between sliding platens.
  [[nodiscard]] std::optional<ClosedCurve> closed() const;

  // Why the last evaluation failed.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  [[nodiscard]] const scenario::Scenario& fixed() const { return fixed_; }
  [[nodiscard]] CurveKind kind() const { return kind_; }

 private:
  CurveKind kind_;
  scenario::Scenario fixed_;
  const scenario::Family* family_;
  std::span<const Unknown> unknowns_;
  const std::atomic<bool>* stop_;
  std::vector<double> x_;
  scene::SpecimenShapes shapes_;
  double shift_ = 0.0;
  bool shape_varies_ = false;
  std::string failure_;
};

}  // namespace palpate::fit
