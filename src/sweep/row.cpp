// Rows as tables: id, attempt, outcome, reason, name, and values, warnings and curve as CSV texts.
#include "sweep/row.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "fit/case_fits.h"
#include "record/csv.h"

namespace palpate::sweep {
namespace {

constexpr std::size_t digits = 16;  // of ids

}  // namespace

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

record::Table journal_row(const SweepRow& row) {
  record::Table values{{"name", "value"}, {}};
  for (const record::Finding& value : row.values) values.rows.push_back({value.name, value.value});
  record::Table neglected{{"what", "change", "when", "remedy", "beside"}, {}};
  for (const record::Neglected& one : row.neglected)
    neglected.rows.push_back(
        {one.what, record::known(one.change), one.when, one.remedy, one.beside});
  const std::string curve = row.curve.columns.empty() ? "" : record::csv_text(row.curve);
  return {{"id", "attempt", "outcome", "reason", "name", "values", "neglected", "curve"},
          {{id_text(row.id), static_cast<double>(row.attempt), outcome_word(row.outcome),
            row.reason, row.name, record::csv_text(values), record::csv_text(neglected), curve}}};
}

std::optional<SweepHead> head_of(const record::Table& row) {
  for (const char* column : {"id", "outcome", "reason", "name", "values", "neglected", "curve"})
    if (record::value_in<std::string>(row, column) == nullptr) return std::nullopt;
  const auto id = id_of(*record::value_in<std::string>(row, "id"));
  const auto* attempt = record::value_in<double>(row, "attempt");
  constexpr double most = std::numeric_limits<std::uint32_t>::max();
  if (!id || attempt == nullptr || !(*attempt >= 1.0 && *attempt <= most)) return std::nullopt;
  for (const SweepOutcome one :
       {SweepOutcome::completed, SweepOutcome::diverged, SweepOutcome::failed})
    if (*record::value_in<std::string>(row, "outcome") == outcome_word(one))
      return SweepHead{.id = *id, .attempt = static_cast<std::uint32_t>(*attempt), .outcome = one};
  return std::nullopt;
}

std::optional<SweepRow> row_of(const record::Table& row) {
  const auto head = head_of(row);
  if (!head) return std::nullopt;
  const auto word = [&](const char* name) { return *record::value_in<std::string>(row, name); };
  SweepRow read{.id = head->id,
                .attempt = head->attempt,
                .outcome = head->outcome,
                .reason = word("reason"),
                .name = word("name")};
  try {
    for (auto& value : record::parse_csv(word("values"), "values").rows) {
      const auto* name = std::get_if<std::string>(value.data());
      if (name == nullptr || value.size() != 2) return std::nullopt;
      read.values.push_back({*name, std::move(value[1])});
    }
    for (const auto& cells : record::parse_csv(word("neglected"), "neglected").rows) {
      if (cells.size() != 5) return std::nullopt;
      record::Neglected& one = read.neglected.emplace_back();
      if (const auto* change = std::get_if<double>(&cells[1])) one.change = *change;
      for (const auto& [k, text] : {std::pair(0, &one.what), std::pair(2, &one.when),
                                    std::pair(3, &one.remedy), std::pair(4, &one.beside)})
        if (const auto* given = std::get_if<std::string>(&cells[as_index(k)])) *text = *given;
      if (one.what.empty()) return std::nullopt;
    }
    if (!word("curve").empty()) read.curve = record::parse_csv(word("curve"), "curve");
  } catch (const InputError&) {
    return std::nullopt;
  }
  return read;
}

namespace {

// Replaces the spaces in a curve's name, as in `force_indentation x 0.1`.
std::string column_word(std::string text) {
  std::ranges::replace(text, ' ', '_');
  return text;
}

void add_fits(const std::vector<fit::NamedFit>& fits, SweepRow& row) {
  for (const fit::NamedFit& named : fits) {
    const std::string curve =
        column_word(named.curve) + "_" + std::string(fit::info(named.fit.model).name);
    for (const fit::Estimate& parameter : named.fit.parameters) {
      const std::string unit =
          parameter.unit.empty() ? "" : "_" + record::unit_word(parameter.unit);
      const std::string name = curve + "_" + parameter.name;
      row.values.push_back({name + unit, record::known(parameter.estimate)});
      row.values.push_back({name + "_std_error" + unit, record::known(parameter.std_error)});
    }
    row.values.push_back({curve + "_r2", record::known(named.fit.r2)});
  }
}

// The curve without the column `case`, because the row contains the name.
record::Table curve_of(const record::CaseRecord& record) {
  record::Table table =
      record.strain.empty() ? record::contact_table({record}) : record::strain_table({record});
  table.columns.erase(table.columns.begin());
  for (auto& row : table.rows) row.erase(row.begin());
  return table;
}

}  // namespace

SweepRow row_of(const scene::Scene& scene, const record::CaseRecord& record, bool keeps_curve) {
  SweepRow row{.reason = record.reason, .name = record.name, .neglected = record.answer.effects};
  if (record.outcome == record::Outcome::diverged) row.outcome = SweepOutcome::diverged;
  for (const record::Finding& finding : record.findings)
    if (finding.name != "outcome") row.values.push_back(finding);
  if (scene.scenario.output.fits) add_fits(fit::case_fits(scene.scenario, record), row);
  if (keeps_curve) row.curve = curve_of(record);
  return row;
}

}  // namespace palpate::sweep
