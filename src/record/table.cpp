// Lookup of a column by name.
#include "record/table.h"

#include <array>
#include <stdexcept>

#include "base/text.h"

namespace palpate::record {

int Table::find(std::string_view column) const {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] == column) return static_cast<int>(i);
  return -1;
}

namespace {

const std::array units{&unit::mm,        &unit::kPa,        &unit::density,   &unit::s,
                       &unit::ms,        &unit::per_second, &unit::per_metre, &unit::mm_per_s,
                       &unit::N_s_per_m, &unit::N};

std::optional<double> quantity(std::string_view text, const Unit& wanted) {
  const auto leading = leading_number(text);
  if (!leading || leading->out_of_range) return std::nullopt;
  if (trimmed(leading->rest) == wanted.symbol) return leading->value;
  try {
    return wanted.from_si(parse_quantity(text, wanted));
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

// The unit of the text if it is one of `units`, otherwise the first of `units` with its dimension.
const Unit* unit_of(std::string_view text) {
  const auto leading = leading_number(text);
  if (!leading || leading->rest.empty()) return nullptr;
  for (const Unit* one : units)
    if (trimmed(leading->rest) == one->symbol) return one;
  for (const Unit* one : units)
    if (quantity(text, *one)) return one;
  return nullptr;
}

}  // namespace

Cell swept_cell(const std::string& text) {
  if (const auto number = whole_number(text); number && number_text(*number) == text)
    return *number;
  return text;
}

std::string unit_word(std::string_view symbol) {
  std::string text;
  if (symbol.starts_with("1/")) symbol.remove_prefix(1);
  for (std::size_t i = 0; i < symbol.size(); ++i) {
    const char c = symbol[i];
    if (c == '/')
      text += text.empty() ? "per_" : "_per_";
    else if (c == ' ' || (c == '^' && symbol.substr(i + 1, 1) == "n"))
      text += '_';
    else if (c != '^')
      text += c;
  }
  return text;
}

void SweptColumn::see(const Cell& value) {
  if (kind_ == Kind::words) return;
  const auto* word = std::get_if<std::string>(&value);
  if (kind_ == Kind::unseen) {
    if (word != nullptr) unit_ = unit_of(*word);
    kind_ = word == nullptr ? Kind::numbers : unit_ != nullptr ? Kind::quantities : Kind::words;
  } else if (kind_ == Kind::numbers ? word != nullptr
                                    : word == nullptr || !quantity(*word, *unit_)) {
    kind_ = Kind::words;
  }
}

std::string SweptColumn::name() const {
  return kind_ == Kind::quantities ? key_ + "_" + unit_word(unit_->symbol) : key_;
}

Cell SweptColumn::cell(const Cell& value) const {
  if (const auto* word = std::get_if<std::string>(&value)) {
    if (kind_ != Kind::quantities) return *word;
    return quantity(*word, *unit_).value_or(0.0);
  }
  const auto* number = std::get_if<double>(&value);
  if (number != nullptr && kind_ == Kind::words) return number_text(*number);
  return value;
}

}  // namespace palpate::record
