// The plan of a sweep: a folder that lists the cases and never changes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenario/family.h"
#include "sweep/forecast.h"

namespace palpate::sweep {

// OUT/NAME_sweep contains
//   plan.json  version, settings, options, hashes of the other files; its hash is the plan's
//   plan.csv   one row per case: number (from 1), id, the swept keys as words
//   inputs/    the scenario with its settings applied, and copies of all files that it names
//   results/   rows of finished cases: sweep/journal.h
//   locks/     lock files of running parts: sweep/shard.h
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
// `files` are pairs of name and hash.
using HashedNames = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] HashedNames hashed_inputs(const scenario::Family& family);
[[nodiscard]] std::uint64_t case_id(const scenario::Case& one, const HashedNames& files);

// The id of a sampled case that equals an earlier case: a hash of `id` and of its `number` from 1.
// Samples of words repeat, and in a Saltelli design the row of A with a column of B equals the row
// of A if both have the same value in that column.
[[nodiscard]] std::uint64_t twin_id(std::uint64_t id, std::size_t number);

}  // namespace palpate::sweep
