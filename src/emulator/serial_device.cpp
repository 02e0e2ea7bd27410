// The faults of a serial line.
#include "emulator/serial_device.h"

#include <algorithm>
#include <utility>

namespace emulator {

char SerialDevice::noise(char byte) {
  return static_cast<char>((static_cast<unsigned char>(byte) * 37U + 11U) | 0x80U);
}

Nanoseconds SerialDevice::byte_time() const {
  const Nanoseconds usual = (10'000'000'000 + baud_ / 2) / baud_;
  return faults_.lasts("slow", now_) ? 10 * usual : usual;
}

std::string SerialDevice::give() {
  if (faults_.lasts("stall", now_)) return {};
  return std::exchange(out_, {});
}

void SerialDevice::plug_in() {
  unplugged_ = false;
  again_.reset();
}

void SerialDevice::go_to(Nanoseconds time, std::int64_t messages) {
  const auto reach = [&](Nanoseconds at) {
    advance_to(std::max(now_, at));
    for (const Fault& fault : faults_.begin(now_, messages)) {
      log_row("fault", fault.kind);
      if (fault.kind != "unplug") {
        begin(fault);
        continue;
      }
      unplugged_ = true;
      out_.clear();
      if (fault.duration) again_ = now_ + *fault.duration;
    }
  };
  for (auto next = faults_.next_time(); next && *next <= time; next = faults_.next_time())
    reach(*next);
  reach(time);
}

std::string SerialDevice::spoilt(std::string reply, const std::string& another, std::size_t end) {
  if (faults_.spoils("glue")) std::erase_if(reply, [](char c) { return c == '\r' || c == '\n'; });
  if (faults_.spoils("truncate") && reply.size() > end)
    reply.erase((reply.size() - end) / 2, reply.size() - end - (reply.size() - end) / 2);
  if (faults_.spoils("duplicate")) reply += reply;
  if (faults_.spoils("unsolicited")) reply = another + reply;
  if (faults_.spoils("nul")) {
    std::string wide;
    for (const char byte : reply) (wide += byte) += '\0';
    reply = wide;
  }
  if (faults_.spoils("garbage") && reply.size() > end)
    std::transform(reply.begin(), reply.end() - static_cast<std::ptrdiff_t>(end), reply.begin(),
                   noise);
  if (faults_.spoils("drop")) reply.clear();
  return reply;
}

void SerialDevice::send(const std::string& bytes) {
  if (bytes.empty()) return;
  log_row("out", bytes);
  const bool garbled = other_rate_ || faults_.lasts("wrong_baud", now_);
  for (const char byte : bytes) out_ += garbled ? noise(byte) : byte;
}

}  // namespace emulator
