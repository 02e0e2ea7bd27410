// The reference for the time integration alone: all modes, with two lengths of step.
#include "chart/truth.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "run/family.h"
#include "run/refined_mesh.h"

namespace palpate::chart {

std::optional<History> exact_in_time(const Asked& asked, const Variant& variant,
                                     integrate::KnownModes& known) {
  const double interval = coarsest_interval(asked.family.cases[variant.of_case].scenario);
  std::vector<History> finer;
  try {
    // Modes follow the constant loads of a uniform test exactly.
    const double longest = asked.family.cases[variant.of_case].scenario.uniform() ? interval : 5e-4;
    for (const double step : {longest, 0.5 * longest}) {
      std::vector<std::string> settings = variant.settings;
      settings.emplace_back("solver.integrator=modal");
      settings.push_back("output.interval=" + number_text(1e3 * interval) + " ms");
      settings.push_back("solver.substeps=" +
                         number_text(std::max(1.0, std::round(interval / step))));
      const auto family = with_settings(asked, variant.of_case, settings);
      scene::Scene scene = run::build_scene(family.cases.front(), family);
      if (!scene.specimen || scene.specimen->network.nodes() > most_modal_nodes)
        return std::nullopt;
      scene.scenario.solver.modes = 3 * scene.specimen->network.nodes();  // all
      scene.known_modes = &known;
      scene.scenario.output.keep_rows_only();
      const record::CaseRecord record = run::run_case(scene);
      if (record.outcome != record::Outcome::completed) return std::nullopt;
      finer.push_back(without_starts(scene.scenario, history(scene.scenario, record)));
    }
  } catch (const InputError&) {
    return std::nullopt;
  }
  History best = finer.back();
  for (std::size_t i = 0; i < best.size(); ++i)
    best[i].error = std::abs(best[i].value - finer.front()[i].value);
  return best;
}

}  // namespace palpate::chart
