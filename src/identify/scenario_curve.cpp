// Runs a scenario, with one model for a whole search, and interpolates its rows to one curve.
#include "identify/scenario_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/stop_scope.h"
#include "base/text.h"
#include "run/choose.h"
#include "run/family.h"
#include "run/refined_mesh.h"
#include "scenario/integrators.h"
#include "scenario/programme.h"
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
  return std::ranges::any_of(
      words, [&](const char* word) { return lower.find(word) != std::string::npos; });
}

// Contact forces grow as h^(3/2), so that F^(2/3) is interpolated linearly between rows.
double even(double force) { return std::copysign(std::cbrt(force * force), force); }
double uneven(double root) { return std::copysign(std::sqrt(std::abs(root * root * root)), root); }

// F = 4/3 E* sqrt(R) h^(3/2), 1/E* = lambda_1 + (1 - nu^2) / E, h = x - contact point
//                                             Chen 2007 eq. (2); docs/theory.md [modulus], [radius]
double hertz_press(const ClosedCurve& curve, const ClosedCurve::Parameters& p, double x) {
  const double depth = x - p[ClosedCurve::contact_point];
  if (!(depth > 0.0)) return p[ClosedCurve::force_offset];
  const double nu = p[ClosedCurve::poisson];
  const double modulus =
      1.0 / (curve.finger_compliance + (1.0 - nu * nu) / p[ClosedCurve::modulus]);
  return 4.0 / 3.0 * modulus * std::sqrt(curve.radius) * depth * std::sqrt(depth) +
         p[ClosedCurve::force_offset];
}

// Creep compliance J(t), 1/Pa, of Kelvin-Voigt with tau = eta / E: (1 - e^(-t/tau)) / E; of a
// standard linear solid with the moduli E (relaxed) and r E (instantaneous):
// 1/E - (1/E - 1/(r E)) e^(-t/tau_c), tau_c = r tau
//                                         docs/theory.md [kelvin_voigt], [branches], [fit_creep]
double creep_compliance(bool voigt, const ClosedCurve::Parameters& p, double t) {
  const double r = p[ClosedCurve::ratio];
  const double left = voigt ? std::exp(-t / p[ClosedCurve::time])
                            : (1.0 - 1.0 / r) * std::exp(-t / (r * p[ClosedCurve::time]));
  return (1.0 - left) / p[ClosedCurve::modulus];
}

// The stress under a strain that grows for `load_time` and stays: Kelvin-Voigt
// sigma = E (strain + tau strain'), a standard linear solid by superposition of its relaxation,
// elastic where r = 1.       docs/theory.md [kelvin_voigt], [branches], [fit_relaxation]
double compression(bool voigt, const ClosedCurve& curve, const ClosedCurve::Parameters& p,
                   double x) {
  const double t = curve.over_strain ? x / curve.load * curve.load_time : x;
  const double rate = curve.load / curve.load_time;
  const double tau = p[ClosedCurve::time];
  const double grown = std::min(t, curve.load_time);
  if (voigt) return p[ClosedCurve::modulus] * rate * (t < curve.load_time ? t + tau : grown);
  return p[ClosedCurve::modulus] * rate *
         (grown +
          (p[ClosedCurve::ratio] - 1.0) * tau * (std::exp((grown - t) / tau) - std::exp(-t / tau)));
}

}  // namespace

double ClosedCurve::value(const Parameters& p, double x) const {
  switch (form) {
    case Form::hertz_press: return hertz_press(*this, p, x);
    case Form::voigt_creep:
    case Form::solid_creep: {
      // Unloading adds the opposite stress.          docs/theory.md [fit_creep], [fit_recovery]
      const bool voigt = form == Form::voigt_creep;
      const double loaded = load * creep_compliance(voigt, p, x);
      return x > load_time ? loaded - load * creep_compliance(voigt, p, x - load_time) : loaded;
    }
    case Form::solid_relaxation:  // strain E (1 + (r - 1) e^(-t/tau))
      return load * p[modulus] * (1.0 + (p[ratio] - 1.0) * std::exp(-x / p[time]));
    case Form::voigt_compression: return compression(true, *this, p, x);
    case Form::solid_compression: return compression(false, *this, p, x);
  }
  return 0.0;
}

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
      const bool friction = std::ranges::any_of(
          unknowns, [](const Unknown& one) { return one.key == "contact.friction"; });
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
                               "and stress over strain (`compress`)"
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
      unknowns_(unknowns),
      formula_(formula()) {
  const auto shape_at = [&](const Unknown& one, double value) {
    return scene::shape_key(
        scenario::resolve(model_.at({&one, 1}, std::array{value}), model_.model));
  };
  // Shapes that depend on an unknown are not used again and are not kept.
  shape_varies_ =
      fixed_.meshed() && std::ranges::any_of(unknowns, [&](const Unknown& one) {
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
  if (!formula_) return run(u, out);
  ClosedCurve::Parameters p = formula_->known;
  for (std::size_t i = 0; i < u.size(); ++i) p[formula_->slot_of[i]] = unknowns_[i].value(u[i]);
  for (std::size_t i = 0; i < x_.size(); ++i) out[i] = formula_->value(p, x_[i] - shift_);
  return true;
}

bool ScenarioCurve::run(std::span<const double> u, std::span<double> out) {
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
    const auto right = std::min(std::ranges::upper_bound(x, at), x.end() - 1);
    const auto k = as_index(right - x.begin());
    const double part = (at - x[k - 1]) / (x[k] - x[k - 1]);
    const double before = grows ? even(model->y[k - 1]) : model->y[k - 1];
    const double after = grows ? even(model->y[k]) : model->y[k];
    const double between = before + part * (after - before);
    out[i] = gain * (grows ? uneven(between) : between) + offset + tilt * x_[i];
  }
  return true;
}

std::optional<ClosedCurve> ScenarioCurve::formula() const {
  ClosedCurve curve;
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
    // A model that the scenario names is run: the formula of a uniform test only approximates it.
    if (model_.given || !fixed_.uniform() || !one_tissue || !sliding || fixed_.steps.size() != 1 ||
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
    const auto slot =
        std::ranges::find_if(slots, [&](const auto& one) { return one.first == unknown.key; });
    if (slot == slots.end()) return std::nullopt;
    curve.slot_of.push_back(slot->second);
  }
  return curve;
}

// The loading history is lengthened where its end alone would leave rows of the measurement out.

std::optional<double> duration(const scenario::Scenario& scenario) {
  for (const scenario::Step& step : scenario.steps)
    if (const auto* indent = std::get_if<scenario::Indent>(&step); indent && indent->to.second)
      return std::nullopt;
  return scenario::programme_time(scenario);
}

namespace {

constexpr double margin = 1e-6;  // relative; the last row lies beyond the last point

bool lengthen_time(scenario::Scenario& scenario, double farthest) {
  const auto lasts = duration(scenario);
  if (!lasts || farthest <= *lasts * (1.0 + 1e-9)) return false;
  const double more = farthest * (1.0 + margin) - *lasts;
  scenario::Step& last = scenario.steps.back();
  if (auto* hold = std::get_if<scenario::Hold>(&last))
    hold->time += more;
  else if (auto* relax = std::get_if<scenario::Relax>(&last))
    relax->time += more;
  else if (auto* creep = std::get_if<scenario::Creep>(&last))
    creep->recovery_time += more;
  else if (auto* compress = std::get_if<scenario::Compress>(&last))
    compress->hold_time += more;
  else if (auto* indent = std::get_if<scenario::Indent>(&last))
    indent->to.value += more * indent->rate;
  else
    return false;
  return true;
}

}  // namespace

bool lengthen(CurveKind kind, scenario::Scenario& scenario, double farthest) {
  const double end = farthest * (1.0 + margin);
  if (kind == CurveKind::force_travel) {
    for (scenario::Step& step : scenario.steps)
      if (auto* indent = std::get_if<scenario::Indent>(&step)) {
        if (indent->to.second || indent->to.value >= farthest) return false;
        indent->to.value = end;
        return true;
      }
    return false;
  }
  if (kind == CurveKind::tangential_slide) {
    for (scenario::Step& step : scenario.steps)
      if (auto* slide = std::get_if<scenario::Slide>(&step)) {
        if (slide->by >= farthest) return false;
        slide->by = end;
        return true;
      }
    return false;
  }
  if (kind == CurveKind::stress_strain) {
    auto* compress = std::get_if<scenario::Compress>(&scenario.steps.front());
    if (compress == nullptr || compress->strain >= farthest) return false;
    compress->strain = end;
    return true;
  }
  return lengthen_time(scenario, farthest);
}

DefaultBody default_body(ScenarioCurve& curve, const scenario::Family& family,
                         std::span<const double> values) {
  const auto* box = std::get_if<scenario::Cuboid>(&curve.fixed().tissue.shape);
  const Member* tissue = family.document.find("tissue");
  const bool named = tissue != nullptr && tissue->value.find("shape") != nullptr;
  if (box == nullptr || named || curve.fixed().uniform()) return {};
  DefaultBody body;
  body.text = "the scenario names no `tissue.shape`, so that the body is the default block, ";
  for (std::size_t i = 0; i < 3; ++i)
    body.text += (i > 0 ? " by " : "") + rounded_text(unit::mm.from_si(box->size[i]));
  body.text += " mm";
  FixedModel half{.one = curve.at(values)};
  half.one.scenario.tissue.shape = scenario::HalfSpace{};
  half.one.scenario.solver.model = scenario::Model::hertz;
  const auto on_block = curve.rows(values);
  const auto on_half = ScenarioCurve(curve.kind(), std::move(half), family, {}).rows({});
  if (on_block && on_half && on_block->y.size() == on_half->y.size()) {
    // Over time the last row may be after the finger has left the body.
    const auto largest = std::ranges::max_element(on_half->y);
    const double on_this = on_block->y[as_index(largest - on_half->y.begin())];
    const double more = *largest > 0.0 ? on_this / *largest - 1.0 : 0.0;
    if (std::abs(more) > 0.02) {
      body.change = more;
      body.text += ", on which the force at the deepest is " + percent_text(std::abs(more)) +
                   (more > 0.0 ? " larger" : " smaller") +
                   " than on a half-space, and the intervals are as much wider";
    }
  }
  body.text += "; set it to that of the specimen";
  return body;
}

// Chooses the model by its estimated errors at the corners of the box.

namespace {

// The middle of the box, then its corners; for more than 5 unknowns the ends of each one alone.
std::vector<std::vector<double>> places(std::size_t unknowns) {
  std::vector<std::vector<double>> all{std::vector<double>(unknowns, 0.5)};
  constexpr std::size_t most_for_corners = 5;
  if (unknowns > most_for_corners) {
    for (std::size_t i = 0; i < unknowns; ++i)
      for (const double end : {0.0, 1.0}) {
        all.push_back(all.front());
        all.back()[i] = end;
      }
    return all;
  }
  for (std::size_t corner = 0; corner < (std::size_t{1} << unknowns); ++corner) {
    all.emplace_back(unknowns);
    for (std::size_t i = 0; i < unknowns; ++i) all.back()[i] = (corner >> i & 1U) != 0 ? 1.0 : 0.0;
  }
  return all;
}

double error_of(const scene::Choice& choice, scenario::Model model) {
  const scene::Forecast* forecast = choice.forecast(model);
  return forecast != nullptr ? forecast->error : std::numeric_limits<double>::infinity();
}

scene::Choice quick_choice(const scenario::Case& one) {
  scene::SpecimenShapes shapes;
  return run::choose(one, shapes, run::Models::quick);
}

}  // namespace

scenario::Case FixedModel::at(std::span<const Unknown> unknowns,
                              std::span<const double> values) const {
  scenario::Case other = one;
  set_unknowns(other.scenario, unknowns, values);
  return other;
}

FixedModel fix_model(const scenario::Case& one, const Node& document,
                     std::span<const Unknown> unknowns) {
  const scenario::Scenario& scenario = one.scenario;
  FixedModel fixed{.one = one};
  std::vector<scene::Choice> choices;
  scene::SpecimenShapes shapes;
  std::vector<Problem> wrong;
  bool deep_known = true;  // the factor of deep presses exists for all values tried
  for (const std::vector<double>& u : places(unknowns.size())) {
    std::vector<double> values;
    for (std::size_t i = 0; i < u.size(); ++i) values.push_back(unknowns[i].value(u[i]));
    const scenario::Case at = fixed.at(unknowns, values);
    std::vector<Problem> problems;
    scenario::check(at, document, problems);
    if (problems.empty()) {
      choices.push_back(run::choose(at, shapes, run::Models::quick));
      deep_known = deep_known && choices.back().expected.depth_ratio.has_value();
    } else if (wrong.empty()) {
      wrong = problems;
    }
  }
  if (choices.empty()) throw InputError(wrong);

  scenario::Found found{.viscosity_matters = false, .inertia_matters = false};
  fixed.given = choices.front().given;
  fixed.model = choices.front().chosen.solver.model;
  double best = std::numeric_limits<double>::infinity();
  for (const scene::Forecast& forecast : choices.front().forecasts) {  // cheapest first
    if (fixed.given || best <= scenario.solver.tolerance) break;
    double worst = 0.0;
    for (const scene::Choice& choice : choices)
      worst = std::max(worst, error_of(choice, forecast.model) - choice.waves);
    if (worst >= best) continue;
    best = worst;
    fixed.model = forecast.model;
  }
  for (const scene::Choice& choice : choices) {
    if (!choice.forecasts.empty())
      fixed.worst_error = std::max(fixed.worst_error, error_of(choice, fixed.model));
    found.viscosity_matters |= choice.found.viscosity_matters;
    found.inertia_matters |= choice.found.inertia_matters;
    found.depth_matters |= choice.found.depth_matters;
  }
  found.depth_matters = found.depth_matters && deep_known;
  fixed.one.scenario = scenario::answered(one, scenario::resolve(one, fixed.model, found));
  return fixed;
}

// 1 / (omega_1 tau)^2, omega_1 = pi sqrt(E / rho) / (2 H)                docs/theory.md [damping]
std::optional<double> inertia_of_flow(const scenario::Resolved& scenario) {
  const scenario::Resolved::Tissue& tissue = scenario.tissue;
  const auto* box = std::get_if<scenario::Cuboid>(&tissue.shape);
  const bool voigt = tissue.viscosity == tissue::Viscosity::kelvin_voigt;
  const bool solid = tissue.viscosity == tissue::Viscosity::standard_linear_solid;
  if (box == nullptr || (!voigt && !solid) || !scenario.uniform()) return std::nullopt;
  const double time = voigt ? tissue.law.time : tissue.law.longest_time();
  const double speed = std::sqrt(tissue.young_modulus / tissue.density);
  const double turns = std::numbers::pi * speed / (2.0 * box->size[2]) * time;
  return 1.0 / (turns * turns);
}

std::optional<double> predicted_error(const scenario::Case& fixed) {
  const scene::Choice choice = quick_choice(fixed);
  const scene::Forecast* forecast = choice.taken();
  return forecast == nullptr ? std::nullopt : std::optional(forecast->error);
}

std::optional<double> deep_effect(const scenario::Case& fixed) {
  const scene::Choice choice = quick_choice(fixed);
  if (choice.chosen.contact.depth != scenario::Contact::Depth::neo_hookean) return std::nullopt;
  return choice.expected.deep;
}

}  // namespace palpate::identify
