// Writes the echo: first the top-level keys, then each table; tables inside tables are inline.
#include "base/field_writer.h"

#include <vector>

#include "base/document_writer.h"
#include "base/text.h"

namespace palpate {
namespace {

class Writer final : public FieldVisitor {
 public:
  explicit Writer(Written written) : all_(written == Written::all) {}

  [[nodiscard]] std::string result() const { return top_ + tables_; }

  void real(const Key& key, std::optional<double>& value, const Real& kind) override {
    if (value)
      put(key, kind.unit != nullptr ? toml_text(quantity_text(*value, *kind.unit))
                                    : number_text(*value));
    else if (kind.open != nullptr)
      put(key, toml_text(kind.open));
  }
  void whole(const Key& key, std::optional<int>& value, const Whole& kind) override {
    put(key, value ? std::to_string(*value) : toml_text(kind.open));
  }
  void either(const Key& key, Target& target, const Unit& first, const Unit& second,
              const Range&) override {
    put(key, toml_text(quantity_text(target.value, target.second ? second : first)));
  }
  void text(const Key& key, std::string& value) override { put(key, toml_text(value)); }
  void flag(const Key& key, bool& value) override { put(key, value ? "true" : "false"); }
  void quantities(const Key& key, std::span<double> si, const Unit& unit, const Range&) override {
    std::vector<std::string> items;
    for (const double value : si) items.push_back(toml_text(quantity_text(value, unit)));
    put(key, "[" + joined(items, ", ") + "]");
  }
  void counts(const Key& key, std::span<int> values, const Range&) override {
    std::vector<std::string> items;
    for (const int value : values) items.push_back(std::to_string(value));
    put(key, "[" + joined(items, ", ") + "]");
  }
  void quantity_list(const Key& key, std::vector<double>& si, const Unit& unit,
                     const Range& range) override {
    if (!si.empty()) quantities(key, si, unit, range);
  }
  void numbers_by_name(const Key& key, std::map<std::string, double>& values,
                       const Range&) override {
    std::vector<std::string> items;
    for (const auto& [name, value] : values)
      items.push_back(toml_key(name) + " = " + number_text(value));
    if (!items.empty()) put(key, "{ " + joined(items, ", ") + " }");
  }
  void choice_of(const Key& key, int& index, std::span<const Word> words) override {
    put(key, toml_text(words[as_index(index)].word));
  }
  void table(const Key& key, const Fields& fields) override {
    if (!all_ && !key.use.used) return;
    std::vector<std::string> before;
    before.swap(entries_);
    ++depth_;
    fields(*this);
    --depth_;
    before.swap(entries_);
    if (depth_ == 0)
      tables_ += "\n[" + std::string(key.name) + "]\n" + lines(before);
    else
      put(key, "{ " + joined(before, ", ") + " }");
  }
  void tables(const Key& key, int size, const std::function<void(int)>&,
              const std::function<void(FieldVisitor&, int)>& fields) override {
    if (depth_ > 0) {
      if (size > 0) put(key, inline_tables(size, fields));
      return;
    }
    for (int i = 0; i < size; ++i) {
      ++depth_;
      fields(*this, i);
      --depth_;
      tables_ += "\n[[" + std::string(key.name) + "]]\n" + lines(entries_);
      entries_.clear();
    }
  }
  void kind(int chosen, std::span<const Word> words,
            const std::function<Fields(int)>& choose) override {
    put({"kind", ""}, toml_text(words[as_index(chosen)].word));
    choose(chosen)(*this);
  }

 private:
  // A list of tables inside a table, on one line.
  std::string inline_tables(int size, const std::function<void(FieldVisitor&, int)>& fields) {
    std::vector<std::string> items;
    for (int i = 0; i < size; ++i) {
      std::vector<std::string> before;
      before.swap(entries_);
      ++depth_;
      fields(*this, i);
      --depth_;
      before.swap(entries_);
      items.push_back("{ " + joined(before, ", ") + " }");
    }
    return "[" + joined(items, ", ") + "]";
  }

  void put(const Key& key, const std::string& value) {
    if (!all_ && !key.use.used) return;
    const std::string entry = std::string(key.name) + " = " + value;
    if (depth_ == 0)
      top_ += entry + "\n";
    else
      entries_.push_back(entry);
  }

  static std::string lines(const std::vector<std::string>& entries) {
    std::string text;
    for (const std::string& entry : entries) text += entry + "\n";
    return text;
  }

  bool all_;
  int depth_ = 0;
  std::string top_;
  std::string tables_;
  std::vector<std::string> entries_;
};

}  // namespace

std::string fields_as_toml(const Fields& fields, Written written) {
  Writer writer(written);
  fields(writer);
  return writer.result();
}

}  // namespace palpate
