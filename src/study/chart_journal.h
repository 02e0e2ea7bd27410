// What a chart has measured so far, on the disk as soon as it is known.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "record/table.h"
#include "study/chart.h"

namespace palpate::study {

// A folder with `identity.txt`, `journal.csv` (one line a timing, appended and flushed) and a file
// for every reference.
class Journal {
 public:
  // `identity` is the text that two calls must share to go on with each other. Makes the folder, or
  // reads what it holds; `afresh` removes that first. A last line that was cut off is dropped.
  // Throws InputError where the folder belongs to another chart, SystemError where it cannot be
  // made.
  Journal(std::string folder, const std::string& identity, bool afresh);

  // What was kept of a variant, its timings in the order they were made.
  [[nodiscard]] std::optional<Measurement> find(const Variant& variant) const;
  // Keeps a measurement's last timing, and with its first one the rest.
  void add(const Measurement& measurement);

  // References by name, such as `truth_0`; a chart may know that there is none.
  [[nodiscard]] std::optional<record::Table> find_reference(const std::string& name) const;
  void add_reference(const std::string& name, const record::Table& table) const;

  [[nodiscard]] bool resumed() const { return !kept_.empty(); }
  [[nodiscard]] const std::string& folder() const { return folder_; }
  // Removes the journal and gives the folder, with what else lies in it, its place; a folder that
  // was there is replaced. Throws SystemError where that cannot be.
  void finish(const std::string& place) const;

 private:
  void read();

  std::string folder_;
  std::map<std::pair<std::size_t, std::string>, Measurement> kept_;  // by case and name
};

// A history as a table, and back.
[[nodiscard]] record::Table history_table(const Truth& truth);
[[nodiscard]] Truth truth_of(const record::Table& table);

}  // namespace palpate::study
