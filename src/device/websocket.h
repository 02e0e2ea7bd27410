// A WebSocket to a local service, with deadlines and without allocations once it is open.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace palpate::device {

struct Host;
class Tap;

class WebSocket {
 public:
  // Connects and shakes hands till `until` (s, wire_time). Throws LinkError: nobody listens, no
  // WebSocket there, too late.
  WebSocket(const Host& host, int port, double until);
  ~WebSocket();
  WebSocket(WebSocket&&) noexcept;

  // From now on it hears all messages; null: nobody.
  void tap(Tap* tap);

  // Sends one text message of at most 512 bytes. False where the last one is still on its way
  // (the other side does not read) or the socket is closed.
  bool send(std::string_view text);

  enum class Outcome { message, nothing, closed };
  struct Received {
    Outcome outcome = Outcome::nothing;
    std::string_view text;  // holds till the next call; empty where it was beyond 60 kB
    bool binary = false;
  };
  // The next message, waiting till `until` (s, wire_time).
  [[nodiscard]] Received receive(double until);
  // The next message where it is there already. Waits for nothing, and does little work whatever
  // comes in.
  [[nodiscard]] Received glance();

  [[nodiscard]] bool closed() const;
  [[nodiscard]] std::string why_closed() const;  // a clause; empty while it is open

 private:
  struct Implementation;
  std::unique_ptr<Implementation> it_;
};

// The body of `GET http://host:port/target` till `until` (s, wire_time); nothing where none comes.
[[nodiscard]] std::optional<std::string> http_get(const Host& host, int port,
                                                  const std::string& target, double until);

}  // namespace palpate::device
