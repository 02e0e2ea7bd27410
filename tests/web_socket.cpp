#include "web_socket.h"

#include <utility>  // before Asio 1.74, which forgets it

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <optional>

namespace palpate::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

tcp::endpoint endpoint(int port) {
  return {asio::ip::address_v4::loopback(), static_cast<unsigned short>(port)};
}

}  // namespace

struct WebSocketClient::Ends {
  asio::io_context context{};
  websocket::stream<tcp::socket> stream{context};
  error_code error{};
};

WebSocketClient::WebSocketClient(int port) : ends_(std::make_unique<Ends>()) {
  ends_->stream.next_layer().connect(endpoint(port));
  ends_->stream.next_layer().set_option(tcp::no_delay(true));
  ends_->stream.handshake("127.0.0.1", "/");
}

WebSocketClient::~WebSocketClient() = default;

void WebSocketClient::say(const std::string& text) {
  error_code ignored;
  ends_->stream.write(asio::buffer(text), ignored);
}

std::string WebSocketClient::hear() {
  beast::flat_buffer buffer;
  ends_->stream.read(buffer, ends_->error);
  return beast::buffers_to_string(buffer.data());
}

void WebSocketClient::close() {
  error_code ignored;
  ends_->stream.close(websocket::close_code::normal, ignored);
}

std::string WebSocketClient::end() const {
  if (ends_->error == asio::error::connection_reset) return "reset";
  return ends_->error == websocket::error::closed ? "closed" : ends_->error.message();
}

int WebSocketClient::close_code() const { return ends_->stream.reason().code; }

struct WebSocketServer::Ends {
  asio::io_context context{};
  tcp::acceptor acceptor{context, endpoint(0)};
  std::optional<websocket::stream<tcp::socket>> stream = {};
  error_code ignored{};

  void take() { acceptor.accept(stream.emplace(context).next_layer(), ignored); }
};

WebSocketServer::WebSocketServer() : ends_(std::make_unique<Ends>()) {}
WebSocketServer::~WebSocketServer() = default;

int WebSocketServer::port() const { return ends_->acceptor.local_endpoint().port(); }

void WebSocketServer::take_with_handshake() {
  ends_->take();
  ends_->stream->accept(ends_->ignored);
}

void WebSocketServer::take_after_request() {
  ends_->take();
  std::string request;
  asio::read_until(ends_->stream->next_layer(), asio::dynamic_buffer(request), "\r\n\r\n",
                   ends_->ignored);
}

void WebSocketServer::send_raw(std::string_view bytes) {
  asio::write(ends_->stream->next_layer(), asio::buffer(bytes), ends_->ignored);
}

void WebSocketServer::end_sending() {
  ends_->stream->next_layer().shutdown(tcp::socket::shutdown_send, ends_->ignored);
}

int WebSocketServer::descriptor() const { return ends_->stream->next_layer().native_handle(); }

void WebSocketServer::leave() { ends_->stream->next_layer().close(ends_->ignored); }

HttpAnswer http_get(int port, const std::string& target) {
  asio::io_context context;
  tcp::socket socket(context);
  socket.connect(endpoint(port));
  http::request<http::empty_body> request(http::verb::get, target, 11);
  request.set(http::field::host, "127.0.0.1");
  http::write(socket, request);
  beast::flat_buffer buffer;
  http::response<http::string_body> response;
  http::read(socket, buffer, response);
  return {response.result_int(), std::string(response[http::field::content_type]), response.body()};
}

}  // namespace palpate::test
