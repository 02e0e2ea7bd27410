// Builds and runs all cases of a scenario on several workers (threads).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "record/record.h"
#include "scenario/family.h"
#include "scene/scene.h"

namespace palpate::run {

// Calls work(i) for all i below `count` on `workers` threads, which take the StopScope of this one.
// Throws the exception of the first i that has one, after all calls.
void share_out(std::size_t count, int workers, const std::function<void(std::size_t)>& work);

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

// The share of its loading history that a case has gone through; nothing without rows.
[[nodiscard]] std::optional<double> share_done(const scene::Scene& scene,
                                               const record::CaseRecord& record);

struct Cost {
  double seconds = 0.0;  // of a processor
  bool at_least = false;
};

// The cost of all cases after their set-up, from running some of them for up to about `longest`
// seconds. A case that is not finished then counts by the share of its loading history; one of
// `solid` shows none before its last mesh is done, and the cost is then at least what was spent.
[[nodiscard]] Cost expected_cost(const std::vector<scene::Scene>& scenes, double longest = 3.0);

}  // namespace palpate::run
