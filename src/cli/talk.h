// Messages on stderr and JSON events on stdout.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "base/doing.h"
#include "cli/arguments.h"

namespace palpate::cli {

class Talk {
 public:
  explicit Talk(const Manner& manner);

  void say(const std::string& sentence) const;     // stderr, unless quiet
  void warn(const std::string& sentence) const;    // stderr, unless quiet; yellow on terminals
  static void error(const std::string& sentence);  // stderr, always; red on terminals
  static void annotate(const std::string& lines);  // stderr, always: commands to a build server

  // The command that follows on the path, on terminals only: `next: palpate open out/press`;
  // `more` stands behind the path as it is.
  void next(const std::string& verb, const std::string& path, const std::string& more = "") const;

  // Replaces the previous progress line, on terminals only; an empty line removes it.
  void progress(const std::string& line) const;

  // With --json, prints one JSON object on stdout: {"event": name, ...}.
  using Value =
      std::variant<std::string, double, std::size_t, bool, std::map<std::string, std::string>>;
  using Details = std::vector<std::pair<std::string, Value>>;
  void event(const std::string& name, const Details& details) const;

  // Whether progress() shows anything.
  [[nodiscard]] bool shows_progress() const { return terminal_ && !manner_.quiet && !manner_.json; }
  [[nodiscard]] bool quiet() const { return manner_.quiet; }
  [[nodiscard]] bool json() const { return manner_.json; }
  // Whether results on stdout are for a program and not for a person's eyes: they are CSV then.
  [[nodiscard]] bool csv() const { return manner_.csv || !reader_; }

 private:
  Manner manner_;
  bool terminal_ = false;  // stderr
  bool reader_ = false;    // stdout is a terminal
};

// The number that rounded_text() writes.
[[nodiscard]] double rounded(double value, int digits = 4);

// Says all warnings. Returns what a verb's last line says of figures that were not drawn:
// "; 2 figures were not drawn", or nothing.
[[nodiscard]] std::string warn_all(const std::vector<std::string>& warnings, const Talk& talk);

// While this exists, `text`, what is being done and the time are said: on terminals four times a
// second from the second second on, elsewhere once a minute. `text` is called with the seconds so
// far. With --json, `event` is called once a second instead. Both are called from a thread.
class ProgressLine {
 public:
  ProgressLine(const Talk& talk, std::function<std::string(double)> text,
               std::function<void(double)> event = {});
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

 private:
  void tick();

  const Talk& talk_;
  std::function<std::string(double)> text_;
  std::function<void(double)> event_;
  std::mutex mutex_;
  std::condition_variable end_;
  bool ended_ = false;
  std::thread thread_;
};

// `90 s`, `12 min`, `3.5 h`
[[nodiscard]] std::string duration_text(double seconds);

// A progress bar of 20 characters, with the numbers and, if `seconds` were needed for what is done,
// the time left: `[##########..........] 5/10, 12 s left`.
[[nodiscard]] std::string bar(std::size_t done, std::size_t all, double seconds = 0.0);

// A line of progress: a bar if steps are counted, what for, what is being done, the time.
[[nodiscard]] std::string progress_text(const std::string& text, const Doing& at, double seconds);

// Writes data to stdout. Throws SystemError if it cannot be written.
void print(const std::string& data);

// Writes sentences for people, with control characters of names in them shown as `\x1b`.
void print_text(const std::string& text);

}  // namespace palpate::cli
