// The curves that can be fitted, with their parameters and units.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::fit {

enum class Model {
  logarithmic,            // y = a + b ln x
  power,                  // y = A x^n
  exponential,            // y = B (e^(m x) - 1)
  kelvin_voigt,           // y = y_inf (1 - e^(-x/tau)), creep
  kelvin_voigt_recovery,  // y = y_0 e^(-x/tau), recovery
  standard_linear_solid,  // y = y_inf + (y_0 - y_inf) e^(-x/tau), relaxation
};

// How a parameter's unit is formed from those of x and y.
enum class UnitRule { none, of_y, of_x, per_x, y_per_x_to_n };

struct Parameter {
  std::string_view name;
  UnitRule unit;
};

// One row of the table of models. The linear parameters come first.
struct ModelInfo {
  Model model;
  std::string_view name;     // on the command line and in fits.csv
  std::string_view formula;  // for people
  std::span<const Parameter> parameters;
  bool positive_x_only = false;  // points with x <= 0 are excluded
};

// All models, in the order of the enumeration.
[[nodiscard]] std::span<const ModelInfo> models();
[[nodiscard]] const ModelInfo& info(Model model);

// The model of that name, or nothing.
[[nodiscard]] std::optional<Model> find_model(std::string_view name);

// The curve's value at x; `parameters` in the order of info(model) and in the units of the data.
[[nodiscard]] double value(Model model, std::span<const double> parameters, double x);

// A curve is a sum of at most two terms c_i phi_i(x, q). It is linear in c_i and non-linear in the
// shape parameter q (n, m or tau). The logarithmic model has the terms 1 and ln x, and no q.
[[nodiscard]] std::array<double, 2> terms(Model model, double x, double shape);   // phi_i at x
[[nodiscard]] std::array<double, 2> slopes(Model model, double x, double shape);  // d phi_i / dq

[[nodiscard]] int term_count(Model model);
[[nodiscard]] bool has_shape(Model model);  // whether there is a shape parameter, the last one

// The unit at the end of a column's name: `N` for `force_N`, empty for `strain`.
[[nodiscard]] std::string column_unit(std::string_view column);

// The unit of a parameter, from those of the data: `N/mm^n` or `1/mm` for x in mm and y in N.
[[nodiscard]] std::string unit_text(UnitRule rule, const std::string& x_unit,
                                    const std::string& y_unit);

}  // namespace palpate::fit
