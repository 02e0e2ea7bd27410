// The one list of a struct's keys. A struct's `fields(FieldVisitor&, Struct&)` names every key
// once; visitors read them, write the resolved echo and write the manual.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/units.h"

namespace palpate {

// Where a key takes effect. Outside of it, giving the key is an error, or, for machinery that a
// model just does not use, a note.
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
};

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_allowed = true;
  bool high_allowed = true;

  [[nodiscard]] bool holds(double value) const {
    return (low_allowed ? value >= low : value > low) &&
           (high_allowed ? value <= high : value < high);
  }
};
[[nodiscard]] inline Range above(double low) { return {.low = low, .low_allowed = false}; }
[[nodiscard]] inline Range at_least(double low) { return {.low = low}; }
[[nodiscard]] inline Range between(double low, double high) { return {low, high}; }

struct Word {
  const char* word;
  const char* meaning;
};

// A quantity that may be given in one of two dimensions, such as travel or force.
struct Target {
  double value = 0.0;   // SI
  bool second = false;  // in the second dimension
};

class FieldVisitor;
using Fields = std::function<void(FieldVisitor&)>;

class FieldVisitor {
 public:
  virtual ~FieldVisitor() = default;

  virtual void number(const Key& key, double& value, const Range& range) = 0;
  virtual void number(const Key& key, std::optional<double>& value, const Range& range) = 0;
  virtual void quantity(const Key& key, double& si, const Unit& unit, const Range& range) = 0;
  virtual void quantity(const Key& key, std::optional<double>& si, const Unit& unit,
                        const Range& range) = 0;
  // Empty stands for `word`, as in `time_step = "auto"`.
  virtual void quantity_or(const char* word, const Key& key, std::optional<double>& si,
                           const Unit& unit, const Range& range) = 0;
  virtual void count_or(const char* word, const Key& key, std::optional<int>& value,
                        const Range& range) = 0;
  virtual void either(const Key& key, Target& target, const Unit& first, const Unit& second,
                      const Range& range) = 0;
  virtual void count(const Key& key, int& value, const Range& range) = 0;
  virtual void text(const Key& key, std::string& value) = 0;
  virtual void flag(const Key& key, bool& value) = 0;
  virtual void quantities(const Key& key, std::span<double> si, const Unit& unit,
                          const Range& range) = 0;
  virtual void counts(const Key& key, std::span<int> values, const Range& range) = 0;
  // As many as are given, none of them twice; empty where the key is not there.
  virtual void quantity_list(const Key& key, std::vector<double>& si, const Unit& unit,
                             const Range& range) = 0;
  virtual void numbers_by_name(const Key& key, std::map<std::string, double>& values,
                               const Range& range) = 0;
  virtual void choice_of(const Key& key, int& index, std::span<const Word> words) = 0;
  virtual void table(const Key& key, const Fields& fields) = 0;
  // A list of tables: `resize(n)` makes n of them, `fields(visitor, i)` visits the i-th.
  virtual void tables(const Key& key, int size, const std::function<void(int)>& resize,
                      const std::function<void(FieldVisitor&, int)>& fields) = 0;
  // The alternative of a variant: `choose(i)` makes it the i-th and returns its fields.
  virtual void kind(int chosen, std::span<const Word> words,
                    const std::function<Fields(int)>& choose) = 0;

  template <class Enum>
  void choice(const Key& key, Enum& value, std::span<const Word> words) {
    int index = static_cast<int>(value);
    choice_of(key, index, words);
    value = static_cast<Enum>(index);
  }

  // Each alternative has a static `word` (its kind and what it is) and its own `fields`.
  template <class... Kinds>
  void alternatives(std::variant<Kinds...>& value) {
    static constexpr std::array<Word, sizeof...(Kinds)> words{Kinds::word...};
    kind(static_cast<int>(value.index()), words, [&value](int chosen) -> Fields {
      if (chosen != static_cast<int>(value.index())) {
        int index = 0;
        ((index++ == chosen ? void(value.template emplace<Kinds>()) : void()), ...);
      }
      return [&value](FieldVisitor& visitor) {
        std::visit([&visitor](auto& alternative) { fields(visitor, alternative); }, value);
      };
    });
  }
};

}  // namespace palpate
