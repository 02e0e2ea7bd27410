// `palpate data`: says what is understood of a measured file, and what to type next.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/files.h"
#include "base/numerics.h"
#include "base/text.h"
#include "base/written.h"
#include "cli/fit_models.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "fit/contact_model.h"
#include "fit/parts.h"
#include "fit/uniaxial.h"
#include "measured/columns.h"
#include "measured/measured.h"
#include "measured/table.h"

namespace palpate::cli {
namespace {

using measured::RawTable;

const char* form_of(const RawTable& table) {
  switch (table.kind) {
    case RawTable::Kind::afm_tab: return "a .tab file of afmformats";
    case RawTable::Kind::chiaro: return "a text file of an Optics11 Chiaro";
    case RawTable::Kind::febio_log: return "FEBio's log data";
    case RawTable::Kind::jpk: return "a text export of JPK";
    case RawTable::Kind::anton_paar: return "an export of Anton Paar RheoCompass";
    case RawTable::Kind::bluehill: return "an export of Instron Bluehill";
    case RawTable::Kind::plain: break;
  }
  return "a table in text";
}

using Details = Talk::Details;

// `2  Load (uN)  uN, a force  from 0 to 1.5`
std::string column_line(const RawTable& table, std::size_t index, const Talk& talk) {
  const std::string name =
      index < table.names.size() ? table.names[index] : std::string("without a name");
  Details details{{"number", index + 1}, {"name", index < table.names.size() ? name : ""}};
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  std::size_t missing = 0;
  std::size_t words = 0;
  std::string word;
  for (const measured::RawRow& row : table.rows) {
    const std::string& text = row.fields[index].text;
    const auto number = measured::measured_number(text, table.decimal);
    if (!number) {
      ++words;
      word = text;
    } else if (!std::isfinite(*number)) {
      ++missing;
    } else {
      low = std::min(low, *number);
      high = std::max(high, *number);
    }
  }
  std::string line = std::to_string(index + 1) + "  " + (name.empty() ? "(no name)" : name);
  if (const auto unit = measured::file_unit(table, index)) {
    line +=
        ": " + (unit->text.empty() ? "a pure number"
                                   : unit->text + ", " + dimension_name(unit->factor.dimension));
    details.emplace_back("unit", unit->text);
  } else {
    line += ": no unit known";
  }
  if (low <= high) {
    line += ", from " + rounded_text(low) + " to " + rounded_text(high);
    details.insert(details.end(), {{"low", low}, {"high", high}});
  }
  if (missing > 0) line += ", " + std::to_string(missing) + " missing";
  if (words > 0)
    line +=
        ", " + std::to_string(words) + (words == 1 ? " word, `" : " words such as `") + word + "`";
  details.insert(details.end(), {{"missing", missing}, {"words", words}});
  talk.event("column", details);
  return line + "\n";
}

// The parts of a column `segment` or `step`, in the order of the file.
std::string segment_lines(const RawTable& table, const Talk& talk) {
  for (const char* name : {"segment", "step"}) {
    const auto found = measured::columns_named(table, name);
    if (found.size() != 1) continue;
    std::string text;
    std::size_t from = 0;
    int count = 0;
    for (std::size_t i = 1; i <= table.rows.size(); ++i) {
      const std::string& value = table.rows[from].fields[found[0]].text;
      if (i < table.rows.size() && table.rows[i].fields[found[0]].text == value) continue;
      talk.event("segment", {{"name", value}, {"first_row", from + 1}, {"last_row", i}});
      if (++count <= 12)
        text += "segment `" + value + "`: rows " + std::to_string(from + 1) + " to " +
                std::to_string(i) + "\n";
      from = i;
    }
    if (count > 12) text += "and " + std::to_string(count - 12) + " further segments\n";
    return count > 1 ? text : "";
  }
  return "";
}

std::string quoted(const std::string& word) {
  const bool plain = word.find_first_of(" ()[]{}<>$`\"'*?;|&") == std::string::npos;
  return plain ? word : "\"" + word + "\"";
}

using Uniaxial = fit::UniaxialTest::Model;
using Loading = fit::UniaxialTest::Loading;

// How often a specimen is loaded: `fit` asks which of several loadings it shall take.
int loadings_of(std::vector<double> strain) {
  double far = 0.0;
  for (const double each : strain)
    if (std::abs(each - strain[0]) > std::abs(far)) far = each - strain[0];
  for (double& each : strain) each = std::copysign(1.0, far) * each;
  int count = 0;
  for (const fit::Branch& branch : fit::branches_of(strain)) count += branch.up ? 1 : 0;
  return count;
}

// ` --cycle 1`, where there are several loadings.
std::string cycle_of(const std::vector<double>& strain) {
  return loadings_of(strain) > 1 ? " --cycle 1" : "";
}

// The root mean square that a law leaves, Pa or N, on the first loading; infinite where it has no
// fit.
double left_by(const std::vector<double>& strain, const std::vector<double>& stress,
               fit::UniaxialTest test) {
  test.cycle = loadings_of(strain) > 1 ? 1 : 0;
  try {
    return unit::kPa.to_si(fit::fit_uniaxial(strain, stress, test).rmse);
  } catch (const InputError&) {
    return std::numeric_limits<double>::infinity();
  }
}

// Whether a straight line, behind a toe if there is one, leaves less scatter than a round tip's
// law.
bool is_straight(const measured::MeasuredCurve& curve, double scatter) {
  return left_by(curve.x, curve.y, {.toe = true}) < scatter;
}

// What describes a force over a length better than a round tip does: a specimen that is compressed,
// whose height is unknown. Empty: nothing. Ogden's law has one parameter more.
std::string compressed_law(const measured::MeasuredCurve& curve, double scatter) {
  const std::size_t stride = 1 + curve.x.size() / 1000;  // the shape is that of fewer rows, too
  std::vector<double> displacement, force;
  for (std::size_t i = 0; i < curve.x.size(); i += stride) {
    displacement.push_back(curve.x[i]);
    force.push_back(curve.y[i]);
  }
  const double deepest = *std::ranges::max_element(displacement);
  const auto left = [&](Uniaxial law, double most) {
    std::vector<double> strain = displacement;
    for (double& each : strain) each *= most / deepest;
    return left_by(strain, force, {.model = law, .loading = Loading::compression});
  };
  const auto neo_hookean = [&](double most) { return left(Uniaxial::neo_hookean, most); };
  const double simple = neo_hookean(numerics::minimum({0.05, 0.9}, neo_hookean));
  double stiffening = std::numeric_limits<double>::infinity();
  for (const double most : {0.1, 0.3, 0.6})
    stiffening = std::min(stiffening, left(Uniaxial::ogden, most));
  if (stiffening < 0.5 * std::min(simple, scatter)) return "ogden --loading compression";
  return simple < scatter ? "neo_hookean --loading compression" : "";
}

// A law of large strain where a stress over strain bends so much that it leaves half the scatter of
// a line; with `--loading`, and both of them, where neither names nor signs tell which.
struct LargeStrain {
  std::string law, note;
};
LargeStrain large_strain(const measured::MeasuredCurve& curve) {
  const Strained stretched = strained(Fit(), curve);
  const std::vector<double>& strain = stretched.strain;
  const Loading loading = stretched.loading;
  const double line = left_by(strain, curve.y, {});
  const auto ogden = [&](Loading each) {
    return left_by(strain, curve.y, {.model = Uniaxial::ogden, .loading = each});
  };
  const std::string says =
      "the stress bends away from a straight line, and a law of large strain describes all of it: "
      "`--model ogden";
  if (ogden(loading) < 0.5 * line) return {"ogden", says + "`"};
  if (loading == Loading::unknown &&
      std::min(ogden(Loading::compression), ogden(Loading::tension)) < 0.5 * line)
    return {"", says + " --loading compression`, or `--loading tension`"};
  return {};
}

// Contact point, baseline and noise of a force over a length. Both follow from the shape of a
// paraboloid's curve, whatever its radius, here one so large that nothing is said of large strains;
// `platens` becomes the model of a specimen between platens where that does not describe the whole
// curve.
std::string contact_lines(const measured::MeasuredCurve& curve, std::string& platens,
                          const Talk& talk) {
  const char* line =
      "a straight line describes the curve better than the law of a round tip, as of a specimen "
      "between platens\n";
  try {
    const fit::Fit fit = fit::fit_contact(curve.x, curve.y, {.radius = 1e3});
    const bool tip = curve.bending > 0.0;  // of a cantilever, not platens
    const bool straight = !tip && is_straight(curve, fit.rmse);
    if (!straight && !tip && !fit.gave_way) platens = compressed_law(curve, fit.rmse);
    const bool compressed = !platens.empty();
    std::string text;
    const bool round = fit.r2 >= 0.9 && !fit.gave_way && !straight && !compressed;
    if (!compressed && !round && !tip) platens = "modulus";
    Details details{{"round_tip", round},
                    {"straight", straight},
                    {"compressed", compressed},
                    {"r2", fit.r2},
                    {"scatter_N", fit.rmse}};
    if (compressed) {
      talk.event("contact", details);
      return "the law of a specimen that is compressed by a large strain describes the curve "
             "better than that of a round tip\n";
    }
    if (!straight && fit.parameters.size() > 1)
      details.emplace_back("point_mm", fit.parameters[1].estimate);
    if (!straight && fit.parameters.size() > 2)
      details.emplace_back("offset_N", fit.parameters[2].estimate);
    talk.event("contact", details);
    if (fit.r2 < 0.9)
      return "no round tip gives such a curve (R^2 of its law " + rounded_text(fit.r2, 3) + ")\n";
    for (const std::string& note : fit.notes)
      if (straight && note.find("excluded") != std::string::npos) text += note + "\n";
    if (straight) return line + text;
    if (fit.parameters.size() > 1)
      text += "contact point: " + rounded_text(fit.parameters[1].estimate) +
              " mm, if the tip is round\n";
    if (fit.parameters.size() > 2)
      text += "force offset: " + rounded_text(fit.parameters[2].estimate) + " N\n";
    text += "scatter about the curve: " + rounded_text(fit.rmse, 3) + " N (R^2 " +
            rounded_text(fit.r2, 4) + ")\n";
    for (const std::string& note : fit.notes) text += note + "\n";
    return text;
  } catch (const InputError& error) {
    const std::string& why = error.problems().front().message;
    const auto [least, most] = std::ranges::minmax_element(curve.y);
    const bool round = !is_straight(curve, 0.05 * (*most - *least));  // a line: R^2 above 0.97
    if (!round) platens = "modulus";
    talk.event("contact", {{"round_tip", round}, {"straight", !round}, {"why", why}});
    return round ? "no contact point: " + why + "\n" : line;
  }
}

// The curve of the columns asked for. A length that stays over most rows is that of a hold, whose
// curve is one over time.
measured::MeasuredCurve guessed_curve(const Data& command) {
  measured::MeasuredCurve curve = measured::read_measured(command.data, command.columns);
  const double at = curve.x.empty() ? 0.0 : curve.x.back();
  const auto stays = std::ranges::count_if(
      curve.x, [at](double x) { return std::abs(x - at) <= 0.01 * std::abs(at); });
  if (!command.columns.x.empty() || !(curve.x_axis.dimension == unit::mm.dimension) ||
      2 * as_index(stays) <= curve.x.size())
    return curve;
  DataOptions over_time = command.columns;
  over_time.curve = DataOptions::Curve::relaxation;
  over_time.compression.clear();  // a load that relaxes is not one that grows downwards
  try {
    measured::MeasuredCurve held = measured::read_measured(command.data, over_time);
    if (held.y_axis.column != curve.x_axis.column)  // which creeps
      held.notes.push_back("`" + curve.x_axis.column + "` stays over " + std::to_string(stays) +
                           " of " + std::to_string(curve.x.size()) + " rows, as in a hold");
    return held;
  } catch (const InputError&) {  // no column of times
    return curve;
  }
}

// The options by which the curve was read, which `fit` needs as well.
std::string options_of(const DataOptions& given, bool mass) {
  std::string line;
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) line += std::string(" ") + option + " " + quoted(value);
  };
  add("--x-unit", given.x_unit);
  if (!mass) add("--y-unit", given.y_unit);  // its weight follows
  add("--skip", given.skip >= 0 ? std::to_string(given.skip) : "");
  add("--separator", given.separator);
  add("--decimal", given.decimal);
  add("--compression", given.compression == "auto" ? "" : given.compression);
  add("--segment", given.segment);
  for (const std::string& each : given.where) add("--where", each);
  add("--rows", given.rows);
  add("--table", given.table > 0 ? std::to_string(given.table) : "");
  add("--spring-constant", given.spring_constant);
  add("--compliance", given.compliance);
  add("--drift", given.drift);
  add("--case", given.case_name);
  return line;
}

// What to type next for the dimensions of the two columns; `law` is that of a specimen, if one is
// found.
std::string next_line(const Data& command, const measured::MeasuredCurve& curve,
                      const std::string& law) {
  std::string line = "palpate fit " + quoted(command.data) + " --x " + quoted(curve.x_axis.column) +
                     " --y " + quoted(curve.y_axis.column) +
                     options_of(command.columns, curve.y_axis.mass);
  for (const std::string& note : curve.notes)
    if (note.ends_with("sign changed") && command.columns.compression == "auto") {
      line += " --compression auto";
      break;
    }
  if (!curve.x_axis.has_unit) line += " --x-unit UNIT";
  if (!curve.y_axis.has_unit) line += " --y-unit UNIT";
  const Dimension& x = curve.x_axis.dimension;
  const Dimension& y = curve.y_axis.dimension;
  if (x == unit::mm.dimension && y == unit::N.dimension && !law.empty())
    return line + " --model " + law + cycle_of(curve.x) +
           " --height \"... mm\" --area \"... mm^2\"";
  if (x == unit::mm.dimension && y == unit::N.dimension)
    return line + " --model hertz --radius \"... mm\" --poisson 0.5";
  if (x == unit::mm.dimension && y == unit::mm.dimension &&
      lower_case(curve.y_axis.column).find("defl") != std::string::npos)
    return line + " --spring-constant \"... N/m\" --model hertz --radius \"... mm\" --poisson 0.5";
  if (x == unit::s.dimension)
    return line + (y == Dimension{} || y == unit::mm.dimension ? " --model prony_creep --terms 1"
                                                               : " --model prony --terms 1");
  if (curve.y_axis.mass) line += " --y-unit " + curve.y_axis.unit + "f";
  if (x == unit::mm.dimension && curve.y_axis.mass)
    return line + " --model hertz --radius \"... mm\" --poisson 0.5";
  const bool strain =
      curve.x_axis.has_unit || lower_case(curve.x_axis.column).find("strain") != std::string::npos;
  if (x == Dimension{} && y == unit::kPa.dimension && strain)
    return line +
           (law.empty() ? " --model modulus --from \"0 %\" --to \"10 %\"" : " --model " + law) +
           cycle_of(curve.x);
  return line + " --model power";
}

}  // namespace

int perform(const Data& command, const Arguments&, const Talk& talk) {
  const RawTable table =
      measured::raw_table(read_text(command.data), command.data, command.columns);
  std::string text = command.data + ": " + form_of(table) + ", " +
                     count_text(table.rows.size(), "row") + " from line " +
                     std::to_string(table.rows.front().line) + " to " +
                     std::to_string(table.rows.back().line) + "\n";
  talk.event("table", {{"file", command.data},
                       {"form", form_of(table)},
                       {"rows", table.rows.size()},
                       {"first_line", as_index(table.rows.front().line)},
                       {"last_line", as_index(table.rows.back().line)}});
  const auto note = [&](const std::string& sentence) {
    text += sentence + "\n";
    talk.event("note", {{"text", sentence}});
  };
  for (const std::string& sentence : table.notes) note(sentence);
  for (std::size_t i = 0; i < table.width(); ++i) text += column_line(table, i, talk);
  text += segment_lines(table, talk);
  std::string law;
  try {
    const measured::MeasuredCurve curve = guessed_curve(command);
    text += "x is `" + curve.x_axis.column + "`, y is `" + curve.y_axis.column + "`\n";
    talk.event("curve", {{"x", curve.x_axis.column}, {"y", curve.y_axis.column}});
    for (const std::string& sentence : curve.notes)
      if (std::ranges::find(table.notes, sentence) == table.notes.end()) note(sentence);
    if (curve.x_axis.dimension == unit::mm.dimension && curve.y_axis.dimension == unit::N.dimension)
      text += contact_lines(curve, law, talk);
    const bool stress = curve.x_axis.dimension == Dimension{} && curve.x_axis.has_unit &&
                        curve.y_axis.dimension == unit::kPa.dimension;
    if (stress) {
      const LargeStrain found = large_strain(curve);
      law = found.law;
      if (!found.note.empty()) note(found.note);
    }
    const bool specimen = stress || !law.empty();
    if (const int loadings = specimen ? loadings_of(curve.x) : 1; loadings > 1)
      note("the curve has " + std::to_string(loadings) +
           " loadings, which differ by what the ones before did to the specimen: `--cycle` chooses "
           "one");
    const std::string next = next_line(command, curve, law);
    text += "next: " + next + "\n";
    talk.event("next", {{"command", next}});
  } catch (const InputError& error) {
    const std::string& what = error.problems().front().message;
    text += "to be decided: " + what + "\n";
    talk.event("undecided", {{"text", what}});
  }
  if (!talk.json()) print_text(text);
  return exit_good;
}

}  // namespace palpate::cli
