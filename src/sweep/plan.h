// The plan of a sweep: a folder that lists the cases and never changes; its parts, and what it will
// take.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "scenario/family.h"

namespace palpate::sweep {

// The i-th of n parts: every n-th case, so that all parts take about the same time.
struct Shard {
  std::size_t number = 1;  // from 1
  std::size_t of = 1;

  [[nodiscard]] bool holds(std::size_t index) const { return index % of == number - 1; }
  [[nodiscard]] std::string text() const;  // `3-of-16`
};

// Reads `3/16`. Throws InputError for any other text.
[[nodiscard]] Shard parse_shard(const std::string& text);

// Another process runs the part.
class PartIsRun : public InputError {
 public:
  using InputError::InputError;
};

// A lock for the life of the object; the system releases it however the process ends.
class FolderLock {
 public:
  // Locks FOLDER/locks/NAME.lock. Throws PartIsRun, naming the holder, if another process holds
  // the lock, and SystemError if the file cannot be made or locked. Where the file system has no
  // locks, there is none, and warning() says so: two runs of a part do no harm.
  FolderLock(const std::string& folder, const std::string& name);

  [[nodiscard]] const std::string& warning() const { return warning_; }  // a sentence, or empty

 private:
  Descriptor file_;
  std::string warning_;
};

// OUT/NAME_sweep contains
//   plan.json  version, settings, options, hashes of the other files; its hash is the plan's
//   plan.csv   one row per case: number (from 1), id, the swept keys as words
//   inputs/    the scenario with its settings applied, and copies of all files that it names
//   results/   rows of finished cases: sweep/journal.h
//   locks/     lock files of running parts: FolderLock
struct SweepPlan {
  std::string folder;
  std::string hash;  // SHA-256 of plan.json, 64 digits
  std::string program;
  bool curves = false;             // the curves of every case are kept
  scenario::Family family;         // read from inputs/, without cases
  std::vector<std::uint64_t> ids;  // one per case

  [[nodiscard]] std::size_t count() const { return ids.size(); }
};

struct SweepOrder {
  std::string scenario;
  std::vector<std::string> settings = {};
  std::string out = "out";
  enum class Curves { omitted, kept } curves = Curves::omitted;
  enum class Ceiling { holds, lifted } ceiling = Ceiling::holds;
  int workers = 1;
  std::string program = {};  // the version that plans; only this version runs the plan
  std::string reuse = {};    // folder of a plan whose rows of equal cases are taken over
};

struct SweepForecast {
  std::size_t cases = 0;
  double seconds = 0.0;  // of processor time, on one worker
  double bytes = 0.0;    // of rows, without curves
  double memory = 0.0;   // bytes, that one worker's process takes at most
  bool curves = false;

  [[nodiscard]] std::string text() const;  // about 12 s on one worker and 2.4 MB
};

// The number of different set-ups that a family's cases share, from evenly chosen cases. A modulus
// of the only tissue scales a set-up; without a mesh it depends on the tissues alone.
[[nodiscard]] double set_ups(const scenario::Family& family, bool meshed);

// Runs some neighbouring cases for up to about two seconds: once with all that cases share, and
// once without. Nothing if a case is invalid or fails.
[[nodiscard]] std::optional<SweepForecast> forecast(const scenario::Family& family,
                                                    bool keeps_curves);

struct Planned {
  std::string folder;
  std::size_t cases = 0;
  bool there_already = false;  // the folder already contained the same plan
  std::vector<Problem> notes = {};
  std::optional<SweepForecast> forecast = {};
  std::size_t reused = 0;  // rows taken over from another plan
};

// The largest number of cases that is planned unless the ceiling is lifted.
inline constexpr std::size_t sweep_ceiling = 10000;

// Makes every case once, to check it, and writes the plan. Throws InputError for the first invalid
// case, for two equal cases, for too many cases, for a swept key that no chosen model reads, and if
// the folder contains a different plan, naming the differences; SystemError if the folder cannot be
// written. With `reuse`, the completed rows of that plan's equal cases are added to the results of
// the new one: a plan grows by a larger plan beside it.
[[nodiscard]] Planned plan_sweep(const SweepOrder& order);

// Reads a plan and checks it against its hashes. Throws InputError if a file has changed, if the
// folder is not a plan, and if `program` is not the one that planned it.
[[nodiscard]] SweepPlan read_plan(const std::string& folder, const std::string& program);

// A case's id: the first 16 digits of the SHA-256 of all its keys, with defaults and material
// properties, of the model that its family takes, and of the hashes of the files that it reads.
[[nodiscard]] std::uint64_t case_id(const scenario::Case& one,
                                    const std::vector<HashedFile>& files);

// The id of a sampled case that equals an earlier case: a hash of `id` and of its `number` from 1.
// Samples of words repeat, and in a Saltelli design the row of A with a column of B equals the row
// of A if both have the same value in that column.
[[nodiscard]] std::uint64_t twin_id(std::uint64_t id, std::size_t number);

// plan.json. Its text is hashed, so that its keys are written in a fixed order.
struct PlanFile {
  std::string program;
  std::string name;  // of the scenario
  std::vector<std::string> settings;
  bool curves = false;
  std::size_t cases = 0;
  std::optional<scenario::Solver::Model> model = {};  // Family::at_least
  std::string csv_hash = {};
  std::vector<HashedFile> inputs;  // the scenario first
};

[[nodiscard]] std::string plan_text(const PlanFile& file);

// Throws InputError, naming `path`, if the text is not a plan.json of this version.
[[nodiscard]] PlanFile read_plan_file(const std::string& text, const std::string& path);

// Lists the differences between two plans, such as "`--curves`, `--set`".
[[nodiscard]] std::string differences(const PlanFile& a, const PlanFile& b);

}  // namespace palpate::sweep
