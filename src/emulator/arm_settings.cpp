// The tables [hand], [[waypoint]] and [device] of a file.
#include "emulator/arm.h"
#include "emulator/settings.h"

namespace emulator {
namespace {

Vec3 read_position(Table& table, const std::string& key, const Vec3& otherwise) {
  const std::vector<double> values = table.quantities(key, Quantity::length);
  if (values.empty()) return otherwise;
  if (values.size() != 3)
    throw Refused(table.place(key) +
                  "wants three lengths, such as `[\"0 mm\", \"-120 mm\", \"150 mm\"]`");
  return {values[0], values[1], values[2]};
}

void read_hand_table(Table& table, HandSettings& hand) {
  hand.mass = table.quantity("mass", hand.mass, Quantity::mass);
  hand.stiffness = table.quantity("stiffness", hand.stiffness, Quantity::stiffness);
  hand.damping = table.quantity("damping", hand.damping, Quantity::damping);
  hand.start = read_position(table, "start", hand.start);
  table.finish();
  if (hand.mass <= 0.0) throw Refused(table.place("mass") + "wants to be positive");
  if (hand.stiffness <= 0.0) throw Refused(table.place("stiffness") + "wants to be positive");
  if (hand.damping < 0.0) throw Refused(table.place("damping") + "wants not to be negative");
}

void read_device_table(Table& table, ArmSettings& settings) {
  settings.device_id = table.text("id", settings.device_id);
  settings.force_limit = table.quantity("force_limit", settings.force_limit, Quantity::force);
  settings.idle_after =
      nanoseconds(table.quantity("idle_after", seconds(settings.idle_after), Quantity::time));
  table.finish();
  if (settings.force_limit <= 0.0)
    throw Refused(table.place("force_limit") + "wants to be positive");
}

}  // namespace

void read_hand(const std::string& path, ArmSettings& settings) {
  const Document document = read_toml(path);
  Table table(document, document.root);
  for (Table& hand : table.tables("hand")) read_hand_table(hand, settings.hand);
  for (Table& device : table.tables("device")) read_device_table(device, settings);
  double last = 0.0;
  for (Table& waypoint : table.tables("waypoint")) {
    const Waypoint point{waypoint.quantity("at", 0.0, Quantity::time),
                         read_position(waypoint, "position", settings.hand.start)};
    waypoint.finish();
    if (point.at <= last)
      throw Refused(waypoint.place("at") + "wants to be later than the waypoint before");
    last = point.at;
    settings.hand.waypoints.push_back(point);
  }
  table.finish();
}

}  // namespace emulator
