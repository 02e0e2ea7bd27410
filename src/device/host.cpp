// getaddrinfo() has no timeout and cannot be cancelled, so that a separate thread calls it.
#include "device/host.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <future>
#include <thread>
#include <utility>

#include "base/error.h"
#include "device/clock.h"

namespace palpate::device {
namespace {

bool is_address(const std::string& name) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  return ::inet_pton(AF_INET, name.c_str(), bytes.data()) == 1 ||
         ::inet_pton(AF_INET6, name.c_str(), bytes.data()) == 1;
}

// Empty if the host is unknown.
std::vector<std::string> addresses_of(const std::string& name) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* first = nullptr;
  if (::getaddrinfo(name.c_str(), nullptr, &hints, &first) != 0) return {};
  std::vector<std::string> addresses;
  for (const addrinfo* at = first; at != nullptr; at = at->ai_next) {
    std::array<char, NI_MAXHOST> text{};
    if (::getnameinfo(at->ai_addr, at->ai_addrlen, text.data(), text.size(), nullptr, 0,
                      NI_NUMERICHOST) == 0)
      addresses.emplace_back(text.data());
  }
  ::freeaddrinfo(first);
  return addresses;
}

}  // namespace

Host look_up(const std::string& name, double until) {
  if (is_address(name)) return {name, {name}};
  std::promise<std::vector<std::string>> promise;
  auto found = promise.get_future();
  std::thread([name, promise = std::move(promise)]() mutable {
    promise.set_value(addresses_of(name));
  }).detach();
  const std::chrono::duration<double> left(std::max(0.0, until - wire_time()));
  if (found.wait_for(left) != std::future_status::ready)
    throw LinkError("palpate: the host `" + name +
                    "` could not be looked up in time, the system's name service does not answer; "
                    "give the host's address in numbers");
  std::vector<std::string> addresses = found.get();
  if (addresses.empty())
    throw LinkError("palpate: the host `" + name +
                    "` is not known; give its address, or `localhost`");
  return {name, std::move(addresses)};
}

}  // namespace palpate::device
