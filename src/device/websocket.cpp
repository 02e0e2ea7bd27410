// The only file that uses Boost.Beast and Asio. Asynchronous operations run inside the calls that
// wait. Their memory comes from an arena, because a loop with a device must not allocate.
#include <utility>  // before asio.hpp, which needs std::exchange and does not include it

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <future>
#include <memory_resource>
#include <thread>

#include "base/error.h"
#include "device/clock.h"
#include "device/tap.h"
#include "device/websocket.h"

namespace palpate::device {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using Error = boost::system::error_code;
using Executor = net::io_context::executor_type;
using Socket = net::basic_stream_socket<net::ip::tcp, Executor>;

// Memory for the few operations that can be pending at once, taken when the connection opens.
struct Arena {
  std::array<std::byte, 131072> memory;
  std::pmr::monotonic_buffer_resource all{memory.data(), memory.size()};
  std::pmr::unsynchronized_pool_resource pool{{16, 2048}, &all};
};

// A handler with the arena as its associated allocator.
template <class Function>
struct InArena {
  using allocator_type = std::pmr::polymorphic_allocator<std::byte>;  // NOLINT: the standard's name
  Arena* arena;
  Function function;

  [[nodiscard]] allocator_type get_allocator() const { return &arena->pool; }
  template <class... Arguments>
  void operator()(Arguments&&... arguments) {
    function(std::forward<Arguments>(arguments)...);
  }
};
template <class Function>
InArena<Function> in_arena(Arena& arena, Function function) {
  return {&arena, std::move(function)};
}

std::string place(const Host& host, int port) { return host.name + ":" + std::to_string(port); }

using Endpoints = std::vector<net::ip::tcp::endpoint>;

Endpoints endpoints(const Host& host, int port) {
  Endpoints all;
  for (const std::string& text : host.addresses) {
    Error error;
    const auto address = net::ip::make_address(text, error);
    if (!error) all.emplace_back(address, static_cast<unsigned short>(port));
  }
  return all;
}

// Lets the kernel ask the other side for a sign of life while it says nothing. Otherwise a socket
// that only receives looks the same whether its service is quiet or its machine is gone. It breaks
// after 4 s without an answer.
void ask_for_signs_of_life(Socket& socket) {
  for (const auto& [level, name, value] : {std::array<int, 3>{SOL_SOCKET, SO_KEEPALIVE, 1},
                                           std::array<int, 3>{IPPROTO_TCP, TCP_KEEPIDLE, 1},
                                           std::array<int, 3>{IPPROTO_TCP, TCP_KEEPINTVL, 1},
                                           std::array<int, 3>{IPPROTO_TCP, TCP_KEEPCNT, 3}})
    (void)::setsockopt(socket.native_handle(), level, name, &value, sizeof value);
}

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

std::chrono::steady_clock::duration duration(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(seconds));
}

}  // namespace

// getaddrinfo() has no timeout and cannot be cancelled, so that a separate thread calls it.
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

struct WebSocket::Implementation {
  static constexpr std::size_t portion = 4096;  // bytes per read operation
  static constexpr std::size_t many = 64;       // handlers that a wait runs at most
  static constexpr std::size_t few = 8;         // handlers that a glance runs at most

  net::io_context context{1};
  net::executor_work_guard<Executor> work{context.get_executor()};
  Arena arena;
  beast::websocket::stream<Socket> stream{context.get_executor()};
  beast::flat_static_buffer<65536> incoming;
  std::array<char, 512> outgoing{};
  bool reading = false;
  bool complete = false;  // `incoming` contains a whole message
  bool overlong = false;  // the message did not fit into `incoming` and is discarded
  bool handed_out = false;
  bool writing = false;
  Tap* tap = nullptr;
  Error failure;

  void start_reading() {
    if (handed_out) {
      incoming.consume(incoming.size());
      overlong = false;
    }
    handed_out = false;
    if (!reading && !complete && !failure) read_on();
  }

  void read_on() {
    reading = true;
    stream.async_read_some(incoming, portion, in_arena(arena, [this](Error error, std::size_t) {
                             reading = false;
                             if (error) {
                               failure = error;
                             } else if (stream.is_message_done()) {
                               complete = true;
                             } else {
                               make_room();
                               read_on();
                             }
                           }));
  }

  void make_room() {
    if (incoming.size() + portion <= incoming.max_size()) return;
    incoming.consume(incoming.size());
    overlong = true;
  }

  // Runs at most `most` ready handlers, so that a fast sender cannot delay the caller.
  std::size_t run_ready(std::size_t most = many) {
    std::size_t ran = 0;
    while (ran < most && context.poll_one() > 0) ++ran;
    return ran;
  }

  Received take_message() {
    if (!complete) return {failure ? Outcome::closed : Outcome::nothing, {}, false};
    complete = false;
    handed_out = true;
    if (overlong) return {Outcome::message, {}, stream.got_binary()};
    const auto bytes = incoming.cdata();
    const std::string_view message(static_cast<const char*>(bytes.data()), bytes.size());
    if (tap) tap->note(Tap::Way::received, message);
    return {Outcome::message, message, stream.got_binary()};
  }

  // Waits for the socket until `until` (s, wire_time()) and runs the handlers that are ready.
  void turn(double until) {
    if (run_ready() > 0) return;
    const timespec wait = timespec_of(std::max(0.0, until - wire_time()));
    const auto events = static_cast<short>(writing ? POLLIN | POLLOUT : POLLIN);
    pollfd one{beast::get_lowest_layer(stream).native_handle(), events, 0};
    ::ppoll(&one, 1, &wait, nullptr);
    run_ready();
  }
};

WebSocket::WebSocket(const Host& host, int port, double until)
    : it_(std::make_unique<Implementation>()) {
  Implementation& it = *it_;
  const Endpoints all = endpoints(host, port);
  bool done = false;
  Error error;
  const auto await = [&](const char* what) {
    while (!done && wire_time() < until) it.context.run_one_for(duration(until - wire_time()));
    if (!done)
      throw LinkError("palpate: " + place(host, port) + " " + what +
                      "; is the device's service hung? restart it");
    done = false;
  };
  Socket& socket = beast::get_lowest_layer(it.stream);
  net::async_connect(socket, all, [&](Error got, const net::ip::tcp::endpoint&) {
    error = got;
    done = true;
  });
  try {
    await("does not answer");
    if (error == net::error::connection_refused)
      throw LinkError("palpate: nobody listens on " + place(host, port) +
                      "; start the device's service (`systemctl start haply-inverse-service`), or "
                      "give the port it uses");
    if (error)
      throw LinkError("palpate: " + place(host, port) + " cannot be reached: " + error.message());
    socket.set_option(net::ip::tcp::no_delay(true));
    ask_for_signs_of_life(socket);
    it.stream.async_handshake(place(host, port), "/", [&](Error got) {
      error = got;
      done = true;
    });
    await("takes the connection but says nothing");
  } catch (...) {
    // Pending operations refer to variables of this function, and must end before it does.
    Error ignored;
    socket.close(ignored);
    it.context.poll();
    throw;
  }
  if (error)
    throw LinkError("palpate: " + place(host, port) + " is no WebSocket service (" +
                    error.message() + "); the device's service listens on 10001 by default");
  it.stream.text(true);
}

WebSocket::WebSocket(WebSocket&&) noexcept = default;

WebSocket::~WebSocket() {
  if (!it_) return;
  Implementation& it = *it_;
  Socket& socket = beast::get_lowest_layer(it.stream);
  Error ignored;
  if (it.stream.is_open() && !it.failure && !it.writing) {
    bool done = false;
    it.stream.async_close(beast::websocket::close_code::normal, [&](Error) { done = true; });
    const double until = wire_time() + 0.05;  // s, to wait for an orderly close
    while (!done && wire_time() < until) it.context.run_one_for(duration(until - wire_time()));
    socket.close(ignored);
    while (!done && it.context.poll() > 0) {
    }
  }
  socket.close(ignored);
  it.context.poll();
}

void WebSocket::tap(Tap* tap) { it_->tap = tap; }

bool WebSocket::send(std::string_view text) {
  Implementation& it = *it_;
  it.run_ready();
  if (it.failure || it.writing || text.size() > it.outgoing.size()) return false;
  std::ranges::copy(text, it.outgoing.begin());
  it.writing = true;
  if (it.tap) it.tap->note(Tap::Way::sent, text);
  it.stream.async_write(net::buffer(it.outgoing.data(), text.size()),
                        in_arena(it.arena, [&it](Error error, std::size_t) {
                          it.writing = false;
                          if (error) it.failure = error;
                        }));
  it.run_ready();
  return !it.failure;
}

WebSocket::Received WebSocket::receive(double until) {
  Implementation& it = *it_;
  it.start_reading();
  it.run_ready();
  while (!it.complete && !it.failure && wire_time() < until) it.turn(until);
  return it.take_message();
}

WebSocket::Received WebSocket::glance() {
  it_->start_reading();
  it_->run_ready(Implementation::few);
  return it_->take_message();
}

bool WebSocket::closed() const { return static_cast<bool>(it_->failure); }

std::string WebSocket::why_closed() const {
  if (!it_->failure) return {};
  if (it_->failure == beast::websocket::error::closed)
    return "the service closed the connection (code " + std::to_string(it_->stream.reason().code) +
           ")";
  return "the connection broke: " + it_->failure.message();
}

std::optional<std::string> http_get(const Host& host, int port, const std::string& target,
                                    double until) {
  net::io_context context(1);
  Socket socket(context.get_executor());
  http::request<http::empty_body> request(http::verb::get, target, 11);
  request.set(http::field::host, place(host, port));
  request.keep_alive(false);
  beast::flat_static_buffer<16384> buffer;
  // A body of its own size: that of a string takes the memory that an answer announces.
  http::response_parser<http::basic_dynamic_body<beast::flat_static_buffer<65536>>> answer;
  std::optional<std::string> body;
  const Endpoints all = endpoints(host, port);
  net::async_connect(socket, all, [&](Error refused, const net::ip::tcp::endpoint&) {
    if (refused) return;
    http::async_write(socket, request, [&](Error broken, std::size_t) {
      if (broken) return;
      http::async_read(socket, buffer, answer, [&](Error unread, std::size_t) {
        if (!unread && answer.get().result() == http::status::ok)
          body = beast::buffers_to_string(answer.get().body().data());
      });
    });
  });
  context.run_for(duration(std::max(0.0, until - wire_time())));
  Error ignored;
  socket.close(ignored);
  context.restart();
  context.poll();  // ends pending operations, which refer to variables of this function
  return body;
}

}  // namespace palpate::device
