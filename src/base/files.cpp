// POSIX writes with every return value looked at: a full disk must not pass for success.
#include "base/files.h"

#include <fcntl.h>
#include <sha2.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
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

struct Sha256::Context : SHA2_CTX {};

Sha256::Sha256() : context_(std::make_unique<Context>()) { SHA256Init(context_.get()); }
Sha256::~Sha256() = default;

void Sha256::add(std::string_view part) {
  SHA256Update(context_.get(), reinterpret_cast<const std::uint8_t*>(part.data()), part.size());
}

std::string Sha256::digits() {
  std::array<std::uint8_t, SHA256_DIGEST_LENGTH> digest{};
  SHA256Final(digest.data(), context_.get());
  std::string text;
  for (const std::uint8_t byte : digest) {
    constexpr std::string_view hex = "0123456789abcdef";
    text += hex[byte >> 4];
    text += hex[byte & 15];
  }
  return text;
}

std::string sha256(std::string_view content) {
  Sha256 hash;
  hash.add(content);
  return hash.digits();
}

namespace {

struct Closing {
  int file;
  ~Closing() { ::close(file); }
};

}  // namespace

void for_each_line(const std::string& path, const std::function<void(const FileLine&)>& see) {
  constexpr std::size_t part = 1 << 20;  // bytes
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const auto refuse = [&] {
    throw InputError({path, 0, 0},
                     std::string("cannot be read: ") + std::strerror(errno) + "; check the path");
  };
  if (file < 0) refuse();
  const Closing closing{file};
  std::string held;
  std::size_t begin = 0;   // of `held`, in the file
  std::size_t looked = 0;  // so much of `held` has no line feed
  while (true) {
    const std::size_t before = held.size();
    held.resize(before + part);
    const ssize_t got = ::read(file, held.data() + before, part);
    if (got < 0 && errno != EINTR) refuse();
    held.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    std::size_t at = 0;
    for (std::size_t end = held.find('\n', looked); end != std::string::npos;
         end = held.find('\n', at)) {
      see({begin + at, std::string_view(held).substr(at, end - at), true});
      at = end + 1;
    }
    held.erase(0, at);
    begin += at;
    looked = held.size();
    if (got == 0) break;
  }
  if (!held.empty()) see({begin, held, false});
}

GrowingFile::GrowingFile(std::string path) : path_(std::move(path)) {
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file_ < 0) throw SystemError(path_ + " cannot be made: " + std::strerror(errno));
}

GrowingFile::~GrowingFile() { ::close(file_); }

void GrowingFile::append(std::string_view text) {
  std::string_view left = text;
  while (!left.empty()) {
    const ssize_t written = ::write(file_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error = errno;
      if (::ftruncate(file_, static_cast<off_t>(size_)) != 0) {
        // The torn end stays; whoever reads it sees that it is.
      }
      ::lseek(file_, static_cast<off_t>(size_), SEEK_SET);
      throw SystemError(path_ + " cannot be written: " + std::strerror(error));
    }
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  size_ += text.size();
}

void GrowingFile::sync() {
  if (::fsync(file_) != 0) throw SystemError(path_ + " cannot be written: " + std::strerror(errno));
}

}  // namespace palpate
