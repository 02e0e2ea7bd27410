// Times cases as a sweep runs them, and counts how often what they share has to be made.
#include "sweep/forecast.h"

#include <sys/resource.h>

#include <algorithm>
#include <optional>
#include <set>

#include "base/error.h"
#include "base/stop_scope.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "run/family.h"
#include "run/refined_mesh.h"
#include "scenario/programme.h"
#include "scene/estimates.h"
#include "scene/specimen_shape.h"
#include "scene/surface_displacement_store.h"
#include "sweep/plan.h"
#include "sweep/row.h"

namespace palpate::sweep {
namespace {

// Cases that differ only in what a set-up does not depend on have equal texts.
std::string set_up_key(const scenario::Family& family, std::size_t i, bool meshed) {
  const bool one_tissue = family.base.regions.empty();
  std::string text;
  for (const scenario::Setting& setting : family.design.settings(i)) {
    const std::string& key = setting.key;
    const bool scales = one_tissue && key == "tissue.young_modulus";
    const bool after = !meshed && !key.starts_with("tissue.") && !key.starts_with("region");
    if (!scales && !after) text += setting.word + "\n";
  }
  return text;
}

class Trial {
 public:
  Trial(const scenario::Family& family, bool keeps_curves)
      : family_(family), keeps_curves_(keeps_curves), files_(hashed_inputs(family)) {}

  // The time of all cases, s; nothing if a case does not end as it should.
  std::optional<double> seconds() {
    constexpr double most = 8.0;           // cases
    constexpr double most_nodes = 2000.0;  // of all cases, because a set-up cannot be interrupted
    const std::size_t count = family_.design.count();
    const scenario::Case middle = scenario::make_case(family_, count / 2);
    const bool meshed = middle.scenario.meshed();
    const double nodes = meshed ? scene::expected_nodes(middle.scenario.tissue.mesh) : 1.0;
    const std::size_t tried =
        std::min(count, static_cast<std::size_t>(std::clamp(most_nodes / nodes, 1.0, most)));
    const std::size_t first = std::min(count / 2, count - tried);
    std::set<std::string> keys;
    for (std::size_t i = first; i < first + tried; ++i) keys.insert(set_up_key(family_, i, meshed));

    const std::optional<double> apart = run(first, tried);
    if (!apart) return alone(middle);
    if (tried == count) return apart;
    const std::optional<double> shared = run(first, tried);
    if (!shared) return std::nullopt;
    const double set_up = std::max(0.0, *apart - *shared) / static_cast<double>(keys.size());
    return set_up * set_ups(family_, meshed) +
           *shared / static_cast<double>(tried) * static_cast<double>(count);
  }

 private:
  static constexpr double longest = 1.0;  // s

  // How long cases take, with what earlier calls have left; nothing after `longest`.
  std::optional<double> run(std::size_t first, std::size_t count) {
    const Stopwatch watch;
    std::vector<scene::Scene> scenes;
    for (std::size_t i = first; i < first + count && watch.seconds() < longest; ++i) {
      const scenario::Case one = scenario::make_case(family_, i);
      (void)case_id(one, files_);
      scenes.push_back(run::build_scene(one, family_, shapes_));
      scenes.back().scenario.output.keep_rows_only();
      scenes.back().surface_displacements = &surface_displacements_;
    }
    const StopScope deadline(longest - watch.seconds());
    for (const scene::Scene& scene : scenes) {
      const record::CaseRecord record = run::run_case(scene);
      if (record.outcome == record::Outcome::interrupted) return std::nullopt;
      (void)row_of(scene, record, keeps_curves_);
    }
    return scenes.size() == count ? std::optional(watch.seconds()) : std::nullopt;
  }

  // From one case, which may end early.
  std::optional<double> alone(const scenario::Case& one) {
    const Stopwatch watch;
    scene::Scene scene = run::build_scene(one, family_, shapes_);
    const double set_up = std::max(watch.seconds(), shapes_.seconds(scene.scenario));
    scene.scenario.output.keep_rows_only();
    const StopScope deadline(longest);
    const Stopwatch running_watch;
    const record::CaseRecord record = run::run_case(scene);
    const std::optional<double> done = run::share_done(scene, record);
    if (!done) return std::nullopt;
    const double running = running_watch.seconds() / *done;
    return set_up * set_ups(family_, true) + running * static_cast<double>(family_.design.count());
  }

  const scenario::Family& family_;
  bool keeps_curves_;
  HashedNames files_;
  scene::SpecimenShapes shapes_;
  scene::SurfaceDisplacementStore surface_displacements_;
};

// The largest memory of this process so far, bytes: it has had more cases at once than a worker.
double most_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);  // Linux counts in KiB
}

}  // namespace

double set_ups(const scenario::Family& family, bool meshed) {
  constexpr std::size_t most = 2048;
  const std::size_t count = family.design.count();
  const std::size_t tries = std::min(count, most);
  std::set<std::string> found;
  for (std::size_t t = 0; t < tries; ++t)
    found.insert(set_up_key(family, t * count / tries, meshed));
  const auto different = static_cast<double>(found.size());
  const auto tried = static_cast<double>(tries);
  return different < 0.5 * tried ? different : different / tried * static_cast<double>(count);
}

std::string SweepForecast::text() const {
  return "about " + rounded_text(seconds, 2) + " s on one worker and " +
         rounded_text(bytes / 1e6, 2) + " MB" + (curves ? " besides the curves" : "");
}

std::optional<SweepForecast> forecast(const scenario::Family& family, bool keeps_curves) {
  constexpr double row = 2400.0;  // bytes, about; docs/sweeps.md
  std::optional<double> seconds;
  try {
    seconds = Trial(family, keeps_curves).seconds();
  } catch (const InputError&) {  // planning reports invalid cases
  } catch (const MeshError&) {
  }
  if (!seconds) return std::nullopt;
  const std::size_t cases = family.design.count();
  return SweepForecast{.cases = cases,
                       .seconds = *seconds,
                       .bytes = row * static_cast<double>(cases),
                       .memory = most_memory(),
                       .curves = keeps_curves};
}

}  // namespace palpate::sweep
