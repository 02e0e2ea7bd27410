// A result folder: written whole beside its place, then renamed.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fit/fit_table.h"
#include "record/record.h"
#include "report/manifest.h"
#include "scenario/family.h"

namespace palpate::report {

// findings.csv: case, the swept keys, then one column a finding, empty where a case has none.
[[nodiscard]] record::Table findings_table(const scenario::Family& family,
                                           const std::vector<record::CaseRecord>& records);

// The CSV files of a result by name: what `run` writes and `golden bless` keeps.
using CsvFiles = std::vector<std::pair<std::string, record::Table>>;
[[nodiscard]] CsvFiles csv_files(const scenario::Family& family,
                                 const std::vector<record::CaseRecord>& records,
                                 const std::vector<fit::NamedFit>& fits);

// The folder OUT/NAME of a family. While cases run, the finished ones lie in OUT/NAME.partial-PID;
// finish() writes everything there and renames, so that OUT/NAME is always whole.
class ResultFolder {
 public:
  // Throws InputError where OUT/NAME holds a complete result and `replace` is false, or anything
  // that is no result. Makes nothing yet.
  ResultFolder(const std::string& out, const scenario::Family& family, bool replace);

  // Makes the partial folder, a new one whatever earlier programs have left. Throws SystemError
  // where it cannot be made.
  void open();

  // Removes what is left of an unfinished folder, unless a finished case or a growing file lies in
  // it.
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  // The path of a file of the result that grows in the partial folder while the run goes on. Once
  // it is there the folder stays until finish(), whatever ends the program.
  [[nodiscard]] std::string growing(const std::string& name);
  // What has grown, if it is there, is the file of the result: it is not written again.
  void take_grown(const std::string& name);
  // Rows that earlier live runs left in folders beside this one, for they were killed, or others
  // still write: paths of CSV files, in order.
  [[nodiscard]] std::vector<std::string> rows_left_beside() const;

  // Keeps a finished case on the disk at once. One call at a time.
  void keep(std::size_t index, const record::CaseRecord& record);

  // Writes the result and puts it in its place. Beside it stays a part of a run, or a run without
  // `replace`, where a complete result stands by then. Returns warnings, such as a missing gnuplot.
  std::vector<std::string> finish(const std::vector<record::CaseRecord>& records,
                                  const std::vector<fit::NamedFit>& fits, const Origin& origin);

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  void write(const std::string& name, const std::string& content);
  void write_tissue(const std::vector<record::CaseRecord>& records);
  void write_pictures(const std::vector<record::CaseRecord>& records);
  void put_in_place();

  const scenario::Family* family_;
  std::string path_;
  std::string partial_;
  bool replace_ = false;
  bool opened_ = false;
  bool cases_kept_ = false;
  bool finished_ = false;
  std::vector<std::string> files_;
  std::set<std::string> growing_;  // names
  std::set<std::string> grown_;    // of these, whole
};

}  // namespace palpate::report
