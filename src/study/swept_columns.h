// Swept words as columns that a plot can use: numbers in one unit where they are.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.h"
#include "record/table.h"

namespace palpate::study {

// The column of one swept key: `KEY_kPa` where every value is a pressure, `KEY` with numbers where
// every value is one, else `KEY` with words.
class SweptColumn {
 public:
  explicit SweptColumn(std::string key) : key_(std::move(key)) {}

  // First every value is shown to it, then its name and cells are asked for.
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

}  // namespace palpate::study
