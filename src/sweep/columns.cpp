// Picks the columns of factors and outputs from the rows of a sweep.
#include "sweep/columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"

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
  const auto found = std::find(header.begin(), header.end(), column);
  if (found != header.end()) return as_index(found - header.begin());
  const auto near = nearest(column, header);
  throw InputError({}, "the results have no column `" + column + "`" +
                           (near ? "; did you mean `" + *near + "`?"
                                 : "; the first row of results.csv names them"));
}

double word_number(FactorColumn& factor, const std::string& word) {
  const auto found = std::find(factor.words.begin(), factor.words.end(), word);
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
  return as_index(
      std::count_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); }));
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
    std::stable_sort(output_at_.begin(), output_at_.end(), [&](std::size_t a, std::size_t b) {
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

}  // namespace palpate::sweep
