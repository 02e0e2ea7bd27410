// HTTP and WebSocket. This is the only file of the emulator that uses Boost.Beast.
#include <utility>  // before asio.hpp 1.74, which uses it without including it

#include <unistd.h>

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <chrono>
#include <cstdio>
#include <deque>
#include <functional>
#include <list>
#include <memory>

#include "base/error.h"
#include "emulator/arm.h"

namespace emulator {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

constexpr std::chrono::milliseconds beat{2};  // between two advances of the clock without traffic
constexpr std::chrono::milliseconds state_every{20};

class Session;

// Functions of the server that a session calls.
struct Host {
  std::function<Outgoing()> greet;
  std::function<void(Session&, const std::string&)> heard;  // may close the session
  std::function<std::string(const std::string&)> body;      // for a GET target; empty: not found
  std::function<bool()> silent;
};

// A connection: HTTP until the client upgrades it to a WebSocket. Deleted when nothing is pending.
class Session {
 public:
  Session(tcp::socket socket, Host host)
      : stream_(std::move(socket)), timer_(stream_.get_executor()), host_(std::move(host)) {
    stream_.next_layer().set_option(tcp::no_delay(true));
    read_request();
  }

  void send(const Outgoing& message) {
    queue_.push_back(message);
    if (!writing_) write_next();
  }

  // Resumes reading after the fault half_open.
  void wake() {
    if (open_ && !reading_) read_message();
  }

  void reset() {
    ErrorCode ignored;
    stream_.next_layer().set_option(asio::socket_base::linger(true, 0), ignored);
    stream_.next_layer().close(ignored);
    finish();
  }

  void close(websocket::close_code code) {
    if (!open_) return;
    open_ = false;
    ++pending_;
    stream_.async_close(code, [this](ErrorCode) {
      --pending_;
      finish();
    });
  }

  [[nodiscard]] bool is_websocket() const { return open_; }
  [[nodiscard]] bool was_websocket() const { return was_open_; }
  [[nodiscard]] bool done() const { return finished_ && pending_ == 0; }
  [[nodiscard]] bool finished() const { return finished_; }

 private:
  void finish() {
    open_ = false;
    finished_ = true;
    ErrorCode ignored;
    timer_.cancel(ignored);
    if (stream_.next_layer().is_open()) stream_.next_layer().close(ignored);
  }

  void read_request() {
    ++pending_;
    request_ = {};
    http::async_read(stream_.next_layer(), buffer_, request_, [this](ErrorCode error, std::size_t) {
      --pending_;
      if (error) return finish();
      if (websocket::is_upgrade(request_)) return accept();
      answer_request();
    });
  }

  void answer_request() {
    const std::string body = request_.method() == http::verb::get
                                 ? host_.body(std::string(request_.target()))
                                 : std::string();
    response_ = {body.empty() ? http::status::not_found : http::status::ok, request_.version()};
    response_.set(http::field::content_type, "application/json");
    response_.keep_alive(request_.keep_alive());
    response_.body() = body.empty() ? R"({"ok":false,"error":"no such route"})" : body;
    response_.prepare_payload();
    ++pending_;
    http::async_write(stream_.next_layer(), response_, [this](ErrorCode error, std::size_t) {
      --pending_;
      if (error || !response_.keep_alive()) return finish();
      read_request();
    });
  }

  void accept() {
    ++pending_;
    stream_.async_accept(request_, [this](ErrorCode error) {
      --pending_;
      if (error) return finish();
      open_ = was_open_ = true;
      buffer_.consume(buffer_.size());
      if (host_.greet) send(host_.greet());
      read_message();
    });
  }

  void read_message() {
    reading_ = true;
    ++pending_;
    stream_.async_read(buffer_, [this](ErrorCode error, std::size_t) {
      --pending_;
      reading_ = false;
      if (error) return finish();
      const std::string text = beast::buffers_to_string(buffer_.data());
      buffer_.consume(buffer_.size());
      host_.heard(*this, text);
      if (open_ && !host_.silent()) read_message();
    });
  }

  void write_next() {
    if (queue_.empty() || !open_) return;
    writing_ = true;
    if (queue_.front().delay == 0) return write_front();
    ++pending_;
    timer_.expires_after(std::chrono::nanoseconds(queue_.front().delay));
    timer_.async_wait([this](ErrorCode error) {
      --pending_;
      if (!error && open_) write_front();
    });
  }

  void write_front() {
    stream_.binary(queue_.front().binary);
    ++pending_;
    stream_.async_write(asio::buffer(queue_.front().text), [this](ErrorCode error, std::size_t) {
      --pending_;
      writing_ = false;
      queue_.pop_front();
      if (error) return finish();
      write_next();
    });
  }

  websocket::stream<tcp::socket> stream_;
  asio::steady_timer timer_;
  Host host_;
  beast::flat_buffer buffer_ = {};
  http::request<http::string_body> request_ = {};
  http::response<http::string_body> response_ = {};
  std::deque<Outgoing> queue_ = {};
  int pending_ = 0;  // handlers that have not been called yet
  bool reading_ = false;
  bool writing_ = false;
  bool open_ = false;
  bool was_open_ = false;
  bool finished_ = false;
};

class Server {
 public:
  explicit Server(const ArmRun& run)
      : run_(run),
        log_(run.log, "x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,fx_N,fy_N,fz_N,work_J"),
        arm_(run.settings, log_),
        clients_(open_port(run.port)),
        watchers_(open_port(run.events_port)) {}

  int go() {
    std::printf("{\"port\":%d,\"events_port\":%d,\"clock\":\"%s\",\"service\":\"%s\",\"pid\":%d}\n",
                static_cast<int>(clients_.local_endpoint().port()),
                static_cast<int>(watchers_.local_endpoint().port()),
                run_.settings.clock == Clock::real ? "real" : "virtual",
                run_.settings.service == Service::v3_1 ? "3.1" : "3.5",
                static_cast<int>(::getpid()));
    std::fflush(stdout);
    signals_.async_wait([this](ErrorCode, int) { context_.stop(); });
    accept_client();
    accept_watcher();
    tick();
    context_.run();
    arm_.leave();
    arm_.log_state();
    std::printf("%s\n", arm_.summary().c_str());
    std::fflush(stdout);
    return 0;
  }

 private:
  tcp::acceptor open_port(int port) {
    try {
      return {context_,
              tcp::endpoint(asio::ip::address_v4::loopback(), static_cast<unsigned short>(port))};
    } catch (const boost::system::system_error& error) {
      throw palpate::InputError(
          {"port " + std::to_string(port)},
          "it cannot be opened: " + error.code().message() + "; write --port 0 for any free port");
    }
  }

  Nanoseconds elapsed() const {
    return (std::chrono::steady_clock::now() - start_) / std::chrono::nanoseconds(1);
  }

  void accept_client() {
    clients_.async_accept([this](ErrorCode error, tcp::socket socket) {
      if (error) return;
      Host host{.greet =
                    [this] {
                      (void)arm_.pass(elapsed());
                      return arm_.greet();
                    },
                .heard = [this](Session& session, const std::string& text) { hear(session, text); },
                .body = [this](const std::string& target) { return body(target); },
                .silent = [this] { return arm_.silent(); }};
      sessions_.push_back(std::make_unique<Session>(std::move(socket), std::move(host)));
      accept_client();
    });
  }

  void accept_watcher() {
    watchers_.async_accept([this](ErrorCode error, tcp::socket socket) {
      if (error) return;
      Host host{.greet = {},
                .heard = [](Session&, const std::string&) {},  // read-only
                .body = [](const std::string&) { return std::string(); },
                .silent = [] { return false; }};
      watching_.push_back(std::make_unique<Session>(std::move(socket), std::move(host)));
      accept_watcher();
    });
  }

  std::string body(const std::string& target) const {
    if (target == "/version" ||
        (target == "/3.1/version" && run_.settings.service == Service::v3_1))
      return version_body(run_.settings.service);
    return target == "/devices" ? arm_.devices() : std::string();
  }

  void hear(Session& session, const std::string& text) {
    act(arm_.pass(elapsed()));
    if (!session.is_websocket()) return;
    const Answer answer = arm_.answer(text);
    tell_watchers();  // before the reply, so that a client with the reply can have the event
    for (const Outgoing& message : answer.messages) session.send(message);
    act(answer.act);
  }

  void act(Act act) {
    if (act == Act::none) return;
    for (const auto& session : sessions_) {
      if (act == Act::close_normal) session->close(websocket::close_code::normal);
      if (act == Act::close_error) session->close(websocket::close_code::internal_error);
      if (act == Act::reset_connection || act == Act::restart) session->reset();
    }
  }

  void tell_watchers() {
    for (const std::string& event : arm_.take_events())
      for (const auto& watcher : watching_)
        if (watcher->is_websocket()) watcher->send({event});
    if (!arm_.take_events_end()) return;
    for (const auto& watcher : watching_) watcher->reset();
  }

  void tick() {
    timer_.expires_after(beat);
    timer_.async_wait([this](ErrorCode error) {
      if (error) return;
      act(arm_.pass(elapsed()));
      tell_watchers();
      sweep();
      if (run_.lifetime && elapsed() > nanoseconds(*run_.lifetime)) return context_.stop();
      if (run_.settings.clock == Clock::real && ++beats_ % (state_every / beat) == 0)
        arm_.log_state();
      tick();
    });
  }

  void sweep() {
    bool left = false;
    bool anyone = false;
    for (auto at = sessions_.begin(); at != sessions_.end();) {
      Session& session = **at;
      if (!arm_.silent()) session.wake();
      anyone = anyone || session.is_websocket();
      if (!session.done()) {
        ++at;
        continue;
      }
      left = left || session.was_websocket();
      at = sessions_.erase(at);
    }
    if (left && !anyone) arm_.leave();
    watching_.remove_if([](const auto& watcher) { return watcher->done(); });
  }

  const ArmRun& run_;
  Log log_;
  Arm arm_;
  asio::io_context context_{1};
  tcp::acceptor clients_;
  tcp::acceptor watchers_;
  asio::signal_set signals_{context_, SIGINT, SIGTERM};
  asio::steady_timer timer_{context_};
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::list<std::unique_ptr<Session>> sessions_ = {};
  std::list<std::unique_ptr<Session>> watching_ = {};
  std::int64_t beats_ = 0;
};

}  // namespace

int run_inverse3(const ArmRun& run) { return Server(run).go(); }

}  // namespace emulator
