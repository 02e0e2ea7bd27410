// Runs a scenario and interpolates its rows to one curve.
#include "identify/scenario_curve.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "base/error.h"
#include "base/stop_scope.h"
#include "base/text.h"
#include "identify/lengthen.h"
#include "run/family.h"
#include "run/refined_mesh.h"
#include "scenario/integrators.h"
#include "scene/scene.h"

namespace palpate::identify {
namespace {

constexpr Unit strain{"", "strain", {}};

template <class Kind>
int first(const scenario::PlainScenario& scenario) {
  for (std::size_t i = 0; i < scenario.steps.size(); ++i)
    if (std::holds_alternative<Kind>(scenario.steps[i])) return static_cast<int>(i) + 1;
  return 0;
}

bool says(const std::string& name, std::initializer_list<const char*> words) {
  const std::string lower = lower_case(name);
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return lower.find(word) != std::string::npos; });
}

// Contact forces grow as h^(3/2), so that F^(2/3) is interpolated linearly between rows.
double even(double force) { return std::copysign(std::cbrt(force * force), force); }
double uneven(double root) { return std::copysign(std::sqrt(std::abs(root * root * root)), root); }

}  // namespace

const CurveWords& words_of(CurveKind kind) {
  static constexpr std::array<CurveWords, 6> words{{
      {"normal force over displacement, of the first `indent`", unit::mm, unit::N, "travel_mm",
       "force_N"},
      {"normal force over time", unit::s, unit::N, "time_s", "force_N"},
      {"tangential force over the first `slide`", unit::mm, unit::N, "slide_mm", "tangential_N"},
      {"strain over time", unit::s, strain, "time_s", "strain"},
      {"stress over time", unit::s, unit::kPa, "time_s", "stress_kPa"},
      {"stress over strain of the compression", strain, unit::kPa, "strain", "stress_kPa"},
  }};
  return words[as_index(kind)];
}

CurveKind curve_of(const Measurement& measured, const scenario::Scenario& scenario,
                   std::span<const Unknown> unknowns) {
  const bool over_length = measured.x_dimension == unit::mm.dimension;
  const bool over_time = measured.x_dimension == unit::s.dimension;
  const bool force = measured.y_dimension == unit::N.dimension;
  const bool pressure = measured.y_dimension == unit::kPa.dimension;
  const bool bare = measured.y_dimension == Dimension{};
  if (scenario.uniform()) {
    if (over_time && bare) return CurveKind::strain_time;
    if (over_time && pressure) return CurveKind::stress_time;
    const bool over_strain = measured.x_dimension == Dimension{};
    if (over_strain && pressure && first<scenario::Compress>(scenario) == 1)
      return CurveKind::stress_strain;
  } else {
    if (over_time && force) return CurveKind::force_time;
    if (over_length && force) {
      const bool slides = first<scenario::Slide>(scenario) > 0;
      const bool friction = std::any_of(unknowns.begin(), unknowns.end(), [](const Unknown& one) {
        return one.key == "contact.friction";
      });
      if (slides && (friction || says(measured.x_name, {"slide", "lateral", "shear"}) ||
                     says(measured.y_name, {"tangential", "friction", "shear", "lateral"})))
        return CurveKind::tangential_slide;
      if (first<scenario::Indent>(scenario) > 0) return CurveKind::force_travel;
    }
  }
  refuse(dimension_name(measured.y_dimension) + " (`" + measured.y_name + "`) over " +
         dimension_name(measured.x_dimension) + " (`" + measured.x_name +
         "`) is no curve of this scenario, which has " +
         (scenario.uniform() ? "strain over time (`creep`), stress over time (`relax`, `compress`) "
                               "and stress over strain "
                               "(`compress`)"
                             : "force over a length (`indent`, `slide`) and force over time") +
         "; name other columns with `--x` and `--y`, or give another scenario");
}

scenario::Scenario part_for(CurveKind kind, const scenario::Scenario& scenario, double farthest) {
  scenario::Scenario part = scenario;
  part.output.keep_rows_only();
  const int last = kind == CurveKind::force_travel       ? first<scenario::Indent>(scenario)
                   : kind == CurveKind::tangential_slide ? first<scenario::Slide>(scenario)
                                                         : 0;
  if (last > 0) part.steps.resize(as_index(last));
  auto* indent = std::get_if<scenario::Indent>(&part.steps.back());
  if (kind == CurveKind::force_travel && indent != nullptr && indent->to.second)
    indent->to = {std::min(farthest, scenario.finger.radius), false};
  return part;
}

ScenarioCurve::ScenarioCurve(CurveKind kind, FixedModel fixed_model, const scenario::Family& family,
                             std::span<const Unknown> unknowns)
    : kind_(kind),
      model_(std::move(fixed_model)),
      fixed_(scenario::resolve(model_.one, model_.model)),
      family_(&family),
      unknowns_(unknowns) {
  const auto shape_at = [&](const Unknown& one, double value) {
    return scene::shape_key(
        scenario::resolve(model_.at({&one, 1}, std::array{value}), model_.model));
  };
  // Shapes that depend on an unknown are not used again and are not kept.
  shape_varies_ =
      fixed_.meshed() && std::any_of(unknowns.begin(), unknowns.end(), [&](const Unknown& one) {
        return one.what == Unknown::What::key && shape_at(one, one.low) != shape_at(one, one.high);
      });
}

std::optional<ScenarioCurve::Rows> ScenarioCurve::rows(std::span<const double> values) {
  scenario::Case one = at(values);
  one.name = family_->name;
  if (farthest_) {
    double end = *farthest_;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (unknowns_[i].what == Unknown::What::contact_point) end -= values[i];
    (void)lengthen(kind_, one.scenario, end);
  }
  std::vector<Problem> problems;
  scenario::check(one, family_->document, problems);
  if (!problems.empty()) {
    failure_ = problems.front().message;
    return std::nullopt;
  }
  record::CaseRecord record;
  try {
    scene::SpecimenShapes fresh;
    scene::SpecimenShapes& shapes = shape_varies_ ? fresh : shapes_;
    const scene::Scene scene =
        run::build_scene(one, *family_, shapes, scene::given_choice(one, model_.model, shapes));
    record = run::run_case(scene);
  } catch (const InputError& error) {
    failure_ = error.problems().front().message;
    return std::nullopt;
  } catch (const MeshError& error) {
    failure_ = error.what();
    return std::nullopt;
  } catch (const Stopped&) {  // while the scene was built
    return std::nullopt;
  }
  if (record.outcome != record::Outcome::completed) {
    failure_ = record.reason;
    return std::nullopt;
  }
  Rows rows;
  const auto add = [&](double x, double y) {
    rows.x.push_back(x);
    rows.y.push_back(y);
  };
  const int pressed = first<scenario::Indent>(fixed_);
  const int slid = first<scenario::Slide>(fixed_);
  for (const record::ContactRow& row : record.contact) {
    switch (kind_) {
      case CurveKind::force_travel:
        if (row.step <= pressed && (rows.x.empty() || row.travel > rows.x.back()))
          add(row.travel, row.contact_force);
        break;
      case CurveKind::tangential_slide:
        if (row.step == slid && rows.x.empty()) add(0.0, 0.0);
        if (row.step == slid) add(std::abs(row.slide), row.tangential);
        break;
      case CurveKind::force_time: add(row.time, row.force); break;
      case CurveKind::strain_time:
      case CurveKind::stress_time:
      case CurveKind::stress_strain: break;  // below
    }
  }
  for (const record::StrainRow& row : record.strain) {
    if (kind_ != CurveKind::stress_strain)
      add(row.time, kind_ == CurveKind::strain_time ? row.strain : row.stress);
    else if (row.step == 1 && (rows.x.empty() || row.strain > rows.x.back()))
      add(row.strain, row.stress);
  }
  if (rows.x.size() < 2) {
    failure_ = "the loading history gives fewer than two rows of this curve";
    return std::nullopt;
  }
  return rows;
}

bool ScenarioCurve::evaluate(std::span<const double> u, std::span<double> out) {
  std::vector<double> values;
  double shift = shift_;
  double gain = 1.0;
  double tilt = 0.0;
  double offset = kind_ == CurveKind::force_travel ? fixed_.contact.ambient_force : 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    values.push_back(unknowns_[i].value(u[i]));
    if (unknowns_[i].what == Unknown::What::contact_point) shift += values.back();
    if (unknowns_[i].what == Unknown::What::force_delay) shift += values.back();
    if (unknowns_[i].what == Unknown::What::force_gain) gain = values.back();
    if (unknowns_[i].what == Unknown::What::force_offset) offset += values.back();
    if (unknowns_[i].what == Unknown::What::force_tilt) tilt = values.back();
  }
  const auto model = rows(values);
  if (!model) return false;
  const bool grows = kind_ == CurveKind::force_travel;
  const auto& x = model->x;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double at = x_[i] - shift;
    if (at < x.front()) {  // in a press there is no contact yet, and the first row is 0
      out[i] = gain * model->y.front() + offset + tilt * x_[i];
      continue;
    }
    const double end = x.back() + 1e-9 * std::abs(x.back()) + std::abs(shift_);  // 1e-9: rounding
    if (at > end) {
      failure_ = "the loading history ends before the measured points do";
      return false;
    }
    // The last pair whose left row is not beyond `at`; of two rows at the same x the later counts.
    const auto right = std::min(std::upper_bound(x.begin(), x.end(), at), x.end() - 1);
    const auto k = as_index(right - x.begin());
    const double part = (at - x[k - 1]) / (x[k] - x[k - 1]);
    const double before = grows ? even(model->y[k - 1]) : model->y[k - 1];
    const double after = grows ? even(model->y[k]) : model->y[k];
    const double between = before + part * (after - before);
    out[i] = gain * (grows ? uneven(between) : between) + offset + tilt * x_[i];
  }
  return true;
}

std::optional<ClosedCurve> ScenarioCurve::closed() const {
  ClosedCurve curve;
  curve.unknowns.assign(unknowns_.begin(), unknowns_.end());
  for (const double x : x_) curve.x.push_back(x - shift_);
  const scenario::Resolved::Tissue& tissue = fixed_.tissue;
  curve.known = {tissue.young_modulus, tissue.poisson_ratio, 1.0, 1.0, 0.0, 0.0};
  const bool one_tissue = fixed_.regions.empty();
  std::vector<std::pair<std::string, ClosedCurve::Slot>> slots{
      {"tissue.young_modulus", ClosedCurve::modulus}};
  if (kind_ == CurveKind::force_travel) {
    const auto* space = std::get_if<scenario::HalfSpace>(&tissue.shape);
    const bool flat =
        std::holds_alternative<scenario::Cuboid>(tissue.shape) ||
        (space != nullptr && space->curvature == 0.0 && space->curvature_2.value_or(0.0) == 0.0);
    const auto* indent = std::get_if<scenario::Indent>(&fixed_.steps.front());
    if (!scenario::traits(model_.model).eq_2 || !flat || indent == nullptr ||
        fixed_.finger.spheres != 1 || scenario::viscous_contact(fixed_) ||
        fixed_.contact.depth != scenario::Contact::Depth::hertz)
      return std::nullopt;
    const scene::Finger finger = scene::make_finger(fixed_);
    curve.form = ClosedCurve::Form::hertz_press;
    curve.radius = finger.whole.radius;
    curve.finger_compliance = finger.compliance_share / finger.whole.modulus;
    curve.known[ClosedCurve::force_offset] = fixed_.contact.ambient_force;
    slots.emplace_back("tissue.poisson_ratio", ClosedCurve::poisson);
    slots.emplace_back("contact_point", ClosedCurve::contact_point);
    if (fixed_.contact.ambient_force == 0.0)
      slots.emplace_back("force_offset", ClosedCurve::force_offset);
  } else {
    const bool sliding = tissue.base == tissue::Base::frictionless;
    const bool voigt = tissue.viscosity == tissue::Viscosity::kelvin_voigt;
    const bool solid = tissue.viscosity == tissue::Viscosity::standard_linear_solid;
    if (!fixed_.uniform() || !one_tissue || !sliding || fixed_.steps.size() != 1 ||
        !std::holds_alternative<scenario::Cuboid>(tissue.shape) ||
        about(fixed_.solver.integrator).inertia)
      return std::nullopt;
    const auto* compress = std::get_if<scenario::Compress>(&fixed_.steps.front());
    const bool elastic = tissue.viscosity == tissue::Viscosity::none && compress != nullptr;
    if (!voigt && !solid && !elastic) return std::nullopt;
    if (const auto* creep = std::get_if<scenario::Creep>(&fixed_.steps.front())) {
      curve.form = voigt ? ClosedCurve::Form::voigt_creep : ClosedCurve::Form::solid_creep;
      curve.load = creep->stress;
      curve.load_time = creep->load_time;
      if (kind_ != CurveKind::strain_time) return std::nullopt;
    } else if (compress != nullptr) {
      if (kind_ == CurveKind::strain_time || compress->platen == tissue::Base::bonded)
        return std::nullopt;
      curve.form =
          voigt ? ClosedCurve::Form::voigt_compression : ClosedCurve::Form::solid_compression;
      curve.over_strain = kind_ == CurveKind::stress_strain;
      curve.load = compress->strain;
      curve.load_time = compress->ramp_time();
      curve.known[ClosedCurve::ratio] = 1.0;
    } else {
      if (!solid || kind_ != CurveKind::stress_time) return std::nullopt;
      curve.form = ClosedCurve::Form::solid_relaxation;
      curve.load = std::get<scenario::Relax>(fixed_.steps.front()).strain;
    }
    curve.known[ClosedCurve::time] = voigt   ? tissue.law.time
                                     : solid ? tissue.law.longest_time()
                                             : 1.0;
    if (!elastic)
      slots.emplace_back(voigt ? "tissue.retardation_time" : "tissue.relaxation_time",
                         ClosedCurve::time);
    if (solid) {
      curve.known[ClosedCurve::ratio] = tissue.law.instantaneous_ratio();
      slots.emplace_back("tissue.instantaneous_ratio", ClosedCurve::ratio);
    }
  }
  for (const Unknown& unknown : unknowns_) {
    const auto slot = std::find_if(slots.begin(), slots.end(),
                                   [&](const auto& one) { return one.first == unknown.key; });
    if (slot == slots.end()) return std::nullopt;
    curve.slot_of.push_back(slot->second);
  }
  return curve;
}

}  // namespace palpate::identify
