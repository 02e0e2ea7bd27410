// A WebSocket client with deadlines, which allocates no memory once the connection is open.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::device {

class Tap;

// A host's name and its addresses, looked up with a time limit.
struct Host {
  std::string name;                    // as it was given
  std::vector<std::string> addresses;  // numerical, IPv4 and IPv6, in the system's order
};

// Looks `name` up until `until` (s, wire_time()); a numerical address is returned as it is. Throws
// LinkError if the host is unknown or the system's name service does not answer in time; in the
// latter case a detached thread goes on waiting for the answer.
[[nodiscard]] Host look_up(const std::string& name, double until);

class WebSocket {
 public:
  // Connects and completes the handshake until `until` (s, wire_time()). Throws LinkError if no
  // program listens on the port, if the program there is no WebSocket service, or if time runs out.
  WebSocket(const Host& host, int port, double until);
  ~WebSocket();
  WebSocket(WebSocket&&) noexcept;

  // From now on `tap` receives a copy of all messages; null ends this.
  void tap(Tap* tap);

  // Sends one text message of at most 512 bytes. False if it is longer, if the last message is
  // still being written (the other side does not read), or if the socket is closed.
  bool send(std::string_view text);

  enum class Outcome { message, nothing, closed };
  struct Received {
    Outcome outcome = Outcome::nothing;
    std::string_view text;  // valid until the next call; empty for a message of more than 60 kB
    bool binary = false;
  };
  // Returns the next message; waits for it until `until` (s, wire_time()).
  [[nodiscard]] Received receive(double until);
  // Returns the next message if it has arrived already. Never waits, and its work is bounded.
  [[nodiscard]] Received glance();

  [[nodiscard]] bool closed() const;
  [[nodiscard]] std::string why_closed() const;  // a clause; empty while it is open

 private:
  struct Implementation;
  std::unique_ptr<Implementation> it_;
};

// GET http://host:port/target: the body, if it comes with status 200 by `until` (s, wire_time()).
[[nodiscard]] std::optional<std::string> http_get(const Host& host, int port,
                                                  const std::string& target, double until);

}  // namespace palpate::device
