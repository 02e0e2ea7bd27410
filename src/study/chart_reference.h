// What a chart's errors are measured against, and how wrong that is itself.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "study/chart_design.h"
#include "study/chart_history.h"

namespace palpate::study {

struct Truth {
  std::string kind;      // "closed form", "refined", "modal": a word for the table
  std::string sentence;  // what it is, for people
  History moments;       // with their own errors
};

// The best that is available for a case:
//   a half-space            `hertz`, with its factor of a deep press where that matters
//   a flat whose sides and  `layer`; its own error is what the sides take and what waves add, as
//   waves change less than  the ladder estimates them, of every force: refined meshes know no
//   3 % of the force        better
//   a uniform test between  the material's creep or relaxation; its own error is what inertia
//   slippery platens        adds, by `modal` on the scenario's mesh
//   any other press         run::refer(), tissue that the scenario's contact does not know the
//                           viscosity of without any, at most 20 moments
//   any other uniform test  coupled springs on three meshes, modal where their size allows it,
//                           extrapolated
//   a ready mesh            coupled springs on it; its own error is what the ladder predicts
// Throws what these throw; nothing where `stop` was set before it was done.
[[nodiscard]] std::optional<Truth> find_truth(const Asked& asked, std::size_t of_case,
                                              const std::atomic<bool>& stop,
                                              const std::function<void(const std::string&)>& told);

// Of time alone: the variant's scenario by `modal`, in quarters of a ms, its error the difference
// to halves, at the coarsest rows of the case's variants. Nothing where `modal` cannot serve it, or
// `stop` was set.
[[nodiscard]] std::optional<History> exact_in_time(const Asked& asked, const Variant& variant,
                                                   const std::atomic<bool>& stop);

}  // namespace palpate::study
