// A host's name and its addresses, looked up with a time limit.
#pragma once

#include <string>
#include <vector>

namespace palpate::device {

struct Host {
  std::string name;                    // as it was given
  std::vector<std::string> addresses;  // numerical, IPv4 and IPv6, in the system's order
};

// Looks `name` up until `until` (s, wire_time()); a numerical address is returned as it is. Throws
// LinkError if the host is unknown or the system's name service does not answer in time; in the
// latter case a detached thread goes on waiting for the answer.
[[nodiscard]] Host look_up(const std::string& name, double until);

}  // namespace palpate::device
