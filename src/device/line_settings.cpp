// Reads the settings of a gauge, and refuses a pattern that leaves a unit open.
#include "device/line_settings.h"

#include <stdexcept>
#include <string_view>

#include "base/document.h"
#include "base/field_reader.h"
#include "base/fields.h"
#include "base/text.h"

namespace palpate::device {
namespace {

constexpr auto parity_words = words_of<LineFormat::Parity>(
    {{"none", "8N1 and the like"}, {"even", "7E1 and the like"}, {"odd", "7O1 and the like"}});
constexpr auto decimal_words =
    words_of<LinePattern::Decimal>({{"point", "`1.5`"}, {"comma", "`1,5`"}});
constexpr auto towards_words = words_of<LineSettings::Towards>(
    {{"down", "a press increases the travel"}, {"up", "a press decreases it"}});

void fields(FieldVisitor& visitor, LineSettings& settings) {
  visitor.count({"baud", "rate of the line"}, settings.line.baud, {});
  visitor.count({"data_bits", "of a byte, 7 or 8"}, settings.line.data_bits, between(7, 8));
  visitor.choice({"parity", "of a byte"}, settings.line.parity, parity_words);
  visitor.text({"pattern", "what the lines look like"}, settings.pattern);
  visitor.choice({"decimal", "decimal sign in the lines"}, settings.decimal, decimal_words);
  visitor.text({"force_unit", "of forces without unit"}, settings.force_unit);
  visitor.text({"travel_unit", "of the travel without unit"}, settings.travel_unit);
  visitor.text({"time_unit", "of times without unit"}, settings.time_unit);
  visitor.number({"force_zero", "reading without load, as the lines show it"}, settings.force_zero,
                 {});
  visitor.number({"force_scale", "factor of the reading above its zero"}, settings.force_scale, {});
  visitor.choice({"travel", "where the travel increases"}, settings.travel, towards_words);
  visitor.text({"poll", "what is sent for every reading"}, settings.poll);
  visitor.text({"start", "what is sent at the start"}, settings.start);
  visitor.text({"stop", "what is sent at the end"}, settings.stop);
  visitor.number({"rate", "readings per second"}, settings.rate, {.low = 0.1, .high = 1000.0});
  visitor.quantity({"wait", "for the first line"}, settings.wait, unit::s, above(0.0));
  visitor.quantity({"start_force", "with which a run without travel begins"}, settings.start_force,
                   unit::N, above(0.0));
}

// TOML's single quotes keep a backslash as it is, and no gauge waits for the two characters.
void refuse_literal_ends(const Node& file, const char* key, const std::string& text) {
  for (const char* end : {"\\r", "\\n"})
    if (text.find(end) != std::string::npos)
      throw InputError(place_of(file, key),
                       "would be sent with the two characters `" + std::string(end) +
                           "` and no line end, because single quotes of TOML keep them; write "
                           "double quotes, as `poll = \"Q\\r\\n\"`");
}

// Every number of the pattern needs one unit, from the line or from the settings.
void check_unit(const Node& file, const LinePattern& pattern, Measure measure, const char* key,
                const std::string& given) {
  const std::string name = std::string(key).substr(0, std::string_view(key).find('_'));
  if (!given.empty() && !pattern.has_number(measure))
    throw InputError(place_of(file, key),
                     "has no effect, because the pattern has no `{" + name + "}`; leave it out");
  if (!given.empty() && pattern.has_unit(measure))
    throw InputError(place_of(file, key),
                     "has no effect, because the pattern takes the unit from "
                     "the lines; leave it out");
  if (!given.empty() && !unit_of(measure, given))
    throw InputError(place_of(file, key),
                     "`" + given + "` is no unit of it; write " + known_units(measure));
  if (given.empty() && pattern.has_number(measure) && !pattern.has_unit(measure))
    throw InputError(place_of(file, "pattern"), "gives the " + name + " no unit; add `" +
                                                    std::string(key) + "`, or `{" + key +
                                                    "}` to the pattern");
}

}  // namespace

LineSettings read_line_settings(const std::string& path) {
  const Node file = read_toml(path);
  LineSettings settings;
  const Reading reading =
      read_fields(file, [&](FieldVisitor& visitor) { fields(visitor, settings); });
  if (!reading.problems.empty()) throw InputError(reading.problems);
  if (settings.pattern.empty())
    throw InputError({path, 0, 0},
                     "`pattern` is missing; say what a line looks like, as `pattern = \"{force} "
                     "{force_unit}\"`");
  if (!is_known_rate(settings.line.baud))
    throw InputError(place_of(file, "baud"), "no serial line has a rate of " +
                                                 std::to_string(settings.line.baud) +
                                                 " baud; write " + known_rates());
  if (settings.force_scale == 0.0)
    throw InputError(place_of(file, "force_scale"), "0 makes every force 0; give the factor");
  refuse_literal_ends(file, "poll", settings.poll);
  refuse_literal_ends(file, "start", settings.start);
  refuse_literal_ends(file, "stop", settings.stop);
  try {
    const LinePattern pattern(settings.pattern, settings.decimal);
    check_unit(file, pattern, Measure::force, "force_unit", settings.force_unit);
    check_unit(file, pattern, Measure::travel, "travel_unit", settings.travel_unit);
    check_unit(file, pattern, Measure::time, "time_unit", settings.time_unit);
    if (settings.start_force && pattern.has_number(Measure::travel))
      throw InputError(place_of(file, "start_force"),
                       "has no effect, because the lines have a travel; leave it out");
  } catch (const std::invalid_argument& error) {
    throw InputError(place_of(file, "pattern"), error.what());
  }
  return settings;
}

}  // namespace palpate::device
