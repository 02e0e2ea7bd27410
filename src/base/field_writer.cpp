// Makes a document of the values of fields, and texts of their ranges.
#include "base/field_writer.h"

#include <cmath>
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

}  // namespace palpate
