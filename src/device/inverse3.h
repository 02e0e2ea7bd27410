// The link to a haptic arm through its maker's local service, which answers each message once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "device/clock.h"
#include "device/inverse3_protocol.h"
#include "device/link.h"
#include "device/sample.h"
#include "device/websocket.h"

namespace palpate::device {

class Tap;

// Times of the messages whose replies have not come, so that each reply is charged to its own
// message: the service answers in order, and a reply does not say which message it answers.
class Unanswered {
 public:
  void sent(double time);  // s
  // The time of the oldest message, which a reply at this moment answers; nothing if none waits.
  [[nodiscard]] std::optional<double> answered();
  [[nodiscard]] std::uint64_t given_up() const { return given_up_; }  // messages
  // Whether more than one message waits.
  [[nodiscard]] bool several() const { return count_ > 1; }

 private:
  void forget(std::size_t count);
  static constexpr std::size_t most = 256;    // a quarter of a second
  static constexpr std::size_t window = 100;  // replies
  std::array<double, most> times_{};          // s, a ring
  std::size_t begin_ = 0;
  std::size_t count_ = 0;
  // If as many messages wait after each of `window` replies, their replies are lost, unless so many
  // have waited since the start: then the service is that slow.
  std::size_t replies_ = 0;  // in this window
  std::size_t least_ = most;
  std::optional<std::size_t> usual_;  // the smallest least_ so far
  std::uint64_t given_up_ = 0;
};

class Inverse3 : public LinkParts {
 public:
  // Finds the host, connects, requests the version and reads the snapshot, all within about 2 s;
  // then finds the spelling by zero forces, within about 1.2 s. With Purpose::look a service that
  // can be read without forces is sent none. Throws LinkError with a diagnosis, with
  // Purpose::command also for an arm that is not calibrated or has no power, for coordinates that
  // the service turns or scales, and for several arms without an id in the address; a missing
  // events port is only a note. `clock` and `tap` must outlive the link.
  Inverse3(const ArmAddress& address, Purpose purpose, Clock& clock, Tap* tap = nullptr);
  ~Inverse3();
  Inverse3(const Inverse3&) = delete;
  Inverse3& operator=(const Inverse3&) = delete;

  [[nodiscard]] Traffic traffic() const;

  // Returns the newest reply, waiting for it at most `wait` s; sends a zero force first if no
  // message awaits a reply. Events set `fault`; after a `disconnected` event the link is lost.
  [[nodiscard]] Sample sample(double wait);
  // Sends a force (N), a force that is not finite as zero. Returns refused for a force with
  // Purpose::look, hung_up if the connection is closed, and silent if the service does not read.
  [[nodiscard]] Fault command_force(const Vec3& force);
  bool stop();  // true if a zero force was sent and the link is not lost

 private:
  void listen(const ArmAddress& address, Tap* tap);
  void ask_version(int port);
  void greet(const std::string& wanted_id);
  void accept(const inverse3::Arm& arm);
  void find_spelling();
  bool try_spelling(inverse3::Spelling spelling);
  bool send(const Vec3& force);
  void pass_over_duplicates();
  void hear_events();
  void obey(Event event);
  bool charge();
  Sample exchange(double wait);
  Sample read(const WebSocket::Received& message);

  Purpose purpose_;
  double connected_by_;  // s, wire_time(), the deadline of the constructor's first part
  Host host_;
  WebSocket socket_;
  std::optional<WebSocket> events_ = {};
  inverse3::Spelling spelling_ = inverse3::Spelling::vector;
  inverse3::IdForm id_form_ = inverse3::IdForm::text;
  bool probes_ = false;    // positions are requested by `probe_position`, without forces
  bool framed_ = false;    // the service turned or scaled the coordinates from the start
  bool awaiting_ = false;  // a message was sent since the last reply
  double asked_at_ = 0.0;  // s, wire_time() of the first message since the last reply
  Unanswered unanswered_;
  inverse3::Mode mode_ = inverse3::Mode::unknown;
  bool confirmed_ = false;    // the arm has left its idle mode after a zero force
  int idle_replies_ = 0;      // idle replies in a row
  Fault told_ = Fault::none;  // of an event, to be returned with the next sample
  bool braked_ = false;       // according to the last brake event
  Fault gone_ = Fault::none;  // why the link is lost, while the socket is open
  int surplus_ = 0;           // events beyond the usual number of all frames so far
};

}  // namespace palpate::device
