// One live link, whatever stands behind it.
#pragma once

#include <memory>
#include <string_view>

#include "device/clock.h"
#include "device/sample.h"

namespace palpate::device {

class Tap;

class Link {
 public:
  // Opens what a LINK text names. Throws InputError where the text or a recording is wrong, and
  // LinkError with a diagnosis where nobody answers. `clock` outlives the link, as does `tap`,
  // which hears what goes over the line from the greeting on.
  Link(std::string_view text, Purpose purpose, Clock& clock, Tap* tap = nullptr);
  ~Link();
  Link(Link&&) noexcept;

  [[nodiscard]] const Identity& identity() const;
  [[nodiscard]] const Limits& limits() const;
  [[nodiscard]] Traffic traffic() const;

  // A new sample where one comes within `wait` s of real time; 0 only looks. Allocates nothing.
  // The arm answers what was sent: after each sample a force, if only zero, asks for the next.
  [[nodiscard]] Sample sample(double wait);

  // What the arm's hand should feel, in N, along the axes of `position`: sent at once. A force
  // that is not finite is sent as zero. `refused` by links that take no force, and by the arm for
  // anything but zero where it was opened to look.
  [[nodiscard]] Fault command_force(const Vec3& force);

  // What the stand's crosshead should do; see Mark10. `refused` by other links.
  [[nodiscard]] Fault set_travel_limits(double low, double high);
  [[nodiscard]] Fault command_motion(const Motion& motion);

  // No motion, no force; true where the device confirms it (the arm does so by its silence).
  bool stop();

 private:
  struct Variant;
  std::unique_ptr<Variant> link_;
};

}  // namespace palpate::device
