// Files of rows that survive a crash: every row is one line with a checksum and its column names.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/files.h"
#include "base/index.h"
#include "record/table.h"

namespace palpate::record {

// A table of one row as a line with its line feed. It begins with a seal: 16 digits of a hash of
// the row, of `identity` and of the version of this format, so that rows of another plan or chart,
// or of another version, are recognised.
[[nodiscard]] std::string sealed_line(const Table& row, std::string_view identity);
// The row of such a line, given without its line feed; nothing if the seal does not match
// or the content is not one row.
[[nodiscard]] std::optional<Table> read_line(std::string_view line, std::string_view identity);

// The value in a column of a one-row table; null if the column is missing or has another type.
template <class Value>
[[nodiscard]] const Value* value_in(const Table& row, std::string_view column) {
  const int at = row.find(column);
  return at < 0 ? nullptr : std::get_if<Value>(&row.rows.front()[as_index(at)]);
}

// The outcome of reading a file of rows.
struct JournalFile {
  enum class Whose {
    ours,
    another,  // the first line has another identity, and no row has a matching seal
    unknown   // the first line is not a header of this format, and no row has a matching seal
  };
  std::string path;
  std::size_t rows = 0;     // valid ones
  std::size_t corrupt = 0;  // complete lines without a valid row
  bool torn = false;        // the last line is incomplete
  Whose whose = Whose::unknown;

  // Sentences about lines that cannot be used.
  [[nodiscard]] std::vector<std::string> warnings() const;
};

// Called with every row and its line. Returns false if the row is not valid; it counts as corrupt.
using RowSeen = std::function<bool(const Table& row, const FileLine& line)>;

// Reads a file line by line and calls `see`. Throws InputError if the file cannot be read.
[[nodiscard]] JournalFile read_journal(const std::string& path, std::string_view identity,
                                       const RowSeen& see);

// The paths of the files of rows in a folder, sorted by name; none if the folder does not exist.
// Throws SystemError if it cannot be read.
[[nodiscard]] std::vector<std::string> journal_files(const std::string& folder);

// A new file FOLDER/PART_HOST_PID_COUNT.rows; every process appends to a file that only it writes.
// The first line contains the identity; rows can be read without it.
class Journal {
 public:
  // Creates the folder if necessary. Throws SystemError if folder or file cannot be created.
  Journal(const std::string& folder, const std::string& part, std::string identity);

  // Passes the row to the operating system before it returns, so that the row survives a kill of
  // the process. Throws SystemError on a full disk; earlier rows stay valid. One call at a time.
  void add(const Table& row);
  // Returns when all rows are on the disk and survive a power failure.
  void sync() { file_.sync(); }

  [[nodiscard]] const std::string& path() const { return file_.path(); }

 private:
  std::string identity_;
  GrowingFile file_;
};

}  // namespace palpate::record
