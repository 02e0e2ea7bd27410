// Times cases, the middle ones first.
#include "run/cost.h"

#include <algorithm>

#include "base/processor_time.h"
#include "base/stop_scope.h"
#include "base/stopwatch.h"
#include "run/family.h"
#include "scenario/programme.h"

namespace palpate::run {
namespace {

// The share of its loading history that a case has gone through. `solid` has no rows before its
// last mesh is done; nothing shows then how far it is, and most such cases are far.
double share_done(const scene::Scene& scene, const record::CaseRecord& record) {
  constexpr double unknown = 1.0 / 3.0;
  const double time = !record.strain.empty()    ? record.strain.back().time
                      : !record.contact.empty() ? record.contact.back().time
                                                : 0.0;
  const double whole = scenario::programme_time(scene.scenario);
  return time > 0.0 && whole > 0.0 ? std::min(1.0, time / whole) : unknown;
}

}  // namespace

double expected_seconds(const std::vector<scene::Scene>& scenes) {
  constexpr double longest = 3.0;  // s
  const Stopwatch watch;
  double sum = 0.0;
  std::size_t tried = 0;
  for (; tried < scenes.size() && watch.seconds() < longest; ++tried) {
    const scene::Scene& scene = scenes[(scenes.size() / 2 + tried) % scenes.size()];
    const StopScope deadline(longest - watch.seconds());
    const double before = processor_seconds();
    const record::CaseRecord record = run_case(scene);
    const double spent = processor_seconds() - before;
    sum +=
        record.outcome == record::Outcome::interrupted ? spent / share_done(scene, record) : spent;
  }
  return tried == 0 ? 0.0 : sum / static_cast<double>(tried) * static_cast<double>(scenes.size());
}

}  // namespace palpate::run
