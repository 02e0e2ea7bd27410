// The table of models and their formulas.
#include "fit/model.h"

#include <cassert>
#include <cmath>

#include "base/index.h"

namespace palpate::fit {
namespace {

constexpr std::array logarithmic{Parameter{"a", UnitRule::of_y}, Parameter{"b", UnitRule::of_y}};
constexpr std::array power{Parameter{"A", UnitRule::y_per_x_to_n}, Parameter{"n", UnitRule::none}};
constexpr std::array exponential{Parameter{"B", UnitRule::of_y}, Parameter{"m", UnitRule::per_x}};
constexpr std::array creep{Parameter{"y_inf", UnitRule::of_y}, Parameter{"tau", UnitRule::of_x}};
constexpr std::array recovery{Parameter{"y_0", UnitRule::of_y}, Parameter{"tau", UnitRule::of_x}};
constexpr std::array relaxation{Parameter{"y_inf", UnitRule::of_y},
                                Parameter{"y_0", UnitRule::of_y}, Parameter{"tau", UnitRule::of_x}};

constexpr std::array<ModelInfo, 6> table{{
    {Model::logarithmic, "logarithmic", "y = a + b ln x", logarithmic, true},
    {Model::power, "power", "y = A x^n", power, true},
    {Model::exponential, "exponential", "y = B (e^(m x) - 1)", exponential},
    {Model::kelvin_voigt, "kelvin_voigt", "y = y_inf (1 - e^(-x/tau))", creep},
    {Model::kelvin_voigt_recovery, "kelvin_voigt_recovery", "y = y_0 e^(-x/tau)", recovery},
    {Model::standard_linear_solid, "standard_linear_solid", "y = y_inf + (y_0 - y_inf) e^(-x/tau)",
     relaxation},
}};

constexpr std::array<std::string_view, 16> unit_words{
    "m", "mm", "um", "nm", "s", "ms", "us", "min", "N", "mN", "uN", "Pa", "kPa", "MPa", "J", "mJ"};

}  // namespace

std::span<const ModelInfo> models() { return table; }

const ModelInfo& info(Model model) {
  const ModelInfo& row = table[as_index(model)];
  assert(row.model == model);
  return row;
}

std::optional<Model> find_model(std::string_view name) {
  for (const ModelInfo& row : table)
    if (row.name == name) return row.model;
  return std::nullopt;
}

bool has_shape(Model model) { return model != Model::logarithmic; }

int term_count(Model model) {
  return static_cast<int>(info(model).parameters.size()) - (has_shape(model) ? 1 : 0);
}

std::array<double, 2> terms(Model model, double x, double shape) {
  switch (model) {
    case Model::logarithmic: return {1.0, std::log(x)};
    case Model::power: return {std::pow(x, shape)};
    case Model::exponential: return {std::expm1(shape * x)};  // accurate for small m x
    case Model::kelvin_voigt: return {-std::expm1(-x / shape)};
    case Model::kelvin_voigt_recovery: return {std::exp(-x / shape)};
    case Model::standard_linear_solid: return {-std::expm1(-x / shape), std::exp(-x / shape)};
  }
  return {};
}

std::array<double, 2> slopes(Model model, double x, double shape) {
  const auto left = [&] { return x / (shape * shape) * std::exp(-x / shape); };
  switch (model) {
    case Model::logarithmic: return {};
    case Model::power: return {std::pow(x, shape) * std::log(x)};
    case Model::exponential: return {x * std::exp(shape * x)};
    case Model::kelvin_voigt: return {-left()};  // d/dtau (1 - e^(-x/tau)) = -(x/tau^2) e^(-x/tau)
    case Model::kelvin_voigt_recovery: return {left()};
    case Model::standard_linear_solid: return {-left(), left()};
  }
  return {};
}

double value(Model model, std::span<const double> parameters, double x) {
  assert(parameters.size() == info(model).parameters.size());
  const auto phi = terms(model, x, parameters.back());
  double sum = 0.0;
  for (int i = 0; i < term_count(model); ++i) {
    const auto k = as_index(i);
    sum += parameters[k] * phi[k];
  }
  return sum;
}

std::string column_unit(std::string_view column) {
  const std::size_t underscore = column.rfind('_');
  if (underscore == std::string_view::npos) return {};
  const std::string_view last = column.substr(underscore + 1);
  for (const std::string_view unit : unit_words)
    if (last == unit) return std::string(unit);
  return {};
}

std::string unit_text(UnitRule rule, const std::string& x_unit, const std::string& y_unit) {
  const std::string above = y_unit.empty() ? "1" : y_unit;
  switch (rule) {
    case UnitRule::none: return {};
    case UnitRule::of_y: return y_unit;
    case UnitRule::of_x: return x_unit;
    case UnitRule::per_x: return x_unit.empty() ? std::string() : "1/" + x_unit;
    case UnitRule::y_per_x_to_n: return x_unit.empty() ? y_unit : above + "/" + x_unit + "^n";
  }
  return {};
}

}  // namespace palpate::fit
