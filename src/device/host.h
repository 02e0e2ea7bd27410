// A host's name and where it is, found in time.
#pragma once

#include <string>
#include <vector>

namespace palpate::device {

struct Host {
  std::string name;                    // as it was given
  std::vector<std::string> addresses;  // of IPv4 and IPv6, as numbers, in the system's order
};

// Looks the name up till `until` (s, wire_time); a name that is an address is its own. Throws
// LinkError where the host is not known, or the system's name service does not say so in time: a
// thread is left behind then, which waits for it.
[[nodiscard]] Host look_up(const std::string& name, double until);

}  // namespace palpate::device
