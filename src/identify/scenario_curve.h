// The curve that a scenario computes, at the points of a measurement.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/units.h"
#include "identify/closed_curve.h"
#include "identify/fixed_model.h"
#include "scene/specimen_shape.h"

namespace palpate::identify {

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

  // Computes the curve at the points for u in [0, 1]; false, with a failure(), if it cannot.
  [[nodiscard]] bool evaluate(std::span<const double> u, std::span<double> out);

  // The curve as a formula, if it has one: an elastic, shallow Hertz press on a flat surface, or
  // one creep or relaxation step of a cuboid of one tissue between sliding platens.
  [[nodiscard]] std::optional<ClosedCurve> closed() const;

  // Why the last evaluation failed.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  // The case with the scenario's values of the unknowns, and with `values` (SI) instead.
  [[nodiscard]] const scenario::Resolved& fixed() const { return fixed_; }
  [[nodiscard]] scenario::Case at(std::span<const double> values) const {
    return model_.at(unknowns_, values);
  }
  [[nodiscard]] CurveKind kind() const { return kind_; }

 private:
  CurveKind kind_;
  FixedModel model_;
  scenario::Resolved fixed_;
  const scenario::Family* family_;
  std::span<const Unknown> unknowns_;
  std::vector<double> x_;
  scene::SpecimenShapes shapes_;
  double shift_ = 0.0;
  std::optional<double> farthest_;
  bool shape_varies_ = false;
  std::string failure_;
};

}  // namespace palpate::identify
