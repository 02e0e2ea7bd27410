// What running scenes will take.
#pragma once

#include <optional>
#include <vector>

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// The share of its loading history that a case has gone through; nothing without rows.
[[nodiscard]] std::optional<double> share_done(const scene::Scene& scene,
                                               const record::CaseRecord& record);

// The processor time (s) of all cases after their set-up, from running some of them for up to about
// three seconds. A case that is not finished then counts by the share of its loading history.
[[nodiscard]] double expected_seconds(const std::vector<scene::Scene>& scenes);

}  // namespace palpate::run
