// Reads the tables [stand] and [gauge].
#include <vector>

#include "emulator/settings.h"
#include "emulator/stand.h"

namespace emulator {
namespace {

using palpate::above;
using palpate::between;
using palpate::Word;
using palpate::words_of;

constexpr auto status_words =
    words_of<StatusLayout>({{"compact", "`SLDL`"}, {"spaced", "`S L DL`"}, {"none", "no reply"}});
constexpr auto order_words =
    words_of<PairOrder>({{"force_first", "as LabKit reads it"}, {"travel_first", "the other way"}});
constexpr auto list_words =
    words_of<ListStyle>({{"ipol", "with `IPOL0;OPOL0`"}, {"pol", "with `MIT;POL`"}});
constexpr auto overload_words = words_of<OverloadReply>(
    {{"text", "`OVERLOAD`"}, {"saturated", "the largest number that it can show"}});

std::vector<Word> unit_words() {
  std::vector<Word> words;
  for (const ForceUnit& unit : force_units) words.push_back({unit.symbol.data(), ""});
  return words;
}

void stand_fields(FieldVisitor& visitor, StandSettings& settings) {
  CrossheadSettings& head = settings.crosshead;
  visitor.quantity({"acceleration", "of every change of speed"}, head.acceleration, unit::mm_per_s2,
                   above(0.0));
  visitor.quantity({"slowest", "lowest speed"}, head.slowest, unit::mm_per_min, above(0.0));
  visitor.quantity({"fastest", "greatest speed"}, head.fastest, unit::mm_per_min, above(0.0));
  visitor.quantity({"speed", "after switching on"}, settings.speed, unit::mm_per_min, {});
  visitor.quantity({"lower_end", "lower limit switch, from the start"}, head.lower_end, unit::mm,
                   {.high = 0.0, .high_allowed = false});
  visitor.quantity({"upper_end", "upper limit switch, from the start"}, head.upper_end, unit::mm,
                   above(0.0));
  visitor.quantity({"travel_resolution", "resolution of the displayed travel"},
                   settings.travel_resolution, unit::mm, above(0.0));
  visitor.flag({"pc_control", "whether the line may move the stand"}, settings.pc_control);
  visitor.flag({"travel_display", "whether it has one"}, settings.travel_display);
  visitor.choice({"order", "of the two lines of `n`"}, settings.order, order_words);
  visitor.choice({"status", "how `p` writes its codes"}, settings.status, status_words);
}

void gauge_fields(FieldVisitor& visitor, StandSettings& settings) {
  GaugeSettings& gauge = settings.gauge;
  visitor.quantity({"capacity", "greatest rated force"}, gauge.capacity, unit::N, above(0.0));
  visitor.quantity({"resolution", "of the displayed force"}, gauge.resolution, unit::N, above(0.0));
  visitor.quantity({"noise", "standard deviation of a sample"}, gauge.noise, unit::N,
                   at_least(0.0));
  int unit = static_cast<int>(gauge.unit);
  visitor.choice_of({"unit", "of the displayed force"}, unit, unit_words());
  gauge.unit = palpate::as_index(unit);
  visitor.count({"filter", "the display averages 2^filter samples"}, gauge.filter, between(0, 10));
  visitor.count({"peak_filter", "peaks average 2^peak_filter samples"}, gauge.peak_filter,
                between(0, 10));
  visitor.choice({"list", "the form of the reply to LIST"}, settings.list, list_words);
  visitor.choice({"overload", "the reply above 110 % of the capacity"}, settings.overload,
                 overload_words);
}

}  // namespace

void fields(FieldVisitor& visitor, StandSettings& settings) {
  visitor.table({"stand", "the crosshead"},
                [&](FieldVisitor& inside) { stand_fields(inside, settings); });
  visitor.table({"gauge", "the force gauge"},
                [&](FieldVisitor& inside) { gauge_fields(inside, settings); });
}

void read_stand(const std::string& path, StandSettings& settings) {
  const palpate::Node file =
      read_settings(path, [&](FieldVisitor& visitor) { fields(visitor, settings); });
  if (settings.crosshead.fastest < settings.crosshead.slowest)
    refuse(file, "stand.fastest", "`fastest` is below `slowest`; give a greater speed");
}

}  // namespace emulator
