// Converts swept words to columns for plots: numbers in one unit, where possible.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.h"
#include "record/table.h"

namespace palpate::sweep {

// The column of one swept key: `KEY_UNIT` with numbers if all values are quantities of one
// dimension, `KEY` with numbers if all are pure numbers, otherwise `KEY` with words.
class SweptColumn {
 public:
  explicit SweptColumn(std::string key) : key_(std::move(key)) {}

  // Call see() with every value before name() and cell().
  void see(const record::Cell& value);

  [[nodiscard]] std::string name() const;
  [[nodiscard]] record::Cell cell(const record::Cell& value) const;

 private:
  enum class Kind { unseen, numbers, quantities, words };
  std::string key_;
  Kind kind_ = Kind::unseen;
  const Unit* unit_ = nullptr;
};

// A unit as the last part of a column's name: `kg/m^3` as `kg_per_m3`.
[[nodiscard]] std::string unit_word(std::string_view symbol);

}  // namespace palpate::sweep
