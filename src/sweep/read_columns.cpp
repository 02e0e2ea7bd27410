// Reads the columns of a merged sweep in parts, so that a million cases need no table in memory.
#include <algorithm>
#include <optional>

#include "base/files.h"
#include "base/index.h"
#include "record/csv.h"
#include "sweep/columns.h"
#include "sweep/labels.h"

namespace palpate::sweep {
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
                       .column = header.at(before_keys + as_index(key)),
                       .scale = first.interval ? first.interval->scale : Scale::linear,
                       .levels = factor.levels()});
  }
  return choices;
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
  bool quoted = false;  // inside a quoted field, which may contain line ends
  for_each_line(path, [&](const FileLine& line) {
    std::string& into = header.empty() || (quoted && rows.empty()) ? header : rows;
    into += std::string(line.text) + "\n";
    if (std::count(line.text.begin(), line.text.end(), '"') % 2 != 0) quoted = !quoted;
    if (!quoted && rows.size() > part) parse();
  });
  parse();
  SweepColumns columns = reader->finish();
  for (std::size_t f = 0; f < columns.factors.size(); ++f)
    if (FactorColumn& factor = columns.factors[f]; factor.is_number() &&
                                                   !design.factors()[f].keys.front().interval &&
                                                   spread_wide(factor.values))
      factor.choice.scale = Scale::logarithmic;
  return columns;
}

}  // namespace palpate::sweep
