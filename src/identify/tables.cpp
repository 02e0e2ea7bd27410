// Tables and sentences, with numbers in the units of the keys.
#include "identify/tables.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/text.h"
#include "fit/residuals.h"
#include "scenario/integrators.h"

namespace palpate::identify {

bool is_exact(const Identification& found) {
  const auto [least, most] = std::minmax_element(found.measured.begin(), found.measured.end());
  return found.rmse < 1e-6 * (*most - *least);
}

namespace {

using record::Cell;

Cell cell(const std::optional<double>& si, const Unknown& unknown) {
  return si ? Cell(unknown.shown(*si)) : Cell();
}

Cell word(bool yes) { return std::string(yes ? "yes" : "no"); }

// `57.2 kPa`, `0.45`
std::string with_unit(double value, const std::string& unit) {
  return rounded_text(value, 4) + (unit.empty() ? "" : " " + unit);
}

std::string interval_text(const Interval& interval, const Unknown& unknown, bool exact) {
  const std::string unit = unknown.unit_text();
  if (interval.low && interval.high && exact &&
      rounded_text(*interval.low, 4) == rounded_text(*interval.high, 4))
    return "exact to rounding";
  if (interval.low && interval.high)
    return rounded_text(*interval.low, 4) + " to " + with_unit(*interval.high, unit);
  if (interval.high) return "at most " + with_unit(*interval.high, unit);
  if (interval.low) return "at least " + with_unit(*interval.low, unit);
  return "open";
}

// `+3.1 %` for unknowns on a logarithmic scale, otherwise a difference in the unknown's unit.
std::string change(double moved, const Identified& one) {
  const bool relative = one.unknown.scale == Unknown::Scale::logarithmic;
  const double number = relative ? 100.0 * moved / one.estimate : one.unknown.shown(moved);
  const std::string unit = relative ? "%" : one.unknown.unit_text();
  return (number > 0.0 ? "+" : "") + with_unit(number, unit);
}

std::string combination_sentence(const Identification& found, const Combination& one) {
  std::vector<std::string> names;
  for (const std::size_t i : one.of) names.push_back("`" + found.unknowns[i].unknown.name() + "`");
  const auto [value, interval] = estimate_texts(one);
  return joined(names, " and ") +
         " are not separately identifiable: these data cannot tell them apart. Determined is " +
         value + ", " + interval + "; set one of them by `--set`.";
}

std::string model_sentence(const Identification& found) {
  const std::string model = scenario::traits(found.taken).word;
  const CurveWords& words = words_of(found.kind);
  std::string text = std::string(words.sentence) + ", by `" + model + "`";
  if (found.closed_form && found.scenario.uniform())
    text = std::string(words.sentence) + ", by the formula of a uniform specimen";
  else if (found.predicted_error)
    text += ", predicted to be within " + percent_text(*found.predicted_error) +
            ", which the intervals contain";
  if (found.deep_effect)
    text += "; large strain changes the force at the deepest by " +
            std::string(*found.deep_effect > 0.0 ? "+" : "-") +
            percent_text(std::abs(*found.deep_effect)) + ", which is taken into account";
  return capitalized(text) + ".";
}

}  // namespace

Interval trusted(const Identified& one) {
  Interval interval;
  const auto& low = one.by_profile ? one.profile_low : one.ci95_low;
  const auto& high = one.by_profile ? one.profile_high : one.ci95_high;
  if (low) interval.low = one.unknown.shown(*low);
  if (high) interval.high = one.unknown.shown(*high);
  return interval;
}

record::Table identified_table(const Identification& found) {
  record::Table table;
  table.columns = {"unknown",   "unit",       "estimate",     "std_error",   "ci95_low",
                   "ci95_high", "at_bound",   "identifiable", "profile_low", "profile_high",
                   "interval",  "moved_down", "moved_up"};
  for (const Identified& one : found.unknowns) {
    const Unknown& unknown = one.unknown;
    const std::optional<double> estimate =
        one.inseparable ? std::nullopt : std::optional(one.estimate);
    table.rows.push_back(
        {unknown.name(), unknown.unit_text(), cell(estimate, unknown), cell(one.std_error, unknown),
         cell(one.ci95_low, unknown), cell(one.ci95_high, unknown), word(one.at_bound),
         word(!one.inseparable), cell(one.profile_low, unknown), cell(one.profile_high, unknown),
         one.inseparable ? Cell() : Cell(std::string(one.by_profile ? "profile" : "student")),
         cell(one.moved_down, unknown), cell(one.moved_up, unknown)});
    if (unknown.unit_text().empty()) table.rows.back()[1] = Cell();
  }
  for (const Combination& one : found.combinations) {
    table.rows.push_back({one.text, one.unit, one.estimate, one.std_error, one.ci95_low,
                          one.ci95_high, word(false), word(true), Cell(), Cell(),
                          std::string("student"), Cell(), Cell()});
    if (one.unit.empty()) table.rows.back()[1] = Cell();
  }
  return table;
}

record::Table correlation_table(const Identification& found) {
  record::Table table;
  table.columns = {"unknown"};
  const std::size_t n = found.unknowns.size();
  for (const Identified& one : found.unknowns) table.columns.push_back(one.unknown.name());
  for (std::size_t i = 0; i < n; ++i) {
    table.rows.push_back({found.unknowns[i].unknown.name()});
    for (std::size_t j = 0; j < n; ++j) {
      const double value = found.correlation[i * n + j];
      Cell& cell = table.rows.back().emplace_back();
      if (!std::isnan(value)) cell = value;
    }
  }
  return table;
}

record::Table residual_table(const Identification& found) {
  const CurveWords& words = words_of(found.kind);
  const std::string y = words.y_column;
  const std::string unit = *words.y.symbol == '\0' ? "" : std::string("_") + words.y.symbol;
  record::Table table;
  table.columns = {words.x_column, "measured" + unit, "model" + unit, "residual" + unit};
  for (std::size_t i = 0; i < found.x.size(); ++i)
    table.rows.push_back({words.x.from_si(found.x[i]), words.y.from_si(found.measured[i]),
                          words.y.from_si(found.model[i]),
                          words.y.from_si(found.measured[i] - found.model[i])});
  return table;
}

record::Table profile_table(const Identification& found) {
  record::Table table;
  table.columns = {"unknown", "unit", "value", "delta", "threshold"};
  for (const ProfilePoint& point : found.profile) {
    const Unknown& unknown = found.unknowns[point.unknown].unknown;
    const std::string unit = unknown.unit_text();
    table.rows.push_back({unknown.name(), unit.empty() ? Cell() : Cell(unit),
                          unknown.shown(point.value), point.delta, found.threshold});
  }
  return table;
}

EstimateTexts estimate_texts(const Identification& found, const Identified& one) {
  if (one.inseparable) return {"not determined by itself", ""};
  return {with_unit(one.unknown.shown(one.estimate), one.unknown.unit_text()),
          "(95 %: " + interval_text(trusted(one), one.unknown, is_exact(found)) +
              (one.by_profile ? ", by profile)" : ")") +
              (one.at_bound ? "  on the edge of its range" : "")};
}

EstimateTexts estimate_texts(const Combination& one) {
  return {one.text + " = " + with_unit(one.estimate, one.unit),
          "95 % " + rounded_text(one.ci95_low, 4) + " to " + rounded_text(one.ci95_high, 4)};
}

std::vector<std::string> identified_sentences(const Identification& found) {
  std::vector<std::string> lines;
  std::size_t width = 0;
  for (const Identified& one : found.unknowns) width = std::max(width, one.unknown.name().size());
  for (const Identified& one : found.unknowns) {
    const std::string gap(width - one.unknown.name().size() + 2, ' ');
    const auto [value, interval] = estimate_texts(found, one);
    lines.push_back(one.unknown.name() + gap + value + (interval.empty() ? "" : "  ") + interval);
  }
  for (const Combination& one : found.combinations)
    lines.push_back(combination_sentence(found, one));
  for (const GivenPart& part : found.givens)
    for (std::size_t i = 0; i < found.unknowns.size(); ++i)
      if (const Unknown& unknown = found.unknowns[i].unknown; !found.unknowns[i].inseparable)
        lines.push_back("Of this, `" + part.key + "` = " + part.value + " +- " + part.deviation +
                        " adds a standard error of " +
                        with_unit(unknown.shown(part.deviations[i]), unknown.unit_text()) +
                        " to `" + unknown.name() + "`.");
  const auto points_of = [](const Identification& one, const std::string& size) {
    const CurveWords& words = words_of(one.kind);
    return std::to_string(one.x.size()) + " points" +
           (one.excluded > 0 ? " (" + std::to_string(one.excluded) + " excluded)" : "") + size +
           ", RMSE " + with_unit(words.y.from_si(one.rmse), words.y.symbol) + ", R2 " +
           rounded_text(one.r2, 6);
  };
  const std::string size =
      found.rho > 0.0
          ? ", effective sample size " + rounded_text(std::max(1.0, found.effective_size), 3)
          : "";
  const std::string watson = ", Durbin-Watson " + rounded_text(found.durbin_watson, 3) + ".";
  if (found.pairs.empty()) {
    lines.push_back(model_sentence(found));
    lines.push_back(points_of(found, size) + watson);
  } else {
    for (std::size_t k = 0; k < found.pairs.size(); ++k)
      lines.push_back("Pair " + std::to_string(k + 1) + ": " + model_sentence(found.pairs[k]) +
                      " " + points_of(found.pairs[k], "") + ".");
    lines.push_back(std::to_string(found.x.size()) + " points together" + size + watson);
    for (std::size_t i = 0; i < found.unknowns.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (const double with = found.correlation[i * found.unknowns.size() + j];
            std::abs(with) > 0.9)
          lines.push_back("`" + found.unknowns[j].unknown.name() + "` and `" +
                          found.unknowns[i].unknown.name() + "` correlate by " +
                          rounded_text(with, 3) + ".");
  }
  const CurveWords& words = words_of(found.kind);
  for (const Identified& one : found.unknowns)
    if (one.moved_down && one.moved_up)
      lines.push_back(std::string(found.kind == CurveKind::force_travel ||
                                          found.kind == CurveKind::tangential_slide
                                      ? "A contact point "
                                      : "A start ") +
                      with_unit(words.x.from_si(found.contact_shift), words.x.symbol) +
                      " earlier or later changes `" + one.unknown.name() + "` by " +
                      change(*one.moved_down, one) + " or " + change(*one.moved_up, one) + ".");
  return lines;
}

std::vector<std::string> warnings_of(const Identification& found,
                                     const WeightedResiduals& residuals,
                                     const scenario::Resolved& with) {
  std::vector<std::string> warnings;
  // Systematic residuals below a thousandth of the curve come from interpolation.
  const bool few = found.rho > 0.0 && found.effective_size < 10.0;
  if ((fit::systematic(residuals.values) || few) && residuals.noise > 1e-3)
    warnings.push_back(fit::correlation_sentence(
        found.durbin_watson, found.x.size(),
        found.rho > 0.0 ? found.effective_size : static_cast<double>(found.x.size())));
  if (found.r2 < 0.9)
    warnings.push_back("R^2 is " + rounded_text(found.r2, 3) +
                       ", so that the model describes the curve poorly, and the estimates mean "
                       "little");
  std::vector<std::string> inseparable;
  for (const Identified& one : found.unknowns)
    if (one.inseparable) inseparable.push_back("`" + one.unknown.name() + "`");
  if (!inseparable.empty())
    warnings.push_back(
        joined(inseparable, " and ") +
        (inseparable.size() > 1 ? " have no numbers" : " has no number") +
        ": these data do not tell; give one by `--set` or `--given`, or add a test that "
        "differs, such as another radius or thickness, by `--with`");
  for (const Identified& one : found.unknowns)
    if (one.at_bound)
      warnings.push_back("the best `" + one.unknown.name() +
                         "` is on the edge of its range; widen the range, or hold it there with "
                         "`--set`");
  for (const Identification* one : views(found))
    if (one->predicted_error && *one->predicted_error > with.solver.tolerance)
      warnings.push_back("the estimated error of `" +
                         std::string(scenario::traits(one->taken).word) + "` is " +
                         percent_text(*one->predicted_error) +
                         " here, and the estimates are wrong by about as much" +
                         (one->given ? "; leave `solver.model` to `auto`" : ""));
  const auto waves = inertia_of_flow(with);
  if (waves && *waves > 0.01 && !about(with.solver.integrator).inertia)
    warnings.push_back("waves in the specimen change its deformation by about " +
                       percent_text(*waves) +
                       " and are neglected; set `solver.integrator = \"central_difference\"`");
  return warnings;
}

}  // namespace palpate::identify
