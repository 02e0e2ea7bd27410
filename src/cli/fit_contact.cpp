// Reads the tip, the baseline and the range of depths.
#include "cli/fit_contact.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"

namespace palpate::cli {
namespace {

constexpr std::array tips{"paraboloid", "sphere", "cone", "pyramid3", "pyramid4", "punch"};

contact::LayerBase base_of(const std::string& word) {
  if (word.empty() || word == "bonded") return contact::LayerBase::bonded;
  if (word == "frictionless") return contact::LayerBase::frictionless;
  refuse("`--base` does not know `" + word + "`; it is bonded or frictionless");
}

fit::Tip::Kind tip_of(const std::string& word) {
  if (word.empty()) return fit::Tip::Kind::paraboloid;
  if (const auto found = fit::find_tip(word)) return *found;
  const std::vector<std::string> known(tips.begin(), tips.end());
  const auto near = nearest(word, known);
  refuse("`--tip` does not know `" + word + "`" +
         (near ? "; did you mean `" + *near + "`?" : "; it is one of " + joined(known, ", ")));
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
  if (word.empty() || word == "auto") return Choice::automatic;
  if (word == "none") return Choice::none;
  if (word == "offset") return Choice::offset;
  if (word == "tilt") return Choice::tilt;
  refuse("`--baseline` does not know `" + word + "`; it is none, offset, tilt or auto");
}

// `0.1 mm`, or a share as `10 %` or `0.1`.
std::optional<fit::DepthLimit> limit_of(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto number = leading_number(text);
  const std::string unit = number ? trimmed(number->rest) : "";
  if (number && (unit.empty() || unit == "%")) {
    const double share = unit.empty() ? number->value : number->value / 100.0;
    if (!(share >= 0.0 && share <= 1.0))
      refuse("`" + option + "` is `" + text +
             "`; give a share from 0 to 100 %, or a depth as `1 mm`");
    return fit::DepthLimit{share, true};
  }
  try {
    const double depth = parse_quantity(text, unit::mm);
    if (depth < 0.0) refuse("`" + option + "` is `" + text + "`; give a depth of 0 or more");
    return fit::DepthLimit{depth, false};
  } catch (const std::invalid_argument& wrong) {
    refuse("`" + option + "` " + wrong.what() + ", or as `10 %`");
  }
}

// A place on the axis of x, of any sign.
std::optional<double> place_of(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  try {
    return parse_quantity(text, unit::mm);
  } catch (const std::invalid_argument& wrong) {
    refuse("`" + option + "` " + wrong.what());
  }
}

}  // namespace

double length_of(const std::string& option, const std::string& text) {
  double size = 0.0;
  try {
    size = parse_quantity(text, unit::mm);
  } catch (const std::invalid_argument& wrong) {
    refuse("`" + option + "` " + wrong.what());
  }
  if (!(size > 0.0)) refuse("`" + option + "` is `" + text + "`; give a length above 0");
  return size;
}

fit::AdhesiveTest adhesive_test(const Fit& command) {
  fit::AdhesiveTest test;
  if (command.model != "adhesive")
    test.law = command.model == "jkr" ? fit::Adhesion::jkr : fit::Adhesion::dmt;
  if (!command.atoms.empty()) test.distance = length_of("--atoms", command.atoms);
  return test;
}

fit::ContactTest contact_test(const Fit& command) {
  fit::ContactTest test;
  test.poisson_ratio = command.poisson_ratio;
  test.tip = tip_of(command.tip);
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
  test.base = base_of(command.base);
  const bool hertz = command.model == "hertz";
  if (!hertz && command.model != "layer" && test.tip != fit::Tip::Kind::paraboloid)
    refuse("the model `" + command.model + "` knows no tip but `paraboloid`; leave `--tip` out");
  if (!hertz && command.model != "layer" && command.baseline == "tilt" &&
      command.model.starts_with("hertz_"))
    refuse("the model `" + command.model + "` knows no tilt; give `--baseline offset`");
  if (command.model == "layer") {
    if (test.tip != fit::Tip::Kind::paraboloid)
      refuse("the model `layer` knows no tip but `paraboloid`; leave `--tip` out");
    test.thickness = length_of("--thickness", command.thickness);
  }
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
  const bool adhesive =
      command.model == "jkr" || command.model == "dmt" || command.model == "adhesive";
  if (segment == "retract" || (adhesive && segment.empty())) test.way = fit::Way::retract;
  if (segment == "all" && !adhesive) test.way = fit::Way::all;
  test.residuals = fit::Residuals::correlated;
  return test;
}

}  // namespace palpate::cli
