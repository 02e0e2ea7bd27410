// The visitor that reads fields, with the messages for everything that it refuses, and the one that
// makes a document of their values.
#include "base/fields.h"

#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/text.h"

namespace palpate {

std::string range_text(const Range& range, const Unit* unit, const RangeWords& words) {
  const auto bound = [&](double value) {
    return unit != nullptr ? quantity_text(value, *unit) : number_text(value);
  };
  std::string text;
  if (range.low == range.high) return words.equal + bound(range.low);
  if (std::isfinite(range.low))
    text += (range.low_allowed ? words.at_least : words.above) + bound(range.low);
  if (std::isfinite(range.high)) {
    if (!text.empty()) text += " and ";
    text += (range.high_allowed ? words.at_most : words.below) + bound(range.high);
  }
  return text;
}

std::string no_key_text(const std::string& key, std::span<const std::string> known) {
  return ticked(key) + " is not a key here; " +
         did_you_mean(key, known, "known keys: " + joined(known, ", "));
}

std::string no_word_text(const std::string& key, const Node& node,
                         std::span<const std::string> known) {
  const std::string choices = joined(known, ", ");
  if (node.kind != Node::Kind::text)
    return ticked(key) + " wants one of " + choices + ", got " + node.kind_name() +
           "; write it as `" + key + " = \"" + known[0] + "\"`";
  const auto near = nearest(node.text, known);
  return ticked(key) + " does not know " + ticked(node.text) +
         (near ? "; did you mean " + ticked(*near) + "? It" : "; it") + " is one of " + choices;
}

namespace {

class Writer final : public FieldVisitor {
 public:
  explicit Writer(Written written) : all_(written == Written::all) {}

  [[nodiscard]] const Node& result() const { return table_; }

  void real(const Key& key, std::optional<double>& value, const Real& kind) override {
    if (value)
      put(key, kind.unit != nullptr ? text_node(quantity_text(*value, *kind.unit))
                                    : number_node(*value));
    else if (kind.open != nullptr)
      put(key, text_node(kind.open));
  }
  void whole(const Key& key, std::optional<int>& value, const Whole& kind) override {
    put(key, value ? number_node(*value) : text_node(kind.open));
  }
  void either(const Key& key, Target& target, const Unit& first, const Unit& second,
              const Range&) override {
    put(key, text_node(quantity_text(target.value, target.second ? second : first)));
  }
  void text(const Key& key, std::string& value) override { put(key, text_node(value)); }
  void flag(const Key& key, bool& value) override {
    Node node;
    node.kind = Node::Kind::boolean;
    node.boolean = value;
    put(key, node);
  }
  void quantities(const Key& key, std::span<double> si, const Unit& unit, const Range&) override {
    std::vector<Node> items;
    for (const double value : si) items.push_back(text_node(quantity_text(value, unit)));
    put(key, list_node(std::move(items)));
  }
  void counts(const Key& key, std::span<int> values, const Range&) override {
    std::vector<Node> items;
    for (const int value : values) items.push_back(number_node(value));
    put(key, list_node(std::move(items)));
  }
  void quantity_list(const Key& key, std::vector<double>& si, const Unit& unit,
                     const Range& range) override {
    if (!si.empty()) quantities(key, si, unit, range);
  }
  void numbers_by_name(const Key& key, std::map<std::string, double>& values,
                       const Range&) override {
    Node table;
    for (const auto& [name, value] : values)
      table.members.push_back({name, {}, number_node(value)});
    if (!values.empty()) put(key, table);
  }
  void choice_of(const Key& key, int& index, std::span<const Word> words) override {
    put(key, text_node(words[as_index(index)].word));
  }
  void table(const Key& key, const Fields& fields) override {
    if (all_ || key.use.used) put(key, inside([&] { fields(*this); }));
  }
  void tables(const Key& key, int size, const std::function<void(int)>&,
              const std::function<void(FieldVisitor&, int)>& fields) override {
    std::vector<Node> items;
    for (int i = 0; i < size; ++i) items.push_back(inside([&] { fields(*this, i); }));
    if (size > 0) put(key, list_node(std::move(items)));
  }
  void kind(int chosen, std::span<const Word> words,
            const std::function<Fields(int)>& choose) override {
    put({"kind", ""}, text_node(words[as_index(chosen)].word));
    choose(chosen)(*this);
  }

 private:
  Node inside(const std::function<void()>& visit) {
    Node outer = std::exchange(table_, {});
    visit();
    return std::exchange(table_, std::move(outer));
  }

  void put(const Key& key, Node value) {
    if (all_ || key.use.used) table_.members.push_back({key.name, {}, std::move(value)});
  }

  bool all_;
  Node table_;  // that is being filled
};

}  // namespace

Node fields_as_node(const Fields& fields, Written written) {
  Writer writer(written);
  fields(writer);
  return writer.result();
}

std::string fields_as_toml(const Fields& fields, Written written) {
  return toml_document(fields_as_node(fields, written));
}

namespace {

// Words of earlier versions, and those that took their place.
constexpr std::array renamed{std::pair<const char*, const char*>{"neo_hookean", "solid"}};

// A key that is looked for in another table, and how it is written there.
constexpr std::pair elsewhere{"tissue.mesh.up",
                              R"(tissue.shape = { kind = "as_meshed", up = "y" })"};

class Reader final : public FieldVisitor {
 public:
  // `trust_uses`: whether all choices on which Key::use depends could be read.
  Reader(const Node& root, Reading* reading, bool trust_uses)
      : reading_(reading), trust_uses_(trust_uses) {
    open_.push_back({&root, {}, {}});
  }

  void finish() { refuse_unknown_keys(); }

  [[nodiscard]] bool choices_read() const { return choices_read_; }

  void real(const Key& key, std::optional<double>& value, const Real& kind) override {
    const Node* node = find(key);
    if (node == nullptr) return;
    const bool text = kind.open != nullptr && node->kind == Node::Kind::text;
    double read = 0.0;
    if (text && node->text == kind.open)
      value.reset();
    else if (text && !leading_number(trimmed(node->text)))
      wants_word(key, *node, kind.open, std::string("a ") + kind.unit->quantity);
    else if (kind.unit != nullptr ? read_quantity(key, *node, read, *kind.unit, kind.range)
                                  : read_number(key, *node, read, kind.range))
      value = read;
  }
  void whole(const Key& key, std::optional<int>& value, const Whole& kind) override {
    const Node* node = find(key);
    if (node == nullptr) return;
    const bool text = kind.open != nullptr && node->kind == Node::Kind::text;
    int read = 0;
    if (text && node->text == kind.open)
      value.reset();
    else if (text)
      wants_word(key, *node, kind.open, "a whole number");
    else if (read_count(key, *node, read, kind.range))
      value = read;
  }
  void either(const Key& key, Target& target, const Unit& first, const Unit& second,
              const Range& range) override {
    const Node* node = find(key);
    if (node == nullptr) return;
    const bool of_second =
        node->kind == Node::Kind::text && is_quantity(node->text, second.dimension);
    const std::string both = std::string(first.quantity) + " or a " + second.quantity;
    Unit wanted = of_second ? second : first;
    if (!of_second) wanted.quantity = both.c_str();
    double value = 0.0;
    if (read_quantity(key, *node, value, wanted, range)) target = {value, of_second};
  }
  void text(const Key& key, std::string& value) override {
    const Node* node = find(key);
    if (node == nullptr) return;
    if (node->kind != Node::Kind::text)
      wrong_type(key, *node, "a text", node->is_number() ? "\"" + node->shown() + "\"" : "\"...\"");
    else
      value = node->text;
  }
  void flag(const Key& key, bool& value) override {
    const Node* node = find(key);
    if (node == nullptr) return;
    if (node->kind != Node::Kind::boolean)
      wrong_type(key, *node, "`true` or `false`", "true");
    else
      value = node->boolean;
  }
  void quantities(const Key& key, std::span<double> si, const Unit& unit,
                  const Range& range) override {
    read_list(key, si.size(), [&](const Node& item, std::size_t i) {
      read_quantity(key, item, si[i], unit, range);
    });
  }
  void counts(const Key& key, std::span<int> values, const Range& range) override {
    read_list(key, values.size(),
              [&](const Node& item, std::size_t i) { read_count(key, item, values[i], range); });
  }
  void quantity_list(const Key& key, std::vector<double>& si, const Unit& unit,
                     const Range& range) override {
    const Node* node = find(key);
    if (node == nullptr) return;
    if (node->kind != Node::Kind::array)
      return wrong_type(key, *node, "a list", "[\"1 " + std::string(unit.symbol) + "\"]");
    si.clear();
    in_list_ = true;
    for (const Node& item : node->items) {
      (void)read_quantity(key, item, si.emplace_back(), unit, range);
    }
    in_list_ = false;
  }
  void numbers_by_name(const Key& key, std::map<std::string, double>& values,
                       const Range& range) override {
    const Node* node = find(key);
    if (node == nullptr) return;
    if (node->kind != Node::Kind::table) return wrong_type(key, *node, "a table", "{ name = 1 }");
    values.clear();
    for (const Member& member : node->members) {
      double read = 0.0;
      const Key entry{member.key.c_str(), key.meaning};
      if (read_number(entry, member.value, read, range)) values[member.key] = read;
    }
  }
  void choice_of(const Key& key, int& index, std::span<const Word> words) override {
    const Node* node = find(key);
    if (node == nullptr) return;
    if (const auto chosen = read_word(key.name, *node, words)) index = *chosen;
  }
  void table(const Key& key, const Fields& fields) override {
    const Node* node = find(key);
    if (node == nullptr) return;
    if (node->kind != Node::Kind::table) return wrong_type(key, *node, "a table", "{ ... }");
    enter(key.name, *node, [&] { fields(*this); });
  }
  void tables(const Key& key, int, const std::function<void(int)>& resize,
              const std::function<void(FieldVisitor&, int)>& fields) override {
    const Node* node = find(key);
    if (node == nullptr) return;
    if (node->kind != Node::Kind::array)
      return problem(node->place, ticked(key.name) + " wants a list of tables, got " +
                                      node->kind_name() + "; write `[[" + key.name + "]]`");
    resize(static_cast<int>(node->items.size()));
    for (std::size_t i = 0; i < node->items.size(); ++i) {
      const Node& item = node->items[i];
      if (item.kind == Node::Kind::table)
        enter(std::string(key.name) + "." + std::to_string(i + 1), item,
              [&] { fields(*this, static_cast<int>(i)); });
      else
        problem(item.place, ticked(key.name) + " wants tables, got " + item.kind_name() +
                                "; write `[[" + key.name + "]]`");
    }
  }
  void kind(int chosen, std::span<const Word> words,
            const std::function<Fields(int)>& choose) override {
    const Node& here = *open_.back().node;
    open_.back().known.insert("kind");
    if (const Member* member = here.find("kind")) {
      const auto read = read_word("kind", member->value, words);
      if (!read) return know_everything();
      chosen = *read;
    } else {
      // A table with a key named like an alternative needs no `kind`: `{ file = "leg.node" }`.
      for (std::size_t i = 0; i < words.size(); ++i)
        if (here.find(words[i].word) != nullptr) chosen = static_cast<int>(i);
    }
    choose(chosen)(*this);
  }

 private:
  struct Open {
    const Node* node;
    std::string name;  // its key in the table around it
    std::set<std::string> known;
  };

  void problem(const Place& place, const std::string& message) {
    reading_->problems.push_back({place, message});
  }

  void wants_word(const Key& key, const Node& node, const char* word, const std::string& or_else) {
    problem(node.place, ticked(key.name) + " wants " + ticked(word) + " or " + or_else + ", got " +
                            ticked(node.text) + "; write " + ticked(word));
  }

  void wrong_type(const Key& key, const Node& node, const std::string& wanted,
                  const std::string& example) {
    const bool has_text = node.shown() != node.kind_name();
    const std::string got = node.kind_name() + (has_text ? " " + ticked(node.shown()) : "");
    problem(node.place, ticked(key.name) + " wants " + wanted + ", got " + got + "; write it as `" +
                            (in_list_ ? "" : std::string(key.name) + " = ") + example + "`");
  }

  const Node* find(const Key& key) {
    Open& here = open_.back();
    here.known.insert(key.name);
    const Member* member = here.node->find(key.name);
    if (member == nullptr) return nullptr;
    if (!key.use.used && trust_uses_) {
      reading_->unread.push_back({path_of(key.name), key.use.when});
      if (key.use.otherwise == Use::Otherwise::note)
        reading_->notes.push_back(
            {member->place, ticked(key.name) + " is left unread: it is used only " + key.use.when});
      else
        problem(member->place, ticked(key.name) + " has no effect here: it is used only " +
                                   key.use.when + "; remove it or change that");
      if (key.use.otherwise == Use::Otherwise::error) return nullptr;
    }
    return &member->value;
  }

  [[nodiscard]] std::string path_of(const std::string& key) const {
    std::string path;
    for (const Open& open : open_)
      if (!open.name.empty()) path += open.name + ".";
    return path + key;
  }

  void enter(const std::string& name, const Node& node, const std::function<void()>& visit) {
    open_.push_back({&node, name, {}});
    visit();
    refuse_unknown_keys();
    open_.pop_back();
  }

  void know_everything() {  // after a wrong `kind` it is unknown which keys are allowed
    for (const Member& member : open_.back().node->members) open_.back().known.insert(member.key);
  }

  void refuse_unknown_keys() {
    const Open& here = open_.back();
    const std::vector<std::string> known(here.known.begin(), here.known.end());
    for (const Member& member : here.node->members) {
      if (here.known.contains(member.key)) continue;
      problem(member.place,
              path_of(member.key) == elsewhere.first
                  ? ticked(member.key) + " is not a key here; write " + ticked(elsewhere.second)
                  : no_key_text(member.key, known));
    }
  }

  bool within(const Key& key, const Node& node, double value, const Range& range,
              const Unit* unit) {
    if (range.holds(value)) return true;
    problem(node.place,
            ticked(key.name) + " must be " + range_text(range, unit) + ", got " +
                ticked(node.shown()) +
                (range.low == range.high ? "; write that" : std::string("; ") + range.remedy));
    return false;
  }

  bool read_number(const Key& key, const Node& node, double& value, const Range& range) {
    if (!node.is_number()) {
      const std::string text = node.kind == Node::Kind::text ? node.text : "";
      const auto given = leading_number(text);
      if (given && given->rest.empty() && (given->out_of_range || !std::isfinite(given->value)))
        return not_finite(key, node);
      auto inside = whole_number(text);
      if (given && given->rest.starts_with(',')) {  // a decimal comma
        std::string point = text;
        std::ranges::replace(point, ',', '.');
        inside = whole_number(point);
      }
      if (given && trimmed(given->rest) == "%") inside = given->value / 100.0;
      wrong_type(key, node, "a pure number", inside ? number_text(*inside) : "0.5");
      return false;
    }
    if (!std::isfinite(node.number)) return not_finite(key, node);
    if (!within(key, node, node.number, range, nullptr)) return false;
    value = node.number;
    return true;
  }

  bool not_finite(const Key& key, const Node& node) {
    problem(node.place, ticked(key.name) + " wants a finite number, got " + ticked(node.shown()) +
                            "; write one as `0.5`");
    return false;
  }

  // "2` or `3" for 2.5: whole numbers in the range beside the one given.
  static std::string whole_near(const Node& node, const Range& range) {
    const bool usable = node.is_number() && std::isfinite(node.number);
    const double below = usable ? std::floor(node.number) : 1.0;
    const double above = usable ? std::ceil(node.number) : 1.0;
    if (!range.holds(below) && !range.holds(above))
      return number_text(range.holds(1.0) ? 1.0 : range.low);
    if (!range.holds(below) || below == above) return number_text(above);
    return number_text(below) + (range.holds(above) ? "` or `" + number_text(above) : "");
  }

  bool read_count(const Key& key, const Node& node, int& value, const Range& range) {
    if (node.kind != Node::Kind::integer) {
      wrong_type(key, node, "a whole number", whole_near(node, range));
      return false;
    }
    if (!within(key, node, node.number, range, nullptr)) return false;
    if (std::abs(node.number) > 1e9) {
      problem(node.place, ticked(key.name) + " must be below 1e9, got " + ticked(node.shown()) +
                              "; give a smaller number");
      return false;
    }
    value = static_cast<int>(node.number);
    return true;
  }

  bool read_quantity(const Key& key, const Node& node, double& si, const Unit& unit,
                     const Range& range) {
    if (node.kind != Node::Kind::text) {
      const bool usable = node.is_number() && std::isfinite(node.number);
      const std::string digits = usable ? number_text(node.number) : "1";
      wrong_type(key, node, std::string("a ") + unit.quantity + " with its unit, as text",
                 "\"" + digits + " " +
                     std::string(plausible_unit(usable ? node.number : 1.0, unit.symbol)) + "\"");
      return false;
    }
    try {
      const double value = parse_quantity(node.text, unit);
      if (!within(key, node, value, range, &unit)) return false;
      si = value;
      return true;
    } catch (const std::invalid_argument& error) {
      problem(node.place, ticked(key.name) + " " + error.what());
      return false;
    }
  }

  // Reads a list of a fixed length, or some of its entries by their numbers, as in `size.3`; the
  // others keep their default.
  void read_list(const Key& key, std::size_t size,
                 const std::function<void(const Node&, std::size_t)>& read) {
    const Node* node = find(key);
    if (node == nullptr) return;
    in_list_ = true;
    if (node->kind == Node::Kind::table && !node->members.empty()) {
      for (const Member& member : node->members) {
        const auto number = whole_number(member.key);
        const auto i = number && *number >= 1 && *number <= static_cast<double>(size)
                           ? static_cast<std::size_t>(*number) - 1
                           : size;
        if (i < size && number == static_cast<double>(i + 1))
          read(member.value, i);
        else
          problem(member.place, ticked(key.name) + " has no entry " + ticked(member.key) +
                                    "; count its entries from 1 to " + std::to_string(size));
      }
    } else if (is_list(key, *node, size)) {
      for (std::size_t i = 0; i < size; ++i) read(node->items[i], i);
    }
    in_list_ = false;
  }

  bool is_list(const Key& key, const Node& node, std::size_t size) {
    if (node.kind == Node::Kind::array && node.items.size() == size) return true;
    const std::string got = node.kind == Node::Kind::array
                                ? "a list of " + std::to_string(node.items.size())
                                : node.kind_name();
    problem(node.place, ticked(key.name) + " wants a list of " + std::to_string(size) + ", got " +
                            got + "; write it as `[" +
                            joined(std::vector<std::string>(size, "..."), ", ") + "]`");
    return false;
  }

  std::optional<int> read_word(const std::string& name, const Node& node,
                               std::span<const Word> words) {
    std::vector<std::string> known;
    for (const Word& word : words) known.emplace_back(word.word);
    const auto at = std::ranges::find(known, node.text);
    if (node.kind == Node::Kind::text && at != known.end())
      return static_cast<int>(at - known.begin());
    choices_read_ = false;
    for (const auto& [old, now] : renamed)
      if (node.text == old && std::ranges::find(known, now) != known.end()) {
        problem(node.place, ticked(name) + " calls " + ticked(old) + " " + ticked(now) +
                                " now; write `" + name + " = \"" + now + "\"`");
        return std::nullopt;
      }
    problem(node.place, no_word_text(name, node, known));
    return std::nullopt;
  }

  Reading* reading_;
  bool trust_uses_;
  bool choices_read_ = true;
  bool in_list_ = false;
  std::vector<Open> open_;
};

}  // namespace

Reading read_fields(const Node& root, const Fields& fields) {
  Reading discarded;
  Reader first(root, &discarded, false);
  fields(first);
  Reading reading;
  Reader second(root, &reading, first.choices_read());
  fields(second);
  second.finish();
  sort_by_place(reading.problems);
  return reading;
}

}  // namespace palpate
