// A WebSocket to a local service, with deadlines and without allocations once it is open.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace palpate::device {

class Tap;

class WebSocket {
 public:
  // Connects and shakes hands within `wait` s of real time. Throws LinkError: no such host, nobody
  // listens, no WebSocket there, too late.
  WebSocket(const std::string& host, int port, double wait);
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
    std::string_view text;  // holds till the next call
    bool binary = false;
  };
  // The next message, waiting till `until` (s, wire_time).
  [[nodiscard]] Received receive(double until);

  [[nodiscard]] bool closed() const;
  [[nodiscard]] std::string why_closed() const;  // a clause; empty while it is open

 private:
  struct Implementation;
  std::unique_ptr<Implementation> it_;
};

// The body of `GET http://host:port/target` within `wait` s; nothing where none comes.
[[nodiscard]] std::optional<std::string> http_get(const std::string& host, int port,
                                                  const std::string& target, double wait);

}  // namespace palpate::device
