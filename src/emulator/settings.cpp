// Quantities, and tables that know which of their keys were asked for.
#include "emulator/settings.h"

#include <array>
#include <charconv>
#include <cmath>

namespace emulator {
namespace {

struct Unit {
  std::string_view symbol;
  Quantity quantity;
  double si;  // of one
};

constexpr std::array units{
    Unit{"s", Quantity::time, 1.0},
    Unit{"ms", Quantity::time, 1e-3},
    Unit{"us", Quantity::time, 1e-6},
    Unit{"min", Quantity::time, 60.0},
    Unit{"m", Quantity::length, 1.0},
    Unit{"mm", Quantity::length, 1e-3},
    Unit{"um", Quantity::length, 1e-6},
    Unit{"m/s", Quantity::speed, 1.0},
    Unit{"mm/s", Quantity::speed, 1e-3},
    Unit{"mm/min", Quantity::speed, 1e-3 / 60.0},
    Unit{"m/s^2", Quantity::acceleration, 1.0},
    Unit{"mm/s^2", Quantity::acceleration, 1e-3},
    Unit{"N", Quantity::force, 1.0},
    Unit{"mN", Quantity::force, 1e-3},
    Unit{"Pa", Quantity::pressure, 1.0},
    Unit{"kPa", Quantity::pressure, 1e3},
    Unit{"MPa", Quantity::pressure, 1e6},
    Unit{"kg", Quantity::mass, 1.0},
    Unit{"g", Quantity::mass, 1e-3},
    Unit{"N/m", Quantity::stiffness, 1.0},
    Unit{"N/mm", Quantity::stiffness, 1e3},
    Unit{"N s/m", Quantity::damping, 1.0},
};

struct Name {
  Quantity quantity;
  const char* name;
  const char* example;
};

constexpr std::array names{
    Name{Quantity::time, "time", "1.5 s"},
    Name{Quantity::length, "length", "3 mm"},
    Name{Quantity::speed, "speed", "60 mm/min"},
    Name{Quantity::acceleration, "acceleration", "200 mm/s^2"},
    Name{Quantity::force, "force", "2 N"},
    Name{Quantity::pressure, "pressure", "12 kPa"},
    Name{Quantity::mass, "mass", "200 g"},
    Name{Quantity::stiffness, "stiffness", "300 N/m"},
    Name{Quantity::damping, "damping", "4 N s/m"},
};

const Name& name_of(Quantity quantity) {
  for (const Name& name : names)
    if (name.quantity == quantity) return name;
  return names.front();
}

std::string where(const Document& document, const Node& node) {
  return document.path + ":" + std::to_string(node.line) + ":" + std::to_string(node.column) + ": ";
}

}  // namespace

double parse_quantity(std::string_view text, Quantity quantity, const std::string& place) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc() && rest != end && *rest == ' ' && std::isfinite(value)) {
    const std::string_view symbol(rest + 1, end);
    for (const Unit& unit : units)
      if (unit.quantity == quantity && unit.symbol == symbol) return value * unit.si;
  }
  const Name& name = name_of(quantity);
  throw Refused(place + "wants a " + name.name + ", got `" + std::string(text) +
                "`; write it as `" + name.example + "`");
}

std::string Table::place(const std::string& key) const {
  for (const auto& [name, node] : node_->entries)
    if (name == key) return where(*document_, node) + "`" + key + "` ";
  return where(*document_, *node_) + "`" + key + "` ";
}

const Node* Table::find(const std::string& key) {
  read_.insert(key);
  for (const auto& [name, node] : node_->entries)
    if (name == key) return &node;
  return nullptr;
}

bool Table::has(const std::string& key) const {
  for (const auto& entry : node_->entries)
    if (entry.first == key) return true;
  return false;
}

double Table::quantity(const std::string& key, double otherwise, Quantity quantity) {
  const Node* node = find(key);
  if (node == nullptr) return otherwise;
  if (node->kind != Node::Kind::text)
    throw Refused(place(key) + "wants a text with a unit, such as `\"" + name_of(quantity).example +
                  "\"`");
  return parse_quantity(node->text, quantity, place(key));
}

double Table::number(const std::string& key, double otherwise) {
  const Node* node = find(key);
  if (node == nullptr) return otherwise;
  if (node->kind != Node::Kind::number) throw Refused(place(key) + "wants a number");
  return node->number;
}

std::int64_t Table::count(const std::string& key, std::int64_t otherwise) {
  const double value = number(key, static_cast<double>(otherwise));
  if (value < 0.0 || value != std::floor(value) || value > 1e15)
    throw Refused(place(key) + "wants a whole number that is not negative");
  return static_cast<std::int64_t>(value);
}

bool Table::flag(const std::string& key, std::string_view otherwise) {
  const Node* node = find(key);
  if (node == nullptr) return otherwise == "true";
  if (node->kind != Node::Kind::flag) throw Refused(place(key) + "wants `true` or `false`");
  return node->flag;
}

std::string Table::text(const std::string& key, const std::string& otherwise) {
  const Node* node = find(key);
  if (node == nullptr) return otherwise;
  if (node->kind != Node::Kind::text) throw Refused(place(key) + "wants a text in quotes");
  return node->text;
}

std::string Table::choice(const std::string& key, const std::string& otherwise,
                          std::span<const std::string_view> allowed) {
  std::string got = text(key, otherwise);
  std::string all;
  for (const std::string_view one : allowed) {
    if (one == got) return got;
    all += (all.empty() ? "`" : ", `") + std::string(one) + "`";
  }
  throw Refused(place(key) + "knows no `" + got + "`; choose one of " + all);
}

std::vector<double> Table::quantities(const std::string& key, Quantity quantity) {
  std::vector<double> values;
  const Node* node = find(key);
  if (node == nullptr) return values;
  if (node->kind != Node::Kind::list) throw Refused(place(key) + "wants a list");
  for (const Node& item : node->items)
    values.push_back(parse_quantity(item.text, quantity, place(key)));
  return values;
}

std::vector<Table> Table::tables(const std::string& key) {
  std::vector<Table> found;
  const Node* node = find(key);
  if (node == nullptr) return found;
  if (node->kind == Node::Kind::table)
    found.emplace_back(*document_, *node);
  else if (node->kind != Node::Kind::list)
    throw Refused(place(key) + "wants a table");
  for (const Node& item : node->items) {
    if (item.kind != Node::Kind::table) throw Refused(place(key) + "wants tables");
    found.emplace_back(*document_, item);
  }
  return found;
}

void Table::finish() const {
  for (const auto& [name, node] : node_->entries) {
    if (read_.contains(name)) continue;
    std::string all;
    for (const std::string& key : read_) all += (all.empty() ? "`" : ", `") + key + "`";
    throw Refused(where(*document_, node) + "there is no key `" + name + "` here; there are " +
                  all);
  }
}

}  // namespace emulator
