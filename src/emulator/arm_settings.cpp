// Reads the tables [hand], [[waypoint]] and [device].
#include "emulator/arm.h"
#include "emulator/settings.h"

namespace emulator {

using palpate::above;

void fields(FieldVisitor& visitor, ArmSettings& settings) {
  HandSettings& hand = settings.hand;
  visitor.table({"hand", "the person's hand"}, [&](FieldVisitor& inside) {
    inside.quantity({"mass", "of hand and arm at the grip"}, hand.mass, unit::g, above(0.0));
    inside.quantity({"stiffness", "of the spring to the intended position"}, hand.stiffness,
                    unit::N_per_m, above(0.0));
    inside.quantity({"damping", "of that spring"}, hand.damping, unit::N_s_per_m, at_least(0.0));
    inside.quantities({"start", "position at time zero"}, hand.start, unit::mm, {});
  });
  visitor.table({"device", "the haptic arm"}, [&](FieldVisitor& inside) {
    inside.text({"id", "device id"}, settings.device_id);
    ArmForm& form = settings.form;
    inside.text({"basis", "permutation of the axes"}, form.basis);
    inside.number({"mount_scale", "of the mount"}, form.mount_scale, above(0.0));
    inside.number({"mount_turn", "of the mount about x, rad"}, form.mount_turn, {});
    inside.number({"transform_scale", "of the workspace"}, form.transform_scale, above(0.0));
    inside.flag({"both_modes", "`mode` beside `control_mode`"}, form.both_modes);
    inside.flag({"grips", "two grips before the arms"}, form.grips);
    inside.flag({"numeric_id", "the id is a JSON number"}, form.numeric_id);
    inside.text({"second_id", "of a second arm, which comes first"}, form.second_id);
    inside.flag({"calibrated", "of the status"}, form.calibrated);
    inside.flag({"power_supply", "of the status"}, form.power);
    inside.quantity({"force_limit", "greatest length of the force"}, settings.force_limit, unit::N,
                    above(0.0));
    inside.quantity({"idle_after", "time without messages until the force ends"},
                    settings.idle_after, unit::ms, {});
  });
  visitor.tables(
      {"waypoint", "intended position of the hand at a time"},
      static_cast<int>(hand.waypoints.size()),
      [&](int count) {
        hand.waypoints.resize(palpate::as_index(count), {0.0, hand.start});
      },
      [&](FieldVisitor& inside, int i) {
        Waypoint& point = hand.waypoints[palpate::as_index(i)];
        inside.quantity({"at", "time of arrival"}, point.at, unit::s, above(0.0));
        inside.quantities({"position", "of the waypoint"}, point.position, unit::mm, {});
      });
}

void read_hand(const std::string& path, ArmSettings& settings) {
  const palpate::Node file =
      read_settings(path, [&](FieldVisitor& visitor) { fields(visitor, settings); });
  double last = 0.0;
  for (std::size_t i = 0; i < settings.hand.waypoints.size(); ++i) {
    const double at = settings.hand.waypoints[i].at;
    if (at <= last)
      refuse(file, "waypoint." + std::to_string(i + 1) + ".at",
             "`at` must be later than that of the waypoint before; give a later time");
    last = at;
  }
}

}  // namespace emulator
