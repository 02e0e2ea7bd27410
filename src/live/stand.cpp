// The loop of a stand: sets its limits, then carries out motions; safety rules check every reading.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.h"
#include "contact/hertz.h"
#include "device/mark10_protocol.h"
#include "device/safety.h"
#include "live/loop.h"
#include "live/touch.h"
#include "run/pace.h"

namespace palpate::live {
namespace {

using device::Arrival;
using device::Fault;
using device::LinkState;
using device::Motion;
using device::Sample;
using device::Trip;
using SafetyVerdict = device::StandSafety::Verdict;

constexpr double sample_wait = 0.06;   // s of wire time
constexpr double free_way = 2e-3;      // m above the surface, where motions begin
constexpr double travel_speed = 5e-3;  // m/s, out of contact
constexpr double feel_speed = 0.5e-3;  // m/s
constexpr double feel_noise = 5e-3;    // N: with more noise it goes slower, for more readings,
constexpr double feel_slowest = 0.2;   // down to this part of feel_speed
constexpr double feel_way = 20e-3;     // m, largest way down from the first position
constexpr double feel_step = 0.2e-3;   // m: the stand goes no further if nobody can stop it
constexpr double feel_to = 40e-3;      // N above the mean out of contact ends the search, or
constexpr double noise_to = 10.0;      // so many standard deviations of the noise, if that is more
constexpr int quiet_readings = 10;     // out of contact, for that mean and the noise
constexpr double found_to = 0.05;      // of the deepest travel: standard deviation of the surface
constexpr double rest_time = 1.0;      // s, for the tissue to recover from feeling
constexpr double arrived = 0.65 * device::mark10::travel_step;  // m: half a step, in mm or inches
constexpr double stuck_time = 1.0;  // s without a change of travel during a motion
constexpr int tries = 3;

// The mean of the last five forces.
class LastForces {
 public:
  void add(double force) { forces_[count_++ % forces_.size()] = force; }
  [[nodiscard]] double mean() const {
    const std::size_t have = std::min(count_, forces_.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < have; ++i) sum += forces_[i];
    return sum / static_cast<double>(have);
  }

 private:
  std::array<double, 5> forces_{};
  std::size_t count_ = 0;
};

// The deepest permitted travel, m: for a step to a force twice the predicted one, up to the radius.
double deepest_of(const scene::Scene& scene) {
  double deepest = scene::deepest_travel(scene.scenario, scene.law());
  for (const scenario::Step& step : scene.scenario.steps)
    if (const auto* indent = std::get_if<scenario::Indent>(&step); indent && indent->to.second)
      return std::min(2.0 * deepest, scene.scenario.finger.radius);
  return deepest;
}

class StandLoop {
  using Limits = device::Limits;

 public:
  explicit StandLoop(LiveLoop& loop)
      : loop_(loop),
        real_(loop.clock.kind() == device::Clock::Kind::monotonic),
        period_(loop.link.limits().period),
        deepest_(deepest_of(loop.scene)),
        safety_(device::StandRules{}) {}

  LiveEnd run() {
    start_ = next_ = loop_.clock.now();
    if (begin() && find_surface() && go_to_start()) (void)carry_out();
    loop_.health.end_of_samples(now());
    // The stand is stopped however the run ends, and a stop without confirmation is reported.
    if (!loop_.link.stop() && end_.why != LiveEnd::Why::link)
      end_ = ended_by_link(Trip::not_verified, Fault::not_verified);
    if (end_.why == LiveEnd::Why::link && !trip_noted_) note(LinkState::tripped, Fault::none);
    loop_.health.pass({now(), LinkState::closed, Trip::none, Fault::none});
    return end_;
  }

 private:
  bool ends(LiveEnd end) {
    if (!over_) end_ = std::move(end);
    over_ = true;
    return false;
  }
  bool ends(Trip trip, Fault fault) { return ends(ended_by_link(trip, fault)); }

  // Arms the rules for a range of travel (m), which is also set as limits in the stand.
  bool allow_range(double low, double high) {
    device::StandRules rules;
    rules.force = most_force(loop_.options, device::Kind::stand);
    rules.low = low;
    rules.high = high;
    rules.fastest = loop_.link.limits().speed;
    rules.stale.stale_after = loop_.link.limits().stale_after;
    rules.stale.lost_after = loop_.link.limits().lost_after;
    const Fault fault = put_limits(low, high);
    if (fault != Fault::none) return ends_by(fault);
    safety_ = device::StandSafety(rules);
    // New rules can only be armed after a reading.
    for (int i = 0; i < 10 && !over_; ++i) {
      const Sample sample = read();
      if (safety_.step(now(), sample) == SafetyVerdict::stop)
        return ends(safety_.tripped(), sample.fault);
      if (sample.arrival == Arrival::fresh && safety_.arm(fault)) {
        note(LinkState::armed, Fault::none);
        return true;
      }
    }
    return ends({LiveEnd::Why::link, "the stand is at " + rounded_text(1e3 * last_.position.z()) +
                                         " mm, outside of what this run may travel, " +
                                         rounded_text(1e3 * low) + " to " +
                                         rounded_text(1e3 * high) + " mm; jog it there"});
  }

  Fault put_limits(double low, double high) {
    Fault fault = Fault::not_verified;
    for (int i = 0; i < tries && fault != Fault::none && fault != Fault::hung_up; ++i)
      fault = loop_.link.set_travel_limits(low, high);
    return fault;
  }

  bool ends_by(Fault fault) {
    const bool lost = fault == Fault::hung_up || fault == Fault::unguarded;
    return ends(lost ? Trip::link_lost : Trip::not_verified, fault);
  }

  [[nodiscard]] double now() const { return loop_.clock.now() - start_; }

  void note(LinkState state, Fault fault) {
    loop_.health.pass({now(), state, safety_.tripped(), fault});
    trip_noted_ = trip_noted_ || state == LinkState::lost || state == LinkState::tripped;
  }

  Sample read() {
    if (real_) {
      next_ = std::max(next_ + period_, loop_.clock.now());
      loop_.clock.sleep_until(next_);
      loop_.health.lateness.add(loop_.clock.now() - next_);
    }
    Sample sample = loop_.link.sample(real_ ? sample_wait : stepped_wait);
    loop_.health.count(now(), sample);
    if (sample.arrival != Arrival::fresh) return sample;
    last_ = sample;
    forces_.add(sample.force);
    if (reaching_) loop_.free.add(sample.force);
    return sample;
  }

  bool begin() {
    note(LinkState::open, Fault::none);
    Sample sample;
    for (int i = 0; i < 20 && sample.arrival != Arrival::fresh; ++i) {
      if (loop_.stop.load()) return ends({LiveEnd::Why::interrupted, "it was interrupted"});
      sample = read();
      if (sample.arrival == Arrival::lost) return ends(Trip::link_lost, sample.fault);
    }
    if (sample.arrival != Arrival::fresh) return ends(Trip::link_lost, Fault::silent);
    return true;
  }

  // Takes one reading and acts on it. Returns false when the run is over.
  bool poll() {
    if (over_) return false;
    if (loop_.stop.load()) return ends({LiveEnd::Why::interrupted, "it was interrupted"});
    if (now() > loop_.options.longest) return ends({LiveEnd::Why::too_long, "the time is up"});
    const double before = loop_.clock.now();
    const Sample sample = read();
    const double begun = device::wire_time();
    switch (safety_.step(now(), sample)) {
      case SafetyVerdict::stop:
        note(sample.arrival == Arrival::lost ? LinkState::lost : LinkState::tripped, sample.fault);
        return ends(safety_.tripped(), sample.fault);  // run() stops the stand
      case SafetyVerdict::halt:
        note(LinkState::stale, sample.fault);
        ++loop_.health.rules.stale;
        if (!halted_) (void)loop_.link.stop();
        halted_ = true;
        break;
      case SafetyVerdict::go_on:
        // The guard process may have stopped the stand while this one stood still.
        if ((halted_ || sample.fault == Fault::guarded) && !send(motion_)) return false;
        halted_ = false;
        note(LinkState::armed, Fault::none);
        break;
    }
    if (sample.arrival == Arrival::fresh && programme_) follow(sample, sample.taken - start_);
    loop_.health.compute.add(device::wire_time() - begun);
    if (real_ && loop_.clock.now() > before + 2.0 * period_) ++loop_.health.deadline_misses;
    return !over_;
  }

  bool send(const Motion& wanted) {
    const Motion motion = safety_.allow(wanted);
    if (motion.act == Motion::Act::stop) return true;
    Fault fault = Fault::not_verified;
    for (int i = 0; i < tries && fault != Fault::none && fault != Fault::hung_up; ++i)
      fault = loop_.link.command_motion(motion);
    return fault == Fault::none || ends_by(fault);
  }

  // What ends a motion before its target: a change of the force of either sign.
  struct Until {
    double force = Limits::none;      // N
    double quiet = 0.0;               // N, from which it changes
    SurfaceSearch* search = nullptr;  // receives the readings; the force is a mean then
  };

  // Moves to the height `target` (m), which is also set as the stand's limit.
  bool go(double target, double speed, const Until& until) {
    const double z = last_.position.z();
    if (std::abs(target - z) <= arrived) return true;
    const bool down = target < z;
    const double asked = now();
    const Fault fault = down ? put_limits(target, high_) : put_limits(low_, target);
    if (fault != Fault::none) return ends_by(fault);
    motion_ = {down ? Motion::Act::down : Motion::Act::up, speed};
    if (!send(motion_)) return false;
    lead_ = now() - asked;
    if (waiting_) start_programme();
    const bool there = wait_for(target, until);
    motion_ = {};
    arrived_at_ = last_.received - start_;
    return there;
  }

  bool wait_for(double target, const Until& until) {
    double moved_at = now();
    double before = last_.position.z();
    while (poll()) {
      if (until.search != nullptr) until.search->add(last_.taken, last_.position.z(), last_.force);
      const double change = (until.search != nullptr ? forces_.mean() : last_.force) - until.quiet;
      const bool felt = std::abs(change) >= until.force;
      // The stand is stopped even at its limit: while braking it would continue if the limit moved.
      if (felt || std::abs(last_.position.z() - target) <= arrived) {
        if (!loop_.link.stop()) return ends(Trip::not_verified, Fault::not_verified);
        if (!felt || change > 0.0) return true;
        return ends(
            {LiveEnd::Why::link, "the force fell by " + rounded_text(-change, 3) +
                                     " N in the press: the gauge shows compression as negative; "
                                     "change its polarity (IPOL), or the way it is mounted"});
      }
      if (last_.position.z() != before || halted_) moved_at = now();
      before = last_.position.z();
      // At the lowest speed of the stand its reading changes only every 2.4 s.
      const double patience = stuck_time + 3.0 * device::mark10::travel_step / motion_.speed;
      if (now() > moved_at + patience)
        return ends({LiveEnd::Why::link, "the stand stopped on its way, at " +
                                             rounded_text(1e3 * before) + " mm instead of " +
                                             rounded_text(1e3 * target) + " mm"});
    }
    return false;
  }

  bool wait(double time) {
    const double until = now() + time;
    while (now() < until)
      if (!poll()) return false;
    return true;
  }

  bool find_surface() {
    if (loop_.options.surface) {
      surface_ = *loop_.options.surface;
      return true;
    }
    const double from = last_.position.z();
    low_ = from - feel_way;
    high_ = from + free_way;
    if (!allow_range(low_, high_)) return false;
    Readings rest;
    for (int i = 0; i < quiet_readings; ++i) {
      if (!poll()) return false;
      rest.add(last_.force);
    }
    const double quiet = rest.mean();
    const double noise =
        rest.deviation() * std::sqrt(quiet_readings / static_cast<double>(quiet_readings - 1));
    SurfaceSearch search(loop_.scene.relaxation);
    // No deeper than the loading history presses: to the force of relaxed tissue there.
    const contact::SphereLaw& law = loop_.scene.law();
    const double deep = contact::hertz::force(deepest_, law.radius, law.modulus);
    const Until until{.force = std::max(feel_to, std::min(noise_to * noise, deep)),
                      .quiet = quiet,
                      .search = &search};
    const double speed = feel_speed * std::clamp(feel_noise / noise, feel_slowest, 1.0);
    while (forces_.mean() - quiet < until.force) {
      const double z = last_.position.z();
      if (z <= low_ + arrived)
        return ends({LiveEnd::Why::link, "nothing was felt within " + rounded_text(1e3 * feel_way) +
                                             " mm; jog the stand nearer, or give `--surface`"});
      if (!go(std::max(low_, z - feel_step), speed, until)) return false;
    }
    const auto found = search.find();
    if (!found)
      return ends({LiveEnd::Why::link,
                   "the force does not grow with depth where it was felt; give `--surface`"});
    if (found->error > found_to * deepest_)
      return ends({LiveEnd::Why::link,
                   "the gauge scatters by " + rounded_text(1e3 * found->noise, 2) +
                       " mN, by which the surface is known to " +
                       rounded_text(1e3 * found->error, 2) + " mm only; give `--surface`"});
    surface_ = found->surface;
    felt_ = true;
    return true;
  }

  bool go_to_start() {
    low_ = std::min(surface_ - deepest_, last_.position.z());
    high_ = std::max(surface_ + free_way, last_.position.z());
    if (!allow_range(low_, high_)) return false;
    if (felt_ && !go(surface_ + free_way, travel_speed, {})) return false;
    if (low_ < surface_ - deepest_) {  // the search went deeper than the loading history
      low_ = surface_ - deepest_;
      if (!allow_range(low_, high_)) return false;
    }
    // The finger is above the surface: these readings show the gauge's zero.
    reaching_ = true;
    const bool there = (!felt_ || wait(rest_time)) && go(surface_, travel_speed, {});
    reaching_ = false;
    return there;
  }

  // The time of the loading history begins with its first motion.
  void start_programme() {
    waiting_ = false;
    programme_start_ = now();
    programme_ = true;
    follow(last_, programme_start_);
  }

  bool carry_out() {
    waiting_ = true;
    if (std::holds_alternative<scenario::Hold>(loop_.scene.scenario.steps.front()))
      start_programme();
    double travel = 0.0;  // m, as planned
    for (const scenario::Step& step : loop_.scene.scenario.steps) {
      ++step_;
      bool good = false;
      if (const auto* indent = std::get_if<scenario::Indent>(&step)) {
        travel = indent->to.second ? deepest_ : indent->to.value;
        good = go(surface_ - travel, indent->rate,
                  {.force = indent->to.second ? indent->to.value : Limits::none});
        if (good && indent->to.second && last_.force < indent->to.value)
          good = ends({LiveEnd::Why::link, "the force of step " + std::to_string(step_) +
                                               " was not reached at the largest displacement"});
      } else if (const auto* retract = std::get_if<scenario::Retract>(&step)) {
        good = go(surface_ - retract->to, retract->rate, {});
      } else if (const auto* hold = std::get_if<scenario::Hold>(&step)) {
        // The next motion begins lead_ after its command.
        const double until = arrived_at_ + hold->time - lead_;
        good = wait(std::max(0.0, until - now()));
      }
      if (!good) return false;
    }
    return true;
  }

  // Advances the model to the position that was measured at `taken` (s) and writes a row.
  void follow(const Sample& sample, double taken) {
    const double time = followed_ = std::max(followed_, taken - programme_start_);
    const Vec3 offset(0.0, 0.0, sample.position.z() - surface_);
    if (auto wrong = loop_.model.follow(offset, time)) {
      (void)ends({LiveEnd::Why::model, *wrong});
      return;
    }
    LogRow row{run::contact_row(loop_.scene, loop_.model.touch()), {}};
    row.contact.step = std::max(1, step_);
    row.contact.time = time;
    row.measured.place = {0.0, 0.0, offset.z()};
    row.measured.force = sample.force;
    loop_.log.push(row);
  }

  LiveLoop& loop_;
  bool real_;
  double period_;   // s
  double deepest_;  // m, of travel
  device::StandSafety safety_;
  Sample last_;                   // the last fresh one
  LastForces forces_;             // of the last fresh ones
  Motion motion_;                 // continues after a halt
  double start_ = 0.0;            // s, of the clock
  double next_ = 0.0;             // s, of the clock: time of the next reading
  double surface_ = 0.0;          // m, along the stand's z
  double low_ = 0.0;              // m, the stand's range
  double high_ = 0.0;             // m
  double programme_start_ = 0.0;  // s
  double followed_ = 0.0;         // s, time of the last row
  double lead_ = 0.0;             // s, from the limits and command of a motion to its start
  double arrived_at_ = 0.0;       // s, end of the last motion
  int step_ = 0;
  bool felt_ = false;
  bool halted_ = false;
  bool reaching_ = false;   // on the way to the surface from above it
  bool waiting_ = false;    // for the loading history's first motion
  bool programme_ = false;  // the loading history is running
  bool over_ = false;
  bool trip_noted_ = false;  // among the states of device_health.json
  LiveEnd end_;
};

}  // namespace

LiveEnd run_stand(LiveLoop& loop) { return StandLoop(loop).run(); }

}  // namespace palpate::live
