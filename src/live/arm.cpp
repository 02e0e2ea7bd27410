// The loop of an arm. A frame checks the sample, advances the model, and sends the permitted force.
#include <algorithm>
#include <cmath>

#include "contact/passivity.h"
#include "device/safety.h"
#include "live/loop.h"
#include "run/pace.h"

namespace palpate::live {
namespace {

using device::Arrival;
using device::LinkState;
using device::Sample;
using device::Trip;

constexpr double box = 0.15;          // m, half the edge of the workspace around the first position
constexpr double longest_fall = 0.3;  // s, to bring the last force down to 0
constexpr double most_frames_behind = 8.0;

device::ArmRules rules_of(const LiveLoop& loop) {
  device::ArmRules rules;
  const device::Limits& limits = loop.link.limits();
  rules.force = most_force(loop.options, device::Kind::arm);
  rules.frame = limits.period;
  if (loop.scene.scenario.device.damping) rules.damping = *loop.scene.scenario.device.damping;
  rules.stale.stale_after = limits.stale_after;
  rules.stale.lost_after = limits.lost_after;
  return rules;
}

// Largest ratio of force to depth, N/m, that the device can render by Colgate and Brown's bound
// [passive] with a delay of one frame. The slope of Hertz's law is 3/2 of this ratio.
double stiffest_of(const device::ArmRules& rules) {
  return 2.0 / 3.0 *
         contact::passive_stiffness(
             {.damping = rules.damping, .frame = rules.frame, .delay = rules.frame});
}

class ArmLoop {
 public:
  explicit ArmLoop(LiveLoop& loop)
      : loop_(loop),
        recording_(loop.link.identity().kind == device::Kind::recording),
        real_(loop.clock.kind() == device::Clock::Kind::monotonic),
        period_(loop.link.limits().period),
        guide_(loop.scene.scenario.steps),
        rules_(rules_of(loop)),
        safety_(rules_),
        stiffest_(stiffest_of(rules_)) {}

  LiveEnd run() {
    if (!begin()) return end_;
    double next = loop_.clock.now();
    while (frame()) next = exchange(next);
    loop_.health.end_of_samples(now_);
    loop_.health.pass({now_, LinkState::closed, Trip::none, device::Fault::none});
    loop_.health.rules = safety_.counts();
    loop_.health.least_energy = safety_.observer().least();
    return end_;
  }

 private:
  // Takes the first sample, whose position determines the origin of the tissue. False if lost.
  bool begin() {
    for (int tries = 0; tries < 50 && sample_.arrival != Arrival::fresh; ++tries) {
      sample_ = loop_.link.sample(stepped_wait);
      if (sample_.arrival == Arrival::lost) break;
    }
    start_ = loop_.clock.now();
    loop_.health.pass({0.0, LinkState::open, Trip::none, device::Fault::none});
    if (sample_.arrival != Arrival::fresh) {
      end_ = ended_by_link(Trip::link_lost, sample_.fault);
      return false;
    }
    origin_ = recording_ ? Vec3::Zero() : sample_.position;
    if (!recording_) origin_.z() -= LiveOptions::below_hand;
    if (loop_.options.surface) origin_.z() = *loop_.options.surface;
    if (!recording_) {
      rules_.workspace = {sample_.position.array() - box, sample_.position.array() + box};
      safety_ = device::ArmSafety(rules_);
    }
    return true;
  }

  void finish(const LiveEnd& end) {
    if (ending_) return;
    ending_ = true;
    end_ = end;
    ended_at_ = now_;
    safety_.disarm();
  }

  // Computes one frame. Returns false when the loop is over and the last force sent is 0.
  bool frame() {
    const double begun = device::wire_time();
    now_ = loop_.clock.now() - start_;
    loop_.health.count(now_, sample_);
    if (recording_ && sample_.arrival == Arrival::lost) {
      // The rest of the loading history was not recorded.
      end_.why = guide_.done() ? LiveEnd::Why::done : LiveEnd::Why::too_long;
      end_.sentence = "the recording ended in step " + std::to_string(guide_.step());
      return false;
    }
    const bool good = recording_ ? sample_.arrival == Arrival::fresh : safety_.take(now_, sample_);
    if (good) {
      offset_ = sample_.position - origin_;
      measured_ = sample_.force;
    }
    follow();
    arm();
    if (loop_.model.touch().contacts.empty()) safety_.out_of_contact();
    const Vec3 wanted = failed_ ? Vec3(Vec3::Zero()) : softened(loop_.model.force());
    force_ = safety_.allow(now_, wanted);
    if (good || !recording_) write();
    note_state();
    if (safety_.tripped() != Trip::none && !ending_)
      finish(ended_by_link(safety_.tripped(), sample_.fault));
    if (loop_.stop.load()) finish({LiveEnd::Why::interrupted, "it was interrupted"});
    if (guide_.done()) finish({});
    if (now_ >= loop_.options.longest) finish({LiveEnd::Why::too_long, "the time is up"});
    loop_.health.compute.add(device::wire_time() - begun);
    if (!ending_) return true;
    // The last frames reduce the force to 0.
    const bool over = recording_ || sample_.arrival == Arrival::lost ||
                      safety_.freshness() == device::Staleness::State::lost ||
                      safety_.sent().isZero(0.0) || now_ > ended_at_ + longest_fall;
    return !over;
  }

  // Limits the force to the stiffness that the device can render passively.
  Vec3 softened(const Vec3& force) {
    const mechanics::SphereContact* deepest = loop_.model.touch().deepest();
    if (deepest == nullptr) return force;
    const double most = stiffest_ * std::max(0.0, deepest->approach);
    if (force.norm() <= most) return force;
    ++loop_.softened;
    return device::clamped_norm(force, most);
  }

  // Advances the model. If it is more than some frames behind, it drops the rest of the time.
  void follow() {
    const double passed = now_ - followed_;
    followed_ = now_;
    const bool limited = real_ && !recording_;
    const double taken = limited ? std::min(passed, most_frames_behind * period_) : passed;
    model_time_ += taken;
    loop_.dropped += passed - taken;
    if (failed_) return;
    if (auto wrong = loop_.model.follow(offset_, model_time_)) {
      failed_ = true;
      finish({LiveEnd::Why::model, *wrong});
    }
  }

  void arm() {
    if (loop_.options.act != LiveOptions::Act::command || recording_ || ending_) return;
    if (safety_.armed() || safety_.tripped() != Trip::none) return;
    // With a contact the finger is inside the tissue, even if it is above the plane z = 0.
    const bool inside = !loop_.model.touch().contacts.empty();
    if (safety_.arm(now_, inside ? std::max(1e-9, -offset_.z()) : 0.0)) return;
    if (inside && safety_.freshness() == device::Staleness::State::fresh)
      safety_.disarm(Trip::inside_tissue);
  }

  void write() {
    guide_.pass({now_, offset_, loop_.model.touch().force()});
    LogRow row{run::contact_row(loop_.scene, loop_.model.touch()), {}};
    row.contact.step = guide_.step();
    row.contact.time = now_;
    row.measured.place = {offset_.x(), offset_.y(), offset_.z()};
    row.measured.force = measured_;
    if (!recording_) row.measured.sent = {force_.x(), force_.y(), force_.z()};
    loop_.log.push(row);
  }

  void note_state() {
    LinkState state = safety_.armed() ? LinkState::armed : LinkState::open;
    if (safety_.freshness() == device::Staleness::State::stale) state = LinkState::stale;
    // The end of the loading history disarms the arm, which is no trip.
    if (safety_.tripped() != Trip::none && safety_.tripped() != Trip::by_hand)
      state = LinkState::tripped;
    if (sample_.arrival == Arrival::lost) state = LinkState::lost;
    if (recording_) return;
    const Trip why = state == LinkState::open ? Trip::none : safety_.tripped();
    loop_.health.pass({now_, state, why, sample_.fault});
  }

  // Sends the force and waits for the reply in the frame. Returns the start of the next frame, s.
  double exchange(double next) {
    if (recording_) {
      sample_ = loop_.link.sample(10.0 * loop_.link.limits().lost_after);
      return next;
    }
    (void)loop_.link.command_force(force_);
    if (!real_) {
      sample_ = loop_.link.sample(stepped_wait);
      return next;
    }
    next += period_;
    if (const double late = loop_.clock.now() - next; late > 0.0) {
      const double missed = std::floor(late / period_) + 1.0;
      loop_.health.deadline_misses += static_cast<std::uint64_t>(missed);
      next += missed * period_;
    }
    sample_ = loop_.link.sample(std::max(0.0, next - loop_.clock.now()));
    if (sample_.arrival != Arrival::lost) loop_.clock.sleep_until(next);
    loop_.health.lateness.add(loop_.clock.now() - next);
    return next;
  }

  LiveLoop& loop_;
  bool recording_;
  bool real_;
  double period_;  // s
  Guide guide_;
  device::ArmRules rules_;
  device::ArmSafety safety_;
  double stiffest_;  // N/m
  Sample sample_;
  double start_ = 0.0;          // s, of the clock
  double now_ = 0.0;            // s, since the start
  double followed_ = 0.0;       // s, time of the last follow()
  double model_time_ = 0.0;     // s
  Vec3 origin_ = Vec3::Zero();  // m, first touch in the device's axes
  Vec3 offset_ = Vec3::Zero();  // m, of the finger from origin_
  Vec3 force_ = Vec3::Zero();   // N, sent
  double measured_ = Sample::nan;
  bool failed_ = false;
  bool ending_ = false;
  double ended_at_ = 0.0;  // s
  LiveEnd end_;
};

}  // namespace

LiveEnd run_arm(LiveLoop& loop) { return ArmLoop(loop).run(); }

}  // namespace palpate::live
