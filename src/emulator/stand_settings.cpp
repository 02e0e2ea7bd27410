// The tables [stand] and [gauge] of a file.
#include <array>

#include "emulator/settings.h"
#include "emulator/stand.h"

namespace emulator {
namespace {

constexpr std::array<std::string_view, 2> status_layouts{"compact", "spaced"};
constexpr std::array<std::string_view, 2> list_styles{"ipol", "pol"};
constexpr std::array<std::string_view, 2> overload_replies{"text", "saturated"};

std::size_t read_unit(Table& table, std::size_t otherwise) {
  const std::string symbol = table.text("unit", std::string(force_units[otherwise].symbol));
  std::string all;
  for (std::size_t unit = 0; unit < force_units.size(); ++unit) {
    if (force_units[unit].symbol == symbol) return unit;
    all += (all.empty() ? "`" : ", `") + std::string(force_units[unit].symbol) + "`";
  }
  throw Refused(table.place("unit") + "knows no `" + symbol + "`; choose one of " + all);
}

void read_stand_table(Table& table, StandSettings& settings) {
  CrossheadSettings& head = settings.crosshead;
  head.acceleration = table.quantity("acceleration", head.acceleration, Quantity::acceleration);
  head.slowest = table.quantity("slowest", head.slowest, Quantity::speed);
  head.fastest = table.quantity("fastest", head.fastest, Quantity::speed);
  head.lower_end = table.quantity("lower_end", head.lower_end, Quantity::length);
  head.upper_end = table.quantity("upper_end", head.upper_end, Quantity::length);
  settings.speed = table.quantity("speed", settings.speed, Quantity::speed);
  settings.travel_resolution =
      table.quantity("travel_resolution", settings.travel_resolution, Quantity::length);
  if (!table.flag("pc_control", "true")) settings.control = Control::off;
  if (table.choice("status", "compact", status_layouts) == "spaced")
    settings.status = StatusLayout::spaced;
  table.finish();
  if (head.acceleration <= 0.0) throw Refused(table.place("acceleration") + "wants to be positive");
  if (head.slowest <= 0.0 || head.fastest < head.slowest)
    throw Refused(table.place("fastest") + "wants `0 < slowest <= fastest`");
  if (head.lower_end >= 0.0 || head.upper_end <= 0.0)
    throw Refused(table.place("lower_end") + "wants `lower_end < 0 < upper_end`, about the start");
  if (settings.travel_resolution <= 0.0)
    throw Refused(table.place("travel_resolution") + "wants to be positive");
}

void read_gauge_table(Table& table, StandSettings& settings) {
  GaugeSettings& gauge = settings.gauge;
  gauge.capacity = table.quantity("capacity", gauge.capacity, Quantity::force);
  gauge.resolution = table.quantity("resolution", gauge.resolution, Quantity::force);
  gauge.noise = table.quantity("noise", gauge.noise, Quantity::force);
  gauge.unit = read_unit(table, gauge.unit);
  gauge.filter = static_cast<int>(table.count("filter", gauge.filter));
  gauge.peak_filter = static_cast<int>(table.count("peak_filter", gauge.peak_filter));
  if (table.choice("list", "ipol", list_styles) == "pol") settings.list = ListStyle::pol;
  if (table.choice("overload", "text", overload_replies) == "saturated")
    settings.overload = OverloadReply::saturated;
  table.finish();
  if (gauge.capacity <= 0.0) throw Refused(table.place("capacity") + "wants to be positive");
  if (gauge.resolution <= 0.0) throw Refused(table.place("resolution") + "wants to be positive");
  if (gauge.noise < 0.0) throw Refused(table.place("noise") + "wants not to be negative");
  if (gauge.filter > 10) throw Refused(table.place("filter") + "goes up to 10");
  if (gauge.peak_filter > 10) throw Refused(table.place("peak_filter") + "goes up to 10");
}

}  // namespace

void read_stand(const std::string& path, StandSettings& settings) {
  const Document document = read_toml(path);
  Table table(document, document.root);
  for (Table& stand : table.tables("stand")) read_stand_table(stand, settings);
  for (Table& gauge : table.tables("gauge")) read_gauge_table(gauge, settings);
  table.finish();
}

}  // namespace emulator
