// Each way in which a service can keep us waiting while we connect ends by the deadline, with a
// sentence of its own: a name service, a host, a listener and a web server that say nothing.

#include <arpa/inet.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "device/clock.h"
#include "device/websocket.h"
#include "refusal.h"
#include "web_socket.h"

namespace {

std::atomic<bool> name_service_answers = false;

}  // namespace

// In front of the system's: it knows nothing of `slow.test`, and takes its time to say so.
extern "C" int getaddrinfo(const char* name, const char* service, const addrinfo* hints,
                           addrinfo** found) {
  if (std::string(name) == "slow.test") {
    while (!name_service_answers) std::this_thread::yield();
    return EAI_NONAME;
  }
  using Function = int (*)(const char*, const char*, const addrinfo*, addrinfo**);
  const auto real = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "getaddrinfo"));
  return real(name, service, hints, found);
}

namespace palpate::device {
namespace {

constexpr double short_time = 0.05;  // s: all of these would wait for ever

std::string connecting_refusal(const std::function<void()>& act) {
  return test::refusal<LinkError>(act);
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Connecting, WaitsForANameServiceTillItsDeadline) {
  const std::string late =
      connecting_refusal([] { static_cast<void>(look_up("slow.test", wire_time() + short_time)); });
  EXPECT_TRUE(has(late, "`slow.test` could not be looked up in time")) << late;
  EXPECT_TRUE(has(late, "address")) << late;
  name_service_answers = true;
  const std::string unknown =
      connecting_refusal([] { static_cast<void>(look_up("slow.test", wire_time() + 60.0)); });
  EXPECT_TRUE(has(unknown, "`slow.test` is not known")) << unknown;
}

TEST(Connecting, TakesAddressesAsTheyAreAndFindsLocalhost) {
  // No time is left, and none is needed.
  EXPECT_EQ(look_up("127.0.0.1", 0.0).addresses, std::vector<std::string>{"127.0.0.1"});
  EXPECT_EQ(look_up("::1", 0.0).addresses, std::vector<std::string>{"::1"});
  const Host host = look_up("localhost", wire_time() + 60.0);
  EXPECT_EQ(host.name, "localhost");
  ASSERT_FALSE(host.addresses.empty());
  for (const std::string& address : host.addresses)
    EXPECT_TRUE(address == "127.0.0.1" || address == "::1") << address;
}

// Listens and never accepts; the system takes `room` connections for it, and leaves those that come
// after them without an answer.
class Listener {
 public:
  explicit Listener(int room) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address = here(0);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::listen(socket_, room), 0);
    socklen_t size = sizeof address;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~Listener() {
    for (const int client : clients_) ::close(client);
    ::close(socket_);
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  void fill() {
    for (int i = 0; i < 8; ++i) {
      clients_.push_back(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
      sockaddr_in address = here(port_);
      ::connect(clients_.back(), reinterpret_cast<sockaddr*>(&address), sizeof address);
    }
  }
  [[nodiscard]] int port() const { return port_; }

 private:
  static sockaddr_in here(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    return address;
  }
  int socket_;
  int port_ = 0;
  std::vector<int> clients_;
};

const Host this_machine{"localhost", {"127.0.0.1"}};

TEST(Connecting, WaitsForAHostThatDoesNotAnswerTillItsDeadline) {
  Listener listener(0);
  listener.fill();
  const std::string late = connecting_refusal(
      [&] { WebSocket(this_machine, listener.port(), wire_time() + short_time); });
  EXPECT_TRUE(has(late, "localhost:" + std::to_string(listener.port()) + " does not answer"))
      << late;
}

TEST(Connecting, WaitsForAHandshakeTillItsDeadline) {
  const Listener listener(8);
  const std::string late = connecting_refusal(
      [&] { WebSocket(this_machine, listener.port(), wire_time() + short_time); });
  EXPECT_TRUE(has(late, "takes the connection but says nothing")) << late;
  EXPECT_EQ(http_get(this_machine, listener.port(), "/version", wire_time() + short_time),
            std::nullopt);
}

// A host with several addresses is asked at each.
TEST(Connecting, TriesEveryAddress) {
  const Listener listener(8);
  const std::string late = connecting_refusal([&] {
    WebSocket({"two", {"::1", "127.0.0.1"}}, listener.port(), wire_time() + short_time);
  });
  EXPECT_TRUE(has(late, "takes the connection but says nothing")) << late;
}

// A machine that is gone neither closes a connection nor answers. TCP_REPAIR lets a socket vanish
// in the same way.
TEST(Connected, NoticesThatTheOtherMachineIsGone) {
  test::WebSocketServer server;
  std::thread service([&] { server.take_with_handshake(); });
  WebSocket socket(this_machine, server.port(), wire_time() + 5.0);
  service.join();
  const double quiet = wire_time() + 1.5;
  while (wire_time() < quiet)
    ASSERT_EQ(socket.receive(quiet).outcome, WebSocket::Outcome::nothing) << socket.why_closed();
  const int vanishing = 1;
  if (::setsockopt(server.descriptor(), IPPROTO_TCP, TCP_REPAIR, &vanishing, sizeof vanishing) != 0)
    GTEST_SKIP() << "only root may let a socket vanish";
  server.leave();
  EXPECT_EQ(socket.receive(wire_time() + 10.0).outcome, WebSocket::Outcome::closed);
  EXPECT_TRUE(socket.closed());
}

}  // namespace
}  // namespace palpate::device
