// The folder of a result: its files, and those that are written while the run continues.
#pragma once

#include <map>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/whole_folder.h"
#include "fit/case_fits.h"
#include "record/record.h"
#include "report/manifest.h"
#include "scenario/family.h"

namespace palpate::report {

// The CSV files of a result by name, as written by `run` and stored by `golden add`.
using CsvFiles = std::vector<std::pair<std::string, record::Table>>;
[[nodiscard]] CsvFiles csv_files(const scenario::Family& family,
                                 const std::vector<record::CaseRecord>& records,
                                 const std::vector<fit::NamedFit>& fits);

// Fingerprint of inputs and settings, for WholeFolder: equal ones mean equal results.
[[nodiscard]] std::string origin_of(const scenario::Family& family);

// The folder OUT/NAME of a family. During the run, finished cases are in OUT/NAME.partial-PID.
class ResultFolder {
 public:
  // Throws InputError if OUT/NAME exists and may not be replaced. Creates nothing yet. `origin` is
  // that of WholeFolder: empty for a live run, which nothing can repeat.
  ResultFolder(const std::string& out, const scenario::Family& family, Replace replace,
               const std::string& origin = {});

  // Creates the partial folder. Throws SystemError if that fails.
  void open() { folder_.open(); }

  // Returns the path, in the partial folder, of a file that the caller writes during the run. Once
  // the file exists, the folder is kept until finish(), however the program ends.
  [[nodiscard]] std::string growing(const std::string& name);
  // Takes the growing file `name`, if it exists, as a file of the result, without writing it again.
  void take_grown(const std::string& name);
  // Paths (sorted) of the CSV rows that other live runs have in partial folders beside this one:
  // runs that were killed, or that are still running.
  [[nodiscard]] std::vector<std::string> rows_left_beside() const;

  // Takes a finished case: its rows as text, and a copy in the partial folder, quick cases
  // together. Several threads may call this at once.
  void keep(std::size_t index, const record::CaseRecord& record);

  // Writes the result of the records, each of which was kept, and moves it to OUT/NAME. Returns
  // warnings, for example that gnuplot is missing, or that a complete result has appeared at
  // OUT/NAME in the meantime.
  std::vector<std::string> finish(const std::vector<record::CaseRecord>& records,
                                  const std::vector<fit::NamedFit>& fits, const Origin& origin);

  [[nodiscard]] const std::string& path() const { return folder_.path(); }
  // The partial folder if a case was kept in it; else empty.
  [[nodiscard]] std::string kept() const { return folder_.kept(); }

 private:
  void keep_for_a_kill(const std::string& folder, const std::string& curve,
                       const record::CaseRecord& record, const std::string& rows);
  // Adds a table to the text of one with the same header; returns what was added.
  static std::string_view add_rows(std::string& all, std::string_view text);

  const scenario::Family* family_;
  WholeFolder folder_;
  std::mutex keeping_;
  bool cases_kept_ = false;
  // Cases since the last that were written for a kill: names and findings, and rows.
  std::vector<record::CaseRecord> unkept_;
  std::string unkept_rows_;
  double seconds_ = 0.0;         // s, of all cases
  double kept_seconds_ = 0.0;    // s, of those that were written
  std::set<std::string> grown_;  // names
  // The file of all curves, and its hash, as far as cases have ended in their order.
  std::string rows_;
  Sha256 rows_hash_;
  std::size_t next_ = 0;                      // case
  std::map<std::size_t, std::string> ahead_;  // texts of later cases
};

}  // namespace palpate::report
