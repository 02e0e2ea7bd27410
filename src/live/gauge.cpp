// The loop of a gauge that only reads: the model follows the travel, or forces are written alone.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/text.h"
#include "device/safety.h"
#include "live/loop.h"
#include "live/touch.h"
#include "run/pace.h"
#include "scenario/programme.h"

namespace palpate::live {
namespace {

using device::Arrival;
using device::Fault;
using device::LinkState;
using device::Sample;
using device::Trip;

constexpr double longest_wait = 0.1;  // s, after which a signal is noticed
constexpr double late = 1.5;          // periods without a line: one is missing
constexpr double told_tare = 0.1;     // of `start_force`
constexpr double given_up = 0.5;      // of the travel asked for: a withdrawal after it ends the run
constexpr double still = 10.0;        // s without motion in contact, which no step asks for
constexpr double moved = 0.02;        // of the deepest travel: less is no motion
constexpr double known = 5.0;         // readings at rest that tell their mean and noise
constexpr double fall_time = 0.5;     // s below the force at rest, which no noise stays for
constexpr double silent = 5.0;        // s without a press, after which what it waits for is said

class GaugeLoop {
 public:
  explicit GaugeLoop(LiveLoop& loop)
      : loop_(loop),
        limits_(loop.link.limits()),
        guide_(loop.scene.scenario.steps),
        staleness_({.stale_after = limits_.stale_after, .lost_after = limits_.lost_after}),
        surface_(loop.options.surface.value_or(0.0)),
        planned_(scenario::programme_time(loop.scene.scenario)),
        begun_(!limits_.start_force || limits_.measures_travel) {}

  LiveEnd run() {
    start_ = loop_.clock.now();
    note(LinkState::open, Fault::none);
    while (!over_) frame();
    loop_.health.end_of_samples(loop_.clock.now() - start_);
    note(LinkState::closed, Fault::none);
    if (rows_ == 0 &&
        (end_.why == LiveEnd::Why::done || (end_.why == LiveEnd::Why::too_long && !begun_)))
      end_ = {LiveEnd::Why::link, "the force never rose by " + awaited()};
    return end_;
  }

 private:
  [[nodiscard]] bool stepped() const { return loop_.clock.kind() == device::Clock::Kind::stepped; }

  void note(LinkState state, Fault fault) {
    loop_.health.pass({loop_.clock.now() - start_, state,
                       state == LinkState::lost ? Trip::link_lost : Trip::none, fault});
  }

  void ends(LiveEnd end) {
    if (!over_) end_ = std::move(end);
    over_ = true;
  }

  void frame() {
    const Sample sample =
        loop_.link.sample(stepped() ? stepped_wait : std::min(longest_wait, limits_.lost_after));
    const double now = loop_.clock.now() - start_;
    const double begun = device::wire_time();
    // The link is asked more often than a slow gauge sends, and that is no frame.
    if (sample.arrival != Arrival::none || now - framed_ > late * limits_.period) {
      loop_.health.count(now, sample);
      framed_ = now;
    }
    staleness_.step(now, sample.arrival);
    const bool no_answer = staleness_.state() == device::Staleness::State::lost ||
                           (stepped() && sample.arrival == Arrival::none && ++unheard_ > 2);
    if (sample.fault == Fault::overload) {
      note(LinkState::tripped, sample.fault);
      ends(ended_by_link(Trip::overload, Fault::none));
    } else if (sample.arrival == Arrival::lost || no_answer) {
      note(LinkState::lost, sample.fault);
      ends(ended_by_link(Trip::link_lost,
                         sample.fault == Fault::none ? Fault::silent : sample.fault));
    } else if (sample.arrival == Arrival::fresh) {
      unheard_ = 0;
      note(LinkState::open, sample.fault);
      take(sample);
    } else if (staleness_.state() == device::Staleness::State::stale) {
      note(LinkState::stale, sample.fault);
    }
    if (loop_.stop.load()) ends({LiveEnd::Why::interrupted, "it was interrupted"});
    if (now >= loop_.options.longest) ends({LiveEnd::Why::too_long, "the time is up"});
    loop_.health.compute.add(device::wire_time() - begun);
  }

  // The change of the force (N) with which the rows begin.
  [[nodiscard]] double beginning() const {
    return std::max(*limits_.start_force, 6.0 * rest_.deviation());
  }

  // What the rows wait for, which may never come.
  [[nodiscard]] std::string awaited() const {
    return rounded_text(1e3 * beginning(), 3) + " mN above that at rest, " +
           (beginning() <= *limits_.start_force ? "the `start_force` of the settings"
                                                : "which is six times the noise of the gauge; "
                                                  "press harder, or use a quieter gauge");
  }

  // The time of a sample (s), by the gauge's own clock if its lines have it.
  [[nodiscard]] static double time_of(const Sample& sample) {
    return std::isfinite(sample.device_time) ? sample.device_time : sample.received;
  }

  void rested(std::vector<Sample>& readings) {
    for (const Sample& one : std::exchange(readings, {})) rest_.add(one.force);
  }

  // A force that falls as far as it should rise, and stays there, is no noise: the gauge's sign is
  // turned, or its first readings were those of a press. What falls more slowly than a press is
  // drift.
  void fell(const Sample& sample, double fall) {
    low_.push_back(sample);
    const double lasts = time_of(sample) - time_of(low_.front());
    if (lasts > planned_) return rested(low_);
    if (low_.size() < 3 || lasts < fall_time || fall < beginning()) return;
    ends({LiveEnd::Why::link, "the force fell by " + rounded_text(1e3 * fall, 3) +
                                  " mN below that at rest; turn the gauge's sign by a negative "
                                  "`force_scale`, or begin with the finger out of contact"});
  }

  // Without travel the time of the loading history begins with the contact: where a line through
  // F^(2/3) of the first readings is 0, as for a sphere that is pressed at a constant speed. Three
  // readings make a line; with fewer, contact began after the last reading without force.
  // Forces are those above the mean of the readings at rest, which is what a gauge shows that is
  // not tared.
  bool begins(const Sample& sample) {
    const double time = time_of(sample);
    if (rest_.count == 0) rest_.add(sample.force);
    const double least = *limits_.start_force;
    const double change = sample.force - rest_.mean();
    if (!(change < -least / 8.0)) rested(low_);
    if (!(change > least / 8.0)) {
      rested(first_);
      if (change < -least / 8.0 && rest_.count >= known)
        fell(sample, -change);
      else
        rest_.add(sample.force);
      line_ = StraightLine();
      last_free_ = time;
      return false;
    }
    line_.add(time, linear_in_depth(change));
    first_.push_back(sample);
    if (change < beginning()) return false;
    tare_ = rest_.mean();
    if (std::abs(tare_) > told_tare * least)
      loop_.warnings.push_back("the gauge showed " + rounded_text(1e3 * tare_, 3) +
                               " mN at rest, which is taken out of all forces; tare it");
    const auto line = line_.found();
    first_time_ = line && line->slope > 0.0 ? std::min(line->zero, time_of(first_.front()))
                                            : last_free_.value_or(time);
    for (const Sample& one : std::exchange(first_, {})) write(one);
    return true;
  }

  void take(const Sample& sample) {
    if (begun_) {
      if (rows_ == 0) first_time_ = time_of(sample);
      write(sample);
    } else {
      begun_ = begins(sample);
      if (begun_ || told_ || loop_.clock.now() - start_ < silent) return;
      told_ = true;
      loop_.say("waiting for the force to rise by " + awaited());
    }
  }

  // A person who stops short of a step's travel is not waited for.
  void look_for_an_end(double time, double travel) {
    deepest_ = std::max(deepest_, travel);
    const scenario::Step& step = loop_.scene.scenario.steps[as_index(guide_.step() - 1)];
    const auto* indent = std::get_if<scenario::Indent>(&step);
    const bool holds = std::holds_alternative<scenario::Hold>(step);
    if (std::abs(travel - rest_travel_) > moved * deepest_ || holds || deepest_ <= 0.0) {
      rest_travel_ = travel;
      moved_at_ = time;
    }
    const bool withdrawn = indent != nullptr && !indent->to.second && travel <= 0.0 &&
                           deepest_ > given_up * indent->to.value;
    if (!withdrawn && time - moved_at_ < still) return;
    if (!withdrawn) loop_.moved_until = moved_at_;
    ends({LiveEnd::Why::too_long,
          "step " + std::to_string(guide_.step()) + " was not carried out to its end: the finger " +
              (withdrawn ? "was withdrawn after " + rounded_text(1e3 * deepest_, 3) + " mm"
                         : "stands still at " + rounded_text(1e3 * travel, 3) + " mm")});
  }

  void write(const Sample& sample) {
    const double time = time_of(sample) - first_time_;
    const Vec3 offset(0.0, 0.0, limits_.measures_travel ? sample.position.z() - surface_ : 0.0);
    if (limits_.measures_travel) {
      if (auto wrong = loop_.model.follow(offset, time)) return ends({LiveEnd::Why::model, *wrong});
      guide_.pass({time, offset, loop_.model.touch().force()});
      look_for_an_end(time, -offset.z());
    } else if (time > planned_) {
      return ends({});
    }
    LogRow row{run::contact_row(loop_.scene, loop_.model.touch()), {}};
    row.contact.step = guide_.step();
    row.contact.time = time;
    row.measured.place = {0.0, 0.0, offset.z()};
    row.measured.force = sample.force - tare_;
    loop_.log.push(row);
    ++rows_;
    if (guide_.done()) ends({});
  }

  LiveLoop& loop_;
  const device::Limits& limits_;
  Guide guide_;
  device::Staleness staleness_;
  double surface_;           // m, in the gauge's z
  double planned_;           // s, of the loading history
  bool begun_;               // the rows have begun
  double start_ = 0.0;       // s, of the clock
  double framed_ = 0.0;      // s, since the start, of the last frame that was counted
  double first_time_ = 0.0;  // s, of the first row or of the contact
  Readings rest_;            // before the contact
  double tare_ = 0.0;        // N
  StraightLine line_;
  std::vector<Sample> first_;        // in contact, before the rows
  std::vector<Sample> low_;          // in a row below those at rest
  std::optional<double> last_free_;  // s, of the last reading without force
  double deepest_ = 0.0;             // m, of the travel
  double rest_travel_ = 0.0;         // m, of the last motion
  double moved_at_ = 0.0;            // s
  long long rows_ = 0;
  int unheard_ = 0;    // waits in a row without a line, in lock-step
  bool told_ = false;  // what it waits for
  bool over_ = false;
  LiveEnd end_;
};

}  // namespace

LiveEnd run_gauge(LiveLoop& loop) { return GaugeLoop(loop).run(); }

}  // namespace palpate::live
