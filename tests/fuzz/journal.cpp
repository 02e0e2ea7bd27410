// Any bytes as a file of rows: every line is a row, corrupt or torn.
#include <algorithm>

#include "fuzzing.h"
#include "record/journal.h"

void palpate::fuzz::journal(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = text_of(data, size);
  const auto lines = static_cast<std::size_t>(std::count(bytes.begin(), bytes.end(), '\n'));
  std::size_t seen = 0;
  const auto read = record::read_journal(file("part.rows", bytes), "a plan",
                                         [&](const record::Table& row, const FileLine& line) {
                                           ++seen;
                                           require(row.rows.size() == 1 && line.whole);
                                           return true;
                                         });
  require(read.rows == seen && read.rows + read.corrupt <= lines);
  require(read.rows == 0 || read.whose == record::JournalFile::Whose::ours);
  for (const std::string& warning : read.warnings()) require(!warning.empty());
}
