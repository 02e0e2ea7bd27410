// Reads the tables [gauge] and [[waypoint]] of a gauge.
#include "emulator/line_gauge.h"
#include "emulator/settings.h"

namespace emulator {
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
    inside.quantity({"capacity", "greatest rated force"}, settings.gauge.capacity, unit::N,
                    above(0.0));
    inside.quantity({"resolution", "of the displayed force"}, settings.gauge.resolution, unit::N,
                    above(0.0));
    inside.quantity({"noise", "standard deviation of a sample"}, settings.gauge.noise, unit::N,
                    at_least(0.0));
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
  const palpate::Node file =
      read_settings(path, [&](FieldVisitor& visitor) { fields(visitor, settings); });
  double last = 0.0;
  for (std::size_t i = 0; i < settings.points.size(); ++i) {
    if (settings.points[i].at <= last)
      refuse(file, "waypoint." + std::to_string(i + 1) + ".at",
             "`at` must be later than that of the waypoint before; give a later time");
    last = settings.points[i].at;
  }
}

}  // namespace emulator
