// Opens the connection to a stand: ends the gauge's automatic output, reads its identity, sign and
// unit, and diagnoses why a stand does not answer.
#include <utility>

#include "base/error.h"
#include "device/mark10.h"

namespace palpate::device {
namespace {

constexpr double mute_time = 0.03;  // s, to wait for an error after a setter, which has no reply
constexpr double still_time = 0.1;  // s, in which a stand at 12 mm/min moves by its resolution

}  // namespace

void Mark10::greet() {
  drain();
  quiet_gauge();
  ask_gauge_who_it_is();
  if (purpose_ == Purpose::command) send("i");
  std::optional<mark10::Pair> pair;
  bool force_alone = false;
  int error = 0;
  // Two attempts, because earlier bytes may spoil the first reply.
  for (int tries = 0; tries < 2 && !pair; ++tries) {
    pairs_.clear();
    if (!ask("n")) break;
    const double until = wire_time() + patience(answer_time);
    while (const auto line = pair ? std::nullopt : line_until(until)) {
      const auto step = pairs_.take(*line);
      if (step.error != 0) error = step.error;
      const auto quantity = mark10::parse_quantity(*line);
      force_alone = force_alone || (quantity && mark10::newtons(*quantity));
      pair = step.pair;
    }
  }
  if (!pair && error != 0)
    throw LinkError("palpate: the stand on `" + path_ + "` answers `*" + std::to_string(error) +
                    "`, " + std::string(mark10::error_text(error)) +
                    "; switch its PC Control on, and its gauge to the main screen");
  if (!pair && force_alone && !port_.lost())
    throw LinkError("palpate: the stand on `" + path_ +
                    "` sends a force and no travel; it has no travel display, or this is a gauge "
                    "by itself; read that with `serial:" +
                    path_ + ",SETTINGS.toml`");
  if (!pair) refuse_silence();
  if (pairs_.order() == mark10::PairReader::Order::travel_first)
    identity_.notes.push_back("the stand sends the travel before the force");
  unit_ = pair->force_unit;
  identity_.dialect = "gauge in " + std::string(unit_.data());
  ask_stand_limits();
  if (purpose_ == Purpose::command) refuse_without_pc_control();
}

// Without PC Control a stand reads and does not obey: its speed does not change. A stand that
// reports no speed is left to move(), which reads it back.
void Mark10::refuse_without_pc_control() {
  const auto before = ask_number("a");
  const auto shown = before ? mark10::metres_per_second(*before) : std::nullopt;
  if (!shown) return;
  const double other = *shown > 1.5e-3 ? 1e-3 : 2e-3;  // m/s
  send(mark10::speed_command(other)->text());
  const auto after = ask_number("a");
  if (!after || after->value != before->value || after->unit != before->unit) return;
  throw LinkError("palpate: the stand on `" + path_ +
                  "` is read and does not obey; switch PC Control on in its menu");
}

void Mark10::quiet_gauge() {
  gauge("AOUT0", mute_time);
  if (purpose_ != Purpose::command) return;
  gauge("FULL", mute_time);
  gauge("N", mute_time);
}

void Mark10::ask_gauge_who_it_is() {
  const auto settings = ask_settings();
  if (!settings) {
    identity_.notes.push_back(
        "the gauge does not list its settings; a compressive force is assumed to be positive, the "
        "default of the series");
    return;
  }
  using Sign = mark10::Settings::Sign;
  identity_.firmware = settings->version;
  if (settings->sign == Sign::tension_positive) sign_ = -1.0;
  if (!settings->sign_listed && settings->sign == Sign::compression_positive)
    identity_.notes.push_back(
        "the gauge does not list its polarity (IPOL); a compressive force is assumed to be "
        "positive");
  if (settings->auto_output > 0)
    identity_.notes.push_back("the gauge still sends readings by itself, in spite of AOUT0");
  if (!settings->mode.empty() && settings->mode != "CUR")
    identity_.notes.push_back("the gauge shows a peak (" + settings->mode +
                              "), not the current force; set it to CUR");
  if (settings->sign == Sign::omitted) {
    const std::string why = "the gauge omits the sign of its forces; set OPOL0 in its menu";
    if (purpose_ == Purpose::command) throw LinkError("palpate: on `" + path_ + "` " + why);
    identity_.notes.push_back(why);
  }
  if (settings->numbers_only)
    throw LinkError("palpate: on `" + path_ +
                    "` the gauge sends numbers without a unit (NUM); set it to FULL in its menu");
  if (purpose_ == Purpose::command && settings->unit != "N")
    identity_.notes.push_back("the gauge still uses " + settings->unit +
                              "; its forces are converted");
  // Model and serial number.
  for (const auto& [command, into] :
       {std::pair{"RM", &identity_.model}, std::pair{"RS", &identity_.id}}) {
    const auto reply = gauge(command, patience(answer_time));
    if (reply && !mark10::parse_error(*reply) && garbage_share(*reply) == 0.0) *into = *reply;
  }
}

void Mark10::ask_stand_limits() {
  const auto read = [&](std::string_view command, double& into, auto convert) {
    const auto number = ask_number(command);
    const auto si = number ? convert(*number) : std::nullopt;
    if (si) into = *si;
    return si.has_value();
  };
  const auto length = [](const mark10::Quantity& one) {
    return one.unit.empty() ? std::optional(one.value * 1e-3) : mark10::metres(one);
  };
  const bool high = read("v", limits_.high, length);
  const bool low = read("w", limits_.low, length);
  if (!high || !low) identity_.notes.push_back("the stand does not report its travel limits");
  // The status of a stand that moves between its limits may be read in two ways (`DL`).
  const auto status = ask_status();
  has_status_ = status.has_value();
  if (!status)
    identity_.notes.push_back(
        "the stand does not report its status (`p`): two equal readings of its travel count as a "
        "stop, and motion slower than 0.5 mm/s is not seen by them");
  if (!status && !stands_still(still_time)) identity_.notes.push_back(moving_note(""));
  if (!status) return;
  using Moving = mark10::Status::Moving;
  const Moving moving = status->moving;
  if (moving == Moving::stopped || (moving == Moving::unknown && stands_still(still_time))) return;
  identity_.notes.push_back(moving_note(moving == Moving::up     ? " up"
                                        : moving == Moving::down ? " down"
                                                                 : ""));
}

std::string Mark10::moving_note(const char* way) const {
  return "the stand is moving" + std::string(way) + "; `palpate device stop mark10:" + path_ +
         "` stops it";
}

void Mark10::refuse_silence() const {
  const std::string on = "palpate: on `" + path_ + "` ";
  if (port_.lost()) throw LinkError(on + "the device hung up; check its cable");
  if (first_bytes_.empty())
    throw LinkError(
        on +
        "nothing answers; switch the stand on, set CONTROL to CONSOLE, PC Control to on "
        "and the rate to " +
        std::to_string(mark10::baud) + " baud, and check the cable");
  // At another rate most bytes are not text; a fifth of them is enough for the diagnosis.
  if (garbage_share(first_bytes_) > 0.2)
    throw LinkError(on + "garbage answers, as at a wrong baud rate; set the stand and its gauge " +
                    "to " + std::to_string(mark10::baud) + " baud, 8 bits, no parity");
  throw LinkError(on + "a device answers in words that are no reading (`" +
                  printable(first_bytes_) +
                  "`); is this the stand's port, and is the gauge plugged into the stand?");
}

}  // namespace palpate::device
