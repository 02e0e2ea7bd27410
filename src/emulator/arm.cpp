// Processes messages: clock, faults, device and hand.
#include "emulator/arm.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace emulator {
namespace {

// Faults with `after_messages` begin with a message only, and not while time advances.
constexpr std::int64_t none_counted = -1;

double length(const Vec3& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// The events that faults send.
struct FaultEvent {
  std::string_view kind;
  const char *name, *level, *safety_type, *message;
};
constexpr const char* safety = "device-safety-triggered";
constexpr std::array fault_events{
    FaultEvent{"event_stall", safety, "warning", "stall_detected", "Motor stall detected"},
    FaultEvent{"event_ceiling", safety, "warning", "stability_ceiling",
               "Stability ceiling reached"},
    FaultEvent{"event_stage", safety, "warning", "fod_stage_changed",
               "FOD stage changed: guard -> hard"},
    FaultEvent{"event_unknown", safety, "error", "something_new", "Something new"},
    FaultEvent{"event_busy", "device-busy", "warning", "", "Device is in use"},
    FaultEvent{"event_disconnect", "device-disconnected", "warning", "", "Device was lost"},
    FaultEvent{"event_other", safety, "error", "ebrake_triggered", "Emergency brake engaged"},
    FaultEvent{"event_partial", safety, "error", "ebrake_triggered", "Emergency brake engaged"}};

}  // namespace

Arm::Arm(const ArmSettings& settings, Log& log)
    : settings_(settings),
      hand_(make_hand(settings.hand, 1.0 / static_cast<double>(hand_rate))),
      faults_(settings.faults),
      log_(&log) {
  if (settings.tissue) tissue_ = make_tissue(*settings.tissue, hand_.step);
}

void Arm::log_row(const char* kind, const std::string& text) {
  std::vector<double> values;
  for (const Vec3& v : {hand_.position, hand_.velocity, force_})
    values.insert(values.end(), v.begin(), v.end());
  values.push_back(hand_.work);
  log_->row(now_, kind, text, values);
}

void Arm::let_go() {
  force_ = {};
  mode_ = "idle";
}

// Advances the hand to `time` under the present force.
void Arm::run_to(Nanoseconds time) {
  now_ = std::max(now_, time);
  const std::int64_t wanted =
      now_ / 1'000'000 * (hand_rate / 1000) + now_ % 1'000'000 * hand_rate / 1'000'000'000;
  const bool held = faults_.lasts("brake", now_);
  for (; steps_ < wanted; ++steps_) {
    Vec3 other{};
    if (tissue_) other[2] = press(*tissue_, tissue_->settings.surface - hand_.position[2]);
    if (held)
      hold(hand_);
    else
      move(hand_, force_, other);
  }
}

void Arm::go_to(Nanoseconds time, std::int64_t messages) {
  for (auto next = faults_.next_time(); next && *next <= time; next = faults_.next_time()) {
    run_to(*next);
    begin_faults(messages);
  }
  // A command expires: without further messages the device is idle (Control Commands, 3.5).
  const Nanoseconds silence = last_message_ + nanoseconds(settings_.idle_after);
  if (settings_.clock == Clock::real && mode_ != "idle" && time >= silence) {
    run_to(silence);
    let_go();
    log_row("idle", "");
  }
  run_to(time);
  begin_faults(messages);
  const bool brake = faults_.lasts("brake", now_);
  const bool told = brake || faults_.lasts("event_brake", now_);
  if (told != braked_) {
    events_.push_back(event_message({"device-safety-triggered", told ? "error" : "notice",
                                     told ? "ebrake_triggered" : "ebrake_released",
                                     told ? "Emergency brake engaged" : "Emergency brake released"},
                                    settings_.device_id));
    braked_ = told;
  }
  if (brake || faults_.lasts("not_ready", now_) || faults_.lasts("power_off", now_)) let_go();
}

void Arm::begin_faults(std::int64_t messages) {
  for (const Fault& fault : faults_.begin(now_, messages)) {
    log_row("fault", fault.kind);
    begin_event(fault.kind);
    if (fault.kind == "rst") wanted_ = Act::reset_connection;
    if (fault.kind == "close_1000") wanted_ = Act::close_normal;
    if (fault.kind == "close_1011") wanted_ = Act::close_error;
    if (fault.kind == "reset") {
      wanted_ = Act::restart;
      ++session_;
      let_go();
    }
    if (fault.kind == "freeze") frozen_ = state();
  }
}

void Arm::begin_event(const std::string& kind) {
  if (kind == "events_close") events_end_ = true;
  if (kind == "event_garbage") events_.emplace_back(R"({"name":"device-safety-triggered",,)");
  if (kind == "event_huge")
    events_.push_back(event_message(
        {.name = "system-report", .level = "info", .message = std::string(200'000, '.')},
        settings_.device_id));
  for (int i = 0; kind == "event_flood" && i < 2000; ++i)
    events_.push_back(event_message({.name = "device-battery-low", .level = "warning"}, "0CAF"));
  for (const FaultEvent& event : fault_events) {
    if (event.kind != kind) continue;
    std::string text = event_message({event.name, event.level, event.safety_type, event.message},
                                     kind == "event_other" ? "0BAD" : settings_.device_id);
    if (kind == "event_partial") text.resize(text.size() / 2);
    events_.push_back(std::move(text));
  }
}

// Limits the vector's length. A vector whose length is not finite counts as no force.
void Arm::command(const Request& request) {
  let_go();
  if (!request.force || faults_.lasts("brake", now_) || faults_.lasts("not_ready", now_)) return;
  const double size = length(*request.force);
  mode_ = "force";
  if (!std::isfinite(size)) {
    ++clamped_;
    return;
  }
  const double scale = size > settings_.force_limit ? settings_.force_limit / size : 1.0;
  if (scale < 1.0) ++clamped_;
  for (std::size_t i = 0; i < 3; ++i) force_[i] = scale * (*request.force)[i];
  greatest_force_ = std::max(greatest_force_, length(force_));
}

ArmState Arm::state() const {
  return {.device_id = settings_.device_id,
          .position = hand_.position,
          .velocity = hand_.velocity,
          .force = force_,
          .mode = mode_,
          .in_use = in_use_,
          .form = settings_.form};
}

ArmState Arm::told() {
  if (!faults_.lasts("freeze", now_)) frozen_.reset();
  ArmState told = frozen_.value_or(state());
  if (faults_.lasts("id_change", now_)) told.device_id = "0BAD";
  if (faults_.lasts("jump", now_)) told.position[2] += faults_.value("jump");
  if (faults_.lasts("not_ready", now_)) told.ready = false;
  if (faults_.lasts("power_off", now_)) told.form.power = false;
  if (faults_.lasts("transform", now_)) told.form.transform_scale = 2.0;
  if (faults_.spoils("velocity_spike")) told.velocity[2] = -1000.0;
  return told;
}

Outgoing Arm::greet() {
  in_use_ = true;
  held_.reset();
  return {state_message(told(), settings_.service, Extent::full, session_)};
}

Outgoing Arm::reply(const Request& request) {
  const ArmState state = told();
  const Oddity oddity{.missing_field = faults_.spoils("missing_field"),
                      .wrong_type = faults_.spoils("wrong_type"),
                      .no_device = faults_.spoils("no_device"),
                      .second_device = faults_.lasts("second_device", now_),
                      .nan = faults_.spoils("nan"),
                      .huge = faults_.spoils("huge")};
  const bool odd = oddity.missing_field || oddity.wrong_type || oddity.no_device ||
                   oddity.second_device || oddity.nan || oddity.huge;
  const Extent extent = request.full_state ? Extent::full : Extent::update;
  return {spoilt(odd ? odd_message(state, settings_.service, oddity)
                     : state_message(state, settings_.service, extent, session_)),
          faults_.spoils("binary"),
          faults_.spoils("late") ? nanoseconds(faults_.value("late")) : 0};
}

std::string Arm::spoilt(std::string text) {
  if (faults_.spoils("empty")) text = "{}";
  if (faults_.spoils("invalid_json")) text = "{\"inverse3\":[{\"device_id\":,}";
  if (faults_.spoils("partial")) text.resize(text.size() / 2);
  return text;
}

Answer Arm::answer(const std::string& text) {
  begin_faults(messages_);
  const Request request =
      parse_request(text, settings_.service, settings_.device_id, settings_.form);
  if (wanted_ != Act::none || silent()) {  // the service does not read the message
    log_row("in", "(unheard) " + text);
    return {{}, std::exchange(wanted_, Act::none)};
  }
  last_message_ = now_;
  command(request);
  log_row("in", text);
  if (!request.warning.empty()) log_row("warning", request.warning);
  if (settings_.clock == Clock::lockstep) go_to(now_ + settings_.period, none_counted);
  Answer answer;
  Outgoing first = reply(request);
  if (first.delay > 0 && settings_.clock == Clock::lockstep)
    go_to(now_ + first.delay, none_counted);
  if (first.delay > 0) log_row("late", "");
  const std::size_t more = faults_.spoils("flood") ? 19999 : faults_.spoils("duplicate") ? 1 : 0;
  const bool lost = faults_.spoils("drop");
  if (!held_ && faults_.spoils("reorder")) {
    held_ = first;
  } else if (!lost) {
    answer.messages.push_back(first);
    answer.messages.insert(answer.messages.end(), more, first);
    if (held_) answer.messages.push_back(*std::exchange(held_, {}));
  }
  ++messages_;
  answer.act = std::exchange(wanted_, Act::none);
  return answer;
}

Act Arm::pass(Nanoseconds now) {
  if (settings_.clock == Clock::real) go_to(now, none_counted);
  return std::exchange(wanted_, Act::none);
}

void Arm::leave() {
  if (!in_use_) return;
  in_use_ = false;
  let_go();
  // When a closed socket is noticed depends on the machine, so a virtual clock's log omits it.
  if (settings_.clock == Clock::real) log_row("left", "");
}

bool Arm::silent() const { return faults_.lasts("half_open", now_); }

std::string Arm::devices() const {
  return state_message(state(), settings_.service, Extent::full, session_);
}

std::vector<std::string> Arm::take_events() {
  std::vector<std::string> events = std::exchange(events_, {});
  if (faults_.lasts("events_half_open", now_)) events.clear();
  return events;
}

bool Arm::take_events_end() { return std::exchange(events_end_, false); }

std::string Arm::summary() const {
  std::array<char, 512> text{};
  std::snprintf(
      text.data(), text.size(),
      "{\"summary\":{\"messages\":%lld,\"time_s\":%.9g,\"clamped\":%lld,\"greatest_force_N\":%.9g,"
      "\"work_by_device_J\":%.9g,\"most_work_by_device_J\":%.9g,\"most_hand_energy_J\":%.9g}}",
      static_cast<long long>(messages_), seconds(now_), static_cast<long long>(clamped_),
      greatest_force_, hand_.work, hand_.most_work, hand_.most_energy);
  return text.data();
}

// Reads the tables [hand], [[waypoint]] and [device].

using palpate::above;

void fields(FieldVisitor& visitor, ArmSettings& settings) {
  HandSettings& hand = settings.hand;
  visitor.table({"hand", "the person's hand"}, [&](FieldVisitor& inside) {
    inside.quantity({"mass", "of hand and arm at the grip"}, hand.mass, unit::g, above(0.0));
    inside.quantity({"stiffness", "of the spring to the intended position"}, hand.stiffness,
                    unit::N_per_m, above(0.0));
    inside.quantity({"damping", "of that spring"}, hand.damping, unit::N_s_per_m, at_least(0.0));
    inside.quantities({"start", "position at time zero"}, hand.start, unit::mm, {});
  });
  visitor.table({"device", "the haptic arm"}, [&](FieldVisitor& inside) {
    inside.text({"id", "device id"}, settings.device_id);
    ArmForm& form = settings.form;
    inside.text({"basis", "permutation of the axes"}, form.basis);
    inside.number({"mount_scale", "of the mount"}, form.mount_scale, above(0.0));
    inside.number({"mount_turn", "of the mount about x, rad"}, form.mount_turn, {});
    inside.number({"transform_scale", "of the workspace"}, form.transform_scale, above(0.0));
    inside.flag({"both_modes", "`mode` beside `control_mode`"}, form.both_modes);
    inside.flag({"grips", "two grips before the arms"}, form.grips);
    inside.flag({"numeric_id", "the id is a JSON number"}, form.numeric_id);
    inside.text({"second_id", "of a second arm, which comes first"}, form.second_id);
    inside.flag({"calibrated", "of the status"}, form.calibrated);
    inside.flag({"power_supply", "of the status"}, form.power);
    inside.quantity({"force_limit", "greatest length of the force"}, settings.force_limit, unit::N,
                    above(0.0));
    inside.quantity({"idle_after", "time without messages until the force ends"},
                    settings.idle_after, unit::ms, {});
  });
  visitor.tables(
      {"waypoint", "intended position of the hand at a time"},
      static_cast<int>(hand.waypoints.size()),
      [&](int count) {
        hand.waypoints.resize(palpate::as_index(count), {0.0, hand.start});
      },
      [&](FieldVisitor& inside, int i) {
        Waypoint& point = hand.waypoints[palpate::as_index(i)];
        inside.quantity({"at", "time of arrival"}, point.at, unit::s, above(0.0));
        inside.quantities({"position", "of the waypoint"}, point.position, unit::mm, {});
      });
}

void read_hand(const std::string& path, ArmSettings& settings) {
  refuse_unordered(read_settings(path, [&](FieldVisitor& visitor) { fields(visitor, settings); }),
                   settings.hand.waypoints);
}

// The hand's motion. It is exact if force and intended acceleration are constant during a step.

namespace {

using Matrix = std::array<double, 4>;  // 2 x 2, by rows

Matrix product(const Matrix& a, const Matrix& b) {
  return {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2],
          a[2] * b[1] + a[3] * b[3]};
}

// exp(A t) for y'' + (b/m) y' + (k/m) y = 0 with any damping: a Taylor series for a fraction of t,
// then squarings (Moler and Van Loan 2003, method 3). For a short step there are mostly none.
Matrix exponential(double k_over_m, double b_over_m, double t) {
  int squarings = 0;
  double part = t;
  for (; (1.0 + k_over_m + b_over_m) * part > 0.5; part *= 0.5) ++squarings;
  const Matrix a{0.0, part, -k_over_m * part, -b_over_m * part};
  Matrix sum{1.0, 0.0, 0.0, 1.0};
  Matrix term = sum;
  for (int n = 1; n <= 16; ++n) {  // 0.5^17 / 17! is below the last bit
    term = product(term, a);
    for (std::size_t i = 0; i < 4; ++i) sum[i] += (term[i] /= n);
  }
  for (; squarings > 0; --squarings) sum = product(sum, sum);
  return sum;
}

}  // namespace

// x(s) = x0 + (x1 - x0)(10 s^3 - 15 s^4 + 6 s^5), s from 0 to 1     Flash and Hogan 1985, eq. (3)
Intent intent_at(const HandSettings& settings, double t) {
  Waypoint from{0.0, settings.start};
  for (const Waypoint& to : settings.waypoints) {
    if (t >= to.at) {
      from = to;
      continue;
    }
    const double length = to.at - from.at;
    const double s = (t - from.at) / length;
    const double along = s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
    const double speed = 30.0 * s * s * (1.0 + s * (-2.0 + s)) / length;
    const double change = 60.0 * s * (1.0 + s * (-3.0 + 2.0 * s)) / (length * length);
    Intent intent{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double way = to.position[i] - from.position[i];
      intent.position[i] = from.position[i] + way * along;
      intent.velocity[i] = way * speed;
      intent.acceleration[i] = way * change;
    }
    return intent;
  }
  return {from.position, {}, {}};
}

Hand make_hand(const HandSettings& settings, double step) {
  Hand hand{.settings = settings,
            .step = step,
            .propagator = exponential(settings.stiffness / settings.mass,
                                      settings.damping / settings.mass, step)};
  hand.position = settings.start;
  return hand;
}

// With y = x - x_intent: m y'' + b y' + k y = F - m x_intent''. The offset from the equilibrium
// y = (F - m a)/k is multiplied by the propagator.
void move(Hand& hand, const Vec3& device_force, const Vec3& other_force) {
  const HandSettings& s = hand.settings;
  const Intent before = intent_at(s, hand.t);
  const Intent middle = intent_at(s, hand.t + 0.5 * hand.step);
  hand.t += hand.step;
  const Intent after = intent_at(s, hand.t);
  const auto& [p00, p01, p10, p11] = hand.propagator;
  for (std::size_t i = 0; i < 3; ++i) {
    const double force = device_force[i] + other_force[i];
    const double rest = (force - s.mass * middle.acceleration[i]) / s.stiffness;
    const double offset = hand.position[i] - before.position[i] - rest;
    const double speed = hand.velocity[i] - before.velocity[i];
    const double position = after.position[i] + rest + p00 * offset + p01 * speed;
    hand.work += device_force[i] * (position - hand.position[i]);
    hand.position[i] = position;
    hand.velocity[i] = after.velocity[i] + p10 * offset + p11 * speed;
  }
  hand.most_work = std::max(hand.most_work, hand.work);
  hand.most_energy = std::max(hand.most_energy, energy_of(hand));
}

void hold(Hand& hand) {
  hand.t += hand.step;
  hand.velocity = {};
}

double energy_of(const Hand& hand) {
  const Intent intent = intent_at(hand.settings, hand.t);
  double energy = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double offset = hand.position[i] - intent.position[i];
    energy += 0.5 * hand.settings.mass * hand.velocity[i] * hand.velocity[i] +
              0.5 * hand.settings.stiffness * offset * offset;
  }
  return energy;
}

}  // namespace emulator
