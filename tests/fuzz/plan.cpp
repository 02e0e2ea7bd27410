// Any text as the plan.json of a sweep: one that is read is written as a text that reads the same.
#include "fuzzing.h"
#include "sweep/plan_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  sweep::PlanFile plan;
  if (!fuzz::reads([&] {
        plan = sweep::read_plan_file(std::string(fuzz::text_of(data, size)), "plan.json");
      }))
    return 0;
  const std::string text = sweep::plan_text(plan);
  fuzz::require(sweep::plan_text(sweep::read_plan_file(text, "plan.json")) == text);
  return 0;
}
