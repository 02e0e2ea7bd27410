// Boost.Beast and Asio, here alone. All operations are asynchronous, run by whoever waits; their
// memory comes from an arena, for nothing may be allocated while a hand holds the device.
#include <utility>  // before asio.hpp, which needs std::exchange and does not include it

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <poll.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <chrono>
#include <cmath>
#include <cstddef>

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

// Memory for the few operations that can be under way at once.
class Arena {
 public:
  void* take(std::size_t size) {
    for (std::size_t i = 0; size <= slot_size && i < slots; ++i) {
      if (used_[i]) continue;
      used_[i] = true;
      return memory_.data() + i * slot_size;
    }
    return ::operator new(size);
  }
  void give_back(void* pointer) {
    auto* byte = static_cast<std::byte*>(pointer);
    if (std::less<>()(byte, memory_.data()) ||
        !std::less<>()(byte, memory_.data() + memory_.size()))
      return ::operator delete(pointer);
    used_[static_cast<std::size_t>(byte - memory_.data()) / slot_size] = false;
  }

 private:
  static constexpr std::size_t slots = 16;
  static constexpr std::size_t slot_size = 2048;
  alignas(std::max_align_t) std::array<std::byte, slots * slot_size> memory_;
  std::bitset<slots> used_;
};

template <class T>
struct ArenaAllocator {
  using value_type = T;
  Arena* arena;

  explicit ArenaAllocator(Arena* from) : arena(from) {}
  template <class U>
  ArenaAllocator(const ArenaAllocator<U>& other) : arena(other.arena) {}  // NOLINT: rebinding
  T* allocate(std::size_t n) { return static_cast<T*>(arena->take(n * sizeof(T))); }
  void deallocate(T* pointer, std::size_t) { arena->give_back(pointer); }
  bool operator==(const ArenaAllocator& other) const { return arena == other.arena; }
};

// A function with the arena as its allocator.
template <class Function>
struct InArena {
  using allocator_type = ArenaAllocator<std::byte>;
  Arena* arena;
  Function function;

  [[nodiscard]] allocator_type get_allocator() const { return allocator_type(arena); }
  template <class... Arguments>
  void operator()(Arguments&&... arguments) {
    function(std::forward<Arguments>(arguments)...);
  }
};
template <class Function>
InArena<Function> in_arena(Arena& arena, Function function) {
  return {&arena, std::move(function)};
}

std::string place(const std::string& host, int port) { return host + ":" + std::to_string(port); }

using Endpoints = net::ip::tcp::resolver::results_type;

Endpoints resolve(net::io_context& context, const std::string& host, int port) {
  net::ip::tcp::resolver resolver(context);
  Error error;
  const auto found = resolver.resolve(host, std::to_string(port), error);
  if (error)
    throw LinkError("palpate: the host `" + host +
                    "` is not known; give its address, or `localhost`");
  return found;
}

std::chrono::steady_clock::duration duration(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(seconds));
}

}  // namespace

struct WebSocket::Implementation {
  net::io_context context{1};
  net::executor_work_guard<Executor> work{context.get_executor()};
  Arena arena;
  beast::websocket::stream<Socket> stream{context.get_executor()};
  beast::flat_static_buffer<65536> incoming;
  std::array<char, 512> outgoing{};
  bool reading = false;
  bool complete = false;  // a message lies in `incoming`
  bool handed_out = false;
  bool writing = false;
  Tap* tap = nullptr;
  Error failure;

  void start_reading() {
    if (handed_out) incoming.consume(incoming.size());
    handed_out = false;
    if (reading || complete || failure) return;
    reading = true;
    stream.async_read(incoming, in_arena(arena, [this](Error error, std::size_t) {
                        reading = false;
                        if (error) {
                          failure = error;
                        } else {
                          complete = true;
                        }
                      }));
  }

  // Waits for the socket till `until` and does what is due.
  void turn(double until) {
    if (context.poll() > 0) return;
    const double left = std::max(0.0, until - wire_time());
    timespec wait{};
    wait.tv_sec = static_cast<time_t>(left);
    wait.tv_nsec = static_cast<long>(1e9 * (left - std::floor(left)));
    const auto events = static_cast<short>(writing ? POLLIN | POLLOUT : POLLIN);
    pollfd one{beast::get_lowest_layer(stream).native_handle(), events, 0};
    ::ppoll(&one, 1, &wait, nullptr);
    context.poll();
  }
};

WebSocket::WebSocket(const std::string& host, int port, double wait)
    : it_(std::make_unique<Implementation>()) {
  Implementation& it = *it_;
  const double until = wire_time() + wait;
  const Endpoints endpoints = resolve(it.context, host, port);
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
  net::async_connect(socket, endpoints, [&](Error got, const net::ip::tcp::endpoint&) {
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
    it.stream.async_handshake(place(host, port), "/", [&](Error got) {
      error = got;
      done = true;
    });
    await("takes the connection but says nothing");
  } catch (...) {
    // What is under way refers to variables of this function.
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
    const double until = wire_time() + 0.05;  // s: courtesy, not need
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
  it.context.poll();
  if (it.failure || it.writing || text.size() > it.outgoing.size()) return false;
  std::copy(text.begin(), text.end(), it.outgoing.begin());
  it.writing = true;
  if (it.tap) it.tap->note(Tap::Way::sent, text);
  it.stream.async_write(net::buffer(it.outgoing.data(), text.size()),
                        in_arena(it.arena, [&it](Error error, std::size_t) {
                          it.writing = false;
                          if (error) it.failure = error;
                        }));
  it.context.poll();
  return !it.failure;
}

WebSocket::Received WebSocket::receive(double until) {
  Implementation& it = *it_;
  it.start_reading();
  it.context.poll();
  while (!it.complete && !it.failure && wire_time() < until) it.turn(until);
  if (it.complete) {
    it.complete = false;
    it.handed_out = true;
    const auto bytes = it.incoming.cdata();
    const std::string_view message(static_cast<const char*>(bytes.data()), bytes.size());
    if (it.tap) it.tap->note(Tap::Way::received, message);
    return {Outcome::message, message, it.stream.got_binary()};
  }
  return {it.failure ? Outcome::closed : Outcome::nothing, {}, false};
}

bool WebSocket::closed() const { return static_cast<bool>(it_->failure); }

std::string WebSocket::why_closed() const {
  if (!it_->failure) return {};
  if (it_->failure == beast::websocket::error::closed)
    return "the service closed the connection (code " + std::to_string(it_->stream.reason().code) +
           ")";
  return "the connection broke: " + it_->failure.message();
}

std::optional<std::string> http_get(const std::string& host, int port, const std::string& target,
                                    double wait) {
  net::io_context context(1);
  Socket socket(context.get_executor());
  http::request<http::empty_body> request(http::verb::get, target, 11);
  request.set(http::field::host, place(host, port));
  request.keep_alive(false);
  beast::flat_static_buffer<16384> buffer;
  http::response<http::string_body> response;
  std::optional<std::string> body;
  net::async_connect(socket, resolve(context, host, port),
                     [&](Error refused, const net::ip::tcp::endpoint&) {
                       if (refused) return;
                       http::async_write(socket, request, [&](Error broken, std::size_t) {
                         if (broken) return;
                         http::async_read(socket, buffer, response, [&](Error unread, std::size_t) {
                           if (!unread && response.result() == http::status::ok)
                             body = response.body();
                         });
                       });
                     });
  context.run_for(duration(wait));
  Error ignored;
  socket.close(ignored);
  context.restart();
  context.poll();  // what is under way refers to variables of this function
  return body;
}

}  // namespace palpate::device
