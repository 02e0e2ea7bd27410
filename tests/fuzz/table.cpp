// Any text as a table in CSV, such as plan.csv: what is read is written as a text that reads the
// same.
#include "fuzzing.h"
#include "record/csv.h"

void palpate::fuzz::table(const std::uint8_t* data, std::size_t size) {
  record::Table table;
  if (!reads([&] { table = record::parse_csv(text_of(data, size), "t.csv"); })) return;
  for (const auto& row : table.rows) require(row.size() == table.columns.size());
  const std::string text = record::csv_text(table);
  require(record::csv_text(record::parse_csv(text, "t.csv")) == text);
}
