// The links there are, by the kind of their address.
#include "device/link.h"

#include <utility>
#include <variant>

#include "device/inverse3.h"
#include "device/link_text.h"
#include "device/mark10.h"
#include "device/recording.h"

namespace palpate::device {

struct Link::Variant {
  std::variant<std::monostate, Mark10, Inverse3, Recording> link;

  // Calls `use` with the link there is.
  template <class Use>
  decltype(auto) with(const Use& use) {
    if (auto* stand = std::get_if<Mark10>(&link)) return use(*stand);
    if (auto* arm = std::get_if<Inverse3>(&link)) return use(*arm);
    return use(std::get<Recording>(link));
  }
};

Link::Link(std::string_view text, Purpose purpose, Clock& clock, Tap* tap)
    : link_(std::make_unique<Variant>()) {
  const Address address = parse_link(text);
  auto& link = link_->link;
  if (const auto* stand = std::get_if<StandAddress>(&address)) {
    link.emplace<Mark10>(stand->port, purpose, clock, tap);
  } else if (const auto* arm = std::get_if<ArmAddress>(&address)) {
    link.emplace<Inverse3>(*arm, purpose, clock, tap);
  } else {
    link.emplace<Recording>(std::get<RecordingAddress>(address).file, clock);
  }
}

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

bool Link::stop() {
  if (auto* stand = std::get_if<Mark10>(&link_->link)) return stand->stop();
  if (auto* arm = std::get_if<Inverse3>(&link_->link)) return arm->stop();
  return true;
}

}  // namespace palpate::device
