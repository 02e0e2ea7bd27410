// Labels made from the names of columns.
#include "sweep/labels.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "base/text.h"
#include "fit/model.h"
#include "plot/gnuplot_text.h"
#include "record/table.h"

namespace palpate::sweep {
namespace {

// Converts the unit in a column's name: `kg_per_m3` to `kg/m3`.
std::string unit_symbol(std::string unit) {
  if (unit == "us") return "µs";
  if (unit.starts_with("per_")) unit = "1_" + unit;
  const std::size_t per = unit.find("_per_");
  if (per != std::string::npos) unit.replace(per, 5, "/");
  std::replace(unit.begin(), unit.end(), '_', ' ');
  return unit;
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + " (" + unit + ")";
}

// The units of the curves that are fitted (docs/results.md).
struct CurveUnits {
  const char* curve;
  const char* x;
  const char* y;
};
constexpr std::array<CurveUnits, 4> curves{
    CurveUnits{"force_indentation", "mm", "N"}, CurveUnits{"creep", "s", ""},
    CurveUnits{"recovery", "s", ""}, CurveUnits{"relaxation", "s", "kPa"}};

// The label of a fitted parameter, a column CURVE_MODEL_PARAMETER_UNIT; empty for other columns.
std::string fit_label(const std::string& column) {
  for (const CurveUnits& curve : curves)
    for (const fit::ModelInfo& model : fit::models())
      for (const fit::Parameter& parameter : model.parameters) {
        const std::string name(model.name);
        const std::string unit = fit::unit_text(parameter.unit, curve.x, curve.y);
        if (column == std::string(curve.curve) + "_" + name + "_" + std::string(parameter.name) +
                          (unit.empty() ? "" : "_" + record::unit_word(unit)))
          return with_unit(std::string(parameter.name) + ", " + name + " fit" +
                               (&curve == curves.data() ? "" : std::string(", ") + curve.curve),
                           unit);
      }
  return {};
}

}  // namespace

std::string output_label(const std::string& column) {
  if (std::string fitted = fit_label(column); !fitted.empty()) return fitted;
  const std::string unit = fit::column_unit(column);
  std::string text = column.substr(0, column.size() - (unit.empty() ? 0 : unit.size() + 1));
  std::replace(text.begin(), text.end(), '_', ' ');
  return with_unit(capitalized(text), unit);
}

std::string factor_label(const sweep::FactorChoice& factor) {
  const std::string& column = factor.column;
  // A factor of several linked keys has the column of the first.
  const std::string key = factor.name.substr(0, factor.name.find(" + "));
  const bool has_unit = column.size() > key.size() + 1 && column.starts_with(key + "_");
  return with_unit(plot::key_label(factor.name),
                   has_unit ? unit_symbol(column.substr(key.size() + 1)) : "");
}

std::string file_word(const std::string& column) {
  std::string word = column;
  for (char& c : word)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return word;
}

bool spread_wide(std::span<const double> values) {
  const auto [least, most] = ends(values);
  return least > 0.0 && most > 30.0 * least;
}

}  // namespace palpate::sweep
