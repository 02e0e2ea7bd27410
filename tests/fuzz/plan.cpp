// Any text as the plan.json of a sweep: one that is read is written as a text that reads the same.
#include "sweep/plan.h"
#include "fuzzing.h"

void palpate::fuzz::plan(const std::uint8_t* data, std::size_t size) {
  sweep::PlanFile plan;
  if (!reads([&] { plan = sweep::read_plan_file(std::string(text_of(data, size)), "plan.json"); }))
    return;
  const std::string text = sweep::plan_text(plan);
  require(sweep::plan_text(sweep::read_plan_file(text, "plan.json")) == text);
}
