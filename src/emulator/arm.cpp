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

// The event that a fault sends; nothing for faults that send none.
std::optional<Event> event_of(const std::string& kind) {
  if (kind == "event_stall")
    return Event{
        .level = "warning", .safety_type = "stall_detected", .message = "Motor stall detected"};
  if (kind == "event_ceiling")
    return Event{.level = "warning",
                 .safety_type = "stability_ceiling",
                 .message = "Stability ceiling reached"};
  if (kind == "event_stage")
    return Event{.level = "warning",
                 .safety_type = "fod_stage_changed",
                 .message = "FOD stage changed: guard -> hard"};
  if (kind == "event_unknown")
    return Event{.level = "error", .safety_type = "something_new", .message = "Something new"};
  if (kind == "event_busy")
    return Event{.name = "device-busy", .level = "warning", .message = "Device is in use"};
  if (kind == "event_disconnect")
    return Event{.name = "device-disconnected", .level = "warning", .message = "Device was lost"};
  if (kind == "event_other" || kind == "event_partial")
    return Event{
        .level = "error", .safety_type = "ebrake_triggered", .message = "Emergency brake engaged"};
  return {};
}

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
    if (fault.kind == "freeze")
      frozen_ = ArmState{.device_id = settings_.device_id,
                         .position = hand_.position,
                         .velocity = hand_.velocity,
                         .force = force_,
                         .mode = mode_,
                         .in_use = in_use_,
                         .form = settings_.form};
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
  const std::optional<Event> event = event_of(kind);
  if (!event) return;
  std::string text = event_message(*event, kind == "event_other" ? "0BAD" : settings_.device_id);
  if (kind == "event_partial") text.resize(text.size() / 2);
  events_.push_back(std::move(text));
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

ArmState Arm::told() {
  if (!faults_.lasts("freeze", now_)) frozen_.reset();
  ArmState state = frozen_.value_or(ArmState{.device_id = settings_.device_id,
                                             .position = hand_.position,
                                             .velocity = hand_.velocity,
                                             .force = force_,
                                             .mode = mode_,
                                             .in_use = in_use_,
                                             .form = settings_.form});
  if (faults_.lasts("id_change", now_)) state.device_id = "0BAD";
  if (faults_.lasts("jump", now_)) state.position[2] += faults_.value("jump");
  if (faults_.lasts("not_ready", now_)) state.ready = false;
  if (faults_.lasts("power_off", now_)) state.form.power = false;
  if (faults_.lasts("transform", now_)) state.form.transform_scale = 2.0;
  if (faults_.spoils("velocity_spike")) state.velocity[2] = -1000.0;
  return state;
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
  return state_message({.device_id = settings_.device_id,
                        .position = hand_.position,
                        .velocity = hand_.velocity,
                        .force = force_,
                        .mode = mode_,
                        .in_use = in_use_,
                        .form = settings_.form},
                       settings_.service, Extent::full, session_);
}

std::vector<std::string> Arm::take_events() {
  std::vector<std::string> events = std::exchange(events_, {});
  if (faults_.lasts("events_half_open", now_)) events.clear();
  return events;
}

bool Arm::take_events_end() { return std::exchange(events_end_, false); }

std::string Arm::summary() const {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(),
                "{\"summary\":{\"messages\":%lld,\"time_s\":%.9g,\"clamped\":%lld,"
                "\"greatest_force_N\":%.9g,\"work_by_device_J\":%.9g,"
                "\"most_work_by_device_J\":%.9g,\"most_hand_energy_J\":%.9g}}",
                static_cast<long long>(messages_), seconds(now_), static_cast<long long>(clamped_),
                greatest_force_, hand_.work, hand_.most_work, hand_.most_energy);
  return text.data();
}

}  // namespace emulator
