// Fields by tabs: seal, id, attempt, outcome, reason, name, then lists, each after its length.
#include "study/sweep_row.h"

#include <charconv>

#include "base/files.h"
#include "base/text.h"

namespace palpate::study {
namespace {

constexpr std::size_t digits = 16;  // of ids and seals

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\\\";
    else if (c == '\t')
      out += "\\t";
    else if (c == '\n')
      out += "\\n";
    else
      out += c;
  }
  return out;
}

std::string plain(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      out += text[i];
      continue;
    }
    const char next = text[++i];
    out += next == 't' ? '\t' : next == 'n' ? '\n' : next;
  }
  return out;
}

// Words begin with a quote, so that `nan` the word is not nan the number.
std::string cell_text(const record::Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return number_text(*number);
  if (const auto* word = std::get_if<std::string>(&cell)) return "\"" + escaped(*word);
  return {};
}

record::Cell cell_of(std::string_view text) {
  if (text.empty()) return std::monostate{};
  if (text.front() == '"') return plain(text.substr(1));
  return whole_number(text).value_or(0.0);
}

std::string seal_of(std::string_view content, std::string_view plan) {
  Sha256 hash;
  hash.add(plan);
  hash.add("\n");
  hash.add(content);
  return hash.digits().substr(0, digits);
}

// What stands after the seal, where the seal fits.
std::optional<std::string_view> content_of(std::string_view line, std::string_view plan) {
  if (line.size() < digits + 1 || line[digits] != '\t') return std::nullopt;
  const std::string_view content = line.substr(digits + 1);
  if (line.substr(0, digits) != seal_of(content, plan)) return std::nullopt;
  return content;
}

// Takes fields off the front of a line; what is sealed has them all.
class Fields {
 public:
  explicit Fields(std::string_view text) : left_(text) {}

  std::string_view next() {
    const std::size_t end = std::min(left_.find('\t'), left_.size());
    const std::string_view field = left_.substr(0, end);
    left_.remove_prefix(std::min(end + 1, left_.size()));
    return field;
  }
  std::size_t count() {
    const std::string_view field = next();
    std::size_t value = 0;
    std::from_chars(field.data(), field.data() + field.size(), value);
    return std::min(value, left_.size() + 1);
  }

 private:
  std::string_view left_;
};

SweepHead head_of(Fields& fields) {
  SweepHead head;
  head.id = id_of(fields.next()).value_or(0);
  head.attempt = static_cast<std::uint32_t>(fields.count());
  const std::string_view outcome = fields.next();
  for (const SweepOutcome one :
       {SweepOutcome::completed, SweepOutcome::diverged, SweepOutcome::failed})
    if (outcome == outcome_word(one)) head.outcome = one;
  return head;
}

}  // namespace

const char* outcome_word(SweepOutcome outcome) {
  switch (outcome) {
    case SweepOutcome::completed: return "completed";
    case SweepOutcome::diverged: return "diverged";
    case SweepOutcome::failed: return "failed";
  }
  return "";
}

std::string id_text(std::uint64_t id) {
  constexpr std::string_view hex = "0123456789abcdef";
  std::string text(digits, '0');
  for (std::size_t i = digits; i-- > 0; id >>= 4) text[i] = hex[id & 15];
  return text;
}

std::optional<std::uint64_t> id_of(std::string_view text) {
  std::uint64_t id = 0;
  if (text.size() != digits) return std::nullopt;
  const auto [end, error] = std::from_chars(text.data(), text.data() + digits, id, 16);
  if (error != std::errc() || end != text.data() + digits) return std::nullopt;
  return id;
}

std::string row_line(const SweepRow& row, std::string_view plan) {
  std::string text = id_text(row.id) + "\t" + std::to_string(row.attempt) + "\t" +
                     outcome_word(row.outcome) + "\t" + escaped(row.reason) + "\t" +
                     escaped(row.name);
  const auto add = [&](const std::string& field) { text.append("\t").append(field); };
  add(std::to_string(row.values.size()));
  for (const record::Finding& value : row.values) {
    add(escaped(value.name));
    add(cell_text(value.value));
  }
  add(std::to_string(row.remarks.size()));
  for (const std::string& remark : row.remarks) add(escaped(remark));
  add(std::to_string(row.curve.columns.size()));
  for (const std::string& column : row.curve.columns) add(escaped(column));
  add(std::to_string(row.curve.rows.size()));
  for (const auto& cells : row.curve.rows)
    for (const record::Cell& cell : cells) add(cell_text(cell));
  return seal_of(text, plan) + "\t" + text + "\n";
}

std::optional<SweepHead> read_head(std::string_view line, std::string_view plan) {
  const auto content = content_of(line, plan);
  if (!content) return std::nullopt;
  Fields fields(*content);
  SweepHead head = head_of(fields);
  head.seal = id_of(line.substr(0, digits)).value_or(0);
  return head;
}

std::optional<SweepRow> read_row(std::string_view line, std::string_view plan) {
  const auto content = content_of(line, plan);
  if (!content) return std::nullopt;
  Fields fields(*content);
  const SweepHead head = head_of(fields);
  SweepRow row{.id = head.id, .attempt = head.attempt, .outcome = head.outcome};
  row.reason = plain(fields.next());
  row.name = plain(fields.next());
  row.values.resize(fields.count());
  for (record::Finding& value : row.values) {
    value.name = plain(fields.next());
    value.value = cell_of(fields.next());
  }
  row.remarks.resize(fields.count());
  for (std::string& remark : row.remarks) remark = plain(fields.next());
  row.curve.columns.resize(fields.count());
  for (std::string& column : row.curve.columns) column = plain(fields.next());
  row.curve.rows.resize(fields.count());
  for (auto& cells : row.curve.rows) {
    cells.resize(row.curve.columns.size());
    for (record::Cell& cell : cells) cell = cell_of(fields.next());
  }
  return row;
}

}  // namespace palpate::study
