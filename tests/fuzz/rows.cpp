// Any table in CSV as the row of a sweep's journal whose seal is good: it is a row or none.
#include "fuzzing.h"
#include "record/csv.h"
#include "record/journal.h"
#include "sweep/row.h"

void palpate::fuzz::rows(const std::uint8_t* data, std::size_t size) {
  record::Table table;
  if (!reads([&] { table = record::parse_csv(text_of(data, size), "t.csv"); }) ||
      table.rows.size() != 1)
    return;
  std::string line = record::sealed_line(table, "a plan");
  line.pop_back();
  const auto read = record::read_line(line, "a plan");
  require(read.has_value() && !record::read_line(line, "another plan"));
  const auto row = sweep::row_of(*read);
  if (!row) return;
  require(sweep::head_of(*read)->id == row->id && row->attempt > 0);
  const auto again = sweep::row_of(sweep::journal_row(*row));
  require(again && again->values.size() == row->values.size());
}
