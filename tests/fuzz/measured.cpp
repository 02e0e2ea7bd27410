// Any bytes as a measured file. The bits of the first byte say with which options.
#include "measured/measured.h"
#include "fuzzing.h"
#include "measured/table.h"

void palpate::fuzz::measured(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return;
  const auto has = [&](int bit) { return (data[0] >> bit & 1) != 0; };
  const std::string_view bytes = text_of(data + 1, size - 1);
  measured::DataLayout layout;
  if (has(0)) layout.x = "1";
  if (has(0)) layout.y = "2";
  if (has(1)) layout.x_unit = "mm";
  if (has(1)) layout.y_unit = "N";
  if (has(2)) layout.compression = "auto";
  if (has(3)) layout.blanks = measured::DataLayout::Blanks::keep;
  if (has(4)) layout.segment = "approach";
  if (has(5)) layout.rows = "2..5";
  if (has(6)) layout.table = 1;
  if (has(7)) layout.skip = 1;
  reads([&] {
    const measured::RawTable table = measured::raw_table(bytes, "fuzz.csv", layout);
    require(!table.rows.empty());
    for (const auto& row : table.rows) require(row.fields.size() == table.width());
  });
  reads([&] {
    const auto curve = measured::parse_measured(bytes, "fuzz.csv", layout);
    const std::size_t points = curve.x.size();
    require(points > 0 && curve.y.size() == points && curve.lines.size() == points);
    require(curve.x_written.size() == points && curve.y_written.size() == points);
  });
}
