// A chart's measurements on the disk, each appended as soon as it is made.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "base/whole_folder.h"
#include "chart/chart.h"
#include "record/journal.h"

namespace palpate::chart {

// A folder of files with one row per timing and per reference; every call writes a new file.
class Journal {
 public:
  // Reads the rows in the folder, or removes them with Replace::any. A chart continues only with
  // the same text `identity`. Throws InputError if the folder contains rows of another chart or
  // version, and SystemError if it cannot be made.
  Journal(const std::string& folder, const std::string& identity, Replace replace);

  // The measurement of a variant with all its timings; nothing if there is none.
  [[nodiscard]] std::optional<Measurement> find(const Variant& variant) const;
  // Appends the measurement with its last timing.
  void add(const Measurement& measurement);

  // References by name, such as `truth_0`; an empty table means that there is no reference.
  [[nodiscard]] const std::map<std::string, record::Table>& references() const {
    return references_;
  }
  void add_reference(const std::string& name, const record::Table& table);

  [[nodiscard]] bool resumed() const { return !kept_.empty(); }
  [[nodiscard]] const std::string& folder() const { return folder_; }
  // Sentences about rows that could not be read.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
  // Removes the files that were read or written, and the folder if it is then empty.
  void remove() const;
  // Calls remove() if nothing has been kept.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

 private:
  bool read(const record::Table& row);

  std::map<std::pair<std::size_t, std::string>, Measurement> kept_;  // by case and name
  std::map<std::string, record::Table> references_;
  std::vector<std::string> warnings_;
  std::string folder_;
  std::vector<std::string> files_;
  std::optional<record::Journal> file_;
};

// References as tables, and back.
[[nodiscard]] record::Table history_table(const Truth& truth);
[[nodiscard]] Truth truth_of(const record::Table& table);
[[nodiscard]] record::Table surface_table(const run::SurfaceReference& surface);
[[nodiscard]] run::SurfaceReference surface_of(const record::Table& table);

}  // namespace palpate::chart
