// Converts two columns of a measured table to numbers in SI units. The sign of compression: a test
// begins unloaded, and the load then changes towards it.
#include "measured/measured.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "measured/columns.h"
#include "measured/table.h"

namespace palpate::measured {
namespace {

double number_of(const RawTable& table, const RawRow& row, const Column& column) {
  const Piece& field = row.fields[column.index];
  const auto number = measured_number(field.text, table.decimal);
  const Place place{table.file, row.line, field.column};
  if (!number)
    throw InputError(
        place, "`" + column.name + "` holds `" + field.text + "`, " + why_no_number(field.text));
  // The words `inf` and `nan` mean a row without a number; digits beyond all doubles are an error.
  if (std::isinf(*number) && field.text.find_first_of("0123456789") != std::string::npos)
    throw InputError(place, out_of_range_text(field.text));
  // SCPI: 9.9E37 is an overload, 9.91E37 no number.
  if (std::abs(*number) > 9.89e37 && std::abs(*number) < 9.92e37)
    throw InputError(place,
                     "`" + column.name + "` holds `" + field.text + "`, " + why_no_number("over"));
  return *number;
}

MeasuredAxis axis_of(const Column& column) {
  MeasuredAxis axis;
  axis.column = column.name;
  axis.has_unit = column.unit.has_value();
  axis.stretch =
      is_stretch(column.name) && (!column.unit || column.unit->factor.dimension == Dimension{});
  if (axis.stretch) axis.has_unit = true;
  axis.mass = column.unit && is_mass(*column.unit);
  if (!column.unit) return axis;
  axis.unit = column.unit->text;
  axis.dimension = column.unit->factor.dimension;
  return axis;
}

// What is said of a force that the file gives in grams.
std::string weight_note(const RawTable& table, const Column& column) {
  if (!column.unit || !(column.unit->factor.dimension == force)) return {};
  const std::string& unit = column.unit->text;
  const std::string written =
      column.index < table.units.size() ? table.units[column.index] : column.name;
  if (!unit.ends_with("gf") || lower_case(written).find("gf") != std::string::npos ||
      lower_case(written).find("kp") != std::string::npos)
    return {};
  return "`" + column.name + "` is in " + unit.substr(0, unit.size() - 1) + ", taken as " + unit +
         ", the weight under 9.80665 m/s^2; `--y-unit` decides otherwise";
}

void take(MeasuredCurve& curve, const RawTable& table, const DataLayout& layout) {
  const Column x = find_column(table, layout, Role::x);
  const Column y = find_column(table, layout, Role::y);
  curve.x_axis = axis_of(x);
  curve.y_axis = axis_of(y);
  curve.guessed = (layout.x.empty() || layout.y.empty()) && table.width() > 2;
  for (const Column* column : {&x, &y})
    if (const std::string weight = weight_note(table, *column); !weight.empty())
      curve.notes.push_back(weight);
  std::vector<Column> beside;
  for (const std::string& name : layout.beside) {
    beside.push_back(find_column(table, {.y = name}, Role::y));
    curve.beside.push_back({axis_of(beside.back()), {}});
  }
  const Rows rows = chosen_rows(table, layout, {x, y});
  for (const std::size_t i : rows.kept) {
    const RawRow& row = table.rows[i];
    double x_value = number_of(table, row, x);
    const double y_value = number_of(table, row, y);
    if (x.falls) x_value = 0.0 - x_value;
    const bool whole = std::isfinite(x_value) && std::isfinite(y_value);
    if (!whole && layout.blanks == DataLayout::Blanks::leave_out) {
      ++curve.excluded;
      continue;
    }
    curve.x_written.push_back(x_value);
    curve.y_written.push_back(y_value);
    curve.x.push_back(x.unit ? x.unit->factor.to_si(x_value) : x_value);
    curve.y.push_back(y.unit ? y.unit->factor.to_si(y_value) : y_value);
    curve.lines.push_back(row.line);
    for (std::size_t k = 0; k < beside.size(); ++k) {
      const double value = number_of(table, row, beside[k]);
      curve.beside[k].values.push_back(beside[k].unit ? beside[k].unit->factor.to_si(value)
                                                      : value);
    }
  }
  // A column named as a stretch may hold strains, which begin near 0 and not near 1.
  const auto first = std::ranges::find_if(curve.x, [](double each) { return std::isfinite(each); });
  if (first != curve.x.end() && *first < 0.3) curve.x_axis.stretch = false;
  if (x.falls) curve.notes.push_back("`" + x.name + "` falls as the tip goes in; taken as a depth");
  curve.notes.insert(curve.notes.end(), rows.notes.begin(), rows.notes.end());
}

// The depth of the tip from the travel of its holder, which bends by the force times a compliance.
// A y that is a length is the deflection itself.
void take_off_deflection(MeasuredCurve& curve, const DataLayout& layout) {
  const bool spring = !layout.spring_constant.empty();
  if (!spring && layout.compliance.empty()) return;
  const std::string& text = spring ? layout.spring_constant : layout.compliance;
  const std::string option = spring ? "--spring-constant" : "--compliance";
  const auto number = leading_number(text);
  const auto unit = number ? written_unit(number->rest) : std::nullopt;
  const Dimension wanted = spring ? Dimension{0, 1, -2} : Dimension{0, -1, 2};
  if (!unit || !(unit->factor.dimension == wanted) || !(number->value > 0.0))
    throw InputError({}, "palpate: `" + option + " " + text + "` is no " +
                             (spring ? "stiffness; write it as `0.1 N/m`"
                                     : "compliance; write it as `0.2 um/N`"));
  const double si = unit->factor.to_si(number->value);
  const double compliance = spring ? 1.0 / si : si;
  if (spring) curve.bending = compliance;
  const bool deflection = spring && curve.y_axis.dimension == length;
  if (!(curve.x_axis.dimension == length) || !(curve.y_axis.dimension == force || deflection))
    throw InputError({curve.file, 0, 0},
                     "`" + option + "` takes the bending off a travel under a force, and `" +
                         curve.y_axis.column + "` over `" + curve.x_axis.column +
                         "` is no force over a length; name other columns, or leave it out");
  const double per_x =
      curve.x_axis.unit.empty() ? 1.0 : written_unit(curve.x_axis.unit)->factor.to_si(1.0);
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (deflection) curve.y[i] /= compliance;
    curve.x[i] -= curve.y[i] * compliance;
    curve.x_written[i] = curve.x[i] / per_x;
    if (deflection) curve.y_written[i] = curve.y[i];
  }
  if (deflection) {
    curve.y_axis.unit = "N";
    curve.y_axis.dimension = force;
  }
  curve.notes.push_back("`" + curve.x_axis.column + "` minus the bending, " +
                        (deflection ? "`" + curve.y_axis.column + "`" : "force times compliance") +
                        ", is the depth");
}

// The line over time through the free ends of the whole record, before and after contact.
void take_off_drift(MeasuredCurve& curve, const RawTable& table, const DataLayout& layout) {
  if (layout.drift.empty()) return;
  const Column x = find_column(table, layout, Role::x);
  const Column y = find_column(table, layout, Role::y);
  Column time;
  time.index = named_index(table, layout.drift, "--drift");
  time.name = layout.drift;
  DataLayout all = layout;
  all.segment = "all";
  struct Row {
    double t, x, y;
    int line;
  };
  std::vector<Row> rows;
  for (const std::size_t i : chosen_rows(table, all, {x, y}).kept) {
    const RawRow& row = table.rows[i];
    const Row each{number_of(table, row, time), number_of(table, row, x), number_of(table, row, y),
                   row.line};
    if (std::isfinite(each.t) && std::isfinite(each.x) && std::isfinite(each.y))
      rows.push_back(each);
  }
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Row& row : rows) {
    low = std::min(low, row.x);
    high = std::max(high, row.x);
  }
  struct End {
    double n = 0.0, t = 0.0, y = 0.0;
  };
  const auto end_of = [&](auto from, auto to) {
    End end;
    for (auto row = from; row != to && std::abs(row->x - from->x) <= 0.1 * (high - low); ++row) {
      end.n += 1.0;
      end.t += row->t;
      end.y += row->y;
    }
    end.t /= end.n;
    end.y /= end.n;
    return end;
  };
  if (rows.size() < 10)
    throw InputError({curve.file, 0, 0}, "has too few rows for a `--drift`; leave it out");
  const End first = end_of(rows.begin(), rows.end());
  const End last = end_of(rows.rbegin(), rows.rend());
  const bool free = std::abs(rows.front().x - rows.back().x) <= 0.2 * (high - low);
  if (!free || first.n < 5 || last.n < 5 || !(last.t > first.t))
    throw InputError(
        {curve.file, 0, 0},
        "does not begin and end at the same place with five rows there, so that two free ends are "
        "not known; leave `--drift` out, or give `--baseline-from` and `--baseline-to`");
  const double rate = (last.y - first.y) / (last.t - first.t);
  double most = 0.0;
  for (const Row& row : rows) most = std::max(most, std::abs(row.y - first.y));
  // The rows of the curve by their lines, both in the order of the file.
  const double to_si = y.unit ? y.unit->factor.to_si(1.0) : 1.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < curve.y.size(); ++i) {
    while (at + 1 < rows.size() && rows[at].line < curve.lines[i]) ++at;
    const double drift = rate * (rows[at].t - first.t);
    curve.y_written[i] -= drift;
    curve.y[i] -= drift * to_si;
  }
  curve.notes.push_back("a drift of `" + y.name + "` by " +
                        percent_text(std::abs(last.y - first.y) / std::max(most, 1e-300)) +
                        " of its largest change, from " + rounded_text(first.n) +
                        " rows before and " + rounded_text(last.n) +
                        " after contact, is taken off");
}

// Least ratio of the larger to the smaller change; adhesion and noise are smaller than a third.
constexpr double clear = 3.0;

bool is_load(const Dimension& dimension) { return dimension == force || dimension == stress; }

void turn(std::vector<double>& si, std::vector<double>& written) {
  for (double& value : si) value = 0.0 - value;  // 0 stays 0 and does not become -0
  for (double& value : written) value = 0.0 - value;
}

struct Span {
  double up = 0.0;    // above the start
  double down = 0.0;  // below it
  std::size_t peak = 0;
};

Span span_of(const std::vector<double>& values, double start) {
  Span span;
  double farthest = -1.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double away = values[i] - start;
    if (!std::isfinite(away)) continue;
    span.up = std::max(span.up, away);
    span.down = std::max(span.down, -away);
    if (std::abs(away) > farthest) span.peak = i;
    farthest = std::max(farthest, std::abs(away));
  }
  return span;
}

[[noreturn]] void refuse_sign(const MeasuredCurve& curve, const Span& span) {
  if (span.up == 0.0 && span.down == 0.0)
    throw InputError(
        {curve.file, 0, 0},
        "`" + curve.y_axis.column + "` is the same at every point; name another column with `--y`");
  throw InputError({curve.file, 0, 0},
                   "`" + curve.y_axis.column +
                       "` both rises and falls from its start, so that its sign in compression is "
                       "not clear; give `--compression positive` or `--compression negative`");
}

// Whether the load is negative in compression.
bool load_is_negative(const MeasuredCurve& curve, std::size_t rest) {
  // Over a length the load is at rest at one end; over time it may start at its peak, so that 0 is
  // used.
  const bool along = curve.x_axis.dimension == length ||
                     (curve.x_axis.has_unit && curve.x_axis.dimension == Dimension{});
  const Span span = span_of(curve.y, along ? curve.y[rest] : 0.0);
  if (span.down >= clear * span.up && span.down > 0.0) return true;
  if (span.up >= clear * span.down && span.up > 0.0) return false;
  refuse_sign(curve, span);
}

// Changes the sign of x if it is a length or a strain that decreases while the load grows.
void turn_length(MeasuredCurve& curve, std::size_t rest) {
  const bool strain = curve.x_axis.has_unit && curve.x_axis.dimension == Dimension{};
  if ((curve.x_axis.dimension != length && !strain) || !is_load(curve.y_axis.dimension)) return;
  const std::size_t peak = span_of(curve.y, curve.y[rest]).peak;
  if (curve.x[peak] >= curve.x[rest]) return;
  turn(curve.x, curve.x_written);
  curve.notes.push_back("`" + curve.x_axis.column + "` falls as the load grows; sign changed");
}

// Changes the sign of loads that are negative in compression, according to DataLayout::compression
// or, for `auto`, to the curve; then also that of a length that decreases while the load grows.
// Adds a note for each change. Throws InputError if `auto` is ambiguous or the word is unknown.
void orient(MeasuredCurve& curve, const DataLayout& layout) {
  const std::string& said = layout.compression;
  if (!said.empty() && said != "positive" && said != "negative" && said != "auto")
    throw InputError({}, "palpate: `--compression " + said +
                             "` is unknown; give `positive`, `negative` or `auto`");
  if (said.empty() || said == "positive" || curve.y.empty()) return;
  if (said == "auto" && curve.x_axis.stretch) return;  // below 1 it is compression
  if (!is_load(curve.y_axis.dimension)) {
    if (said == "auto") return;
    throw InputError({curve.file, 0, 0}, "`" + curve.y_axis.column +
                                             "` is no load, to which `--compression negative` "
                                             "could apply; name a column of forces with `--y`");
  }
  const bool retract = layout.segment.starts_with("retract") ||
                       (curve.x_axis.dimension == length && only_retracts(curve.x, curve.y));
  const std::size_t rest = retract ? curve.y.size() - 1 : 0;
  const bool negative = said == "negative" || load_is_negative(curve, rest);
  if (negative) {
    turn(curve.y, curve.y_written);
    curve.notes.push_back("`" + curve.y_axis.column + "` is negative in compression; sign changed");
  }
  turn_length(curve, rest);
}

}  // namespace

MeasuredCurve parse_measured(std::string_view bytes, const std::string& file,
                             const DataLayout& layout) {
  const RawTable table = raw_table(bytes, file, layout);
  MeasuredCurve curve;
  curve.file = file;
  curve.notes = table.notes;
  take(curve, table, layout);
  take_off_drift(curve, table, layout);
  if (curve.excluded > 0)
    curve.notes.push_back(std::to_string(curve.excluded) +
                          (curve.excluded == 1 ? " row is" : " rows are") +
                          " excluded: a number is missing or not finite");
  if (curve.x.empty())
    throw InputError({file, 0, 0}, "no row is left with a number in `" + curve.x_axis.column +
                                       "` and in `" + curve.y_axis.column +
                                       "`; name columns that are filled");
  orient(curve, layout);
  take_off_deflection(curve, layout);
  return curve;
}

MeasuredCurve read_measured(const std::string& path, const DataLayout& layout) {
  return parse_measured(read_text(path), path, layout);
}

}  // namespace palpate::measured
