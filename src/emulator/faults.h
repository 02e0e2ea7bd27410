// The fault script: what goes wrong, when, for how long.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace emulator {

// How a kind of fault lives: it happens once, spoils a number of replies, or lasts a time.
enum class Life { moment, replies, lasting };

struct FaultKind {
  std::string_view name;
  Life life;
  std::string_view what;  // for the manual and for --faults
};

[[nodiscard]] std::span<const FaultKind> stand_faults();
[[nodiscard]] std::span<const FaultKind> arm_faults();

struct Fault {
  std::string kind;
  Life life = Life::moment;
  std::optional<std::int64_t> at = {};              // ns
  std::optional<std::int64_t> after_messages = {};  // requests with a reply, or client messages
  std::optional<std::int64_t> duration = {};        // ns; none lasts to the end
  std::int64_t replies = 1;                         // how many are spoilt
  double value = 0;                                 // SI; what it means depends on the kind
};

// `[[fault]]` tables; throws `Refused` for a kind this link does not have.
[[nodiscard]] std::vector<Fault> read_faults(const std::string& path,
                                             std::span<const FaultKind> kinds);

// What is due, and what is still at work.
class Faults {
 public:
  explicit Faults(std::vector<Fault> script) : pending_(std::move(script)) {}

  // Faults that begin now. `messages` counts those that came before this one.
  [[nodiscard]] std::vector<Fault> begin(std::int64_t now, std::int64_t messages);
  // Whether one that lasts is at work.
  [[nodiscard]] bool lasts(std::string_view kind, std::int64_t now) const;
  // When it ends, where it is at work and ends at all.
  [[nodiscard]] std::optional<std::int64_t> end_of(std::string_view kind) const;
  // Uses up one reply of a kind that spoils replies.
  [[nodiscard]] bool spoils(std::string_view kind);
  [[nodiscard]] double value(std::string_view kind) const;      // of the last one that began
  [[nodiscard]] std::optional<std::int64_t> next_time() const;  // ns, of those with `at`

 private:
  struct Active {
    Fault fault;
    std::optional<std::int64_t> until = {};
  };
  std::vector<Fault> pending_;
  std::vector<Active> active_ = {};
};

}  // namespace emulator
