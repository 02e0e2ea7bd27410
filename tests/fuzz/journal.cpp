// Any bytes as a file of rows: every line is a row, corrupt or torn.
#include <algorithm>

#include "fuzzing.h"
#include "record/journal.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  const std::string_view bytes = fuzz::text_of(data, size);
  const auto lines = static_cast<std::size_t>(std::count(bytes.begin(), bytes.end(), '\n'));
  std::size_t seen = 0;
  const auto file = record::read_journal(fuzz::file("part.rows", bytes), "a plan",
                                         [&](const record::Table& row, const FileLine& line) {
                                           ++seen;
                                           fuzz::require(row.rows.size() == 1 && line.whole);
                                           return true;
                                         });
  fuzz::require(file.rows == seen && file.rows + file.corrupt <= lines);
  fuzz::require(file.rows == 0 || file.whose == record::JournalFile::Whose::ours);
  for (const std::string& warning : file.warnings()) fuzz::require(!warning.empty());
  return 0;
}
