// The single list of a struct's keys. A struct's function `fields(FieldVisitor&, Struct&)` names
// every key once; visitors read the keys from a TOML tree, write the resolved echo and the manual.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/document.h"
#include "base/units.h"
#include "base/words.h"

namespace palpate {

// When a key has an effect. If a key that has none is given, this is an error or, for settings
// that the chosen model does not need, a note.
struct Use {
  enum class Otherwise { error, note };
  bool used = true;
  std::string when = {};  // "with `viscosity = \"nodal_drag\"`"
  Otherwise otherwise = Otherwise::error;
};

struct Key {
  const char* name;
  const char* meaning;
  Use use = {};
  bool of_the_paper = false;  // only comparisons with the paper need it
};
[[nodiscard]] inline Key of_the_paper(Key key) {
  key.of_the_paper = true;
  return key;
}

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_allowed = true;
  bool high_allowed = true;
  const char* remedy = "give a value in that range";

  [[nodiscard]] bool holds(double value) const {
    return (low_allowed ? value >= low : value > low) &&
           (high_allowed ? value <= high : value < high);
  }
};
[[nodiscard]] inline Range above(double low) { return {.low = low, .low_allowed = false}; }
[[nodiscard]] inline Range at_least(double low) { return {.low = low}; }
[[nodiscard]] inline Range between(double low, double high) { return {low, high}; }

// A quantity that may be given in either of two dimensions, such as travel or force.
struct Target {
  double value = 0.0;   // SI
  bool second = false;  // `value` has the second dimension
};

// Which numbers a key accepts. If a key also accepts a word, `open`, as in `time_step = "auto"`,
// this word is read as an empty value.
struct Real {
  const Unit* unit = nullptr;  // null: a pure number
  Range range = {};            // SI
  const char* open = nullptr;
};
struct Whole {
  Range range = {};
  const char* open = nullptr;
};

class FieldVisitor;
using Fields = std::function<void(FieldVisitor&)>;

class FieldVisitor {
 public:
  virtual ~FieldVisitor() = default;

  // A real number; empty if the key is not given or its value is the word `kind.open`.
  virtual void real(const Key& key, std::optional<double>& value, const Real& kind) = 0;
  virtual void whole(const Key& key, std::optional<int>& value, const Whole& kind) = 0;
  virtual void either(const Key& key, Target& target, const Unit& first, const Unit& second,
                      const Range& range) = 0;
  virtual void text(const Key& key, std::string& value) = 0;
  virtual void flag(const Key& key, bool& value) = 0;
  virtual void quantities(const Key& key, std::span<double> si, const Unit& unit,
                          const Range& range) = 0;
  virtual void counts(const Key& key, std::span<int> values, const Range& range) = 0;
  // Any number of different quantities; empty if the key is not given.
  virtual void quantity_list(const Key& key, std::vector<double>& si, const Unit& unit,
                             const Range& range) = 0;
  virtual void numbers_by_name(const Key& key, std::map<std::string, double>& values,
                               const Range& range) = 0;
  virtual void choice_of(const Key& key, int& index, std::span<const Word> words) = 0;
  virtual void table(const Key& key, const Fields& fields) = 0;
  // A list of tables: `resize(n)` makes n of them; `fields(visitor, i)` visits number i, from 0.
  virtual void tables(const Key& key, int size, const std::function<void(int)>& resize,
                      const std::function<void(FieldVisitor&, int)>& fields) = 0;
  // The alternative of a variant: `choose(i)` makes the i-th one active and returns its fields.
  virtual void kind(int chosen, std::span<const Word> words,
                    const std::function<Fields(int)>& choose) = 0;

  void number(const Key& key, double& value, const Range& range) {
    given(value, [&](auto& any) { real(key, any, {nullptr, range}); });
  }
  void number(const Key& key, std::optional<double>& value, const Range& range) {
    real(key, value, {nullptr, range});
  }
  void quantity(const Key& key, double& si, const Unit& unit, const Range& range) {
    given(si, [&](auto& any) { real(key, any, {&unit, range}); });
  }
  void quantity(const Key& key, std::optional<double>& si, const Unit& unit, const Range& range) {
    real(key, si, {&unit, range});
  }
  void quantity_or(const char* word, const Key& key, std::optional<double>& si, const Unit& unit,
                   const Range& range) {
    real(key, si, {&unit, range, word});
  }
  void count(const Key& key, int& value, const Range& range) {
    given(value, [&](auto& any) { whole(key, any, {range}); });
  }
  void count_or(const char* word, const Key& key, std::optional<int>& value, const Range& range) {
    whole(key, value, {range, word});
  }

  template <class Enum, std::size_t size>
  void choice(const Key& key, Enum& value, const Words<Enum, size>& words) {
    int index = static_cast<int>(value);
    choice_of(key, index, words);
    value = static_cast<Enum>(index);
  }

  // An empty value is written as `open`, the first word.
  template <class Enum, std::size_t size>
  void choice_or(const Word& open, const Key& key, std::optional<Enum>& value,
                 const Words<Enum, size>& words) {
    std::array<Word, size + 1> all{open};
    std::ranges::copy(words, all.begin() + 1);
    int index = value ? static_cast<int>(*value) + 1 : 0;
    choice_of(key, index, all);
    value = index > 0 ? std::optional(static_cast<Enum>(index - 1)) : std::nullopt;
  }

  // Each alternative has a static `word` (its kind and what it means) and `fields`. The fields in
  // `besides` follow for every alternative.
  template <class... Kinds>
  void alternatives(std::variant<Kinds...>& value, const Fields& besides = {}) {
    static constexpr std::array<Word, sizeof...(Kinds)> words{Kinds::word...};
    kind(static_cast<int>(value.index()), words, [&](int chosen) -> Fields {
      if (chosen != static_cast<int>(value.index())) {
        int index = 0;
        ((index++ == chosen ? void(value.template emplace<Kinds>()) : void()), ...);
      }
      return [&](FieldVisitor& visitor) {
        std::visit([&visitor](auto& alternative) { fields(visitor, alternative); }, value);
        if (besides) besides(visitor);
      };
    });
  }

 private:
  // Visits a number that is never empty through an optional.
  template <class Number, class Visit>
  static void given(Number& value, const Visit& visit) {
    std::optional<Number> any = value;
    visit(any);
    value = any.value_or(value);
  }
};

// A key that is given but has no effect. It is also reported as a note or as a problem.
struct Unread {
  std::string path;  // dotted, such as `solver.rings`; entries of lists count from 1
  std::string when;  // when the key would be used
};

struct Reading {
  std::vector<Problem> problems;  // errors
  std::vector<Problem> notes;     // keys that the chosen model does not use
  std::vector<Unread> unread;     // all keys that have no effect
};

// Reads all of `root` into the fields. Whether a key is used may depend on keys that come later
// or are in other tables. Therefore a first pass reads the values, and a second pass reads them
// again and reports unknown keys and wrong types, dimensions and ranges. A field that holds one
// value is unchanged if its value is wrong.
[[nodiscard]] Reading read_fields(const Node& root, const Fields& fields);

// What stands before the bounds of a range; `equal` where the range has a single value.
struct RangeWords {
  const char* at_least = "at least ";
  const char* above = "above ";
  const char* at_most = "at most ";
  const char* below = "below ";
  const char* equal = "";
};

// Why a table has no such key, and why a value is none of the words that its key may have.
[[nodiscard]] std::string no_key_text(const std::string& key, std::span<const std::string> known);
[[nodiscard]] std::string no_word_text(const std::string& key, const Node& node,
                                       std::span<const std::string> known);

// Such as "above 0 kPa and below 3 kPa". `unit` is the unit of the key, or null for a pure
// number.
[[nodiscard]] std::string range_text(const Range& range, const Unit* unit,
                                     const RangeWords& words = {});

// Keys that have no effect for the present values are written only with `Written::all`.
enum class Written { used, all };
[[nodiscard]] Node fields_as_node(const Fields& fields, Written written = Written::used);
[[nodiscard]] std::string fields_as_toml(const Fields& fields, Written written = Written::used);

}  // namespace palpate
