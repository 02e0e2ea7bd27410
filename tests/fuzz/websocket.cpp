// Any bytes from a server. The first byte says where: as frames after the handshake, in place of
// the answer to the handshake, or in place of the answer to an HTTP request.
#include <utility>  // which Boost 1.74 forgets

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include "device/websocket.h"

#include <thread>

#include "device/clock.h"
#include "device/host.h"
#include "fuzzing.h"

namespace {

namespace net = boost::asio;
using Error = boost::system::error_code;

// Takes one connection on the loopback and sends the bytes.
class Server {
 public:
  Server() : acceptor_(context_, {net::ip::address_v4::loopback(), 0}) {}
  [[nodiscard]] int port() const { return acceptor_.local_endpoint().port(); }

  void serve(std::string_view bytes, bool shakes_hands) {
    Error ignored;
    boost::beast::websocket::stream<net::ip::tcp::socket> stream(context_);
    auto& socket = stream.next_layer();
    acceptor_.accept(socket, ignored);
    std::string request;
    if (shakes_hands) {
      stream.accept(ignored);
    } else {
      net::read_until(socket, net::dynamic_buffer(request), "\r\n\r\n", ignored);
    }
    net::write(socket, net::buffer(bytes), ignored);
    socket.shutdown(net::ip::tcp::socket::shutdown_send, ignored);
  }

 private:
  net::io_context context_;
  net::ip::tcp::acceptor acceptor_;
};

}  // namespace

void palpate::fuzz::websocket(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return;
  static Server server;
  const int way = data[0] % 3;
  std::thread serving(
      [&] { server.serve(text_of(data + 1, size - 1), /*shakes_hands=*/way == 0); });
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
