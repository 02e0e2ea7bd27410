// Columns of a merged sweep, part by part, so that a million cases need no table in memory.
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/files.h"
#include "record/csv.h"
#include "study/sweep_columns.h"

namespace palpate::study {
namespace {

constexpr std::size_t before_keys = 2;  // number, id
constexpr std::size_t part = 1u << 18;  // bytes

std::vector<FactorChoice> factor_choices(const scenario::Design& design,
                                         const std::vector<std::string>& header) {
  std::vector<FactorChoice> choices;
  for (const scenario::Factor& factor : design.factors()) {
    const scenario::Varied& first = factor.keys.front();
    const auto& keys = design.keys();
    const auto key = std::find(keys.begin(), keys.end(), first.key) - keys.begin();
    choices.push_back({.name = factor.name,
                       .column = header.at(before_keys + static_cast<std::size_t>(key)),
                       .scale = first.interval ? first.interval->scale : Scale::linear,
                       .levels = factor.levels()});
  }
  return choices;
}

bool spread_wide(const FactorColumn& factor) {
  if (!factor.is_number()) return false;
  const auto [least, most] = std::minmax_element(factor.values.begin(), factor.values.end());
  return least != factor.values.end() && *least > 0.0 && *most > 30.0 * *least;
}

}  // namespace

SweepColumns read_sweep_columns(const std::string& path, const scenario::Design& design,
                                const std::vector<std::string>& show) {
  std::optional<ColumnReader> reader;
  std::string header;
  std::string rows;
  const auto parse = [&] {
    const record::Table table = record::parse_csv(header + rows, path);
    if (!reader)
      reader.emplace(ColumnChoice{design.kind(), factor_choices(design, table.columns), show},
                     table.columns);
    for (const auto& row : table.rows) reader->add(row);
    rows.clear();
  };
  bool quoted = false;  // a line may end inside a field
  for_each_line(path, [&](const FileLine& line) {
    std::string& into = header.empty() || (quoted && rows.empty()) ? header : rows;
    into += std::string(line.text) + "\n";
    if (std::count(line.text.begin(), line.text.end(), '"') % 2 != 0) quoted = !quoted;
    if (!quoted && rows.size() > part) parse();
  });
  parse();
  SweepColumns columns = reader->finish();
  for (std::size_t f = 0; f < columns.factors.size(); ++f)
    if (!design.factors()[f].keys.front().interval && spread_wide(columns.factors[f]))
      columns.factors[f].choice.scale = Scale::logarithmic;
  return columns;
}

}  // namespace palpate::study
