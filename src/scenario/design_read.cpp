// Reads [sweep] into a design, and refuses what is not valid, with its place.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "base/files.h"
#include "base/index.h"
#include "base/text.h"
#include "scenario/design.h"
#include "scenario/family.h"

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
    if (std::ranges::find(known, member.key) != known.end()) continue;
    throw InputError(member.place, no_key_text(member.key, known));
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
    throw InputError(
        place, "`points` of " + ticked(key) +
                   " are closer than 12 digits can distinguish; take fewer, or a wider range");
}

// Whether `value`, found at `key`, is a range and not a table with keys of a scenario.
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

// Reads a range. Throws InputError, with its place, for ends that are not finite numbers in one
// unit, equal ends, a logarithmic scale with an end that is not positive, fewer than two points,
// points so many that 12 digits do not distinguish them, and unknown keys.
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

using Kind = Design::Kind;

bool from_command_line(const Place& place) { return place.line == 0; }

class DesignReader {
 public:
  DesignReader(const Node& table, const std::string& folder) : table_(table), folder_(folder) {}

  Design read() {
    kind_ = design();
    const Sampling sampling{sampling_count("samples", 1, most_samples),
                            sampling_count("seed", 0, 9007199254740991.0)};
    if (kind_ == Kind::csv) return csv();
    refuse_unless("file", false, "with `design = \"csv\"`");
    for (const Member& entry : table_.members) {
      if (entry.key == "rows")
        add_rows(entry);
      else if (entry.key != "design" && entry.key != "samples" && entry.key != "seed")
        add_varied(entry.key, entry, factors_);
    }
    check_order();
    for (const Factor& factor : factors_) check_factor(factor);
    if (kind_ == Kind::list)
      for (const Factor& factor : factors_) same_length(factors_.front(), factor);
    check_count(sampling);
    return {kind_, factors_, sampling};
  }

 private:
  [[nodiscard]] bool sampled() const {
    return kind_ == Kind::lhs || kind_ == Kind::sobol || kind_ == Kind::saltelli;
  }
  [[nodiscard]] std::string written() const {
    return "`design = \"" + design_words()[as_index(kind_)] + "\"`";
  }
  [[nodiscard]] const Place& design_place() const {
    const Member* design = table_.find("design");
    return design != nullptr ? design->value.place : table_.place;
  }

  Kind design() {
    const Member* design = table_.find("design");
    if (design == nullptr) return Kind::grid;
    const Node& value = design->value;
    const std::vector<std::string>& words = design_words();
    const auto word = std::ranges::find(words, value.text);
    if (value.kind != Node::Kind::text || word == words.end())
      throw InputError(value.place, no_word_text("design", value, words));
    return static_cast<Kind>(word - words.begin());
  }

  // The value of a key that only some designs use, or null.
  const Node* refuse_unless(const char* key, bool used, const std::string& when) {
    const Member* member = table_.find(key);
    if (member != nullptr && !used)
      throw InputError(member->place, ticked(key) + " has no effect here: it is used only " + when +
                                          "; remove it or change that");
    return member != nullptr ? &member->value : nullptr;
  }

  std::uint64_t sampling_count(const std::string& key, double low, double high) {
    const bool seed = key == "seed";
    const Node* value =
        seed ? refuse_unless("seed", kind_ == Kind::lhs, "with `design = \"lhs\"`")
             : refuse_unless("samples", sampled(),
                             "with `design = \"lhs\"`, `\"sobol\"` or `\"saltelli\"`");
    if (value == nullptr && !seed && sampled())
      throw InputError(design_place(), written() + " lacks `samples`; write `samples = 100`");
    if (value == nullptr) return seed ? 1 : 0;
    if (value->kind != Node::Kind::integer || value->number < low || value->number > high) {
      const auto whole = [](double number) {
        return std::to_string(static_cast<std::uint64_t>(number));
      };
      throw InputError(value->place, ticked(key) + " wants a whole number from " + whole(low) +
                                         " to " + whole(high) + ", got " + ticked(value->shown()) +
                                         "; write `" + key + " = " + (seed ? "1" : "100") + "`");
    }
    return static_cast<std::uint64_t>(value->number);
  }

  Design csv() {
    const Member* file = table_.find("file");
    if (file == nullptr)
      throw InputError(design_place(), written() + " lacks `file`; write `file = \"cases.csv\"`");
    const Node& name = file->value;
    if (name.kind != Node::Kind::text)
      throw InputError(name.place, "`file` wants a text, got " + name.kind_name() +
                                       "; write it as `file = \"cases.csv\"`");
    for (const Member& entry : table_.members)
      if (entry.key != "design" && entry.key != "file")
        throw InputError(entry.place, "with " + written() + " keys are columns of the file; make " +
                                          ticked(entry.key) + " one of them");
    const std::string path = (std::filesystem::path(folder_) / name.text).string();
    std::string text;
    try {
      text = read_text(path);
    } catch (const InputError& error) {
      throw InputError(name.place,
                       "`file` names " + ticked(path) + ", which " + error.problems()[0].message);
    }
    return Design(CaseTable(std::move(text), path));
  }

  // [[sweep.rows]], each of which is one factor.
  void add_rows(const Member& rows) {
    const Node& list = rows.value;
    if (list.kind != Node::Kind::array)
      throw InputError(list.place, "`rows` wants a list of tables, got " + list.kind_name() +
                                       "; write `[[sweep.rows]]`");
    for (const Node& item : list.items) {
      if (item.kind != Node::Kind::table || item.members.empty())
        throw InputError(item.place,
                         "`rows` wants tables of keys that change together, got " +
                             (item.kind == Node::Kind::table ? "an empty one" : item.kind_name()) +
                             "; write `[[sweep.rows]]` and lists of one length");
      std::vector<Factor> alone;
      for (const Member& entry : item.members) add_varied(entry.key, entry, alone);
      Factor factor;
      factor.row = true;
      for (const Factor& one : alone) {
        refuse_twice(one.keys.front());
        factor.keys.push_back(one.keys.front());
        factor.name += (factor.name.empty() ? "" : " + ") + one.name;
      }
      factors_.push_back(factor);
    }
  }

  void refuse_twice(const Varied& varied) const {
    for (const Factor& factor : factors_)
      for (const Varied& other : factor.keys)
        if (other.key == varied.key)
          throw InputError(varied.place,
                           ticked(varied.key) + " is swept twice; keep one of the two");
  }

  void add_varied(const std::string& key, const Member& entry, std::vector<Factor>& factors) {
    const Node& value = entry.value;
    const bool range = is_interval(key, value);
    if (value.kind == Node::Kind::table && !range) {  // `tissue.material = [...]` without quotes
      for (const Member& inner : value.members) add_varied(key + "." + inner.key, inner, factors);
      if (!value.members.empty()) return;
    }
    if (!range && (value.kind != Node::Kind::array || value.items.empty())) {
      const std::string got = value.kind == Node::Kind::array ? "an empty one" : value.kind_name();
      throw InputError(value.place,
                       ticked(key) + " wants a list of values to run, got " + got + "; write `\"" +
                           key +
                           "\" = [\"...\", \"...\"]`, or a range, `{ from = ..., to = ... }`");
    }
    Varied varied{key, entry.place, {}, std::nullopt, value};
    if (range)
      varied.interval = read_interval(key, value);
    else
      varied.levels = value.items;
    const auto same = [&](const Factor& other) { return !other.row && other.name == key; };
    const auto known = std::ranges::find_if(factors, same);
    if (known != factors.end() && from_command_line(entry.place)) {
      known->keys = {varied};
      return;
    }
    if (known == factors.end()) refuse_twice(varied);
    if (known != factors.end())
      throw InputError(entry.place, ticked(key) + " is swept twice; keep one of the two");
    factors.push_back({key, {varied}, false});
  }

  // A table set after one of its keys would replace the value of that key.
  void check_order() const {
    std::vector<const Varied*> before;
    for (const Factor& factor : factors_)
      for (const Varied& varied : factor.keys) {
        for (const Varied* other : before)
          if (other->key.starts_with(varied.key + "."))
            throw InputError(varied.place, ticked(varied.key) + " stands after " +
                                               ticked(other->key) +
                                               " and replaces it; put it first");
        before.push_back(&varied);
      }
  }

  void check_factor(const Factor& factor) const {
    for (const Varied& varied : factor.keys) {
      if (!varied.interval) continue;
      const bool points = varied.interval->points > 0;
      if (!sampled() && !points)
        throw InputError(varied.given.place, ticked(varied.key) + " lacks `points`, which " +
                                                 written() +
                                                 " needs; write `points = 20` beside `to`");
      if (sampled() && points)
        throw InputError(varied.given.place, "`points` of " + ticked(varied.key) +
                                                 " have no effect with " + written() +
                                                 ", where `samples` counts; remove them");
    }
    const Varied& first = factor.keys.front();
    for (const Varied& other : factor.keys) {
      if (sampled() && first.interval.has_value() != other.interval.has_value())
        throw InputError(other.place,
                         ticked(first.key) + " and " + ticked(other.key) + " change together in " +
                             written() +
                             ", where one has a range and the other a list; give both the same");
      same_length({first.key, {first}, true}, {other.key, {other}, true});
    }
  }

  void same_length(const Factor& one, const Factor& other) const {
    if (one.levels() == other.levels()) return;
    throw InputError(other.keys.front().place,
                     ticked(one.name) + " has " + std::to_string(one.levels()) + " values and " +
                         ticked(other.name) + " " + std::to_string(other.levels()) +
                         ", and they change together; give as many of each");
  }

  void check_count(const Sampling& sampling) const {
    if (sampled() && factors_.empty())
      throw InputError(design_place(),
                       written() +
                           " has nothing to vary; add a key, as `\"tissue.young_modulus\" = { from "
                           "= \"1 kPa\", to = \"100 kPa\" }`");
    const std::size_t dimensions = factors_.size() * (kind_ == Kind::saltelli ? 2 : 1);
    const double drawn = static_cast<double>(dimensions) * static_cast<double>(sampling.samples);
    if (sampled() && (dimensions > most_sobol_dimensions || drawn > most_drawn))
      throw InputError(
          table_.place,
          "`sweep` would draw " + rounded_text(drawn) +
              " numbers, which is more than a design holds; vary fewer keys or take fewer samples");
    double count = sampled() ? static_cast<double>(sampling.samples) : 1.0;
    if (kind_ == Kind::grid)
      for (const Factor& factor : factors_) count *= static_cast<double>(factor.levels());
    if (kind_ == Kind::saltelli) count *= static_cast<double>(factors_.size() + 2);
    if (count > most_planned)
      throw InputError(table_.place, "`sweep` makes " + rounded_text(count) + " cases, and " +
                                         rounded_text(most_planned) +
                                         " is the most; give shorter lists or several scenarios");
  }

  const Node& table_;
  const std::string& folder_;
  Kind kind_ = Kind::grid;
  std::vector<Factor> factors_;
};

// Refuses a `--set` of a key that is swept.
void refuse_settings(const Design& design, const Node& document) {
  for (const Factor& factor : design.factors()) {
    for (const Varied& varied : factor.keys) {
      const Place given = place_of(document, varied.key);
      const std::string setting = trimmed(split(given.file, '=').front());
      const bool list = design.kind() != Kind::csv && !factor.row;
      if (from_command_line(given) && setting == "--set " + varied.key)
        throw InputError(given, ticked(varied.key) +
                                    " is swept, so that one value has no effect; " +
                                    (list ? "set the list, `sweep." + varied.key + "=[...]`"
                                          : "change its values in `[sweep]`"));
    }
  }
}

}  // namespace

Design take_design(Node& document, const std::string& folder) {
  const Member* member = document.find("sweep");
  if (member == nullptr) return {};
  const Node table = member->value;
  std::erase_if(document.members, [](const Member& m) { return m.key == "sweep"; });
  if (table.kind != Node::Kind::table)
    throw InputError(table.place, "`sweep` wants a table of keys and lists, got " +
                                      table.kind_name() + "; write `[sweep]`");
  Design design = DesignReader(table, folder).read();
  refuse_settings(design, document);
  return design;
}

}  // namespace palpate::scenario
