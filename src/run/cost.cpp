// Times cases, the middle ones first.
#include "run/cost.h"

#include <algorithm>

#include "base/processor_time.h"
#include "base/stop_scope.h"
#include "base/stopwatch.h"
#include "run/family.h"
#include "scenario/programme.h"

namespace palpate::run {

std::optional<double> share_done(const scene::Scene& scene, const record::CaseRecord& record) {
  const double time = record::end_time(record);
  const double whole = scenario::programme_time(scene.scenario);
  return time > 0.0 && whole > 0.0 ? std::optional(std::min(1.0, time / whole)) : std::nullopt;
}

double expected_seconds(const std::vector<scene::Scene>& scenes) {
  constexpr double longest = 3.0;  // s
  // `solid` has no rows before its last mesh is done; most such cases are far.
  constexpr double far = 1.0 / 3.0;
  const Stopwatch watch;
  double sum = 0.0;
  std::size_t tried = 0;
  for (; tried < scenes.size() && watch.seconds() < longest; ++tried) {
    const scene::Scene& scene = scenes[(scenes.size() / 2 + tried) % scenes.size()];
    const StopScope deadline(longest - watch.seconds());
    const double before = processor_seconds();
    const record::CaseRecord record = run_case(scene);
    const double spent = processor_seconds() - before;
    const bool ended = record.outcome != record::Outcome::interrupted;
    sum += ended ? spent : spent / share_done(scene, record).value_or(far);
  }
  return tried == 0 ? 0.0 : sum / static_cast<double>(tried) * static_cast<double>(scenes.size());
}

}  // namespace palpate::run
