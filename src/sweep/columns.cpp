// Picks the columns of factors and outputs from the rows of a sweep.
#include "sweep/columns.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/index.h"
#include "base/text.h"
#include "fit/regression.h"
#include "plot/gnuplot_text.h"
#include "record/csv.h"

namespace palpate::sweep {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_outputs = 6;
constexpr const char* displacement = "peak_travel_mm";  // a response where the force is given

// The place of a column among the usual outputs, from 0; nothing: only shown if `show` names it.
std::optional<std::size_t> rank(const std::string& column) {
  if (column.starts_with("force_at_")) return 0;
  constexpr std::array<const char*, 10> usual{"peak_force_N",
                                              "peak_stress_kPa",
                                              "secant_modulus_kPa",
                                              "peak_strain",
                                              "creep_half_time_s",
                                              "creep_kelvin_voigt_tau_s",
                                              "creep_standard_linear_solid_tau_s",
                                              "relaxation_standard_linear_solid_tau_s",
                                              "recovery_kelvin_voigt_recovery_tau_s",
                                              displacement};
  for (std::size_t i = 0; i < usual.size(); ++i)
    if (column == usual[i]) return i + 1;
  return std::nullopt;
}

std::size_t place(const std::string& column, std::span<const std::string> header) {
  const auto found = std::ranges::find(header, column);
  if (found != header.end()) return as_index(found - header.begin());
  throw InputError({}, "the results have no column `" + column + "`; " +
                           did_you_mean(column, header, "the first row of results.csv names them"));
}

double word_number(FactorColumn& factor, const std::string& word) {
  const auto found = std::ranges::find(factor.words, word);
  if (found == factor.words.end()) {
    factor.words.push_back(word);
    return static_cast<double>(factor.words.size() - 1);
  }
  return static_cast<double>(found - factor.words.begin());
}

bool varies(const std::vector<double>& values) {
  const auto [least, most] = ends(values);
  // Differences by rounding do not count.
  return most - least > 1e-9 * std::max(std::abs(least), std::abs(most));
}

std::size_t known(const std::vector<double>& values) {
  return as_index(std::ranges::count_if(values, [](double v) { return std::isfinite(v); }));
}

}  // namespace

Ends ends(std::span<const double> values) {
  Ends found;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    found.low = std::min(found.low, value);
    found.high = std::max(found.high, value);
  }
  return found;
}

ColumnReader::ColumnReader(const ColumnChoice& choice, std::span<const std::string> header)
    : asked_(!choice.show.empty()) {
  columns_.kind = choice.kind;
  outcome_at_ = place("outcome", header);
  for (const FactorChoice& factor : choice.factors) {
    factor_at_.push_back(place(factor.column, header));
    columns_.factors.push_back({.choice = factor});
  }
  if (asked_) {
    for (const std::string& column : choice.show) output_at_.push_back(place(column, header));
  } else {
    for (std::size_t i = 0; i < header.size(); ++i)
      if (rank(header[i])) output_at_.push_back(i);
    std::ranges::stable_sort(output_at_, [&](std::size_t a, std::size_t b) {
      return *rank(header[a]) < *rank(header[b]);
    });
  }
  for (const std::size_t i : output_at_) columns_.outputs.push_back({.name = header[i]});
}

void ColumnReader::add(std::span<const record::Cell> row) {
  const auto* outcome = std::get_if<std::string>(&row[outcome_at_]);
  const bool completed = outcome != nullptr && *outcome == "completed";
  ++columns_.cases;
  if (completed) ++completed_;
  for (std::size_t f = 0; f < factor_at_.size(); ++f) {
    FactorColumn& factor = columns_.factors[f];
    const record::Cell& cell = row[factor_at_[f]];
    const auto* number = std::get_if<double>(&cell);
    const auto* text = std::get_if<std::string>(&cell);
    if (number != nullptr && factor.is_number()) {
      factor.values.push_back(*number);
      continue;
    }
    if (factor.is_number())  // a word among numbers makes all of them words
      for (double& value : factor.values) value = word_number(factor, number_text(value));
    const std::string word = number != nullptr ? number_text(*number) : "";
    factor.values.push_back(word_number(factor, text != nullptr ? *text : word));
  }
  for (std::size_t k = 0; k < output_at_.size(); ++k) {
    const record::Cell& cell = row[output_at_[k]];
    if (asked_ && std::holds_alternative<std::string>(cell))
      throw InputError({}, "the column `" + columns_.outputs[k].name + "` holds words, such as `" +
                               std::get<std::string>(cell) +
                               "`; `--show` wants a column of numbers");
    const auto* number = std::get_if<double>(&cell);
    columns_.outputs[k].values.push_back(
        completed && number != nullptr && std::isfinite(*number) ? *number : no_number);
  }
}

SweepColumns ColumnReader::finish() {
  SweepColumns done = std::move(columns_);
  columns_ = {};
  std::vector<OutputColumn> all;
  all.swap(done.outputs);
  for (OutputColumn& output : all) {
    if (!varies(output.values)) {
      if (asked_)
        done.notes.push_back(
            "`" + output.name +
            "` has the same value, or none, in every case: there is nothing to draw");
    } else if (asked_) {
      done.outputs.push_back(std::move(output));
    } else if (known(output.values) == completed_ && done.outputs.size() < most_outputs &&
               (output.name != displacement || done.outputs.empty())) {
      done.outputs.push_back(std::move(output));
    }
  }
  if (done.outputs.empty() && !asked_ && completed_ > 0)
    done.notes.push_back(
        "none of the usual outputs varies and has a value in every case: there is nothing to draw; "
        "give `output.force_at`, or choose a column by `--show`");
  return done;
}

namespace {

// Converts the unit in a column's name: `kg_per_m3` to `kg/m3`.
std::string unit_symbol(std::string unit) {
  if (unit == "us") return "µs";
  if (unit.starts_with("per_")) unit = "1_" + unit;
  const std::size_t per = unit.find("_per_");
  if (per != std::string::npos) unit.replace(per, 5, "/");
  std::ranges::replace(unit, '_', ' ');
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
  std::ranges::replace(text, '_', ' ');
  return with_unit(capitalized(text), unit);
}

std::string factor_label(const FactorChoice& factor) {
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

namespace {

constexpr std::size_t before_keys = 2;  // number, id
constexpr std::size_t part = 1u << 18;  // bytes

std::vector<FactorChoice> factor_choices(const scenario::Design& design,
                                         const std::vector<std::string>& header) {
  std::vector<FactorChoice> choices;
  for (const scenario::Factor& factor : design.factors()) {
    const scenario::Varied& first = factor.keys.front();
    const auto& keys = design.keys();
    const auto key = std::ranges::find(keys, first.key) - keys.begin();
    choices.push_back({.name = factor.name,
                       .column = header.at(before_keys + as_index(key)),
                       .scale = first.interval ? first.interval->scale : Scale::linear,
                       .levels = factor.levels()});
  }
  return choices;
}

}  // namespace

SweepColumns read_sweep_columns(const std::string& path, const scenario::Design& design,
                                const std::vector<std::string>& show) {
  std::optional<ColumnReader> reader;
  std::string header;
  std::string rows;
  const auto parse = [&] {
    const record::Table table = record::parse_csv(header + rows, path);
    if (!reader)
      reader.emplace(ColumnChoice{design.kind(), factor_choices(design, table.columns), show},
                     table.columns);
    for (const auto& row : table.rows) reader->add(row);
    rows.clear();
  };
  bool quoted = false;  // inside a quoted field, which may contain line ends
  for_each_line(path, [&](const FileLine& line) {
    std::string& into = header.empty() || (quoted && rows.empty()) ? header : rows;
    into += std::string(line.text) + "\n";
    if (std::ranges::count(line.text, '"') % 2 != 0) quoted = !quoted;
    if (!quoted && rows.size() > part) parse();
  });
  parse();
  SweepColumns columns = reader->finish();
  for (std::size_t f = 0; f < columns.factors.size(); ++f)
    if (FactorColumn& factor = columns.factors[f]; factor.is_number() &&
                                                   !design.factors()[f].keys.front().interval &&
                                                   spread_wide(factor.values))
      factor.choice.scale = Scale::logarithmic;
  return columns;
}

}  // namespace palpate::sweep
