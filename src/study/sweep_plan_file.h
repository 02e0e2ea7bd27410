// plan.json, and the cells of plan.csv.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "record/table.h"
#include "study/sweep_plan.h"

namespace palpate::study {

struct PlanFile {
  std::string program;
  std::string name;  // of the scenario that was planned
  std::vector<std::string> settings;
  bool curves = false;
  std::size_t cases = 0;
  std::string csv_hash = {};
  HashedNames inputs;  // the scenario first
};

[[nodiscard]] std::string plan_text(const PlanFile& file);

// Throws InputError where the text is no such file; `path` names it.
[[nodiscard]] PlanFile read_plan_file(const std::string& text, const std::string& path);

// In what two plans differ, as `program, settings`.
[[nodiscard]] std::string differences(const PlanFile& a, const PlanFile& b);

// A swept word: as a number where it is one, as written.
[[nodiscard]] record::Cell plan_cell(const std::string& word);

}  // namespace palpate::study
