// Polls or hears a gauge, and makes samples of the lines that match its pattern.
#include "device/line_gauge.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "base/document.h"
#include "base/error.h"
#include "base/fields.h"
#include "base/text.h"

namespace palpate::device {
namespace {

constexpr double farthest = 10.0;      // m, beyond the reach of any stage
constexpr double strongest = 1e6;      // N, beyond any gauge
constexpr double least_answer = 0.25;  // s, that a gauge may take at any rate

// Whether a line without a reading has a word by which gauges report an overload: `OL`, `ovf`.
bool tells_overload(std::string_view line) {
  std::string word;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    const char c = i < line.size() ? static_cast<char>(line[i] & ~0x20) : ' ';
    if (c >= 'A' && c <= 'Z') {
      if (word.size() < 9) word += c;
      continue;
    }
    if (word == "OL" || word == "OVF" || word == "OVER" || word == "OVERLOAD") return true;
    word.clear();
  }
  return false;
}

double unit_or_none(Measure measure, const std::string& word) {
  return word.empty() ? 0.0 : unit_of(measure, word).value_or(0.0);
}

}  // namespace

LineGauge::LineGauge(const GaugeAddress& address, Clock& clock, Tap* tap)
    : LinkParts(clock),
      path_(address.port),
      file_(address.settings),
      settings_(read_line_settings(address.settings)),
      pattern_(settings_.pattern, settings_.decimal),
      given_unit_{unit_or_none(Measure::force, settings_.force_unit),
                  unit_or_none(Measure::travel, settings_.travel_unit),
                  unit_or_none(Measure::time, settings_.time_unit)},
      serial_(address.port, settings_.line, tap) {
  const double period = 1.0 / settings_.rate;
  identity_.kind = Kind::gauge;
  identity_.dialect = "lines like `" + settings_.pattern + "`";
  limits_.measures_force = true;
  limits_.measures_travel = pattern_.has_number(Measure::travel);
  limits_.start_force = settings_.start_force;
  limits_.period = period;
  limits_.stale_after = 3.0 * period;
  limits_.lost_after = std::max(1.0, 10.0 * period);
  // Only a stream that no text starts is in the middle of a line.
  cut_ = settings_.poll.empty() && settings_.start.empty();
  if (!settings_.start.empty()) (void)serial_.port.write(settings_.start);
  // The first line of a stream may be cut, so that two must come.
  wait_ = std::max(settings_.wait, 2.5 * period);
  greet(wire_time() + wait_);
  if (!limits_.measures_travel)
    identity_.notes.push_back(
        "the lines have no travel: forces are recorded over time, without the model; `palpate "
        "identify` reads them with `--x time_s --origin 0`");
}

LineGauge::~LineGauge() {
  if (!settings_.stop.empty()) (void)serial_.port.write(settings_.stop);
}

// With a stepped clock a reading takes one period, as it does in the emulator.
void LineGauge::pass_time() {
  if (clock_.kind() == Clock::Kind::stepped) clock_.sleep_until(clock_.now() + limits_.period);
}

double LineGauge::reply_time() const { return std::max(least_answer, 2.0 * limits_.period); }

// Polls keep the rate of the settings; one that is late is not made up for.
bool LineGauge::due(double until) {
  if (settings_.poll.empty() || asked_ || clock_.kind() == Clock::Kind::stepped) return true;
  const double now = wire_time();
  const double wait = std::min(next_poll_, until) - now;
  if (wait > 0.0) clock_.sleep_until(clock_.now() + wait);
  if (next_poll_ > until) return false;
  next_poll_ = std::max(next_poll_, now) + limits_.period;
  return true;
}

bool LineGauge::ask() {
  if (settings_.poll.empty() || asked_) return true;
  // What came since the last reply is not the reply to this request.
  traffic_.discarded += serial_.drain();
  if (!serial_.port.write(settings_.poll)) return false;
  pass_time();
  asked_ = true;
  heard_ = false;
  asked_at_ = wire_time();
  ++traffic_.sent;
  return true;
}

void LineGauge::greet(double until) {
  while (wire_time() < until && !serial_.port.lost()) {
    const Sample first = sample(std::max(0.0, until - wire_time()));
    if (first.arrival != Arrival::fresh) continue;
    identity_.notes.push_back("the first line, " + heard().back());
    last_.reset();
    return;
  }
  refuse_silence();
}

void LineGauge::refuse_silence() const {
  const std::string on = "palpate: on `" + path_ + "` ";
  if (serial_.port.lost()) throw LinkError(on + "the device hung up; check its cable");
  const std::string rate = std::to_string(settings_.line.baud) + " baud";
  if (serial_.first_bytes.empty())
    throw LinkError(on + "nothing comes within " + rounded_text(wait_, 3) + " s" +
                    (settings_.poll.empty() ? "" : " after `" + printable(settings_.poll) + "`") +
                    "; check the cable, `baud`, `poll` and `start` in `" + file_ + "`");
  if (garbage_share(serial_.first_bytes) > 0.2)
    throw LinkError(on + "garbage comes, as at a wrong rate; give the gauge's own instead of " +
                    rate + " in `" + file_ + "`");
  const bool sends_by_itself = settings_.poll.empty() && settings_.start.empty();
  if (kept_count_ == 0 && sends_by_itself && !cut_)
    throw LinkError(on + "one line comes within " + rounded_text(wait_, 3) +
                    " s, whose beginning may be missing; give the gauge's own `rate`, or a longer "
                    "`wait`, in `" +
                    file_ + "`");
  if (kept_count_ == 0)
    throw LinkError(on + "`" + printable(serial_.first_bytes) +
                    "` comes, which never ends as a line does; let the gauge end each reading with "
                    "a line feed");
  throw LinkError(on + "no line matches `" + settings_.pattern + "`: " + heard().back() +
                  "; change `pattern` in `" + file_ + "`");
}

Traffic LineGauge::traffic() const {
  Traffic traffic = traffic_;
  traffic.discarded += serial_.lines.dropped();
  return traffic;
}

void LineGauge::keep(std::string_view line) {
  Kept& kept = kept_[kept_count_++ % kept_lines];
  kept.size = std::min(line.size(), kept.bytes.size());
  std::copy_n(line.begin(), kept.size, kept.bytes.begin());
}

std::optional<double> LineGauge::value_of(const LineWords& words, Measure measure) const {
  const auto& number = words.of(measure);
  if (!number) return Sample::nan;
  const std::string_view word = words.unit[as_index(measure)];
  const auto unit =
      word.empty() ? std::optional(given_unit_[as_index(measure)]) : unit_of(measure, word);
  if (!unit) return std::nullopt;
  double value = *number;
  if (measure == Measure::force) value = settings_.force_scale * (value - settings_.force_zero);
  if (measure == Measure::travel && settings_.travel == LineSettings::Towards::down) value = -value;
  return value * *unit;
}

Sample LineGauge::read(std::string_view line) {
  const auto words = pattern_.match(line);
  if (!words)
    return finished(Arrival::dropped, tells_overload(line) ? Fault::overload : Fault::garbage);
  const auto force = value_of(*words, Measure::force);
  const auto travel = value_of(*words, Measure::travel);
  const auto time = value_of(*words, Measure::time);
  if (!force || !travel || !time) return finished(Arrival::dropped, Fault::unknown_unit);
  if (std::abs(*force) > strongest || std::abs(*travel) > farthest)
    return finished(Arrival::dropped, Fault::not_finite);
  Sample sample = finished(Arrival::fresh, Fault::none);
  sample.force = *force;
  sample.device_time = *time;
  if (limits_.measures_travel) sample.position.z() = *travel;
  // A gauge that was silent for so long would have been lost before.
  const double ahead =
      last_ ? *time - last_->device_time - (sample.received - last_->received) : 0.0;
  if (last_ && *time < last_->device_time) out_of_time_ = Fault::restarted;
  if (ahead > limits_.lost_after) out_of_time_ = Fault::clock_jumped;
  if (out_of_time_ != Fault::none) return finished(Arrival::lost, out_of_time_);
  const bool timed = pattern_.has_number(Measure::time);
  if (timed && last_ && *time == last_->device_time) {
    sample.arrival = Arrival::duplicate;
    return sample;
  }
  if (last_) {
    const double passed = timed ? *time - last_->device_time : sample.received - last_->received;
    if (passed > 0.0) sample.velocity = (sample.position - last_->position) / passed;
  }
  const std::string_view word = words->unit[as_index(Measure::force)];
  const double unit = word.empty() ? 0.0 : unit_of(Measure::force, word).value_or(0.0);
  if (unit_ == 0.0) unit_ = unit;
  if (unit != unit_) sample.fault = Fault::unit_changed;
  last_ = sample;
  return sample;
}

Sample LineGauge::sample(double wait) {
  if (out_of_time_ != Fault::none) return finished(Arrival::lost, out_of_time_);
  const double until = wire_time() + std::max(0.0, wait);
  while (true) {
    if (!due(until)) return finished(Arrival::none, Fault::none);
    if (!ask())
      return finished(serial_.port.lost() ? Arrival::lost : Arrival::none, Fault::hung_up);
    if (const auto line = serial_.lines.next()) {
      // The beginning of the first line of a stream may be missing.
      if (std::exchange(cut_, false)) continue;
      keep(*line);
      ++traffic_.received;
      if (settings_.poll.empty()) pass_time();
      Sample sample = read(*line);
      // A line that does not match may be an echo, with the reply behind it.
      asked_ = asked_ && sample.arrival == Arrival::dropped;
      heard_ = false;
      return sample;
    }
    if (serial_.port.lost()) return finished(Arrival::lost, Fault::hung_up);
    const double now = wire_time();
    if (asked_ && now >= asked_at_ + reply_time()) {
      asked_ = false;
      if (!heard_) return finished(Arrival::none, Fault::silent);
      return finished(Arrival::dropped, garbage_share(serial_.lines.rest()) > 0.0
                                            ? Fault::garbage
                                            : Fault::truncated);
    }
    if (now >= until) return finished(Arrival::none, Fault::none);
    if (serial_.receive(asked_ ? std::min(until, asked_at_ + reply_time()) : until)) heard_ = true;
  }
}

std::vector<std::string> LineGauge::heard() const {
  std::vector<std::string> sentences;
  for (std::size_t i = kept_count_ - std::min(kept_count_, kept_lines); i < kept_count_; ++i) {
    const Kept& kept = kept_[i % kept_lines];
    const std::string_view line(kept.bytes.data(), kept.size);
    std::string sentence = "`" + printable(line) + "`";
    const auto words = pattern_.match(line);
    if (!words) {
      sentences.push_back(sentence + " does not match: " + pattern_.why_not(line));
      continue;
    }
    const auto add = [&](Measure measure, const char* name, const char* unit, double shown) {
      if (!words->of(measure)) return;
      const auto value = value_of(*words, measure);
      sentence += std::string(", ") + name + " " +
                  (value ? rounded_text(shown * *value, 6) + " " + unit
                         : "in `" + std::string(words->unit[as_index(measure)]) +
                               "`, which is none of " + known_units(measure));
    };
    sentence += ":";
    add(Measure::force, "force", "N", 1.0);
    add(Measure::travel, "height", "mm", 1e3);
    add(Measure::time, "time", "s", 1.0);
    sentence.erase(sentence.find(":,") + 1, 1);
    sentences.push_back(sentence);
  }
  return sentences;
}

// Reads the settings of a gauge, and refuses a pattern that leaves a unit open.

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
    throw InputError(
        place_of(file, key),
        "has no effect, because the pattern takes the unit from the lines; leave it out");
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

// Compiles a pattern to parts, and matches lines to them from the left with one way back: `{any}`.

namespace {

constexpr std::array<const char*, measures> names{"force", "travel", "time"};

struct UnitFactor {
  std::string_view unit;
  double factor;  // SI
};
// Exact by definition: 1 lb = 0.45359237 kg, weighed with 9.80665 m/s^2; 1 oz = 1/16 lb.
// NIST SP 811 B.8
constexpr double kilogram = 9.80665;             // N
constexpr double pound = 0.45359237 * kilogram;  // N
constexpr std::array force_units{UnitFactor{"N", 1.0},
                                 UnitFactor{"mN", 1e-3},
                                 UnitFactor{"kN", 1e3},
                                 UnitFactor{"uN", 1e-6},
                                 UnitFactor{"g", 1e-3 * kilogram},
                                 UnitFactor{"kg", kilogram},
                                 UnitFactor{"mg", 1e-6 * kilogram},
                                 UnitFactor{"gF", 1e-3 * kilogram},
                                 UnitFactor{"kgF", kilogram},
                                 UnitFactor{"lb", pound},
                                 UnitFactor{"lbF", pound},
                                 UnitFactor{"oz", pound / 16.0},
                                 UnitFactor{"ozF", pound / 16.0}};
constexpr std::array travel_units{UnitFactor{"mm", 1e-3}, UnitFactor{"um", 1e-6},
                                  UnitFactor{"cm", 1e-2}, UnitFactor{"m", 1.0},
                                  UnitFactor{"in", 25.4e-3}};
constexpr std::array time_units{UnitFactor{"s", 1.0}, UnitFactor{"ms", 1e-3},
                                UnitFactor{"us", 1e-6}, UnitFactor{"min", 60.0}};

std::span<const UnitFactor> units_of(Measure measure) {
  switch (measure) {
    case Measure::force: return force_units;
    case Measure::travel: return travel_units;
    case Measure::time: return time_units;
  }
  return {};
}

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

[[noreturn]] void refuse(const std::string& sentence) { throw std::invalid_argument(sentence); }

}  // namespace

LinePattern::LinePattern(std::string_view text, Decimal decimal)
    : decimal_(decimal == Decimal::comma ? ',' : '.') {
  text = without_outer_spaces(text);
  using Kind = Part::Kind;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool doubled = i + 1 < text.size() && text[i + 1] == c;
    if (c == '{' && !doubled) {
      const auto end = text.find('}', i);
      if (end == std::string_view::npos)
        refuse("wants `}` after `" + std::string(text.substr(i)) + "`; write `{{` for a brace");
      add_name(text.substr(i + 1, end - i - 1));
      i = end;
    } else if (is_blank(c)) {
      if (parts_.back().kind != Kind::space) add({.kind = Kind::space, .text = " "});
    } else {
      if (c == '}' && !doubled) refuse("wants `{` before `}`; write `}}` for a brace");
      if (c == '{' || c == '}') ++i;
      if (parts_.empty() || parts_.back().kind != Kind::text) add({.kind = Kind::text});
      parts_.back().text += c;
    }
  }
  if (!has_number(Measure::force))
    refuse("wants `{force}` where the line has the force; write it as `{force} {force_unit}`");
}

void LinePattern::add_name(std::string_view name) {
  if (name == "any") return add({.kind = Part::Kind::any, .text = "{any}"});
  if (name == "force_sign") {
    if (std::exchange(has_sign_, true)) refuse("wants `{force_sign}` once");
    return add({.kind = Part::Kind::sign, .text = "{force_sign}"});
  }
  for (std::size_t i = 0; i < measures; ++i) {
    const std::string_view number = names[i];
    const bool unit = name.size() > number.size() && name.substr(number.size()) == "_unit";
    if (!name.starts_with(number) || (!unit && name != number)) continue;
    bool& has = unit ? has_unit_[i] : has_number_[i];
    if (has) refuse("wants `{" + std::string(name) + "}` once; write `{any}` for the others");
    has = true;
    return add({.kind = unit ? Part::Kind::unit : Part::Kind::number,
                .measure = static_cast<Measure>(i),
                .text = "{" + std::string(name) + "}"});
  }
  refuse("wants a name that it knows in braces, got `{" + std::string(name) +
         "}`; write `{force}`, `{travel}`, `{time}`, one of these with `_unit`, `{force_sign}` or "
         "`{any}`");
}

void LinePattern::add(const Part& part) {
  if (!parts_.empty() && parts_.back().kind == part.kind)
    refuse("wants something between `" + parts_.back().text + "` and `" + part.text +
           "`, which cannot be told apart; write what the line has between them");
  parts_.push_back(part);
}

std::optional<std::size_t> LinePattern::take_number(const Part& part, std::string_view line,
                                                    std::size_t at, LineWords& words) const {
  const auto touches = [&](char c) { return is_digit(c) || c == '.' || c == decimal_; };
  std::array<char, 32> text{};
  std::size_t size = 0;
  std::size_t i = at;
  if (i < line.size() && (line[i] == '-' || line[i] == '+')) {
    if (line[i] == '-') text[size++] = '-';
    for (++i; i < line.size() && is_blank(line[i]);) ++i;
  }
  int digits = 0;
  int points = 0;
  for (; i < line.size() && (is_digit(line[i]) || line[i] == decimal_); ++i) {
    line[i] == decimal_ ? ++points : ++digits;
    if (digits > 15 || points > 1) return std::nullopt;
    text[size++] = line[i] == decimal_ ? '.' : line[i];
  }
  if (digits == 0) return std::nullopt;
  // An exponent, of at most two digits.
  if (i < line.size() && (line[i] == 'e' || line[i] == 'E')) {
    std::size_t end = i + 1;
    if (end < line.size() && (line[end] == '-' || line[end] == '+')) ++end;
    const std::size_t first = end;
    while (end < line.size() && is_digit(line[end])) ++end;
    if (end - first > 2) return std::nullopt;
    if (end > first) {
      text[size++] = 'e';
      if (line[i + 1] == '-') text[size++] = '-';
      for (std::size_t digit = first; digit < end; ++digit) text[size++] = line[digit];
      i = end;
    }
  }
  if (i < line.size() && touches(line[i])) return std::nullopt;
  double value = 0.0;
  if (std::from_chars(text.data(), text.data() + size, value).ec != std::errc())
    return std::nullopt;
  if (!(std::abs(value) < 1e15)) return std::nullopt;
  words.number[as_index(part.measure)] = value;
  return i - at;
}

// How many bytes of the line the part takes at `at`; nothing if it does not match there.
std::optional<std::size_t> LinePattern::take(std::size_t index, std::string_view line,
                                             std::size_t at, LineWords& words) const {
  const Part& part = parts_[index];
  switch (part.kind) {
    case Part::Kind::any: return 0;
    case Part::Kind::text:
      return line.substr(at).starts_with(part.text) ? std::optional(part.text.size())
                                                    : std::nullopt;
    case Part::Kind::space: {
      std::size_t end = at;
      while (end < line.size() && is_blank(line[end])) ++end;
      return end - at;
    }
    case Part::Kind::sign:
      if (at == line.size() || std::string_view("0+ 1-").find(line[at]) == line.npos)
        return std::nullopt;
      words.negative = line[at] == '1' || line[at] == '-';
      return 1;
    case Part::Kind::number: {
      // A text of the pattern may end with anything, and what it does not say must not be a number.
      const bool after_text = index > 0 && (parts_[index - 1].kind == Part::Kind::text ||
                                            parts_[index - 1].kind == Part::Kind::sign);
      const char before = at > 0 ? line[at - 1] : ' ';
      if (!after_text && (is_digit(before) || before == '.' || before == decimal_ ||
                          before == '-' || before == '+'))
        return std::nullopt;
      return take_number(part, line, at, words);
    }
    case Part::Kind::unit: {
      std::size_t end = at;
      while (end < line.size() && is_letter(line[end])) ++end;
      if (end == at || end - at > 7) return std::nullopt;
      words.unit[as_index(part.measure)] = line.substr(at, end - at);
      return end - at;
    }
  }
  return std::nullopt;
}

std::optional<LineWords> LinePattern::match(std::string_view line, Furthest& furthest) const {
  line = without_outer_spaces(line);
  LineWords words;
  std::size_t part = 0;
  std::size_t at = 0;
  // After a failure the last `{any}` takes one byte more, so that the time is at most the product
  // of both lengths.
  std::optional<Furthest> back;
  while (part < parts_.size() || at < line.size()) {
    if (at >= furthest.at) furthest = {part, at};
    const auto size = part < parts_.size() ? take(part, line, at, words) : std::nullopt;
    if (size) {
      if (parts_[part].kind == Part::Kind::any) back = {part, at};
      at += *size;
      ++part;
    } else {
      if (!back || back->at == line.size()) return std::nullopt;
      at = ++back->at;
      part = back->part + 1;
    }
  }
  if (words.negative) words.number[as_index(Measure::force)].value() *= -1.0;
  return words;
}

std::optional<LineWords> LinePattern::match(std::string_view line) const {
  Furthest furthest;
  return match(line, furthest);
}

std::string LinePattern::why_not(std::string_view line) const {
  line = without_outer_spaces(line);
  Furthest furthest;
  if (match(line, furthest)) return "the line matches";
  const std::string rest = printable(line.substr(furthest.at));
  const std::string wanted = furthest.part < parts_.size() ? "`" + parts_[furthest.part].text + "`"
                                                           : "the end of the line";
  return wanted + " was expected " + (rest.empty() ? "where the line ends" : "at `" + rest + "`");
}

// Displays also write units of force in capitals, `LB` or `KGF`; `MN` would be another unit.
std::optional<double> unit_of(Measure measure, std::string_view word) {
  for (const UnitFactor& one : units_of(measure)) {
    const bool same = one.unit.size() == word.size() &&
                      std::equal(word.begin(), word.end(), one.unit.begin(), [&](char a, char b) {
                        const bool capital = measure == Measure::force && one.unit != "mN" &&
                                             is_letter(b) && a == static_cast<char>(b & ~0x20);
                        return a == b || capital || (b == 'F' && a == 'f');
                      });
    if (same) return one.factor;
  }
  return std::nullopt;
}

std::string known_units(Measure measure) {
  std::vector<std::string> list;
  for (const UnitFactor& one : units_of(measure)) list.push_back(ticked(one.unit));
  return alternatives(list);
}

}  // namespace palpate::device
