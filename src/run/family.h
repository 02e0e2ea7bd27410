// All cases of a scenario, on several workers.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "record/record.h"
#include "run/stop.h"
#include "scenario/family.h"
#include "scene/scene.h"

namespace palpate::run {

// Builds every case, before any of them runs. Throws what the first case at fault throws.
[[nodiscard]] std::vector<scene::Scene> build_all(const scenario::Family& family, int workers);

// A record with the case's name and what `auto` chose, without rows.
[[nodiscard]] record::CaseRecord begin_case(const scene::Scene& scene);

// Runs one scene to its end.
[[nodiscard]] record::CaseRecord run_case(const scene::Scene& scene, const std::atomic<bool>& stop);

// Which cases share a loop, lane beside lane: as many as it makes cheaper, all that can, or none.
// Their records are the same to the bit.
enum class Lanes { where_they_pay, wherever_possible, none };

// Runs the scenes; the records stand in the order of the scenes whatever the workers do.
// `finished` is called after each case, one call at a time, on the worker's thread. A set `stop`
// ends running cases at their next row and leaves the rest out.
[[nodiscard]] std::vector<record::CaseRecord> run_all(
    const std::vector<scene::Scene>& scenes, int workers, const std::atomic<bool>& stop,
    const std::function<void(std::size_t, const record::CaseRecord&)>& finished,
    Lanes lanes = Lanes::where_they_pay);

// The same where records need not be kept together: `ended` is given each as soon as its case has
// ended, on its worker's thread, several calls at a time.
void run_each(const std::vector<scene::Scene>& scenes, int workers, const Stop& stop,
              const std::function<void(std::size_t, record::CaseRecord&&)>& ended,
              Lanes lanes = Lanes::where_they_pay);

}  // namespace palpate::run
