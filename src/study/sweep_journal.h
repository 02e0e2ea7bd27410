// Rows of a sweep on the disk: every process appends to a file of its own, and all are read.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/files.h"
#include "study/sweep_plan.h"
#include "study/sweep_row.h"
#include "study/sweep_shard.h"

namespace palpate::study {

// A new file results/PART_HOST_PID_COUNT.rows. Its first line says of which plan it is; every line
// after it is a row.
class SweepJournal {
 public:
  // Throws SystemError where the file cannot be made.
  SweepJournal(const SweepPlan& plan, const std::string& part);

  // On the disk's way when this returns: no kill of the process loses it. Throws SystemError on a
  // full disk; what was added before stays good. One call at a time.
  void add(const SweepRow& row);
  // Past a loss of power, too.
  void sync();

  [[nodiscard]] const std::string& path() const { return file_->path(); }

 private:
  std::string plan_;
  std::unique_ptr<GrowingFile> file_;
  bool changed_ = false;
};

// A file of rows, as far as it could be read.
struct RowFile {
  std::string path;  // of the file
  std::size_t rows = 0;
  std::size_t corrupt = 0;  // lines that are no row
  bool torn = false;        // its last line was cut off
  bool foreign = false;     // it is of another plan, or of another version
};

// Where the row of a case is.
struct RowPlace {
  static constexpr std::uint32_t nowhere = 0xffffffff;
  std::uint32_t file = nowhere;
  SweepHead head;
  std::uint64_t offset = 0;

  [[nodiscard]] bool known() const { return file != nowhere; }
};

// Which cases of a plan have a row, and where. Holds 40 bytes a case, no rows.
class SweepResults {
 public:
  // Reads results/. Of several rows of a case the one of the greatest attempt counts; equal rows
  // are one. Throws SystemError where two rows of one attempt differ, naming both files.
  // With a `shard` the files of other parts of as many are left out: they hold none of its cases,
  // and a thousand tasks need not read each what all have written.
  explicit SweepResults(const SweepPlan& plan, const Shard& shard = {});

  [[nodiscard]] const RowPlace& at(std::size_t index) const { return places_[index]; }
  [[nodiscard]] const std::vector<RowFile>& files() const { return files_; }
  [[nodiscard]] std::size_t corrupt() const;  // lines, torn ones too
  // A sentence for every file that has corrupt lines or is of another plan.
  [[nodiscard]] std::vector<std::string> warnings() const;

  // The row of a case that is known. Throws SystemError where it cannot be read any more.
  [[nodiscard]] SweepRow row(std::size_t index) const;

 private:
  void read(const std::string& path, const std::vector<std::uint32_t>& by_id);
  void add(std::size_t index, const RowPlace& place);

  const SweepPlan* plan_;
  std::vector<RowPlace> places_;
  std::vector<RowFile> files_;
};

}  // namespace palpate::study
