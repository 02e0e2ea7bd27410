// Finds the rows of a plan's cases in the files results/PART_HOST_PID_COUNT.rows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "record/journal.h"
#include "sweep/plan.h"
#include "sweep/row.h"

namespace palpate::sweep {

// The place of a case's row: the file's index and the line's offset, bytes.
struct RowPlace {
  static constexpr std::uint32_t nowhere = 0xffffffff;
  std::uint32_t file = nowhere;
  SweepHead head;
  std::uint64_t offset = 0;

  [[nodiscard]] bool known() const { return file != nowhere; }
};

// Which cases of a plan have a row, and where. Keeps 40 bytes per case and no rows.
class SweepResults {
 public:
  // Reads results/. If a case has several rows, the one with the highest attempt counts. Throws
  // SystemError, naming both files, if two rows of one attempt differ, and InputError if a file was
  // written by an earlier version. Files of other parts (of `shard.of`) contain none of the
  // shard's cases and are not read, so that each of a thousand tasks reads little.
  explicit SweepResults(const SweepPlan& plan, const Shard& shard = {});

  [[nodiscard]] const RowPlace& at(std::size_t index) const { return places_[index]; }
  [[nodiscard]] const std::vector<record::JournalFile>& files() const { return files_; }
  [[nodiscard]] std::size_t corrupt() const;  // number of corrupt or incomplete lines
  // One sentence per file that has corrupt lines or belongs to another plan.
  [[nodiscard]] std::vector<std::string> warnings() const;

  // Reads the row of a case for which at() is known(). Throws SystemError if its line has changed.
  [[nodiscard]] SweepRow row(std::size_t index) const;

 private:
  void read(const std::string& path, const std::vector<std::uint32_t>& by_id);
  void add(std::size_t index, const RowPlace& place);

  const SweepPlan* plan_;
  std::vector<RowPlace> places_;
  std::vector<record::JournalFile> files_;
};

}  // namespace palpate::sweep
