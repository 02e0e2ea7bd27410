// The hand's motion, the lines in three formats, commands, and faults.
#include "emulator/line_gauge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "emulator/files.h"
#include "emulator/stand.h"

namespace emulator {
namespace {

constexpr double gram = 9.80665e-3;  // N
constexpr double unsteady = 2e-3;    // N between two lines, above which a balance shows `US`
constexpr const char* banner = "HX711 ready\r\n";

}  // namespace

LineGauge::LineGauge(const LineGaugeSettings& settings, Log& log)
    : SerialDevice(settings.faults, settings.baud, log),
      settings_(settings),
      gauge_(make_gauge(settings.gauge, settings.seed)),
      tissue_(make_tissue(settings.tissue, 1.0 / static_cast<double>(rate))) {
  // It has been on for a while: a tare at once is that of a whole reading.
  for (int i = 0; i < 1 << gauge_.filter; ++i) sample(gauge_, 0.0);
  if (settings.style == LineStyle::hx711) out_ = banner;
}

double LineGauge::travel() const {
  const double time = seconds(now_);
  TravelPoint before;
  for (const TravelPoint& point : settings_.points) {
    if (time < point.at)
      return before.travel +
             (point.travel - before.travel) * (time - before.at) / (point.at - before.at);
    before = point;
  }
  return before.travel;
}

void LineGauge::log_row(const char* kind, const std::string& text) {
  log_->row(now_, kind, text, std::array{travel(), force()});
}

std::string LineGauge::summary() const {
  char text[120];
  std::snprintf(text, sizeof text, R"({"lines":%lld,"travel_m":%.9g,"force_N":%.9g})",
                static_cast<long long>(lines_), travel(), force());
  return text;
}

void LineGauge::advance_to(Nanoseconds time) {
  for (;; ++steps_) {
    const Nanoseconds next = (steps_ + 1) * 1'000'000'000 / rate;
    if (next > time) break;
    now_ = next;
    sample(gauge_, press(tissue_, settings_.tissue.surface + travel()));
  }
  now_ = std::max(now_, time);
}

void LineGauge::go_to(Nanoseconds time, std::int64_t lines) {
  SerialDevice::go_to(time, lines);
  spoil(gauge_, faults_, now_, travel());
}

void LineGauge::begin(const Fault& fault) {
  if (fault.kind == "unit_change")
    gauge_.unit = settings_.style == LineStyle::mark10 ? 3 : 4;  // lbF, ozF
  if (fault.kind == "reset") {
    zero_time_ = now_;
    if (settings_.style == LineStyle::hx711) send(banner);
  }
  if (fault.kind == "clock_jump") zero_time_ -= nanoseconds(fault.value);
}

double LineGauge::line_rate() const {
  if (settings_.style == LineStyle::hx711) return settings_.rate;
  return settings_.style == LineStyle::mark10 ? language_.auto_output : 0.0;
}

// Sends the lines that are due until then.
void LineGauge::stream(Nanoseconds until) {
  const double per_second = line_rate();
  if (per_second <= 0.0) {
    next_line_ = until;
    return;
  }
  const Nanoseconds step = std::llround(1e9 / per_second);
  if (next_line_ == 0) next_line_ = step;
  for (; next_line_ <= until && !unplugged(); next_line_ += step) {
    go_to(next_line_, lines_);
    if (!unplugged()) send_line(line());
  }
}

void LineGauge::pass(Nanoseconds now) {
  if (settings_.clock == Clock::lockstep) {
    if (listened_ && line_rate() > 0.0 && out_.empty() && !faults_.lasts("stall", now_))
      stream(std::max<Nanoseconds>(next_line_, std::llround(1e9 / line_rate())));
    else if (listened_ && faults_.lasts("stall", now_))
      go_to(now_ + settings_.tick, -1);  // a stall ends, though nothing is sent
    return;
  }
  stream(now);
  if (!unplugged()) go_to(now, -1);  // faults that count lines begin with a line only
}

std::string LineGauge::line() {
  if (settings_.style == LineStyle::mark10) return reading_line(language_, gauge_, gauge_.mode);
  const double newtons = value_of(gauge_, Reading::current);
  const double shown = (gauge_.flipped ? -newtons : newtons);
  const double unit = gauge_.unit == 0 ? gram : force_units[gauge_.unit].newtons;
  if (settings_.style == LineStyle::hx711) {
    std::string number = gauge_.forced_overload ? "ovf" : in_steps(shown / unit, 0.01);
    if (gauge_.forced_number) number = *gauge_.forced_number;
    std::string text = std::to_string((now_ - zero_time_) / 1'000'000) + "," + number;
    if (settings_.travel && !faults_.spoils("no_travel"))
      text += "," + in_steps(1e3 * travel(), 1e3 * settings_.travel_resolution);
    return text + "\r\n";
  }
  const char* state = std::abs(newtons - last_shown_) > unsteady ? "US" : "ST";
  last_shown_ = newtons;
  std::string number = in_steps(std::abs(shown) / unit, 0.01);
  while (number.size() < 8) number.insert(number.begin(), '0');
  if (gauge_.forced_number) number = *gauge_.forced_number;
  if (gauge_.forced_overload) return "OL,+9999999E+19\r\n";
  return std::string(state) + "," + (shown < 0.0 ? "-" : "+") + number +
         (gauge_.unit == 0 ? "  g" : " oz") + "\r\n";
}

// Spoils a line as faults request, and sends it.
void LineGauge::send_line(std::string text) {
  ++lines_;
  const bool huge = faults_.spoils("huge");
  if (huge || faults_.spoils("nan")) {
    gauge_.forced_number = huge ? "1e308" : "nan";
    text = line();
    gauge_.forced_number.reset();
  }
  if (!faults_.lasts("freeze", now_))
    frozen_.clear();
  else if (frozen_.empty())
    frozen_ = text;
  if (!frozen_.empty()) text = frozen_;
  const std::string bare = text.substr(0, text.find('\r'));
  if (faults_.spoils("wrong_unit"))
    text = bare.substr(0, bare.find_last_not_of(" gNozlbF") + 1) + " kp\r\n";
  send(spoilt(text, "battery 80 %\r\n", 2));
}

std::string LineGauge::obey_line(const std::string& command) {
  if (settings_.style == LineStyle::mark10) return obey(language_, gauge_, command);
  if (command == "Q" || command == "SI") return line();
  if (command == "?TN") return "TN,  FX-1200i\r\n";
  if (command == "?SN") return "SN,  12345678\r\n";
  if (command == "?ID") return "ID,  LAB-0123\r\n";
  if (command == "Z" || command == "R") set_zero(gauge_);
  return {};  // as with `ErCd 0`, the balance's own setting
}

void LineGauge::take(char byte, Rate rate_of_other_side) {
  const bool lockstep = settings_.clock == Clock::lockstep;
  listened_ = true;
  hears_at(rate_of_other_side);
  if (unplugged()) return;
  if (other_rate_ || faults_.lasts("wrong_baud", now_)) {
    if (settings_.style != LineStyle::hx711) send(std::string(1, byte));
    return;
  }
  if (faults_.lasts("deaf", now_)) return log_row("in", "(unheard) " + std::string(1, byte));
  if (faults_.lasts("echo", now_)) send(std::string(1, byte));
  if (settings_.style == LineStyle::hx711) {
    log_row("in", std::string(1, byte));
    if (byte == 't') set_zero(gauge_);
    return;
  }
  if (byte != '\r' && byte != '\n') {
    if (command_.size() < 64) command_ += byte;
    return;
  }
  if (command_.empty()) return;
  const std::string command = std::exchange(command_, {});
  log_row("in", command);
  go_to(lockstep ? (now_ / settings_.tick + 1) * settings_.tick : now_, lines_);
  if (unplugged()) return;
  const std::string reply = obey_line(command);
  if (reply.empty()) return;
  if (command.starts_with('?') || command == "Q" || command == "SI")
    send_line(reply);
  else
    send(reply);
}

// Reads the tables [gauge] and [[waypoint]] of a gauge.

namespace {

using palpate::above;

constexpr auto style_words = palpate::words_of<LineStyle>({{"hx711", "`1200,10.35,0.52`, sent"},
                                                           {"mark10", "`0.102 N`"},
                                                           {"balance", "`ST,+00010.35  g`"}});

}  // namespace

void fields(FieldVisitor& visitor, LineGaugeSettings& settings) {
  visitor.table({"gauge", "the gauge"}, [&](FieldVisitor& inside) {
    inside.choice({"style", "format of the lines"}, settings.style, style_words);
    inside.number({"rate", "lines per second"}, settings.rate, above(0.0));
    inside.flag({"travel", "whether the lines have the travel"}, settings.travel);
    inside.quantity({"travel_resolution", "of the travel"}, settings.travel_resolution, unit::mm,
                    above(0.0));
    fields(inside, settings.gauge);
  });
  visitor.tables(
      {"waypoint", "travel of the hand at a time"}, static_cast<int>(settings.points.size()),
      [&](int count) { settings.points.resize(palpate::as_index(count)); },
      [&](FieldVisitor& inside, int i) {
        TravelPoint& point = settings.points[palpate::as_index(i)];
        inside.quantity({"at", "time of arrival"}, point.at, unit::s, above(0.0));
        inside.quantity({"travel", "downwards"}, point.travel, unit::mm, {});
      });
}

void read_line_gauge(const std::string& path, LineGaugeSettings& settings) {
  refuse_unordered(read_settings(path, [&](FieldVisitor& visitor) { fields(visitor, settings); }),
                   settings.points);
}

}  // namespace emulator
