// Any bytes from a server. The first byte says where: as frames after the handshake, in place of
// the answer to the handshake, or in place of the answer to an HTTP request.
#include "device/websocket.h"

#include <thread>

#include "device/clock.h"
#include "fuzzing.h"
#include "web_socket.h"

void palpate::fuzz::websocket(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return;
  static test::WebSocketServer server;
  const int way = data[0] % 3;
  std::thread serving([&] {
    if (way == 0)
      server.take_with_handshake();
    else
      server.take_after_request();
    server.send_raw(text_of(data + 1, size - 1));
    server.end_sending();
  });
  const device::Host host{"127.0.0.1", {"127.0.0.1"}};
  const double until = device::wire_time() + 1.0;  // s, far more than the loopback takes
  try {
    if (way == 2) {
      (void)device::http_get(host, server.port(), "/devices", until);
    } else {
      device::WebSocket socket(host, server.port(), until);
      for (std::size_t message = 0; message <= size; ++message) {
        const auto received = socket.receive(until);
        require(received.text.size() < 65536);
        if (received.outcome == device::WebSocket::Outcome::closed) break;
      }
      require(socket.closed() && !socket.why_closed().empty());
    }
  } catch (const LinkError& error) {
    require(!std::string_view(error.what()).empty());
  }
  serving.join();
}
