// Builds, runs, times and compares the variants of a chart, round after round.
#include "chart/chart.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "base/doing.h"
#include "base/error.h"
#include "base/stop_scope.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "chart/journal.h"
#include "chart/reference.h"
#include "integrate/modal.h"
#include "run/choose.h"
#include "run/family.h"
#include "run/refined_mesh.h"
#include "scene/specimen_shape.h"

namespace palpate::chart {
namespace {

using Clock = std::chrono::steady_clock;

// The time of the first row after the start, s; that of the last one if there is no such row.
double first_time(const record::CaseRecord& record) {
  if (record.contact.size() > 1) return record.contact[1].time;
  return record.strain.size() > 1 ? record.strain[1].time : record::end_time(record);
}

// Without findings; the times count the time of modes that are known already.
Timing run_once(const scene::Scene& scene, record::CaseRecord& record) {
  record = {};
  const double saved = scene.known_modes->saved;
  const Clock::time_point start = Clock::now();
  run::run_programme(scene, record);
  const Clock::time_point end = Clock::now();
  const auto until = [&](Clock::time_point moment) {
    return std::chrono::duration<double>(moment - start).count() + scene.known_modes->saved - saved;
  };
  return {.first_row = until(record.first_row.value_or(end)), .whole = until(end)};
}

// The fastest of several runs, because disturbances only slow a run down; one if it is long.
Timing timed(const scene::Scene& scene, record::CaseRecord& record) {
  constexpr double enough = 5e-3;  // s, of all runs together
  constexpr int most = 1000;
  Timing least = run_once(scene, record);
  double all = least.whole;
  for (int i = 1; i < most && all < enough; ++i) {
    if (record.outcome != record::Outcome::completed) break;
    const Timing again = run_once(scene, record);
    if (again.whole < least.whole) least = again;
    all += again.whole;
  }
  return least;
}

std::string reason_of(const std::exception& error) {
  const auto* input = dynamic_cast<const InputError*>(&error);
  return input != nullptr ? input->problems().front().message : error.what();
}

class Measurer {
 public:
  Measurer(const Asked& asked, const ChartOptions& options, Journal& journal,
           const std::function<void(const ChartProgress&)>& told)
      : asked_(asked),
        options_(options),
        longest_(options.longest * (asked.family.cases.size() > 1 ? 0.5 : 1.0)),
        journal_(journal),
        told_(told) {}

  std::vector<CaseChart> all() {
    for (std::size_t i = 0; i < asked_.family.cases.size(); ++i) begin(i);
    start_ = {};
    for (int round = 0; round < options_.repeats; ++round) {
      if (round == 1) first_end_ = {};
      for (CaseChart& chart : charts_)
        for (Measurement& one : chart.rows) {
          if (round > 0 && first_end_.seconds() > options_.again) return charts_;
          visit(chart, one, round);
        }
    }
    return charts_;
  }

 private:
  void begin(std::size_t i) {
    const scenario::Case& one = asked_.family.cases[i];
    CaseChart chart;
    chart.name = one.name;
    chart.tolerance = one.scenario.solver.tolerance;
    told_({one.name + ": reference"});
    const std::string name = "truth_" + std::to_string(i);
    const auto known = journal_.references().find(name);
    if (known != journal_.references().end()) {
      chart.truth = truth_of(known->second);
    } else {
      chart.truth = find_truth(asked_, i);
      set_doing({""});
      journal_.add_reference(name, history_table(chart.truth));
    }
    chart.reference_error = own_error(one.scenario, chart.truth.moments).greatest;
    const std::string surface = "surface_" + std::to_string(i);
    if (const auto kept = journal_.references().find(surface);
        kept != journal_.references().end()) {
      chart.surface = surface_of(kept->second);
    } else {
      chart.surface = refer_surface(asked_, i);
      StopScope::end_if_stopped();
      journal_.add_reference(surface, surface_table(chart.surface));
    }
    for (const Variant& variant : design(asked_, i, shapes_)) {
      StopScope::end_if_stopped();
      Measurement fresh;
      fresh.variant = variant;
      chart.rows.push_back(journal_.find(variant).value_or(fresh));
    }
    all_ += static_cast<int>(chart.rows.size()) * options_.repeats;
    charts_.push_back(std::move(chart));
  }

  // Measures one timing if it is wanted.
  void visit(const CaseChart& chart, Measurement& one, int round) {
    StopScope::end_if_stopped();
    ChartProgress progress{(charts_.size() > 1 ? chart.name + ": " : "") + one.variant.name, done_,
                           all_};
    if (made_ > 0 && start_.seconds() > 1.0) progress.left = left(round);
    ++done_;
    if (!wanted(one, round)) return;
    told_(progress);
    const std::size_t timings = one.timings.size();
    take(chart, one);
    ++made_;
    if (timings == 0 || one.timings.size() > timings) journal_.add(one);
  }

  // s, estimated from the timings made; the rounds after the first take up to `again`.
  [[nodiscard]] double left(int round) const {
    const double each = start_.seconds() / made_;
    if (round > 0) return std::min(each * (all_ - done_), options_.again - first_end_.seconds());
    const int first = all_ / options_.repeats;
    return each * (first - done_) + std::min(each * (all_ - first), options_.again);
  }

  [[nodiscard]] bool wanted(const Measurement& one, int round) const {
    const bool kept = journal_.find(one.variant).has_value();
    if (!kept) return true;
    if (one.status != Status::measured) return false;
    if (static_cast<int>(one.timings.size()) > round) return false;
    double spent = 0.0;
    for (const Timing& timing : one.timings) spent += timing.build + timing.whole;
    return spent + spent / static_cast<double>(one.timings.size()) <= options_.budget;
  }

  void take(const CaseChart& chart, Measurement& one) {
    const bool first = one.timings.empty();
    try {
      const auto family = with_settings(asked_, one.variant.of_case, one.variant.settings);
      Timing timing;
      auto built = build(family, timing, one);
      if (!built) return;
      scene::Scene& scene = *built;
      scene.scenario.output.keep_rows_only();
      scene.known_modes = &known_modes_;
      settle(scene, one);
      record::CaseRecord record;
      const auto cut = [&] { return record.outcome == record::Outcome::interrupted; };
      const auto time_within = [&](double limit) {
        const StopScope scope(limit);
        const Timing run = timed(scene, record);
        timing.first_row = run.first_row;
        timing.whole = run.whole;
      };
      const auto predicted = [&] {
        const double row = scene.scenario.output.interval;
        return timing.whole * scene_time(chart) / std::max(record::end_time(record), row);
      };
      // Variants that differ in the time step alone tell what a step takes.
      double& a_step =
          seconds_a_step_[std::to_string(one.variant.of_case) + one.model + one.coupling +
                          one.integrator + one.rings + " " + std::to_string(one.nodes)];
      const double steps_in_all = one.substep > 0.0 ? scene_time(chart) / one.substep : 0.0;
      if (first && a_step * steps_in_all > 1.5 * longest_)
        return not_run(one, a_step * steps_in_all);
      time_within((first ? 0.25 : 1.0) * longest_);  // shows what is far too long
      if (first && cut() && !StopScope::stopped() && predicted() < 2.0 * longest_)
        time_within(longest_);
      one.first_simulated = first_time(record);
      if (const double longer = record::end_time(record) - one.first_simulated; longer > 0.0)
        a_step = (timing.whole - timing.first_row) * one.substep / longer;
      StopScope::end_if_stopped();
      if (cut() && first) return not_run(one, predicted());
      if (cut()) return;  // the machine was slow
      one.timings.push_back(timing);
      if (first) compare(chart, scene, record, one);
    } catch (const InputError& error) {
      one.note = reason_of(error);
    } catch (const MeshError& error) {
      one.note = reason_of(error);
    }
  }

  // Nothing if the set-up is predicted to take too long. Variants on one mesh share it, and the
  // time it took counts for each of them.
  std::optional<scene::Scene> build(const scenario::Family& family, Timing& timing,
                                    Measurement& one) {
    const scenario::Case& asked = family.cases.front();
    const Stopwatch watch;
    scene::Choice choice = run::choose(asked);
    const double setup = choice.taken() != nullptr ? choice.taken()->seconds : 0.0;
    if (setup > longest_) {
      not_run(one, setup);
      return std::nullopt;
    }
    if (!choice.chosen.meshed()) {
      scene::SpecimenShapes none;
      scene::Scene scene = run::build_scene(asked, family, none, std::move(choice));
      timing.build = watch.seconds();
      return scene;
    }
    const double made = shapes_.seconds();
    scene::Scene scene = run::build_scene(asked, family, shapes_, std::move(choice));
    timing.build = watch.seconds() - (shapes_.seconds() - made) + shapes_.seconds(scene.scenario);
    return scene;
  }

  static double scene_time(const CaseChart& chart) {
    return chart.truth.moments.empty() ? 0.0 : chart.truth.moments.back().time;
  }

  static void not_run(Measurement& one, double seconds) {
    one.status = Status::not_run;
    one.note = "not run: predicted " + number_text(*whole_number(rounded_text(seconds, 2))) + " s";
  }

  static void settle(const scene::Scene& scene, Measurement& one) {
    const scenario::Resolved& scenario = scene.scenario;
    one.model = word_of(scenario.solver.model);
    if (!scene.specimen) return;
    if (!scenario.uniform()) one.coupling = word_of(scenario.contact.coupling);
    one.integrator = word_of(scenario.solver.integrator);
    if (!scenario.uniform())
      one.rings = scenario.solver.rings ? std::to_string(*scenario.solver.rings) : "all";
    one.substep = scene.specimen->plan.substep;
    one.substeps = scene.specimen->plan.substeps;
    one.nodes = scene.specimen->network.nodes();
    one.tetrahedra = static_cast<int>(scene.specimen->mesh.tetrahedra.size());
  }

  void compare(const CaseChart& chart, scene::Scene& scene, const record::CaseRecord& record,
               Measurement& one) {
    one.simulated = record::end_time(record);
    if (record.outcome == record::Outcome::diverged) {
      one.status = Status::diverged;
      one.note = record.reason + " after " + rounded_text(record.last_stable_time, 3) + " s";
      one.timings.clear();
      return;
    }
    one.status = Status::measured;
    const History got = history(scene.scenario, record);
    one.error = deviation(scene.scenario, got, chart.truth.moments);
    if (scene.specimen && !chart.surface.pieces.empty()) {
      scene.scenario.output.tissue = true;  // in a run of its own, which is not timed
      record::CaseRecord again;
      const StopScope scope(longest_);
      run::run_programme(scene, again);
      one.surface_error = run::surface_error(again, chart.surface.pieces);
    }
    if (one.variant.group != "integrator x time step") return;
    const History& exact = in_time(one);
    if (exact.empty()) return;
    one.time_error = deviation(scene.scenario, got, exact);
    one.time_floor = own_error(scene.scenario, exact).greatest;
  }

  // Reference in time of the model whose integrators are compared; empty without `modal`.
  const History& in_time(const Measurement& one) {
    const std::string name = "in_time_" + std::to_string(one.variant.of_case);
    const auto known = in_time_.find(name);
    if (known != in_time_.end()) return known->second;
    Truth found;
    const auto kept = journal_.references().find(name);
    if (kept != journal_.references().end()) {
      found = truth_of(kept->second);
    } else {
      Variant plain = one.variant;
      plain.settings = {"solver.model=" + one.model};
      if (const auto exact = exact_in_time(asked_, plain, known_modes_))
        found = {"modal", "exact in time", *exact};
      StopScope::end_if_stopped();
      journal_.add_reference(name, history_table(found));
    }
    return in_time_[name] = found.moments;
  }

  const Asked& asked_;
  const ChartOptions& options_;
  double longest_;  // s
  Journal& journal_;
  const std::function<void(const ChartProgress&)>& told_;
  std::vector<CaseChart> charts_;
  std::map<std::string, History> in_time_;
  scene::SpecimenShapes shapes_;                  // meshes of all variants
  integrate::KnownModes known_modes_;             // of the last body
  std::map<std::string, double> seconds_a_step_;  // by all choices but the time step
  Stopwatch start_, first_end_;                   // of all rounds; of the first one
  int done_ = 0, all_ = 0, made_ = 0;
};

// What follows the first row, us per ms.
double cost_of(const Measurement& one, const Timing& timing) {
  const double longer = one.simulated - one.first_simulated;
  if (longer <= 0.0) return 1e3 * timing.whole / std::max(one.simulated, 1e-12);
  return 1e3 * (timing.whole - timing.first_row) / longer;
}

template <class Of>
std::vector<double> each(const Measurement& one, const Of& of) {
  std::vector<double> values;
  for (const Timing& timing : one.timings) values.push_back(of(timing));
  return values;
}

}  // namespace

std::vector<double> Measurement::costs() const {
  return each(*this, [&](const Timing& timing) { return cost_of(*this, timing); });
}
std::vector<double> Measurement::setups() const {
  return each(*this, [](const Timing& timing) { return timing.build + timing.first_row; });
}
std::vector<double> Measurement::totals() const {
  return each(*this, [](const Timing& timing) { return timing.build + timing.whole; });
}

std::vector<CaseChart> measure(const Asked& asked, const ChartOptions& options, Journal& journal,
                               const std::function<void(const ChartProgress&)>& told) {
  return Measurer(asked, options, journal, told).all();
}

}  // namespace palpate::chart
