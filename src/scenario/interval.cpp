// Reads the ranges of a sweep.
#include "scenario/interval.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/text.h"

namespace palpate::scenario {
namespace {

constexpr double most_points = 1e6;

struct End {
  double number = 0.0;
  std::string unit;
};

End read_end(const std::string& name, const Node& node) {
  End end;
  bool readable = node.is_number();
  bool finite = std::isfinite(node.number);
  end.number = node.number;
  if (node.kind == Node::Kind::text) {
    const std::string text = trimmed(node.text);
    const auto number = leading_number(text);
    readable = number.has_value();
    if (number) {
      finite = !number->out_of_range && std::isfinite(number->value);
      end = {number->value, trimmed(number->rest)};
    }
  }
  if (!readable)
    throw InputError(node.place, ticked(name) + " wants a number or a quantity, got " +
                                     ticked(node.shown()) + "; write it as `" + name +
                                     " = \"1 kPa\"`, or give a list of values");
  if (!finite)
    throw InputError(node.place, ticked(name) + " wants a finite number, got " +
                                     ticked(node.shown()) + "; write one as `0.5`");
  return end;
}

void refuse_unknown_keys(const Node& table) {
  const std::vector<std::string> known{"from", "to", "points", "scale"};
  for (const Member& member : table.members) {
    if (std::find(known.begin(), known.end(), member.key) != known.end()) continue;
    const auto near = nearest(member.key, known);
    throw InputError(member.place, ticked(member.key) + " is not a key here; " +
                                       (near ? "did you mean " + ticked(*near) + "?"
                                             : "known keys: " + joined(known, ", ")));
  }
}

// Values are written with 12 digits, so neighbours must differ within these.
void refuse_crowded(const std::string& key, const Interval& interval, const Place& place) {
  const auto steps = static_cast<double>(interval.points - 1);
  const double step = interval.scale == Interval::Scale::logarithmic
                          ? std::log(interval.high / interval.low) / steps
                          : (interval.high / steps - interval.low / steps) /
                                std::max(std::abs(interval.low), std::abs(interval.high));
  if (std::abs(step) < 1e-11)
    throw InputError(place, "`points` of " + ticked(key) +
                                " are closer than 12 digits can distinguish; take fewer, or a "
                                "wider range");
}

}  // namespace

bool is_interval(const std::string& key, const Node& value) {
  if (value.kind != Node::Kind::table) return false;
  for (const char* own : {"from", "points", "scale"})
    if (value.find(own) != nullptr) return true;
  // `step.1.to = ...` without quotes gives a table with a `to`, too, but it is not a range.
  const Member* to = value.find("to");
  const std::string last = key.substr(key.rfind('.') + 1);
  return to != nullptr && !whole_number(last) &&
         (to->value.kind == Node::Kind::text || to->value.is_number());
}

Interval read_interval(const std::string& key, const Node& table) {
  refuse_unknown_keys(table);
  for (const char* needed : {"from", "to"})
    if (table.find(needed) == nullptr)
      throw InputError(table.place, "the range of " + ticked(key) + " lacks " + ticked(needed) +
                                        "; write `{ from = ..., to = ... }`");
  Interval interval;
  interval.from = table.find("from")->value;
  interval.to = table.find("to")->value;
  const End from = read_end("from", interval.from);
  const End to = read_end("to", interval.to);
  interval.low = from.number;
  interval.high = to.number;
  interval.unit = from.unit;
  if (interval.from.is_number() != interval.to.is_number() || from.unit != to.unit) {
    const auto unit = [](const End& end) {
      return end.unit.empty() ? std::string("no unit") : ticked(end.unit);
    };
    throw InputError(interval.to.place, "`from` has " + unit(from) + " and `to` " + unit(to) +
                                            "; write both in one unit");
  }
  if (from.number == to.number)
    throw InputError(interval.to.place, "`from` and `to` are the same; give " + ticked(key) +
                                            " two ends, or one value outside of `[sweep]`");
  if (const Member* scale = table.find("scale")) {
    const Node& word = scale->value;
    if (word.kind != Node::Kind::text || (word.text != "linear" && word.text != "log"))
      throw InputError(word.place, "`scale` is `\"linear\"` or `\"log\"`, got " +
                                       ticked(word.shown()) + "; write one of the two");
    if (word.text == "log") interval.scale = Interval::Scale::logarithmic;
  }
  if (interval.scale == Interval::Scale::logarithmic && (from.number <= 0.0 || to.number <= 0.0))
    throw InputError((from.number <= 0.0 ? interval.from : interval.to).place,
                     "a logarithmic scale has no place for " +
                         ticked((from.number <= 0.0 ? interval.from : interval.to).shown()) +
                         "; begin above 0, or write `scale = \"linear\"`");
  if (const Member* points = table.find("points")) {
    const Node& count = points->value;
    if (count.kind != Node::Kind::integer || count.number < 2.0 || count.number > most_points)
      throw InputError(count.place, "`points` wants a whole number from 2 to 1000000, got " +
                                        ticked(count.shown()) + "; write `points = 20`");
    interval.points = static_cast<std::size_t>(count.number);
    refuse_crowded(key, interval, count.place);
  }
  return interval;
}

}  // namespace palpate::scenario
