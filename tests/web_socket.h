// Both ends of a WebSocket on the loopback, which wait for each other. Their file alone reads
// Boost.Beast, which takes 20 s of a compilation.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace palpate::test {

class WebSocketClient {
 public:
  explicit WebSocketClient(int port);
  ~WebSocketClient();
  void say(const std::string& text);
  std::string hear();  // empty at the end of the connection
  void close();
  // Why nothing more is heard: 'reset' by the other side, or 'closed' by it with a code of RFC
  // 6455.
  [[nodiscard]] std::string end() const;
  [[nodiscard]] int close_code() const;  // 0: none was said

 private:
  struct Ends;
  std::unique_ptr<Ends> ends_;
};

// Listens at a free port and takes one client after another.
class WebSocketServer {
 public:
  WebSocketServer();
  ~WebSocketServer();
  [[nodiscard]] int port() const;
  void take_with_handshake();
  void take_after_request();  // reads the head of an HTTP request and answers nothing
  void send_raw(std::string_view bytes);
  void end_sending();
  [[nodiscard]] int descriptor() const;  // of the client's connection
  void leave();                          // closes it without a word

 private:
  struct Ends;
  std::unique_ptr<Ends> ends_;
};

struct HttpAnswer {
  unsigned status;
  std::string type;
  std::string body;
};
HttpAnswer http_get(int port, const std::string& target);

}  // namespace palpate::test
