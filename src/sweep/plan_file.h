// Writes and reads plan.json, and the cells of plan.csv.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sweep/plan.h"

namespace palpate::sweep {

struct PlanFile {
  std::string program;
  std::string name;  // of the scenario
  std::vector<std::string> settings;
  bool curves = false;
  std::size_t cases = 0;
  std::optional<scenario::Solver::Model> model = {};  // Family::at_least
  std::string csv_hash = {};
  HashedNames inputs;  // the scenario first
};

[[nodiscard]] std::string plan_text(const PlanFile& file);

// Throws InputError, naming `path`, if the text is not a plan.json of this version.
[[nodiscard]] PlanFile read_plan_file(const std::string& text, const std::string& path);

// Lists the differences between two plans, such as "`--curves`, `--set`".
[[nodiscard]] std::string differences(const PlanFile& a, const PlanFile& b);

}  // namespace palpate::sweep
