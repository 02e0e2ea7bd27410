// Any text as a table in CSV, such as plan.csv: what is read is written as a text that reads the
// same.
#include "fuzzing.h"
#include "record/csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  record::Table table;
  if (!fuzz::reads([&] { table = record::parse_csv(fuzz::text_of(data, size), "t.csv"); }))
    return 0;
  for (const auto& row : table.rows) fuzz::require(row.size() == table.columns.size());
  const std::string text = record::csv_text(table);
  fuzz::require(record::csv_text(record::parse_csv(text, "t.csv")) == text);
  return 0;
}
