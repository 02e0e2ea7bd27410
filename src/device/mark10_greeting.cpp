// How a stand is met: the gauge is quieted, asked who it is and in which sign and unit it speaks,
// and where nobody answers, why.
#include <utility>

#include "base/error.h"
#include "device/mark10.h"

namespace palpate::device {
namespace {

constexpr double answer_time = 0.25;  // s
constexpr double mute_time = 0.03;    // s, in which a setter may object

// The bytes for a sentence: what cannot be printed as a point.
std::string printable(std::string_view bytes) {
  std::string text;
  for (const char c : bytes.substr(0, 40)) text += c >= ' ' && c <= '~' ? c : '.';
  return text;
}

}  // namespace

void Mark10::greet() {
  drain();
  quiet_gauge();
  ask_gauge_who_it_is();
  if (purpose_ == Purpose::command) send("i");
  std::optional<mark10::Pair> pair;
  int error = 0;
  // Twice: the first answer may be spoilt by what was on its way.
  for (int tries = 0; tries < 2 && !pair; ++tries) {
    pairs_.clear();
    if (!ask("n")) break;
    const double until = wire_time() + patience(answer_time);
    while (const auto line = pair ? std::nullopt : line_until(until)) {
      const auto step = pairs_.take(*line);
      if (step.error != 0) error = step.error;
      pair = step.pair;
    }
  }
  if (!pair && error != 0)
    throw LinkError("palpate: the stand on `" + path_ + "` answers `*" + std::to_string(error) +
                    "`, " + std::string(mark10::error_text(error)) +
                    "; put it to PC control and its gauge to its main screen");
  if (!pair) refuse_silence();
  unit_ = pair->force_unit;
  identity_.dialect = "gauge in " + std::string(unit_.data());
  ask_stand_limits();
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
        "the gauge does not list its settings; a pressing force is assumed to be positive, as "
        "the series is made");
    return;
  }
  using Sign = mark10::Settings::Sign;
  identity_.firmware = settings->version;
  if (settings->sign == Sign::tension_positive) sign_ = -1.0;
  if (!settings->sign_listed && settings->sign == Sign::compression_positive)
    identity_.notes.push_back(
        "the gauge does not list its polarity (IPOL); a pressing force is assumed to be positive");
  if (settings->auto_output > 0)
    identity_.notes.push_back("the gauge goes on sending readings by itself, against AOUT0");
  if (!settings->mode.empty() && settings->mode != "CUR")
    identity_.notes.push_back("the gauge shows a peak (" + settings->mode +
                              "), not the force of now; put it to CUR");
  if (settings->sign == Sign::omitted) {
    const std::string why = "the gauge omits the sign of its forces; set OPOL0 in its menu";
    if (purpose_ == Purpose::command) throw LinkError("palpate: on `" + path_ + "` " + why);
    identity_.notes.push_back(why);
  }
  if (settings->numbers_only)
    throw LinkError("palpate: on `" + path_ +
                    "` the gauge sends numbers without a unit (NUM); set it to FULL in its menu");
  if (purpose_ == Purpose::command && settings->unit != "N")
    identity_.notes.push_back("the gauge stays in " + settings->unit +
                              "; its forces are converted");
  // Model and serial number, as the gauge gives them.
  for (const auto& [command, into] :
       {std::pair{"RM", &identity_.model}, std::pair{"RS", &identity_.id}}) {
    const auto reply = gauge(command, patience(answer_time));
    if (reply && !mark10::parse_error(*reply) && mark10::garbage_share(*reply) == 0.0)
      *into = *reply;
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
  const bool travels = read("v", limits_.high, length) & read("w", limits_.low, length);
  if (!travels) identity_.notes.push_back("the stand does not tell its travel limits");
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
  // Bytes at another rate are not text; a fifth of them shows it.
  if (mark10::garbage_share(first_bytes_) > 0.2)
    throw LinkError(on + "garbage answers, as at a wrong baud rate; set the stand and its gauge " +
                    "to " + std::to_string(mark10::baud) + " baud, 8 bits, no parity");
  throw LinkError(on + "something answers in words that are no reading (`" +
                  printable(first_bytes_) +
                  "`); is this the stand's port, and is the gauge plugged into the stand?");
}

}  // namespace palpate::device
