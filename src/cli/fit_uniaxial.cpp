// Turns columns into strain and stress.
#include "cli/fit_uniaxial.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/fit_contact.h"

namespace palpate::cli {
namespace {

constexpr Unit mm2{"mm^2", "area", 1, 1e6, {2, 0, 0}};

double area_of(const Fit& command) {
  if (!command.area.empty() && !command.diameter.empty())
    refuse("`--area` and `--diameter` both give the cross-section; leave one of them out");
  if (!command.diameter.empty()) {
    const double diameter = length_of("--diameter", command.diameter);
    return std::numbers::pi / 4.0 * diameter * diameter;
  }
  double area = 0.0;
  try {
    area = parse_quantity(command.area, mm2);
  } catch (const std::invalid_argument& wrong) {
    refuse("`--area` " + std::string(wrong.what()));
  }
  if (!(area > 0.0)) refuse("`--area` is `" + command.area + "`; give an area above 0");
  return area;
}

// A strain, as `10 %` or `0.1`.
std::optional<double> strain_of(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto number = leading_number(text);
  const std::string unit = number ? trimmed(number->rest) : "";
  if (!number || !(unit.empty() || unit == "%"))
    refuse("`" + option + "` wants a strain, got `" + text + "`; write it as `10 %` or `0.1`");
  return unit == "%" ? number->value / 100.0 : number->value;
}

fit::UniaxialTest::Loading loading_of(const Fit& command, const measured::MeasuredCurve& curve) {
  using Loading = fit::UniaxialTest::Loading;
  if (command.loading == "compression") return Loading::compression;
  if (command.loading == "tension") return Loading::tension;
  if (!command.loading.empty())
    refuse("`--loading` does not know `" + command.loading + "`; it is compression or tension");
  // A load that was turned because it is negative in compression.
  const bool turned = std::any_of(curve.notes.begin(), curve.notes.end(), [](const auto& note) {
    return note.find("negative in compression") != std::string::npos;
  });
  const std::string names = lower_case(curve.x_axis.column + " " + curve.y_axis.column);
  if (turned || names.find("compress") != std::string::npos) return Loading::compression;
  if (names.find("tensile") != std::string::npos) return Loading::tension;
  return Loading::unknown;
}

// Whether a column named as a stretch holds strains, which begin near 0 and not near 1.
bool is_strain_below(const std::vector<double>& stretch) {
  for (const double each : stretch)
    if (std::isfinite(each)) return each < 0.3;
  return false;
}

}  // namespace

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
  test.loading = loading_of(command, curve);
  test.residuals = fit::Residuals::correlated;
  test.from = strain_of("--from", command.from);
  test.to = strain_of("--to", command.to);
  if (test.from && test.to && !(*test.from < *test.to))
    refuse("`--from` is not below `--to`; give a range of strains");

  std::vector<double> strain = curve.x;
  std::vector<double> stress = curve.y;
  if (const bool negative = is_strain_below(strain); curve.x_axis.stretch && !negative) {
    for (double& each : strain) each -= 1.0;
    if (test.loading == fit::UniaxialTest::Loading::unknown)
      test.loading = fit::UniaxialTest::Loading::tension;  // of stretches the sign tells
  }
  if (curve.x_axis.dimension == unit::mm.dimension) {
    if (command.height.empty())
      wrong(curve.x_axis,
            "needs the specimen's height for the strain; give it as `--height "
            "\"10 mm\"`, or name a column of strains with `--x`");
    const double height = length_of("--height", command.height);
    for (double& each : strain) each /= height;
  } else if (!(curve.x_axis.dimension == Dimension{}) || !curve.x_axis.has_unit) {
    wrong(curve.x_axis,
          "wants a strain or a length; name another column with `--x`, or give "
          "`--x-unit 1` (or `%`, `mm`)");
  }
  if (curve.y_axis.dimension == unit::N.dimension) {
    if (command.area.empty() && command.diameter.empty())
      wrong(curve.y_axis,
            "needs the cross-section for the stress; give `--diameter \"20 mm\"` or "
            "`--area \"300 mm^2\"`, or name a column of stresses with `--y`");
    const double area = area_of(command);
    for (double& each : stress) each /= area;
  } else if (!(curve.y_axis.dimension == unit::kPa.dimension)) {
    wrong(curve.y_axis,
          "wants a stress or a force; name another column with `--y`, or give "
          "`--y-unit kPa`");
  }
  if (command.platens == "bonded") {
    if (command.diameter.empty() || command.height.empty())
      refuse(
          "`--platens bonded` wants the specimen's `--diameter` and `--height`, for the ratio "
          "of its loaded to its free surface");
    test.shape_factor =
        length_of("--diameter", command.diameter) / (4.0 * length_of("--height", command.height));
  } else if (!command.platens.empty() && command.platens != "slippery") {
    refuse("`--platens` does not know `" + command.platens + "`; it is slippery or bonded");
  }
  fit::Fit result = fit::fit_uniaxial(strain, stress, test);
  if (!test.shape_factor && command.platens.empty()) result.law += ", slippery platens";
  return result;
}

}  // namespace palpate::cli
