// A visitor that lists all numbers of a scenario, or sets one of them.
#include "scenario/numeric_keys.h"

#include <functional>

namespace palpate::scenario {
namespace {

class Numbers final : public FieldVisitor {
 public:
  // Called with each key and a function that sets its value.
  using Each = std::function<void(NumericKey&&, const std::function<void(double)>&)>;
  explicit Numbers(Each each) : each_(std::move(each)) {}

  void real(const Key& key, std::optional<double>& value, const Real& kind) override {
    put(key, key.name, kind, [&](double si) { value = si; });
  }
  void either(const Key& key, Target& target, const Unit& first, const Unit& second,
              const Range& range) override {
    put(key, key.name, {target.second ? &second : &first, range},
        [&](double si) { target.value = si; });
  }
  void quantities(const Key& key, std::span<double> si, const Unit& unit,
                  const Range& range) override {
    for (std::size_t i = 0; i < si.size(); ++i)
      put(key, std::string(key.name) + "." + std::to_string(i + 1), {&unit, range},
          [&](double given) { si[i] = given; });
  }
  void whole(const Key&, std::optional<int>&, const Whole&) override {}
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
  void put(const Key& key, const std::string& name, const Real& kind,
           const std::function<void(double)>& set) {
    const std::optional<Unit> unit =
        kind.unit != nullptr ? std::optional(*kind.unit) : std::nullopt;
    each_({prefix_ + name, unit, kind.range, outer_.used ? key.use : outer_}, set);
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
