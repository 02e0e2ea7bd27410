// Prepares a live run, carries it out, and makes its record.
#include "live/live.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"
#include "base/units.h"
#include "contact/hertz.h"
#include "contact/passivity.h"
#include "device/clock.h"
#include "device/link.h"
#include "device/safety.h"
#include "live/touch.h"
#include "record/csv.h"
#include "run/family.h"
#include "run/findings.h"
#include "run/pace.h"

namespace palpate::live {
namespace {

using device::Kind;

constexpr int cost_frames = 200;
constexpr int fifo_priority = 80;          // of 1 to 98
constexpr std::size_t stack = 512 * 1024;  // bytes, touched before the loop

std::string newtons(double force) { return rounded_text(force, 3) + " N"; }
std::string milli(double length) { return rounded_text(1e3 * length, 3) + " mm"; }

// A recording is computed as fast as possible, with the times in the file.
device::Clock::Kind clock_of(const LiveOptions& options) {
  const bool recording =
      std::holds_alternative<device::RecordingAddress>(device::parse_link(options.link));
  return recording ? device::Clock::Kind::stepped : options.clock;
}

device::Purpose purpose_of(const LiveOptions& options) {
  return options.act == LiveOptions::Act::command ? device::Purpose::command
                                                  : device::Purpose::look;
}

// The parts of the identity that the device reports.
std::vector<std::string> told(const device::Identity& identity) {
  std::vector<std::string> parts;
  for (const std::string& one : {identity.model, identity.id, identity.firmware, identity.dialect})
    if (!one.empty()) parts.push_back(one);
  return parts;
}

std::string limit_sentence(const device::Limits& limits) {
  std::vector<std::string> parts;
  if (std::isfinite(limits.force)) parts.push_back(newtons(limits.force));
  if (std::isfinite(limits.speed)) parts.push_back(milli(limits.speed) + "/s");
  if (std::isfinite(limits.low) || std::isfinite(limits.high))
    parts.push_back(milli(limits.low) + " to " + milli(limits.high));
  parts.push_back("a sample every " + quantity_text(limits.period, unit::ms));
  return "the device's own limits: " + joined(parts, ", ");
}

// A sentence on the depth at which the device begins to generate energy, by Colgate and Brown's
// bound [passive] with a delay of one frame.
std::string passivity_sentence(const scene::Scene& scene, double frame) {
  const double damping = scene.scenario.device.damping.value_or(device::ArmRules{}.damping);
  contact::PointLaw law;
  law.coefficient = contact::hertz::force(1.0, scene.law().radius, scene.law().modulus);
  const double depth =
      contact::passive_depth(law, {.damping = damping, .frame = frame, .delay = frame});
  const std::string what = std::string(scene.scenario.device.damping ? "" : "an assumed ") +
                           rounded_text(damping, 3) + " N s/m of the device";
  if (!std::isfinite(depth))
    return "passivity: with " + what + " the bound holds at any depth of this tissue";
  return "passivity: with " + what + " and frames of " + rounded_text(1e3 * frame, 3) +
         " ms the bound fails below " + milli(depth) +
         " of this tissue; beyond that depth the tissue is rendered no stiffer than there";
}

// For a recording the model follows the travel, as for an arm.
LiveEnd run_loop(Kind kind, LiveLoop& loop) {
  switch (kind) {
    case Kind::stand: return run_stand(loop);
    case Kind::gauge: return run_gauge(loop);
    case Kind::arm:
    case Kind::recording: return run_arm(loop);
  }
  return {};
}

}  // namespace

double most_force(const LiveOptions& options, Kind kind) {
  return options.most_force.value_or(kind == Kind::stand ? device::StandRules{}.force
                                                         : device::ArmRules{}.force);
}

LiveEnd ended_by_link(device::Trip trip, device::Fault fault) {
  LiveEnd end{LiveEnd::Why::link, std::string(device::trip_text(trip))};
  const bool said = trip == device::Trip::brake && fault == device::Fault::brake;
  if (fault != device::Fault::none && !said)
    end.sentence += ": " + std::string(device::fault_text(fault));
  if (trip == device::Trip::inside_tissue)
    end.sentence += "; move it out and begin again, or give another `--surface`";
  if (trip == device::Trip::not_verified)
    end.sentence += "; see that the device stands still, by its own stop if it does not";
  return end;
}

void refuse_beyond_device(const scene::Scene& scene, const std::string& file,
                          const LiveOptions& options) {
  const Place place{file, 0, 0};
  const scenario::Resolved& asked = scene.scenario;
  if (asked.uniform())
    throw InputError(place,
                     "is a uniform test, which no device carries out; give it `indent` steps, or "
                     "remove `--device`");
  const device::Address address = device::parse_link(options.link);
  if (!std::holds_alternative<device::StandAddress>(address) &&
      !std::holds_alternative<device::GaugeAddress>(address))
    return;
  for (std::size_t i = 0; i < asked.steps.size(); ++i)
    if (std::holds_alternative<scenario::Slide>(asked.steps[i]))
      throw InputError(place,
                       "step " + std::to_string(i + 1) +
                           " is a `slide`, and this device goes up and down only; leave it out");
}

Live::Live(const scene::Scene& scene, const LiveOptions& options)
    : scene_(&scene),
      options_(&options),
      clock_(clock_of(options)),
      tap_(options.traffic == LiveOptions::Traffic::kept ? std::make_unique<device::Tap>()
                                                         : nullptr),
      model_(std::make_unique<LiveModel>(scene)),
      link_(options.link, purpose_of(options), clock_, tap_.get()) {}

Live::~Live() = default;

// Refuses a command while the hand is inside the tissue. The loop checks this again.
void Live::refuse_inside(std::vector<std::string>& lines) {
  constexpr double wait = 0.25;  // s
  if (!options_->surface) return;
  const device::Sample sample = link_.sample(wait);
  const double depth = *options_->surface - sample.position.z();
  if (sample.arrival != device::Arrival::fresh || !(depth > 0.0)) return;
  const std::string sentence =
      "the finger is " + milli(depth) +
      " inside the tissue; move it out and begin again, or give another `--surface`";
  if (options_->act == LiveOptions::Act::command)
    throw LinkError("palpate: " + options_->link + ": " + sentence);
  lines.push_back(sentence);
}

std::string Live::step_sentence(int step) const {
  return "step " + std::to_string(step) + ": " +
         guidance(scene_->scenario.steps[as_index(step - 1)]);
}

std::vector<std::string> Live::plan(const std::string& file) {
  const device::Identity& identity = link_.identity();
  const device::Limits& limits = link_.limits();
  const bool real = clock_.kind() == device::Clock::Kind::monotonic;
  std::vector<std::string> lines;
  lines.push_back(
      options_->link + ": " +
      (identity.kind == Kind::recording ? "a recording" : joined(told(identity), ", ")));
  lines.insert(lines.end(), identity.notes.begin(), identity.notes.end());
  if (identity.kind != Kind::recording) {
    lines.push_back(limit_sentence(limits));
    const double most = most_force(*options_, identity.kind);
    if (identity.kind == Kind::arm) {
      const device::ArmRules rules;
      lines.push_back("the force sent is at most " + newtons(most) + ", changes by at most " +
                      rounded_text(rules.slew) + " N/s, and rises from 0 in the first " +
                      rounded_text(rules.start_time) + " s");
      lines.push_back(passivity_sentence(*scene_, limits.period));
      refuse_inside(lines);
    } else if (identity.kind == Kind::gauge) {
      lines.push_back(
          "the gauge only measures: move it by hand or by its own stage" +
          std::string(!limits.measures_travel ? ""
                      : options_->surface
                          ? ""
                          : "; the surface is where the travel is 0, as no `--surface` is given"));
    } else {
      lines.push_back("the stand is stopped beyond " + newtons(most) +
                      " and outside of its travel, from " +
                      milli(scene::deepest_travel(scene_->scenario, scene_->law())) +
                      " below the surface to 2 mm above it or where it is now");
    }
  }
  for (int step = 1; step <= static_cast<int>(scene_->scenario.steps.size()); ++step)
    lines.push_back(step_sentence(step));

  const Place place{file, 0, 0};
  if (scene_->specimen && scene_->specimen->plan.time_step > limits.period * (1.0 + 1e-6) &&
      identity.kind != Kind::recording)
    throw InputError(place, "the mesh moves in steps of " +
                                quantity_text(scene_->specimen->plan.time_step, unit::ms) +
                                ", longer than the device's " +
                                quantity_text(limits.period, unit::ms) +
                                "; set `solver.time_step` to that");
  if (identity.kind == Kind::recording) return lines;
  const FrameCost predicted = predict_cost(*scene_, *model_, limits.period, cost_frames);
  if (!model_->start_again()) model_ = std::make_unique<LiveModel>(*scene_);
  const std::string cost = "the model takes " + rounded_text(1e6 * predicted.median, 3) +
                           " µs a frame, " + rounded_text(1e6 * predicted.p99, 3) +
                           " µs in one of 100, of " + rounded_text(1e6 * limits.period, 3) + " µs";
  lines.push_back(cost);
  if (real && predicted.median > 0.8 * limits.period)
    throw InputError(place, cost +
                                ": it cannot keep the device's pace; take a cheaper model, as "
                                "`solver.integrator = \"modal\"` or `solver.model = \"hertz\"`");
  if (real && predicted.p99 > 0.8 * limits.period)
    lines.push_back("some frames will be late: " + cost);
  if (identity.kind == Kind::stand && predicted.force > most_force(*options_, Kind::stand))
    throw InputError(place, "the loading history is predicted to press with " +
                                newtons(predicted.force) + ", beyond the ceiling of " +
                                newtons(most_force(*options_, Kind::stand)) +
                                "; press less deep, or give `--max-force`");
  return lines;
}

const char* Live::rows_name() const {
  return link_.limits().measures_travel ? "force_indentation.csv" : "force_time.csv";
}

Live::Result Live::go(const std::atomic<bool>& stop, const Output& output) {
  Result result;
  LiveModel& model = *model_;
  device::Health health;
  // In lock-step, as with a recording, the loop waits for a slow disk and loses no row.
  const bool stepped = clock_.kind() == device::Clock::Kind::stepped;
  LiveLog log([&](int step) { output.say(step_sentence(step)); },
              {.rows_file = output.rows_file,
               .case_name = scene_->name,
               .table = link_.limits().measures_travel ? record::contact_table
                                                       : record::measured_force_table,
               .tap = tap_.get(),
               .traffic_file = output.traffic_file,
               .on_trouble = output.on_warning,
               .when_full = stepped ? LogPlan::WhenFull::wait : LogPlan::WhenFull::drop});
  if (options_->priority == LiveOptions::Priority::realtime) {
    for (std::string sentence : {device::lock_memory(), device::use_fifo(fifo_priority)})
      if (!sentence.empty()) result.warnings.push_back(std::move(sentence));
    device::prefault_stack(stack);
  }
  LiveLoop loop{*scene_, *options_, link_, clock_, model, log, health, stop, output.say};
  result.end = run_loop(link_.identity().kind, loop);
  if (link_.identity().kind == Kind::arm) (void)link_.stop();
  if (options_->priority == LiveOptions::Priority::realtime) device::use_ordinary();

  record::CaseRecord& record = result.record = run::begin_case(*scene_);
  for (const LogRow& row : log.finish()) {
    record.contact.push_back(row.contact);
    record.measured.push_back(row.measured);
  }
  result.rows = record.contact.size();
  const double last_time = record.contact.empty() ? 0.0 : record.contact.back().time;
  const bool follows = link_.limits().measures_travel;
  if (!follows) {
    // Without travel the model has not followed, and there is nothing to find in it.
    double most = 0.0;
    for (const record::MeasuredRow& row : record.measured) most = std::max(most, row.force);
    record.answer = {};
    record.answer.model = "Forces over time, without the model: the gauge's lines have no travel.";
    record.answer.error = "Largest measured force: " + rounded_text(most, 3) + " N.";
    if (!log.rows_are_written())
      record.attached.emplace_back(rows_name(),
                                   record::csv_text(record::measured_force_table({record})));
    record.contact.clear();
    record.measured.clear();
  }
  result.rows_are_written = log.rows_are_written();
  notes_.insert(notes_.end(), log.troubles().begin(), log.troubles().end());
  result.warnings.insert(result.warnings.end(), loop.warnings.begin(), loop.warnings.end());
  if (loop.dropped > 0.0)
    result.warnings.push_back(rounded_text(loop.dropped, 3) +
                              " s of late frames are dropped from the model's time: the tissue's "
                              "relaxation and waves lag behind by that time");
  for (const std::vector<std::string>& sentences :
       {device::event_sentences(link_.traffic().events), device::health_warnings(health)})
    result.warnings.insert(result.warnings.end(), sentences.begin(), sentences.end());
  if (loop.softened > 0)
    notes_.push_back(std::to_string(loop.softened) +
                     " frames were rendered less stiff than the tissue, because the device cannot "
                     "render it passively");
  using Why = LiveEnd::Why;
  if (result.end.why == Why::too_long) record.warnings.push_back(result.end.sentence);
  if (result.end.why == Why::model) record.outcome = record::Outcome::diverged;
  if (result.end.why == Why::link || result.end.why == Why::interrupted)
    record.outcome = record::Outcome::stopped;
  if (record.outcome != record::Outcome::completed)
    (void)run::end_early(record, record.outcome, result.end.sentence);
  record.last_stable_time = last_time;
  if (const auto imbalance = model.imbalance())
    record.findings.push_back({"energy_imbalance", *imbalance});
  if (follows) run::add_findings(*scene_, record);
  // Half a run that a fault of the device ended says nothing of the specimen.
  if (measures_force() && follows && result.end.why != Why::link) {
    const scenario::Resolved& asked = scene_->scenario;
    result.verdict =
        judge(measured_curve(record, asked.steps, std::span(loop.free.force).first(loop.free.count),
                             loop.moved_until),
              asked.solver.tolerance);
    for (record::Finding& finding : verdict_findings(*result.verdict))
      record.findings.push_back(std::move(finding));
  }
  device::Identity identity = link_.identity();
  identity.notes.insert(identity.notes.end(), notes_.begin(), notes_.end());
  identity.notes.insert(identity.notes.end(), result.warnings.begin(), result.warnings.end());
  identity.notes.push_back(clock_.kind() == device::Clock::Kind::monotonic
                               ? "times are of the machine's monotonic clock"
                               : "times are of a clock in lock-step with the device");
  record.attached.emplace_back(
      "device_health.json", device::health_json(identity, link_.limits(), link_.traffic(), health));
  return result;
}

// A line through the readings of every motion; what lies between two of them is a hold.

namespace {

constexpr double shortest_hold = 1e-3;  // s: the first hold exists however early the stand sets off
constexpr double edge = 0.15;           // of a way, at both ends, where the stand changes its speed
constexpr int fewest = 5;               // readings

struct Way {
  double rate = 0.0;              // m/s, along travel, below 0 upwards
  double begin = 0.0, end = 0.0;  // s
  double to = 0.0;                // m
};

double travel_of(const record::MeasuredRow& row) { return -row.place[2]; }

// The motion from `from` (m) in the rows of a step.
std::optional<Way> way_of(const record::CaseRecord& record, int step, double from) {
  double to = from;
  for (std::size_t i = 0; i < record.contact.size(); ++i)
    if (record.contact[i].step == step) to = travel_of(record.measured[i]);
  const double low = std::min(from, to) + edge * std::abs(to - from);
  const double high = std::max(from, to) - edge * std::abs(to - from);
  StraightLine line;
  for (std::size_t i = 0; i < record.contact.size(); ++i)
    if (const double travel = travel_of(record.measured[i]);
        record.contact[i].step == step && travel >= low && travel <= high)
      line.add(record.contact[i].time, travel - from);
  const auto found = line.found();
  if (!found || line.count() < fewest) return std::nullopt;
  Way way;
  way.rate = found->slope;
  way.begin = found->zero;
  way.end = way.begin + (to - from) / found->slope;
  way.to = to;
  return way;
}

}  // namespace

std::optional<std::vector<scenario::Step>> as_moved(const record::CaseRecord& record,
                                                    const std::vector<scenario::Step>& planned) {
  if (record.outcome != record::Outcome::completed || record.measured.empty()) return std::nullopt;
  std::vector<scenario::Step> steps;
  double time = 0.0;
  double travel = 0.0;
  for (std::size_t i = 0; i < planned.size(); ++i) {
    if (std::holds_alternative<scenario::Hold>(planned[i])) continue;
    const auto way = way_of(record, static_cast<int>(i) + 1, travel);
    if (!way) return std::nullopt;
    const double rest = way->begin - time;
    if (steps.empty() || rest > shortest_hold)
      steps.emplace_back(scenario::Hold{std::max(rest, shortest_hold)});
    if (way->to <= travel) return steps;
    steps.emplace_back(scenario::Indent{{way->to, false}, way->rate});
    time = way->end;
    travel = way->to;
  }
  const double rest = record.contact.back().time - time;
  if (!steps.empty() && rest > shortest_hold) steps.emplace_back(scenario::Hold{rest});
  return steps.empty() ? std::nullopt : std::optional(steps);
}

// A step ends when its goal is reached, not at its planned time.

using scenario::Hold;
using scenario::Indent;
using scenario::Retract;
using scenario::Slide;

bool Guide::is_over(const GuidePlace& place) const {
  const scenario::Step& step = (*steps_)[as_index(step_ - 1)];
  if (const auto* indent = std::get_if<Indent>(&step))
    return indent->to.second ? place.force >= indent->to.value
                             : -place.offset.z() >= indent->to.value;
  if (const auto* retract = std::get_if<Retract>(&step)) return -place.offset.z() <= retract->to;
  if (const auto* slide = std::get_if<Slide>(&step)) {
    const Vec3 way = place.offset - begin_.offset;
    return std::hypot(way.x(), way.y()) >= slide->by;
  }
  const auto* hold = std::get_if<Hold>(&step);
  return hold == nullptr || place.time - begin_.time >= hold->time;
}

void Guide::pass(const GuidePlace& place) {
  if (!any_) begin_ = place;
  any_ = true;
  if (done_ || !is_over(place)) return;
  begin_ = place;
  if (step_ == static_cast<int>(steps_->size()))
    done_ = true;
  else
    ++step_;
}

std::string guidance(const scenario::Step& step) {
  const auto mm = [](double length) { return rounded_text(1e3 * length) + " mm"; };
  const auto speed = [&](double rate) { return " at about " + mm(rate) + "/s"; };
  if (const auto* indent = std::get_if<Indent>(&step))
    return "press " +
           (indent->to.second ? "until the force is " + rounded_text(indent->to.value) + " N"
                              : "to " + mm(indent->to.value)) +
           speed(indent->rate);
  if (const auto* retract = std::get_if<Retract>(&step))
    return "withdraw to " + mm(retract->to) + speed(retract->rate);
  if (const auto* slide = std::get_if<Slide>(&step))
    return "slide sideways by " + mm(slide->by) + speed(slide->rate);
  if (const auto* hold = std::get_if<Hold>(&step))
    return "hold still for " + rounded_text(hold->time) + " s";
  return "nothing";
}

}  // namespace palpate::live
