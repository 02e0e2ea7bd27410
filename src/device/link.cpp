// The kinds of links, each opened by its type of address.
#include "device/link.h"

#include <utility>
#include <variant>

#include "device/inverse3.h"
#include "device/line_gauge.h"
#include "device/link_text.h"
#include "device/mark10.h"
#include "device/recording.h"

namespace palpate::device {

struct Link::Variant {
  std::variant<Mark10, LineGauge, Inverse3, Recording> link;

  template <class Kind, class... Arguments>
  explicit Variant(std::in_place_type_t<Kind> kind, Arguments&&... arguments)
      : link(kind, std::forward<Arguments>(arguments)...) {}

  static std::unique_ptr<Variant> open(const StandAddress& address, Purpose purpose, Clock& clock,
                                       Tap* tap) {
    return std::make_unique<Variant>(std::in_place_type<Mark10>, address.port, purpose, clock, tap);
  }
  static std::unique_ptr<Variant> open(const GaugeAddress& address, Purpose, Clock& clock,
                                       Tap* tap) {
    return std::make_unique<Variant>(std::in_place_type<LineGauge>, address, clock, tap);
  }
  static std::unique_ptr<Variant> open(const ArmAddress& address, Purpose purpose, Clock& clock,
                                       Tap* tap) {
    return std::make_unique<Variant>(std::in_place_type<Inverse3>, address, purpose, clock, tap);
  }
  static std::unique_ptr<Variant> open(const RecordingAddress& address, Purpose, Clock& clock,
                                       Tap*) {
    return std::make_unique<Variant>(std::in_place_type<Recording>, address.file, clock);
  }

  template <class Use>
  decltype(auto) with(const Use& use) {
    return std::visit(use, link);
  }
};

Link::Link(std::string_view text, Purpose purpose, Clock& clock, Tap* tap)
    : link_(std::visit(
          [&](const auto& address) { return Variant::open(address, purpose, clock, tap); },
          parse_link(text))) {}

Link::~Link() = default;
Link::Link(Link&&) noexcept = default;

const Identity& Link::identity() const {
  return link_->with([](auto& link) -> const Identity& { return link.identity(); });
}
const Limits& Link::limits() const {
  return link_->with([](auto& link) -> const Limits& { return link.limits(); });
}
Traffic Link::traffic() const {
  return link_->with([](auto& link) { return link.traffic(); });
}
Sample Link::sample(double wait) {
  return link_->with([&](auto& link) { return link.sample(wait); });
}

// Only the arm accepts forces, and only the stand accepts motions.
Fault Link::command_force(const Vec3& force) {
  auto* arm = std::get_if<Inverse3>(&link_->link);
  return arm != nullptr ? arm->command_force(force) : Fault::refused;
}
Fault Link::set_travel_limits(double low, double high) {
  auto* stand = std::get_if<Mark10>(&link_->link);
  return stand != nullptr ? stand->set_travel_limits(low, high) : Fault::refused;
}
Fault Link::command_motion(const Motion& motion) {
  auto* stand = std::get_if<Mark10>(&link_->link);
  return stand != nullptr ? stand->move(motion) : Fault::refused;
}

std::vector<std::string> Link::heard() const {
  const auto* gauge = std::get_if<LineGauge>(&link_->link);
  return gauge != nullptr ? gauge->heard() : std::vector<std::string>();
}

bool Link::stop() {
  return link_->with([](auto& link) { return link.stop(); });
}

}  // namespace palpate::device
