// A visitor that lists the numbers, and one of them set.
#include "scenario/numeric_keys.h"

#include <functional>

namespace palpate::scenario {
namespace {

class Numbers final : public FieldVisitor {
 public:
  // `each` is given the key and what sets it.
  using Each = std::function<void(NumericKey&&, const std::function<void(double)>&)>;
  explicit Numbers(Each each) : each_(std::move(each)) {}

  void number(const Key& key, double& value, const Range& range) override {
    put(key, key.name, {value, std::nullopt, range}, [&](double si) { value = si; });
  }
  void number(const Key& key, std::optional<double>& value, const Range& range) override {
    put(key, key.name, {value, std::nullopt, range}, [&](double si) { value = si; });
  }
  void quantity(const Key& key, double& si, const Unit& unit, const Range& range) override {
    put(key, key.name, {si, unit, range}, [&](double given) { si = given; });
  }
  void quantity(const Key& key, std::optional<double>& si, const Unit& unit,
                const Range& range) override {
    put(key, key.name, {si, unit, range}, [&](double given) { si = given; });
  }
  void quantity_or(const char*, const Key& key, std::optional<double>& si, const Unit& unit,
                   const Range& range) override {
    quantity(key, si, unit, range);
  }
  void either(const Key& key, Target& target, const Unit& first, const Unit& second,
              const Range& range) override {
    quantity(key, target.value, target.second ? second : first, range);
  }
  void quantities(const Key& key, std::span<double> si, const Unit& unit,
                  const Range& range) override {
    for (std::size_t i = 0; i < si.size(); ++i)
      put(key, std::string(key.name) + "." + std::to_string(i + 1), {si[i], unit, range},
          [&](double given) { si[i] = given; });
  }
  void count_or(const char*, const Key&, std::optional<int>&, const Range&) override {}
  void count(const Key&, int&, const Range&) override {}
  void text(const Key&, std::string&) override {}
  void flag(const Key&, bool&) override {}
  void counts(const Key&, std::span<int>, const Range&) override {}
  void quantity_list(const Key&, std::vector<double>&, const Unit&, const Range&) override {}
  void numbers_by_name(const Key&, std::map<std::string, double>&, const Range&) override {}
  void choice_of(const Key&, int&, std::span<const Word>) override {}
  void table(const Key& key, const Fields& fields) override {
    inside(key.name, key.use, [&] { fields(*this); });
  }
  void tables(const Key& key, int size, const std::function<void(int)>&,
              const std::function<void(FieldVisitor&, int)>& fields) override {
    for (int i = 0; i < size; ++i)
      inside(std::string(key.name) + "." + std::to_string(i + 1), key.use,
             [&] { fields(*this, i); });
  }
  void kind(int chosen, std::span<const Word>, const std::function<Fields(int)>& choose) override {
    choose(chosen)(*this);
  }

 private:
  struct Value {
    std::optional<double> value;
    std::optional<Unit> unit;
    Range range;
  };

  void put(const Key& key, const std::string& name, const Value& value,
           const std::function<void(double)>& set) {
    const Use& use = outer_.used ? key.use : outer_;
    each_({prefix_ + name, value.value, value.unit, value.range, use}, set);
  }

  void inside(const std::string& name, const Use& use, const std::function<void()>& visit) {
    const std::string prefix = prefix_;
    const Use outer = outer_;
    prefix_ += name + ".";
    if (outer_.used) outer_ = use;
    visit();
    prefix_ = prefix;
    outer_ = outer;
  }

  Each each_;
  std::string prefix_;
  Use outer_;
};

}  // namespace

std::vector<NumericKey> numeric_keys(const Scenario& scenario) {
  std::vector<NumericKey> keys;
  Scenario copy = scenario;
  Numbers visitor([&](NumericKey&& key, const auto&) { keys.push_back(std::move(key)); });
  fields(visitor, copy);
  return keys;
}

bool set_number(Scenario& scenario, std::string_view path, double si) {
  bool found = false;
  Numbers visitor([&](NumericKey&& key, const auto& set) {
    if (key.path != path) return;
    set(si);
    found = true;
  });
  fields(visitor, scenario);
  return found;
}

}  // namespace palpate::scenario
