// The lists of faults, the reading of scripts, and the faults that are active.
#include "emulator/faults.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "emulator/files.h"

namespace emulator {
namespace {

// The faults of the gauge alone, those of both devices on a serial line, and those of the stand
// alone. A reply of the gauge is a line that it sends.
constexpr std::array serial_kinds{
    FaultKind{"wrong_unit", Life::replies, "the line ends with the unit `kp`"},
    FaultKind{"clock_jump", Life::moment, "the gauge's own time jumps ahead by `value` (\"5 s\")"},
    FaultKind{"unplug", Life::moment, "the port is gone; with `duration` it comes back"},
    FaultKind{"stall", Life::lasting, "nothing is sent; replies come afterwards, at once"},
    FaultKind{"deaf", Life::lasting, "bytes that arrive are lost, `s` as well"},
    FaultKind{"garbage", Life::replies, "every byte of the reply is replaced by another"},
    FaultKind{"truncate", Life::replies, "only the reply's first half is sent"},
    FaultKind{"glue", Life::replies, "the reply's line ends are lost, so two lines become one"},
    FaultKind{"drop", Life::replies, "the reply is lost"},
    FaultKind{"duplicate", Life::replies, "the reply is sent twice"},
    FaultKind{"echo", Life::lasting, "bytes that arrive are sent back before the reply"},
    FaultKind{"unsolicited", Life::replies, "another line comes before the reply"},
    FaultKind{"nul", Life::replies, "a NUL byte follows every byte"},
    FaultKind{"nan", Life::replies, "the force reads `nan`"},
    FaultKind{"huge", Life::replies, "the force reads `1e308`"},
    FaultKind{"no_travel", Life::replies, "the reply lacks its travel"},
    FaultKind{"slow", Life::lasting, "the line runs at a tenth of its rate"},
    FaultKind{"wrong_baud", Life::lasting, "both sides receive noise"},
    FaultKind{"unit_change", Life::moment, "the gauge shows lbF, a sketch or balance ounces"},
    FaultKind{"sign_flip", Life::lasting, "the force changes its sign, and nothing says so"},
    FaultKind{"spike", Life::lasting, "`value` (\"5 N\") is added to the force that is shown"},
    FaultKind{"drift", Life::lasting,
              "the force that is shown grows by `value` (\"20 mN\") a second"},
    FaultKind{
        "friction", Life::lasting,
        "`value` (\"50 mN\") is added to the force on the way down, and subtracted on the way up"},
    FaultKind{"lag", Life::lasting, "the force is shown `value` late, at most 140 ms"},
    FaultKind{"lost_force", Life::lasting, "the force reads 0, as with a broken wire"},
    FaultKind{"freeze", Life::lasting, "the same reading is sent again and again"},
    FaultKind{"overload", Life::lasting, "the gauge reports an overload; a stand stops"},
    FaultKind{"reset", Life::moment,
              "switched off and on: a stand's settings are lost, a gauge's time is 0"},
    FaultKind{"error_reply", Life::replies, "`*10` is sent instead of the reply"},
    FaultKind{"swap", Life::replies, "the reply's two lines come in the other order"},
    FaultKind{"travel_unit_change", Life::moment, "the stand shows inches"},
    FaultKind{"limit_switch", Life::moment,
              "the crosshead stops as at a limit switch; only the opposite direction is free"},
    FaultKind{"runaway", Life::lasting, "`s` is ignored"},
};
constexpr std::size_t of_gauge = 2;  // alone
constexpr std::size_t of_stand = 5;

constexpr std::array arm_kinds{
    FaultKind{"rst", Life::moment, "the connection is reset"},
    FaultKind{"close_1000", Life::moment, "the service closes, normally"},
    FaultKind{"close_1011", Life::moment, "the service closes, internal error"},
    FaultKind{"half_open", Life::lasting, "nothing is read and nothing is sent, the socket stays"},
    FaultKind{"drop", Life::replies, "the reply is lost"},
    FaultKind{"late", Life::replies, "the reply comes `value` later"},
    FaultKind{"duplicate", Life::replies, "the reply is sent twice"},
    FaultKind{"flood", Life::replies, "the reply is sent 20000 times"},
    FaultKind{"reorder", Life::replies, "the reply comes after the next one"},
    FaultKind{"invalid_json", Life::replies, "the reply is not JSON"},
    FaultKind{"partial", Life::replies, "the reply ends in its middle"},
    FaultKind{"missing_field", Life::replies, "the state has no `cursor_position`"},
    FaultKind{"wrong_type", Life::replies, "the position's numbers are strings"},
    FaultKind{"empty", Life::replies, "the reply is `{}`"},
    FaultKind{"no_device", Life::replies, "the list of devices is empty"},
    FaultKind{"binary", Life::replies, "the reply is a binary message"},
    FaultKind{"nan", Life::replies, "the position's height is `NaN`, which is not valid JSON"},
    FaultKind{"huge", Life::replies, "the position's height is 1e308"},
    FaultKind{"id_change", Life::lasting, "the device has another id"},
    FaultKind{"second_device", Life::lasting, "another device comes first in the list"},
    FaultKind{"jump", Life::lasting, "the reported position is `value` (\"50 mm\") too high"},
    FaultKind{"velocity_spike", Life::replies, "the reported velocity is 1000 m/s, downwards"},
    FaultKind{"freeze", Life::lasting, "the reported state does not change"},
    FaultKind{"brake", Life::lasting, "the emergency brake holds the arm; commands do nothing"},
    FaultKind{"not_ready", Life::lasting, "the status is not ready, not calibrated; no force"},
    FaultKind{"power_off", Life::lasting, "the status has no power supply; no force"},
    FaultKind{"transform", Life::lasting, "the service scales the workspace by 2"},
    FaultKind{"reset", Life::moment, "the service restarts: connections are reset, new session"},
    FaultKind{
        "event_brake", Life::lasting,
        "an event `ebrake_triggered` is sent, and at the end `ebrake_released`; nothing else"},
    FaultKind{"event_stall", Life::moment, "an event `stall_detected` is sent; nothing else"},
    FaultKind{"event_ceiling", Life::moment, "an event `stability_ceiling` is sent"},
    FaultKind{"event_stage", Life::moment, "an event `fod_stage_changed` is sent, as a warning"},
    FaultKind{"event_unknown", Life::moment, "an event of an unknown `safety_type`, as an error"},
    FaultKind{"event_busy", Life::moment, "an event `device-busy` is sent"},
    FaultKind{"event_disconnect", Life::moment,
              "an event `device-disconnected` is sent; the arm continues"},
    FaultKind{"event_other", Life::moment, "an event reports the brake of another device"},
    FaultKind{"event_garbage", Life::moment, "an event is not JSON"},
    FaultKind{"event_partial", Life::moment, "an event of the brake ends in its middle"},
    FaultKind{"event_huge", Life::moment, "an event has 200 kB"},
    FaultKind{"event_flood", Life::moment, "2000 harmless events are sent at once"},
    FaultKind{"events_close", Life::moment, "the events port resets its connections"},
    FaultKind{"events_half_open", Life::lasting,
              "nothing is sent on the events port, the socket stays"},
};

// The kinds that have a `value`, with its default and unit.
struct ValueOf {
  std::string_view kind;
  double otherwise;  // SI, the default
  palpate::Unit unit;
};
constexpr std::array values{ValueOf{"spike", 5.0, unit::N},      ValueOf{"drift", 0.02, unit::N},
                            ValueOf{"friction", 0.05, unit::N},  ValueOf{"lag", 0.1, unit::ms},
                            ValueOf{"clock_jump", 5.0, unit::s}, ValueOf{"jump", 0.05, unit::mm},
                            ValueOf{"late", 0.03, unit::ms}};

void time(FieldVisitor& visitor, const palpate::Key& key, std::optional<std::int64_t>& ns) {
  std::optional<double> seconds;
  visitor.quantity(key, seconds, unit::s, at_least(0.0));
  if (seconds) ns = static_cast<std::int64_t>(std::floor(*seconds * 1e9 + 0.5));
}

void fields(FieldVisitor& visitor, Fault& fault, std::span<const FaultKind> kinds) {
  std::vector<palpate::Word> words;
  for (const FaultKind& kind : kinds) words.push_back({kind.name, kind.what});
  int chosen = -1;
  visitor.choice_of({"kind", "what goes wrong"}, chosen, words);
  if (chosen >= 0) {
    fault.kind = kinds[palpate::as_index(chosen)].name;
    fault.life = kinds[palpate::as_index(chosen)].life;
  }
  const bool any = chosen < 0;  // without a valid kind, all keys are accepted
  const bool lasts = fault.life == Life::lasting || fault.kind == "unplug";
  time(visitor, {"at", "time at which it begins"}, fault.at);
  int messages = -1;
  visitor.count({"after_messages", "messages after which it begins"}, messages, at_least(0));
  if (messages >= 0) fault.after_messages = messages;
  time(visitor, {"duration", "how long it lasts", {any || lasts, "with a kind that lasts"}},
       fault.duration);
  visitor.count({"replies",
                 "number of replies to spoil",
                 {any || fault.life == Life::replies, "with a kind that spoils replies"}},
                fault.replies, at_least(0));
  const auto value = std::ranges::find(values, fault.kind, &ValueOf::kind);
  if (value != values.end()) fault.value = value->otherwise;
  visitor.quantity(
      {"value", "how much", {any || value != values.end(), "with a kind whose effect has a size"}},
      fault.value, value != values.end() ? value->unit : unit::s, {});
}

}  // namespace

std::span<const FaultKind> stand_faults() { return std::span(serial_kinds).subspan(of_gauge); }
std::span<const FaultKind> gauge_faults() {
  return std::span(serial_kinds).first(serial_kinds.size() - of_stand);
}
std::span<const FaultKind> line_faults() { return gauge_faults().subspan(of_gauge); }
std::span<const FaultKind> arm_faults() { return arm_kinds; }

std::vector<Fault> read_faults(const std::string& path, std::span<const FaultKind> kinds) {
  std::vector<Fault> faults;
  const palpate::Node file = read_settings(path, [&](FieldVisitor& visitor) {
    visitor.tables(
        {"fault", "what goes wrong, and when"}, static_cast<int>(faults.size()),
        [&](int count) { faults.resize(palpate::as_index(count)); },
        [&](FieldVisitor& inside, int i) { fields(inside, faults[palpate::as_index(i)], kinds); });
  });
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const std::string table = "fault." + std::to_string(i + 1);
    if (faults[i].kind.empty())
      refuse(file, table,
             "`kind` is missing; say what goes wrong, as `kind = \"" +
                 std::string(kinds.front().name) + "\"`");
    if (faults[i].at.has_value() == faults[i].after_messages.has_value())
      refuse(file, table + ".kind",
             "a fault begins either `at` a time or `after_messages`; give one of the two");
  }
  return faults;
}

std::vector<Fault> Faults::begin(std::int64_t now, std::int64_t messages) {
  std::vector<Fault> begun;
  for (auto at = pending_.begin(); at != pending_.end();) {
    const bool due = at->at ? *at->at <= now : *at->after_messages <= messages;
    if (!due) {
      ++at;
      continue;
    }
    Active active{*at, now};
    if (at->duration) active.until = now + *at->duration;
    active_.push_back(active);
    begun.push_back(*at);
    at = pending_.erase(at);
  }
  return begun;
}

bool Faults::lasts(std::string_view kind, std::int64_t now) const {
  return std::ranges::any_of(active_, [&](const Active& active) {
    return active.fault.kind == kind && active.fault.life == Life::lasting &&
           (!active.until || now < *active.until);
  });
}

bool Faults::spoils(std::string_view kind) {
  for (Active& active : active_) {
    if (active.fault.kind != kind || active.fault.life != Life::replies) continue;
    if (active.fault.replies == 0) continue;
    --active.fault.replies;
    return true;
  }
  return false;
}

double Faults::value(std::string_view kind) const {
  double value = 0.0;
  for (const Active& active : active_)
    if (active.fault.kind == kind) value = active.fault.value;
  return value;
}

double Faults::age(std::string_view kind, std::int64_t now) const {
  double age = 0.0;
  for (const Active& active : active_)
    if (active.fault.kind == kind && (!active.until || now < *active.until))
      age = static_cast<double>(now - active.since) * 1e-9;
  return age;
}

std::optional<std::int64_t> Faults::next_time() const {
  std::optional<std::int64_t> next;
  for (const Fault& fault : pending_)
    if (fault.at) next = std::min(next.value_or(*fault.at), *fault.at);
  return next;
}

}  // namespace emulator
