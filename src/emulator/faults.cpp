// Reading and keeping of faults, and the two lists of what there is.
#include "emulator/faults.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "emulator/settings.h"

namespace emulator {
namespace {

constexpr std::array stand_kinds{
    FaultKind{"unplug", Life::moment, "the port is gone; with `duration` it comes back"},
    FaultKind{"stall", Life::lasting, "nothing is sent; what was due comes afterwards, at once"},
    FaultKind{"deaf", Life::lasting, "bytes that arrive are lost, `s` as well"},
    FaultKind{"garbage", Life::replies, "every byte of the reply is another"},
    FaultKind{"truncate", Life::replies, "only the reply's first half is sent"},
    FaultKind{"glue", Life::replies, "the reply's line ends are lost, so two lines become one"},
    FaultKind{"drop", Life::replies, "the reply is lost"},
    FaultKind{"duplicate", Life::replies, "the reply is sent twice"},
    FaultKind{"echo", Life::lasting, "bytes that arrive are sent back before the reply"},
    FaultKind{"error_reply", Life::replies, "`*10` comes instead"},
    FaultKind{"unsolicited", Life::replies, "a force line comes before the reply"},
    FaultKind{"nul", Life::replies, "a NUL byte follows every byte"},
    FaultKind{"nan", Life::replies, "the force reads `nan`"},
    FaultKind{"huge", Life::replies, "the force reads `1e308`"},
    FaultKind{"no_travel", Life::replies, "the reply to `n` lacks its second line"},
    FaultKind{"swap", Life::replies, "the reply's two lines come in the other order"},
    FaultKind{"slow", Life::lasting, "the line runs at a tenth of its rate"},
    FaultKind{"wrong_baud", Life::lasting, "both sides hear noise"},
    FaultKind{"unit_change", Life::moment, "the gauge shows lbF"},
    FaultKind{"travel_unit_change", Life::moment, "the stand shows inches"},
    FaultKind{"sign_flip", Life::lasting, "force changes its sign, LIST says nothing"},
    FaultKind{"spike", Life::lasting, "`value` (\"5 N\") is added to the force that is shown"},
    FaultKind{"freeze", Life::lasting, "force and travel are shown as they were"},
    FaultKind{"overload", Life::lasting, "the gauge says overload, the crosshead stops"},
    FaultKind{"limit_switch", Life::moment,
              "the switch of its direction stops the crosshead until it goes back"},
    FaultKind{"runaway", Life::lasting, "`s` is ignored"},
    FaultKind{"reset", Life::moment, "the stand is switched off and on: settings are lost"},
};

constexpr std::array arm_kinds{
    FaultKind{"rst", Life::moment, "the connection is reset"},
    FaultKind{"close_1000", Life::moment, "the service closes, normally"},
    FaultKind{"close_1011", Life::moment, "the service closes, internal error"},
    FaultKind{"half_open", Life::lasting, "nothing is read and nothing is sent, the socket stays"},
    FaultKind{"drop", Life::replies, "the reply is lost"},
    FaultKind{"late", Life::replies, "the reply comes `value` later"},
    FaultKind{"duplicate", Life::replies, "the reply is sent twice"},
    FaultKind{"reorder", Life::replies, "the reply comes after the next one"},
    FaultKind{"invalid_json", Life::replies, "the reply is no JSON"},
    FaultKind{"partial", Life::replies, "the reply ends in its middle"},
    FaultKind{"missing_field", Life::replies, "the state has no `cursor_position`"},
    FaultKind{"wrong_type", Life::replies, "the position's numbers are texts"},
    FaultKind{"empty", Life::replies, "the reply is `{}`"},
    FaultKind{"no_device", Life::replies, "the list of devices is empty"},
    FaultKind{"binary", Life::replies, "the reply is a binary message"},
    FaultKind{"nan", Life::replies, "the position's height is `NaN`, as no JSON may be"},
    FaultKind{"huge", Life::replies, "the position's height is 1e308"},
    FaultKind{"id_change", Life::lasting, "the device has another id"},
    FaultKind{"second_device", Life::lasting, "another device stands first in the list"},
    FaultKind{"jump", Life::lasting, "the position that is told is `value` (\"50 mm\") too high"},
    FaultKind{"velocity_spike", Life::replies, "the velocity that is told is 1000 m/s"},
    FaultKind{"freeze", Life::lasting, "the state that is told stays as it was"},
    FaultKind{"brake", Life::lasting, "the emergency brake holds the arm; commands do nothing"},
    FaultKind{"not_ready", Life::lasting, "status says not ready, not calibrated; no force"},
    FaultKind{"reset", Life::moment, "the service starts again: connections reset, new session"},
    FaultKind{
        "event_brake", Life::lasting,
        "an event says `ebrake_triggered`, and at its end `ebrake_released`; nothing else happens"},
    FaultKind{"event_stall", Life::moment, "an event says `stall_detected`; nothing else happens"},
    FaultKind{"event_ceiling", Life::moment, "an event says `stability_ceiling`"},
    FaultKind{"event_stage", Life::moment, "an event says `fod_stage_changed`, as a warning"},
    FaultKind{"event_unknown", Life::moment, "an event warns of a `safety_type` that nobody knows"},
    FaultKind{"event_busy", Life::moment, "an event says `device-busy`"},
    FaultKind{"event_disconnect", Life::moment,
              "an event says `device-disconnected`; the arm goes on"},
    FaultKind{"event_other", Life::moment, "an event says that the brake of another device holds"},
    FaultKind{"event_garbage", Life::moment, "an event is no JSON"},
    FaultKind{"event_partial", Life::moment, "an event of the brake ends in its middle"},
    FaultKind{"event_huge", Life::moment, "an event has 200 kB"},
    FaultKind{"event_flood", Life::moment, "2000 events come at once, of no concern"},
    FaultKind{"events_close", Life::moment, "the events port resets its connections"},
    FaultKind{"events_half_open", Life::lasting,
              "nothing is sent on the events port, the socket stays"},
};

Fault read_fault(Table& table, std::span<const FaultKind> kinds) {
  std::vector<std::string_view> known;
  for (const FaultKind& kind : kinds) known.push_back(kind.name);
  Fault fault;
  if (!table.has("kind")) throw Refused(table.place("kind") + "is missing; say what goes wrong");
  fault.kind = table.choice("kind", "", known);
  for (const FaultKind& kind : kinds)
    if (kind.name == fault.kind) fault.life = kind.life;
  const auto time = [&](const std::string& key) {
    const double value = table.quantity(key, 0.0, Quantity::time);
    if (value < 0.0) throw Refused(table.place(key) + "wants not to be negative");
    return static_cast<std::int64_t>(std::floor(value * 1e9 + 0.5));
  };
  if (table.has("at")) fault.at = time("at");
  if (table.has("after_messages")) fault.after_messages = table.count("after_messages", 0);
  if (fault.at.has_value() == fault.after_messages.has_value())
    throw Refused(table.place("kind") + "wants either `at` or `after_messages`");
  if (table.has("duration")) fault.duration = time("duration");
  if (fault.duration && fault.life != Life::lasting && fault.kind != "unplug")
    throw Refused(table.place("duration") + "means nothing to a `" + fault.kind +
                  "`; leave it away");
  if (fault.life == Life::replies) fault.replies = table.count("replies", 1);
  if (fault.kind == "spike") fault.value = table.quantity("value", 5.0, Quantity::force);
  if (fault.kind == "jump") fault.value = table.quantity("value", 0.05, Quantity::length);
  if (fault.kind == "late") fault.value = table.quantity("value", 0.03, Quantity::time);
  table.finish();
  return fault;
}

}  // namespace

std::span<const FaultKind> stand_faults() { return stand_kinds; }
std::span<const FaultKind> arm_faults() { return arm_kinds; }

std::vector<Fault> read_faults(const std::string& path, std::span<const FaultKind> kinds) {
  const Document document = read_toml(path);
  Table table(document, document.root);
  std::vector<Fault> faults;
  for (Table& each : table.tables("fault")) faults.push_back(read_fault(each, kinds));
  table.finish();
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
    Active active{*at};
    if (at->duration) active.until = now + *at->duration;
    active_.push_back(active);
    begun.push_back(*at);
    at = pending_.erase(at);
  }
  return begun;
}

bool Faults::lasts(std::string_view kind, std::int64_t now) const {
  return std::any_of(active_.begin(), active_.end(), [&](const Active& active) {
    return active.fault.kind == kind && active.fault.life == Life::lasting &&
           (!active.until || now < *active.until);
  });
}

std::optional<std::int64_t> Faults::end_of(std::string_view kind) const {
  std::optional<std::int64_t> end;
  for (const Active& active : active_)
    if (active.fault.kind == kind && active.until) end = std::max(end.value_or(0), *active.until);
  return end;
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

std::optional<std::int64_t> Faults::next_time() const {
  std::optional<std::int64_t> next;
  for (const Fault& fault : pending_)
    if (fault.at) next = std::min(next.value_or(*fault.at), *fault.at);
  return next;
}

}  // namespace emulator
