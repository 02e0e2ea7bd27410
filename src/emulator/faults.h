// The fault script: kinds of faults, and when each begins and ends.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace emulator {

// A fault happens once, spoils a number of replies, or lasts for a time.
enum class Life { moment, replies, lasting };

struct FaultKind {
  const char* name = nullptr;
  Life life = Life::moment;
  const char* what = nullptr;  // for docs/emulator.md and the verb `faults`
};

// The faults of the stand and of the gauge, and those of both: line_faults().
[[nodiscard]] std::span<const FaultKind> line_faults();
[[nodiscard]] std::span<const FaultKind> stand_faults();
[[nodiscard]] std::span<const FaultKind> gauge_faults();
[[nodiscard]] std::span<const FaultKind> arm_faults();

struct Fault {
  std::string kind;
  Life life = Life::moment;
  std::optional<std::int64_t> at = {};              // ns
  std::optional<std::int64_t> after_messages = {};  // requests with a reply, or client messages
  std::optional<std::int64_t> duration = {};        // ns; none: until the end
  int replies = 1;                                  // number of replies to spoil
  double value = 0;                                 // SI; its meaning depends on the kind
};

// Reads `[[fault]]` tables. Throws InputError, also for a kind that this link does not have.
[[nodiscard]] std::vector<Fault> read_faults(const std::string& path,
                                             std::span<const FaultKind> kinds);

// The faults that have not begun yet, and those that have.
class Faults {
 public:
  explicit Faults(std::vector<Fault> script) : pending_(std::move(script)) {}

  // Begins the faults that are due and returns them. `messages` counts earlier messages.
  [[nodiscard]] std::vector<Fault> begin(std::int64_t now, std::int64_t messages);
  // Whether a lasting fault of this kind is active at `now` (ns).
  [[nodiscard]] bool lasts(std::string_view kind, std::int64_t now) const;
  // True if a fault of this kind spoils the current reply, which is then counted.
  [[nodiscard]] bool spoils(std::string_view kind);
  [[nodiscard]] double value(std::string_view kind) const;  // of the last fault that began
  // s since the last fault of this kind began; 0 if it does not last at `now` (ns).
  [[nodiscard]] double age(std::string_view kind, std::int64_t now) const;
  [[nodiscard]] std::optional<std::int64_t> next_time() const;  // ns, of the next fault with `at`

 private:
  struct Active {
    Fault fault;
    std::int64_t since = 0;
    std::optional<std::int64_t> until = {};
  };
  std::vector<Fault> pending_;
  std::vector<Active> active_ = {};
};

}  // namespace emulator
