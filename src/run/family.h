// Builds and runs all cases of a scenario on several workers (threads).
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "record/record.h"
#include "scenario/family.h"
#include "scene/scene.h"

namespace palpate::run {

// Flags that end running cases or prevent new ones.
struct Stop {
  const std::atomic<bool>& end_now;        // running cases end soon, as interrupted
  const std::atomic<bool>& begin_no_more;  // no case is begun; running cases go on to their end

  [[nodiscard]] bool no_more() const { return end_now.load() || begin_no_more.load(); }
};

// Builds every case, all by one_model(). Throws the exception of the first case (by number) that
// has one.
[[nodiscard]] std::vector<scene::Scene> build_all(const scenario::Family& family, int workers);

// A record with the case's name and the values chosen for `auto`, without rows.
[[nodiscard]] record::CaseRecord begin_case(const scene::Scene& scene);

// Runs the steps of a scene's loading history and adds rows, maps and frames to `record`. Of the
// findings it adds only those that need the state of the mesh. A stopped StopScope ends it as
// interrupted.
void run_programme(const scene::Scene& scene, record::CaseRecord& record);

// Runs one scene to its end, with findings.
[[nodiscard]] record::CaseRecord run_case(const scene::Scene& scene);

// Runs the scenes and returns their records in the order of the scenes. `finished` is called after
// each case, on the worker's thread, with several calls at a time. Where the thread's StopScope is
// stopped, running cases end as interrupted; these and the cases not begun are excluded.
[[nodiscard]] std::vector<record::CaseRecord> run_all(
    const std::vector<scene::Scene>& scenes, int workers,
    const std::function<void(std::size_t, const record::CaseRecord&)>& finished);

// The same without collecting the records: `ended` receives each one when its case has ended, on
// the worker's thread, with several calls at a time.
void run_each(const std::vector<scene::Scene>& scenes, int workers, const Stop& stop,
              const std::function<void(std::size_t, record::CaseRecord&&)>& ended);

}  // namespace palpate::run
