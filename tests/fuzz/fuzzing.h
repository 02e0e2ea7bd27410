// What the fuzz targets share: a broken promise ends the program, a refusal has words.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "base/error.h"

namespace palpate::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// Calls a reader, which may refuse its input with a sentence; any other exception is a crash.
// Returns whether the input was read.
template <class Read>
bool reads(const Read& read) {
  try {
    read();
    return true;
  } catch (const InputError& error) {
    require(!error.problems().empty());
    for (const Problem& problem : error.problems()) require(!problem.message.empty());
  } catch (const MeshError& error) {
    require(!std::string_view(error.what()).empty());
  }
  return false;
}

// The folder of this process for readers that want a path.
inline const std::filesystem::path& folder() {
  static const struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("palpate-fuzz-" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  } made;
  return made.path;
}

// Writes a file there anew and returns its path.
inline std::string file(const std::string& name, std::string_view content) {
  std::string path = (folder() / name).string();
  std::filesystem::remove(path);  // ext4 flushes a file that is cut short and written anew
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

// What each target does with any bytes. A crash is the failure.
using Run = void(const std::uint8_t* data, std::size_t size);
Run emulator, events, inverse3, journal, lines, mark10, measured, nodes, plan, recording, rows,
    scenario, settings, table, tissues, tolerances, websocket;
void cells(const char* format, const std::uint8_t* data, std::size_t size);
void surface(const char* format, const std::uint8_t* data, std::size_t size);

// The target of that name, or none.
[[nodiscard]] Run* target(std::string_view name);

}  // namespace palpate::fuzz
