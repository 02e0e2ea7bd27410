// Messages, progress and events on the standard streams.
#include "cli/talk.h"

#include <unistd.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace palpate::cli {

Talk::Talk(const Manner& manner) : manner_(manner), terminal_(::isatty(STDERR_FILENO) == 1) {}

void Talk::say(const std::string& sentence) const {
  if (!manner_.quiet) std::fprintf(stderr, "%s\n", sentence.c_str());
}

void Talk::warn(const std::string& sentence) const { say("warning: " + sentence); }

void Talk::error(const std::string& sentence) { std::fprintf(stderr, "%s\n", sentence.c_str()); }

void Talk::progress(const std::string& line) const {
  if (!shows_progress()) return;
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
}

void Talk::event(const std::string& name,
                 const std::vector<std::pair<std::string, std::string>>& details) const {
  if (!manner_.json) return;
  nlohmann::ordered_json object;
  object["event"] = name;
  for (const auto& [key, value] : details) object[key] = value;
  print(object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

std::string bar(std::size_t done, std::size_t all) {
  constexpr std::size_t width = 20;
  const std::size_t filled = all == 0 ? 0 : width * done / all;
  return "[" + std::string(filled, '#') + std::string(width - filled, '.') + "] " +
         std::to_string(done) + "/" + std::to_string(all);
}

void print(const std::string& data) {
  if (std::fwrite(data.data(), 1, data.size(), stdout) != data.size() || std::fflush(stdout) != 0)
    throw SystemError("stdout cannot be written");
}

}  // namespace palpate::cli
