// POSIX writes with every return value looked at: a full disk must not pass for success.
#include "base/files.h"

#include <fcntl.h>
#include <sha2.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/error.h"

namespace palpate {

std::string read_text(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0)
    throw InputError({path, 0, 0},
                     std::string("cannot be read: ") + std::strerror(errno) + "; check the path");
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode) && !S_ISCHR(status.st_mode))
    throw InputError({path, 0, 0}, "is not a file; give the path of a file");
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  if (!stream) throw InputError({path, 0, 0}, "cannot be read; check its permissions");
  return content.str();
}

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& temporary, int error) {
  ::unlink(temporary.c_str());
  throw SystemError(path + " cannot be written: " + std::strerror(error));
}

}  // namespace

void write_atomically(const std::string& path, std::string_view content) {
  const std::string temporary = path + ".part" + std::to_string(::getpid());
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail(path, temporary, errno);
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error = errno;
      ::close(file);
      fail(path, temporary, error);
    }
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  const bool flushed = ::fsync(file) == 0;
  const int flush_error = errno;
  if (::close(file) != 0) fail(path, temporary, errno);
  if (!flushed) fail(path, temporary, flush_error);
  if (::rename(temporary.c_str(), path.c_str()) != 0) fail(path, temporary, errno);
}

std::string sha256(std::string_view content) {
  SHA2_CTX context;
  SHA256Init(&context);
  SHA256Update(&context, reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
  std::array<std::uint8_t, SHA256_DIGEST_LENGTH> digest{};
  SHA256Final(digest.data(), &context);
  std::string text;
  for (const std::uint8_t byte : digest) {
    constexpr std::string_view hex = "0123456789abcdef";
    text += hex[byte >> 4];
    text += hex[byte & 15];
  }
  return text;
}

}  // namespace palpate
