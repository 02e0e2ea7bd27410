// Messages, progress and events on the standard streams.
#include "cli/talk.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/error.h"
#include "base/text.h"
#include "plot/gnuplot.h"

namespace palpate::cli {
namespace {

// Names in messages come from files, and a terminal obeys control characters: they are shown as
// `\x1b`. In UTF-8 those from 0x80 to 0x9f follow a byte 0xc2. A build server obeys lines that
// begin with `::`.
enum class Commands { hidden, kept };
std::string shown(const std::string& text, Commands commands = Commands::hidden) {
  std::string safe;
  bool begins = true;  // the line, but for blanks
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    const bool second_set = byte == 0xc2 && next >= 0x80 && next <= 0x9f;
    const bool control = (byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7f;
    const bool command = commands == Commands::hidden && begins && byte == ':' && next == ':';
    begins = byte == '\n' || (begins && (byte == ' ' || byte == '\t'));
    if (control || second_set || command)
      safe += "\\x" + hex_text(second_set ? next : byte);
    else
      safe += text[i];
    if (second_set) ++i;
  }
  return safe;
}

// Writes a line to stderr, in a colour of the terminal if there is one.
void write_line(const std::string& line, const char* colour) {
  const char* no_color = std::getenv("NO_COLOR");  // https://no-color.org: set and not empty
  const char* term = std::getenv("TERM");
  const bool coloured = ::isatty(STDERR_FILENO) == 1 && term != nullptr &&
                        std::string_view(term) != "dumb" &&
                        (no_color == nullptr || *no_color == '\0');
  if (coloured) std::fputs(colour, stderr);
  std::fputs(shown(line).c_str(), stderr);
  std::fputs(coloured ? "\033[0m\n" : "\n", stderr);
}

}  // namespace

Talk::Talk(const Manner& manner)
    : manner_(manner),
      terminal_(::isatty(STDERR_FILENO) == 1),
      reader_(::isatty(STDOUT_FILENO) == 1) {
  if (manner.no_colour) ::setenv("NO_COLOR", "1", 1);
}

void Talk::say(const std::string& sentence) const {
  if (!manner_.quiet) std::fprintf(stderr, "%s\n", shown(sentence).c_str());
}

void Talk::warn(const std::string& sentence) const {
  if (!manner_.quiet) write_line("warning: " + sentence, "\033[33m");  // yellow
}

void Talk::error(const std::string& sentence) { write_line(sentence, "\033[31m"); }  // red

void Talk::next(const std::string& verb, const std::string& path, const std::string& more) const {
  if (shows_progress()) say("next: palpate " + verb + " " + shown_word(path) + more);
}

void Talk::annotate(const std::string& lines) {
  std::fputs(shown(lines, Commands::kept).c_str(), stderr);
}

void Talk::progress(const std::string& line) const {
  if (!shows_progress()) return;
  std::fprintf(stderr, "\r\033[K%s", shown(line).c_str());
  std::fflush(stderr);
}

void Talk::event(const std::string& name, const Details& details) const {
  if (!manner_.json) return;
  nlohmann::ordered_json object;
  object["event"] = name;
  for (const auto& [key, value] : details)
    std::visit([&, &name_of = key](const auto& one) { object[name_of] = one; }, value);
  print(object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

ProgressLine::ProgressLine(const Talk& talk, std::function<std::string(double)> text,
                           std::function<void(double)> event)
    : talk_(talk), text_(std::move(text)), event_(std::move(event)), thread_([this] { tick(); }) {}

ProgressLine::~ProgressLine() {
  {
    const std::scoped_lock lock(mutex_);
    ended_ = true;
  }
  end_.notify_all();
  thread_.join();
  talk_.progress("");
}

void ProgressLine::tick() {
  using namespace std::chrono_literals;
  using Seconds = std::chrono::duration<double>;
  const auto start = std::chrono::steady_clock::now();
  const bool events = talk_.json() && event_;
  const bool shown = talk_.shows_progress();
  const auto pause = events ? 1000ms : shown ? 250ms : 60000ms;
  std::unique_lock lock(mutex_);
  for (auto wait = shown ? 2000ms : pause; !end_.wait_for(lock, wait, [this] { return ended_; });
       wait = pause) {
    const double seconds = Seconds(std::chrono::steady_clock::now() - start).count();
    if (events) try {
        event_(seconds);
        continue;
      } catch (const SystemError&) {  // nobody reads stdout any more: the verb's own print says so
        return;
      }
    const std::string line = progress_text(text_(seconds), doing(), seconds);
    if (shown)
      talk_.progress(line);
    else
      talk_.say(line);
  }
}

std::string progress_text(const std::string& text, const Doing& at, double seconds) {
  return (at.all > 0 ? bar(at.done, at.all, seconds) + ", " : "") + text +
         (at.text.empty() ? "" : ", " + at.text) + ", " +
         std::to_string(static_cast<long>(seconds)) + " s";
}

double rounded(double value, int digits) {
  return std::strtod(rounded_text(value, digits).c_str(), nullptr);
}

std::string warn_all(const std::vector<std::string>& warnings, const Talk& talk) {
  for (const std::string& warning : warnings) talk.warn(warning);
  return plot::missing_figures(warnings);
}

std::string duration_text(double seconds) {
  if (seconds < 100.0) return rounded_text(std::ceil(seconds), 2) + " s";
  if (seconds < 6000.0) return rounded_text(seconds / 60.0, 2) + " min";
  return rounded_text(seconds / 3600.0, 3) + " h";
}

std::string bar(std::size_t done, std::size_t all, double seconds) {
  constexpr std::size_t width = 20;
  const std::size_t filled = all == 0 ? 0 : width * done / all;
  return "[" + std::string(filled, '#') + std::string(width - filled, '.') + "] " +
         std::to_string(done) + "/" + std::to_string(all) +
         (done == 0 || seconds <= 0.0
              ? ""
              : ", " +
                    duration_text(seconds * static_cast<double>(all - done) /
                                  static_cast<double>(done)) +
                    " left");
}

void print(const std::string& text) {
  const std::string data = ::isatty(STDOUT_FILENO) == 1 ? shown(text) : text;
  if (std::fwrite(data.data(), 1, data.size(), stdout) != data.size() || std::fflush(stdout) != 0)
    throw SystemError("stdout cannot be written");
}

void print_text(const std::string& text) { print(shown(text)); }

}  // namespace palpate::cli
