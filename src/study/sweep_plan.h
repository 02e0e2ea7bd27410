// The plan of a sweep: a folder that says which cases there are, and never changes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenario/family.h"

namespace palpate::study {

// OUT/NAME_sweep holds
//   plan.json  what was planned, and the hashes of all else; its own hash is the plan's
//   plan.csv   a row a case: number (from 1), id, the swept keys as words
//   inputs/    the scenario with its settings applied, and copies of all files that it names
//   results/   rows of finished cases: sweep_journal.h
//   locks/     who runs which part: sweep_shard.h
struct SweepPlan {
  std::string folder;
  std::string hash;  // 64 digits
  std::string program;
  bool curves = false;             // every case's curves are kept
  scenario::Family family;         // of the copies, without cases
  std::vector<std::uint64_t> ids;  // of the cases, in their order

  [[nodiscard]] std::size_t count() const { return ids.size(); }
};

struct SweepOrder {
  std::string scenario;
  std::vector<std::string> settings = {};
  std::string out = "out";
  enum class Curves { left_out, kept } curves = Curves::left_out;
  enum class Ceiling { holds, lifted } ceiling = Ceiling::holds;
  int workers = 1;
  std::string program = {};  // the version that plans: no other runs it
};

struct Planned {
  std::string folder;
  std::size_t cases = 0;
  bool there_already = false;  // the very same plan was
  std::vector<Problem> notes = {};
  std::string forecast = {};  // a sentence on time and size, as far as it can be said
};

// So many cases are planned without being asked twice.
inline constexpr std::size_t sweep_ceiling = 10000;

// Makes every case once, to check it, and writes the plan. Throws InputError for the first case
// that cannot be, for two cases that are one, for too many cases, and where another plan is in the
// way, saying what differs; SystemError where the folder cannot be written.
[[nodiscard]] Planned plan_sweep(const SweepOrder& order);

// Reads a plan and checks that nothing of it has changed. Throws InputError where something has,
// where the folder is no plan, and where `program` is not the one that planned.
[[nodiscard]] SweepPlan read_plan(const std::string& folder, const std::string& program);

// What makes a case itself: the first digits of the SHA-256 of all its keys, every default and
// property spelled out, and of the files that it reads. `files` are by name and hash.
using HashedNames = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] HashedNames hashed_inputs(const scenario::Family& family);
[[nodiscard]] std::uint64_t case_id(const scenario::Case& one, const HashedNames& files);

// The id of a sampled case that computes what an earlier one does, by its number from 1: samples of
// words repeat, and in a Saltelli design the row of A with a column of B is that of A itself where
// both have the same value there.
[[nodiscard]] std::uint64_t twin_id(std::uint64_t id, std::size_t number);

}  // namespace palpate::study
