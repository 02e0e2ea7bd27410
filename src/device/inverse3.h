// A haptic arm behind its maker's local service: position in, force out, one reply a message.
#pragma once

#include <optional>
#include <string>

#include "device/clock.h"
#include "device/host.h"
#include "device/inverse3_protocol.h"
#include "device/link_text.h"
#include "device/sample.h"
#include "device/websocket.h"

namespace palpate::device {

class Tap;

class Inverse3 {
 public:
  // Finds the host, connects, asks the version and reads the snapshot, for which there are 2 s in
  // all; chooses the spelling and exchanges a few zero forces, 1.4 s at most; a few ms with a live
  // service. A service whose events cannot be heard is no error, but a note of the identity. Throws
  // LinkError with a plain diagnosis. `clock` outlives the link.
  Inverse3(const ArmAddress& address, Purpose purpose, Clock& clock, Tap* tap = nullptr);
  ~Inverse3();
  Inverse3(const Inverse3&) = delete;
  Inverse3& operator=(const Inverse3&) = delete;

  [[nodiscard]] const Identity& identity() const { return identity_; }
  [[nodiscard]] const Limits& limits() const { return limits_; }
  [[nodiscard]] Traffic traffic() const { return traffic_; }

  // The newest reply; sends a zero force first where nothing is under way. What the service told
  // in the meantime stands in its `fault`; an arm that it said is gone is lost.
  [[nodiscard]] Sample sample(double wait);
  [[nodiscard]] Fault command_force(const Vec3& force);  // N
  bool stop();                                           // true where the zero was taken

 private:
  void listen(const ArmAddress& address, Tap* tap);
  void ask_version(int port);
  void greet();
  bool try_spelling(inverse3::Spelling spelling);
  bool send(const Vec3& force);
  void pass_over_duplicates();
  void hear_events();
  void obey(Event event);
  Sample exchange(double wait);
  Sample read(const WebSocket::Received& message);
  [[nodiscard]] Sample finished(Arrival arrival, Fault fault) const;

  Clock& clock_;
  Purpose purpose_;
  double connected_by_;  // s, wire time
  Host host_;
  WebSocket socket_;
  std::optional<WebSocket> events_ = {};
  Identity identity_;
  Limits limits_;
  inverse3::Spelling spelling_ = inverse3::Spelling::vector;
  bool awaiting_ = false;  // a message was sent since the last reply
  double asked_at_ = 0.0;  // s, wire time, of the first message since the last reply
  inverse3::Mode mode_ = inverse3::Mode::unknown;
  bool confirmed_ = false;      // the arm has left its idle mode for our force
  int idle_replies_ = 0;        // in a row, since then
  Fault told_ = Fault::none;    // by an event, for the next sample
  bool braked_ = false;         // by events, the last one
  bool gone_ = false;           // the service said so
  std::optional<Sample> last_;  // that was fresh
  Traffic traffic_;
};

}  // namespace palpate::device
