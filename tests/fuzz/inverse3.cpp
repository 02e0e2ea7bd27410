// Any bytes from a socket: a position that is taken is finite and near, and nothing crashes.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "device/inverse3_protocol.h"
#include "fuzzing.h"

void palpate::fuzz::inverse3(const std::uint8_t* data, std::size_t size) {
  using namespace device;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto reply = inverse3::parse_reply(bytes, "049D");
  if (reply.position) {
    require(reply.position->allFinite() && reply.position->norm() <= 10.0);
    require(reply.fault == Fault::none || reply.fault == Fault::brake);
  } else {
    require(reply.fault != Fault::none);
  }
  if (reply.velocity) require(reply.velocity->allFinite());
  if (const auto snapshot = inverse3::parse_snapshot(bytes))
    for (const auto& arm : snapshot->arms) require(inverse3::usable_id(arm.id));
  static_cast<void>(inverse3::spelling_of(inverse3::parse_version(bytes)));
  static_cast<void>(inverse3::spelling_of(bytes));
  // The same bytes as numbers of a force: what is sent is short, closed, and no NaN.
  palpate::Vec3 force = palpate::Vec3::Zero();
  for (std::size_t i = 0; i < 3 && 8 * (i + 1) <= size; ++i) {
    std::uint64_t bits = 0;
    for (std::size_t j = 0; j < 8; ++j) bits = bits << 8 | data[8 * i + j];
    static_assert(sizeof bits == sizeof(double));
    __builtin_memcpy(&force[static_cast<Eigen::Index>(i)], &bits, sizeof bits);
  }
  const auto message = inverse3::force_message("049D", inverse3::Spelling::values, force);
  require(message.text().ends_with("}}}}]}"));
  require(message.text().find("nan") == std::string_view::npos &&
          message.text().find("inf") == std::string_view::npos);
}
