// Checks the options of a fit and carries it out.
#include "cli/fit_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "fit/parts.h"
#include "fit/prony.h"
#include "fit/residuals.h"

namespace palpate::cli {
namespace {

using Models = std::span<const std::string_view>;
constexpr auto contact_models = std::to_array<std::string_view>(
    {"hertz", "layer", "jkr", "dmt", "adhesive", "hertz_power_law", "hertz_solid"});
constexpr Models elastic_models = Models(contact_models).first(2);
constexpr Models adhesive_models = Models(contact_models).subspan(2, 3);
constexpr Models viscous_models = Models(contact_models).last(2);
constexpr auto uniaxial_models =
    std::to_array<std::string_view>({"modulus", "neo_hookean", "ogden", "yeoh", "ogden3"});
constexpr auto series_models = std::to_array<std::string_view>({"prony", "prony_creep"});

bool is_one_of(std::string_view word, Models words) {
  return std::ranges::find(words, word) != words.end();
}
bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return is_one_of(word, Models(words.begin(), words.size()));
}

// `20`, `20 deg` or `20 degrees`, in rad.
double angle_of(const std::string& text) {
  const auto number = leading_number(text);
  const std::string unit = number ? trimmed(number->rest) : "";
  if (!number || !(unit.empty() || unit == "deg" || unit == "degrees" || unit == "\u00b0"))
    refuse("`--half-angle` wants an angle, got `" + text + "`; write it as `20 deg`");
  if (!(number->value > 0.0 && number->value < 90.0))
    refuse("`--half-angle` is `" + text + "`; give an angle between 0 and 90 degrees");
  return number->value * std::numbers::pi / 180.0;
}

fit::ContactTest::BaselineChoice baseline_of(const std::string& word) {
  using Choice = fit::ContactTest::BaselineChoice;
  return word == "none"     ? Choice::none
         : word == "offset" ? Choice::offset
         : word == "tilt"   ? Choice::tilt
                            : Choice::automatic;
}

// A share, as `10 %` or `0.1`; nothing for another text.
std::optional<double> share_of(const std::string& text) {
  const auto number = leading_number(text);
  const std::string unit = number ? trimmed(number->rest) : "";
  if (!number || !(unit.empty() || unit == "%")) return std::nullopt;
  return unit.empty() ? number->value : number->value / 100.0;
}

// `0.1 mm`, or a share.
std::optional<fit::DepthLimit> limit_of(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  if (const auto share = share_of(text)) {
    if (!(*share >= 0.0 && *share <= 1.0))
      refuse("`" + option + "` is `" + text +
             "`; give a share from 0 to 100 %, or a depth as `1 mm`");
    return fit::DepthLimit{*share, true};
  }
  const double depth = quantity_of(option, text, unit::mm, ", or as `10 %`");
  if (depth < 0.0) refuse("`" + option + "` is `" + text + "`; give a depth of 0 or more");
  return fit::DepthLimit{depth, false};
}

// A place on the axis of x, of any sign.
std::optional<double> place_of(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  return quantity_of(option, text, unit::mm);
}

double length_of(const std::string& option, const std::string& text) {
  return positive_of(option, text, unit::mm);
}

fit::AdhesiveTest adhesive_test(const Fit& command) {
  fit::AdhesiveTest test;
  if (command.model != "adhesive")
    test.law = command.model == "jkr" ? fit::Adhesion::jkr : fit::Adhesion::dmt;
  if (!command.atoms.empty()) test.distance = length_of("--atoms", command.atoms);
  return test;
}

// The test that the options describe. Throws InputError for a tip without its size, and for options
// that contradict each other.
fit::ContactTest contact_test(const Fit& command) {
  fit::ContactTest test;
  test.poisson_ratio = command.poisson_ratio;
  test.tip = fit::find_tip(command.tip).value_or(fit::Tip::Kind::paraboloid);
  const std::string tip(fit::word(test.tip));
  if (fit::Tip{test.tip}.has_angle()) {
    if (command.half_angle.empty())
      refuse("the tip `" + tip + "` wants `--half-angle`; write it as `--half-angle \"20 deg\"`");
    if (!command.radius.empty())
      refuse("`--radius` is not used by the tip `" + tip + "`; leave it out");
    test.half_angle = angle_of(command.half_angle);
  } else {
    if (command.radius.empty())
      refuse("the model `" + command.model +
             "` wants `--radius`; write it as `--radius \"11 mm\"`");
    if (!command.half_angle.empty())
      refuse("`--half-angle` is not used by the tip `" + tip + "`; leave it out");
    test.radius = length_of("--radius", command.radius);
  }
  if (command.base == "frictionless") test.base = contact::LayerBase::frictionless;
  if (command.model != "hertz" && test.tip != fit::Tip::Kind::paraboloid)
    refuse("the model `" + command.model + "` knows no tip but `paraboloid`; leave `--tip` out");
  if (command.baseline == "tilt" && is_one_of(command.model, viscous_models))
    refuse("the model `" + command.model + "` knows no tilt; give `--baseline offset`");
  if (command.model == "layer") test.thickness = length_of("--thickness", command.thickness);
  test.baseline = baseline_of(command.baseline);
  test.from = limit_of("--from", command.from);
  test.to = limit_of("--to", command.to);
  if (test.from && test.to && test.from->share == test.to->share &&
      !(test.from->value < test.to->value))
    refuse("`--from` is not below `--to`; give a range of depths");
  test.baseline_from = place_of("--baseline-from", command.baseline_from);
  test.baseline_to = place_of("--baseline-to", command.baseline_to);
  if (test.baseline_from && test.baseline_to && !(*test.baseline_from < *test.baseline_to))
    refuse("`--baseline-from` is not below `--baseline-to`; give a range of x");
  test.contact_point = place_of("--contact-point", command.contact_point);
  const std::string& segment = command.columns.segment;
  const bool sticks = is_one_of(command.model, adhesive_models);
  if (segment == "retract" || (sticks && segment.empty())) test.way = fit::Way::retract;
  if (segment == "all" && !sticks) test.way = fit::Way::all;
  test.residuals = fit::Residuals::correlated;
  return test;
}

constexpr Unit mm2{"mm^2", "area", {1, 1e6, {2, 0, 0}}};

double area_of(const Fit& command) {
  if (!command.area.empty() && !command.diameter.empty())
    refuse("`--area` and `--diameter` both give the cross-section; leave one of them out");
  if (command.diameter.empty()) return positive_of("--area", command.area, mm2);
  const double diameter = length_of("--diameter", command.diameter);
  return std::numbers::pi / 4.0 * diameter * diameter;
}

std::optional<double> strain_of(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto strain = share_of(text);
  if (!strain)
    refuse("`" + option + "` wants a strain, got `" + text + "`; write it as `10 %` or `0.1`");
  return strain;
}

fit::UniaxialTest::Loading loading_of(const Fit& command, const measured::MeasuredCurve& curve) {
  using Loading = fit::UniaxialTest::Loading;
  if (command.loading == "compression") return Loading::compression;
  if (command.loading == "tension") return Loading::tension;
  // A load that was turned because it is negative in compression.
  const bool turned = std::ranges::any_of(curve.notes, [](const auto& note) {
    return note.find("negative in compression") != std::string::npos;
  });
  const std::string names = lower_case(curve.x_axis.column + " " + curve.y_axis.column);
  if (turned || names.find("compress") != std::string::npos) return Loading::compression;
  if (names.find("tensile") != std::string::npos) return Loading::tension;
  return Loading::unknown;
}

}  // namespace

Strained strained(const Fit& command, const measured::MeasuredCurve& curve) {
  Strained made{curve.x, loading_of(command, curve)};
  if (!curve.x_axis.stretch) return made;
  for (double& each : made.strain) each -= 1.0;
  const auto far = [](double one, double other) { return std::abs(one) < std::abs(other); };
  const double most = *std::ranges::max_element(made.strain, far);
  if (made.loading == fit::UniaxialTest::Loading::unknown && most > 0.0)
    made.loading = fit::UniaxialTest::Loading::tension;  // of stretches the sign tells
  return made;
}

namespace {

// Nominal stress of true (Cauchy) stress, and the strain of a logarithmic one, where the columns
// are named so: P = sigma / L of an incompressible specimen.
void take_nominal(const measured::MeasuredCurve& curve, std::vector<double>& strain,
                  std::vector<double>& stress, bool compression, std::vector<std::string>& notes) {
  const auto named = [](const measured::MeasuredAxis& axis,
                        std::initializer_list<const char*> words) {
    const std::string name = lower_case(axis.column);
    return std::ranges::any_of(
        words, [&](const char* word) { return name.find(word) != std::string::npos; });
  };
  const double sign = compression ? -1.0 : 1.0;  // of a strain that is positive in compression
  if (named(curve.x_axis, {"true strain", "true_strain", "log strain", "logarithmic", "hencky"})) {
    const bool turned = *std::ranges::min_element(strain) >= 0.0;
    for (double& each : strain) each = turned ? sign * std::expm1(sign * each) : std::expm1(each);
    notes.push_back("`" + curve.x_axis.column + "` is taken as the logarithm of the stretch");
  }
  if (!named(curve.y_axis, {"true stress", "true_stress", "cauchy"})) return;
  const bool turned = *std::ranges::min_element(strain) > -1e-3;
  for (std::size_t i = 0; i < stress.size(); ++i)
    stress[i] /= 1.0 + (turned ? sign : 1.0) * strain[i];
  notes.push_back("`" + curve.y_axis.column +
                  "` is the force per deformed area; divided by the stretch, as in an "
                  "incompressible specimen, it is the nominal stress of the model");
}

// Fits stress over strain, force over strain or force over length, where the sizes of the specimen
// turn forces into stresses and lengths into strains. Throws InputError for missing sizes.
fit::Fit uniaxial_fit(const Fit& command, const measured::MeasuredCurve& curve) {
  const auto wrong = [&](const measured::MeasuredAxis& axis, const std::string& wanted) {
    const std::string known = axis.has_unit ? dimension_name(axis.dimension) : "without a unit";
    throw InputError({curve.file, 0, 0},
                     "`" + axis.column + "` is " + known + ", and this model " + wanted);
  };
  fit::UniaxialTest test;
  using Model = fit::UniaxialTest::Model;
  test.model = command.model == "modulus"       ? Model::modulus
               : command.model == "neo_hookean" ? Model::neo_hookean
               : command.model == "ogden"       ? Model::ogden
               : command.model == "yeoh"        ? Model::yeoh
                                                : Model::ogden3;
  test.cycle = command.cycle;
  test.toe = command.toe;
  auto [strain, loading] = strained(command, curve);
  test.loading = loading;
  test.residuals = fit::Residuals::correlated;
  test.from = strain_of("--from", command.from);
  test.to = strain_of("--to", command.to);
  if (test.from && test.to && !(*test.from < *test.to))
    refuse("`--from` is not below `--to`; give a range of strains");

  std::vector<double> stress = curve.y;
  if (curve.x_axis.dimension == unit::mm.dimension) {
    if (command.height.empty())
      wrong(curve.x_axis,
            "needs the specimen's height for the strain; give it as `--height \"10 mm\"`, or name "
            "a column of strains with `--x`");
    const double height = length_of("--height", command.height);
    for (double& each : strain) each /= height;
  } else if (!(curve.x_axis.dimension == Dimension{}) || !curve.x_axis.has_unit) {
    wrong(curve.x_axis,
          "wants a strain or a length; name another column with `--x`, or give `--x-unit 1` (or "
          "`%`, `mm`)");
  }
  if (curve.y_axis.dimension == unit::N.dimension) {
    if (command.area.empty() && command.diameter.empty())
      wrong(curve.y_axis,
            "needs the cross-section for the stress; give `--diameter \"20 mm\"` or `--area \"300 "
            "mm^2\"`, or name a column of stresses with `--y`");
    const double area = area_of(command);
    for (double& each : stress) each /= area;
  } else if (!(curve.y_axis.dimension == unit::kPa.dimension)) {
    wrong(curve.y_axis,
          "wants a stress or a force; name another column with `--y`, or give `--y-unit kPa`");
  }
  if (command.platens == "bonded") {
    if (command.diameter.empty() || command.height.empty())
      refuse(
          "`--platens bonded` wants the specimen's `--diameter` and `--height`, for the ratio of "
          "its loaded to its free surface");
    test.shape_factor =
        length_of("--diameter", command.diameter) / (4.0 * length_of("--height", command.height));
    if (command.poisson_ratio >= 0) test.poisson_ratio = command.poisson_ratio;
  }
  std::vector<std::string> notes;
  take_nominal(curve, strain, stress, test.loading == fit::UniaxialTest::Loading::compression,
               notes);
  fit::Fit result = fit::fit_uniaxial(strain, stress, test);
  result.notes.insert(result.notes.begin(), notes.begin(), notes.end());
  if (!test.shape_factor && command.platens.empty()) result.law += ", slippery platens";
  return result;
}

}  // namespace

void check_fit(const Fit& command) {
  struct Option {
    std::string name;
    bool given;
    Models models;
    std::string example = {};  // of an option that these models require
  };
  constexpr auto part = std::to_array<std::string_view>(
      {"hertz", "layer", "modulus", "neo_hookean", "ogden", "yeoh", "ogden3"});
  constexpr auto ramps =
      std::to_array<std::string_view>({"prony", "prony_creep", "standard_linear_solid"});
  constexpr Models hertz = elastic_models.first(1), layer = elastic_models.last(1);
  const bool bonded = is_one_of(command.model, uniaxial_models) && command.platens == "bonded";
  for (const Option& option :
       {Option{"--radius", !command.radius.empty(), contact_models},
        Option{"--tip", !command.tip.empty(), contact_models},
        Option{"--half-angle", !command.half_angle.empty(), hertz},
        Option{"--baseline", !command.baseline.empty(), contact_models},
        Option{"--baseline-from", !command.baseline_from.empty(), elastic_models},
        Option{"--baseline-to", !command.baseline_to.empty(), elastic_models},
        Option{"--contact-point", !command.contact_point.empty(), elastic_models},
        Option{"--time", !command.time.empty(), viscous_models, "time"},
        Option{"--atoms", !command.atoms.empty(), adhesive_models},
        Option{"--liquid", command.liquid, series_models},
        Option{"--from", !command.from.empty(), part},
        Option{"--to", !command.to.empty(), part},
        Option{"--height", !command.height.empty(), uniaxial_models},
        Option{"--diameter", !command.diameter.empty(), uniaxial_models},
        Option{"--area", !command.area.empty(), uniaxial_models},
        Option{"--platens", !command.platens.empty(), uniaxial_models},
        Option{"--loading", !command.loading.empty(), uniaxial_models},
        Option{"--cycle", command.cycle > 0, uniaxial_models},
        Option{"--toe", command.toe, uniaxial_models},
        Option{"--poisson", command.poisson_ratio >= 0 && !bonded, contact_models, "0.45"},
        Option{"--thickness", !command.thickness.empty(), layer, "\"5 mm\""},
        Option{"--base", !command.base.empty(), layer},
        Option{"--ramp", command.ramp.has_value(), ramps},
        Option{"--history", !command.history.empty(), series_models},
        Option{"--history-power", command.history_power > 0, series_models},
        Option{"--terms", command.terms > 0, series_models, "2"}}) {
    const bool fits = is_one_of(command.model, option.models);
    if (option.given && !fits)
      refuse("`" + option.name + "` is not used by the model `" + command.model +
             "`; leave it out");
    if (!option.given && fits && !option.example.empty())
      refuse("the model `" + command.model + "` wants `" + option.name + "`; write it as `" +
             option.name + " " + option.example + "`");
  }
  if (command.x_origin && is_one_of(command.model, contact_models))
    refuse("`--origin` is not used by the model `" + command.model +
           "`, which fits the contact point; leave it out");
  if (command.x_origin && is_one_of(command.model, uniaxial_models))
    refuse("`--origin` is not used by the model `" + command.model + "`; leave it out");
}

namespace {

void check_axis(const measured::MeasuredCurve& curve, const measured::MeasuredAxis& axis,
                const Unit& wanted, const std::string& option) {
  if (axis.dimension == wanted.dimension) return;
  if (axis.mass && wanted.dimension == unit::N.dimension)
    throw InputError({curve.file, 0, 0}, "`" + axis.column + "` is a mass in " + axis.unit +
                                             ", and this model wants a force; give `" + option +
                                             "-unit " + axis.unit +
                                             "f` if it is the weight that a load cell shows, or `" +
                                             option + "-unit N` if the unit is wrong");
  const std::string known = axis.has_unit ? dimension_name(axis.dimension) : "without a unit";
  throw InputError({curve.file, 0, 0},
                   "`" + axis.column + "` is " + known + ", and this model wants a " +
                       wanted.quantity + "; name another column with `" + option + "`, or give `" +
                       option + "-unit " + wanted.symbol + "`");
}

fit::Fit contact_fit(const Fit& command, const measured::MeasuredCurve& curve) {
  check_axis(curve, curve.x_axis, unit::mm, "--x");
  check_axis(curve, curve.y_axis, unit::N, "--y");
  fit::ContactTest test = contact_test(command);
  if (is_one_of(command.model, elastic_models)) {
    test.bending = curve.bending;
    return fit::fit_contact(curve.x, curve.y, test);
  }
  if (is_one_of(command.model, adhesive_models))
    return fit::fit_adhesive(curve.x, curve.y, test, adhesive_test(command));
  const measured::MeasuredColumn& time = curve.beside.front();
  if (!(time.axis.dimension == unit::s.dimension))
    throw InputError({curve.file, 0, 0}, "`" + time.axis.column +
                                             "` is no time in a known unit; name another `--time`");
  return fit::fit_viscous(
      time.values, curve.x, curve.y, test,
      command.model == "hertz_solid" ? fit::Viscous::solid : fit::Viscous::power_law);
}

// The series with its loading history: a step, a ramp, or a column of the same rows.
fit::PronySeries series_of(const Fit& command, const measured::MeasuredCurve& curve, double ramp) {
  fit::PronySeries series;
  if (command.model == "prony_creep") series.kind = fit::PronySeries::Kind::creep;
  series.terms = command.terms;
  series.liquid = command.liquid;
  series.history.ramp = ramp;
  if (command.history.empty()) {
    if (command.history_power > 0)
      refuse("`--history-power` is the exponent of `--history`; name that column too");
    return series;
  }
  if (command.ramp) refuse("`--ramp` and `--history` both give the loading; leave one of them out");
  const measured::MeasuredColumn& history = curve.beside.front();
  const bool depth =
      history.axis.dimension == unit::mm.dimension && curve.y_axis.dimension == unit::N.dimension;
  const double power = command.history_power > 0 ? command.history_power : depth ? 1.5 : 1.0;
  for (const double each : history.values)
    series.history.samples.push_back(
        power == 1.0 ? each : std::copysign(std::pow(std::abs(each), power), each));
  return series;
}

// Times that the record is too short to tell: more than ten times its length.
void refuse_long_times(const fit::Fit& result) {
  const double length = result.range_high - result.range_low;
  for (const fit::Estimate& one : result.parameters)
    if (one.name.starts_with("tau") && one.estimate > 10.0 * length)
      throw InputError({}, "`" + one.name + "` is " + rounded_text(one.estimate) + " " + one.unit +
                               ", more than ten times the record of " + rounded_text(length) + " " +
                               one.unit +
                               ", which cannot tell it; record longer, or fit fewer terms");
}

// Where time begins for the model: as asked, or at the step that the curve shows.
fit::StepOrigin origin_of(const Fit& command, const measured::MeasuredCurve& curve) {
  if (command.x_origin) return {{*command.x_origin, command.ramp.value_or(0.0), *command.x_origin}};
  if (!command.history.empty()) return {};  // only differences of the times count
  const std::span<const double> x = curve.x_written;
  const std::span<const double> y = curve.y_written;
  using fit::AfterStep;
  if (command.model == "prony" || command.model == "standard_linear_solid")
    return fit::step_origin(x, y, AfterStep::relaxes, command.ramp);
  const bool rises = y.size() > 1 && y.back() >= y.front();
  if (command.model == "spring_pot" || (command.model == "fractional_zener" && !rises)) {
    fit::StepOrigin origin = fit::step_origin(x, y, AfterStep::relaxes, std::nullopt);
    const auto [time, ramp, first] = origin.best;
    if (ramp == 0.0) return origin;
    origin.best = {time + 0.5 * ramp, 0.0, first};
    origin.others = {{time, 0.0, first}, {time + ramp, 0.0, first}};
    origin.sentence =
        "the load rises from " + rounded_text(time) + " to " + rounded_text(time + ramp) +
        "; the step is taken in the middle (Zapas and " +
        "Phillips 1971), and the intervals contain steps at both ends; `prony` takes " +
        "the ramp as it is";
    return origin;
  }
  if (command.model == "kelvin_voigt_recovery")
    return fit::step_origin(x, y, AfterStep::recovers, 0.0);
  if (command.model == "prony_creep" || command.model == "fractional_zener")
    return fit::step_origin(x, y, AfterStep::rises, command.ramp.value_or(0.0));
  if (is_one_of(command.model, {"kelvin_voigt", "spring_pot_creep"}))
    return fit::step_origin(x, y, AfterStep::rises_from_zero, 0.0);
  return {};
}

// Relaxation with one time constant after a ramp: a Prony series of one term, with y_0 for y_1.
fit::Fit solid_after_ramp(std::span<const double> x, std::span<const double> y,
                          const fit::PronySeries& series, const fit::Options& options) {
  fit::Fit result = fit::fit_prony(x, y, series, options);
  fit::Estimate& jump = result.parameters[1];
  jump.name = "y_0";
  jump.estimate += result.parameters[0].estimate;
  if (const dense::Matrix& v = result.covariance; v.rows() == 3) {
    const double t = (jump.ci95_high - jump.ci95_low) / (2.0 * jump.std_error);
    jump.std_error = std::sqrt(v(0, 0) + v(1, 1) + 2.0 * v(0, 1));
    jump.ci95_low = jump.estimate - t * jump.std_error;
    jump.ci95_high = jump.estimate + t * jump.std_error;
  }
  result.parameters[2].name = "tau";
  result.covariance = {};  // of the series
  return result;
}

// A fit of a curve over time, whose loading begins as given; of every row or of each `stride`th.
fit::Fit fit_over_time(const Fit& command, const measured::MeasuredCurve& curve,
                       const fit::Loading& loading, std::size_t stride = 1) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < curve.x_written.size(); i += stride) {
    // Rows before the step are excluded, and counted.
    x.push_back(curve.x_written[i] < loading.first ? std::nan("") : curve.x_written[i]);
    y.push_back(curve.y_written[i]);
  }
  const fit::Options options{.x_unit = curve.x_axis.unit,
                             .y_unit = curve.y_axis.unit,
                             .x_origin = loading.time,
                             .residuals = fit::Residuals::correlated};
  for (const auto& [name, model] : {std::pair{"spring_pot", fit::Fractional::spring_pot},
                                    {"spring_pot_creep", fit::Fractional::spring_pot_creep},
                                    {"fractional_zener", fit::Fractional::zener}})
    if (command.model == name) return fit::fit_fractional(x, y, model, options);
  const auto model = fit::find_model(command.model);
  if (model == fit::Model::standard_linear_solid && loading.ramp > 0.0) {
    fit::PronySeries series;
    series.terms = 1;
    series.history.ramp = loading.ramp;
    return solid_after_ramp(x, y, series, options);
  }
  if (model) return fit::regress(x, y, *model, options);
  return fit::fit_prony(x, y, series_of(command, curve, loading.ramp), options);
}

// Takes the rows of the recovery off a record of creep; returns how many there are.
std::size_t take_off_recovery(const std::vector<double>& x, std::vector<double>& y) {
  std::vector<double> time, finite;
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    time.push_back(x[i]);
    finite.push_back(y[i]);
  }
  if (finite.empty()) return 0;
  const auto [least, most] = std::ranges::minmax_element(finite);
  if (*most - finite[0] < finite[0] - *least) return 0;  // falls as it creeps
  const std::size_t rows = fit::rows_before_recovery(time, finite);
  std::size_t row = 0;
  for (std::size_t i = 0; i < y.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i]) && ++row > rows) y[i] = std::nan("");
  return finite.size() - rows;
}

fit::Fit fitted_over_time(const Fit& command, const measured::MeasuredCurve& whole) {
  measured::MeasuredCurve curve = whole;
  const bool creeps = is_one_of(command.model, {"kelvin_voigt", "prony_creep", "spring_pot_creep"});
  const std::size_t later = creeps ? take_off_recovery(curve.x_written, curve.y_written) : 0;
  fit::StepOrigin origin = origin_of(command, curve);
  const bool relaxes = is_one_of(command.model, {"prony", "standard_linear_solid", "spring_pot"});
  const fit::Limit limit = relaxes ? fit::limit_of(curve.y_written) : fit::Limit();
  for (std::size_t i = limit.from; i < limit.to; ++i) curve.y_written[i] = std::nan("");
  if (origin.after_level && origin.best.ramp == 0.0 && !origin.sentence.empty()) {
    const std::size_t stride = 1 + curve.x_written.size() / 4000;
    std::vector<double> x, y;
    for (std::size_t i = 0; i < curve.x_written.size(); i += stride) {
      x.push_back(curve.x_written[i]);
      y.push_back(curve.y_written[i]);
    }
    origin = fit::refined(origin, x, y, [&](const fit::Loading& loading) {
      return fit::misfit_of([&] { return fit_over_time(command, curve, loading, stride); });
    });
  }
  fit::Fit result = fit_over_time(command, curve, origin.best);
  double wider = 1.0;
  for (const fit::Loading& other : origin.others) {
    const fit::Fit there = fit_over_time(command, curve, other);
    if (there.termination != fit::Termination::converged ||
        there.parameters.size() != result.parameters.size())
      continue;
    for (std::size_t i = 0; i < result.parameters.size(); ++i) {
      fit::Estimate& one = result.parameters[i];
      const double width = one.ci95_high - one.ci95_low;
      one.ci95_low = std::min(one.ci95_low, there.parameters[i].ci95_low);
      one.ci95_high = std::max(one.ci95_high, there.parameters[i].ci95_high);
      wider = std::max(wider, (one.ci95_high - one.ci95_low) / width);
    }
  }
  if (later > 0)
    result.notes.insert(result.notes.begin(),
                        std::to_string(later) +
                            " points are excluded: the curve falls there as in a recovery, which "
                            "`kelvin_voigt_recovery` fits");
  if (limit.from < limit.to)
    result.notes.insert(result.notes.begin(), std::to_string(limit.to - limit.from) +
                                                  " points are excluded: the load stays at its "
                                                  "largest value, as at the limit of a sensor");
  const auto early =
      std::ranges::count_if(curve.x_written, [&](double x) { return x < origin.best.first; });
  if (early > 0)
    result.notes.insert(result.notes.begin(), std::to_string(early) +
                                                  (early == 1 ? " point is" : " points are") +
                                                  " excluded: before the step");
  if (!origin.sentence.empty())
    result.notes.insert(
        result.notes.begin(),
        origin.sentence +
            (wider > 1.1 ? "; the rows leave it open by their distance, which the intervals contain"
                         : ""));
  return result;
}

fit::Fit fitted(const Fit& command, const measured::MeasuredCurve& curve) {
  if (is_one_of(command.model, contact_models)) return contact_fit(command, curve);
  if (is_one_of(command.model, uniaxial_models)) return uniaxial_fit(command, curve);
  return fitted_over_time(command, curve);
}

// A search that ended without a minimum has no result.
void refuse_unconverged(const fit::Fit& result) {
  if (result.termination == fit::Termination::converged) return;
  if (result.termination == fit::Termination::undetermined) {
    throw InputError({}, "these points do not determine every parameter of `" +
                             fit::model_name(result) +
                             "`; fit a model with fewer parameters, or record more points");
  }
  throw InputError(
      {}, "the search for the parameters of `" + fit::model_name(result) +
              "` ended without a minimum (" + std::string(fit::word(result.termination)) +
              "), so that there is no result; choose another model, or a part of the curve");
}

}  // namespace

FittedCurve fit_curve(const Fit& command, const std::string& path) {
  DataOptions columns = command.columns;
  columns.blanks = DataOptions::Blanks::keep;  // the fit counts all points that it excludes
  if (is_one_of(command.model, adhesive_models)) columns.usual = "retract";
  if (is_one_of(command.model,
                {"prony", "standard_linear_solid", "spring_pot", "fractional_zener"}))
    columns.curve = DataOptions::Curve::relaxation;
  if (is_one_of(command.model,
                {"prony_creep", "kelvin_voigt", "kelvin_voigt_recovery", "spring_pot_creep"}))
    columns.curve = DataOptions::Curve::creep;
  for (const std::string* each : {&command.time, &command.history})
    if (!each->empty()) columns.beside.push_back(*each);
  const measured::MeasuredCurve curve = measured::read_measured(path, columns);
  fit::Fit result;
  try {
    result = fitted(command, curve);
    refuse_unconverged(result);
    if (curve.x_axis.dimension == unit::s.dimension) refuse_long_times(result);
    if (result.law.empty() || is_one_of(result.name, {"prony", "prony_creep", "spring_pot",
                                                      "spring_pot_creep", "fractional_zener"}))
      fit::warn_of_residuals(result);
  } catch (const InputError& error) {
    const Problem& problem = error.problems().front();
    if (!problem.place.file.empty() || problem.message.starts_with("palpate: ")) throw;
    throw InputError({path, 0, 0}, problem.message);
  }
  result.notes.insert(result.notes.begin(), curve.notes.begin(), curve.notes.end());
  if (curve.guessed)
    result.notes.insert(result.notes.begin(), "x is `" + curve.x_axis.column + "` and y is `" +
                                                  curve.y_axis.column +
                                                  "`; `--x` and `--y` name others");
  return {curve.y_axis.column + " over " + curve.x_axis.column, std::move(result)};
}

}  // namespace palpate::cli
