// File operations by POSIX calls; every return value is checked, so that a full disk is not missed.
#include "base/files.h"

#include <fcntl.h>
#include <sha2.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"

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

void HeldFile::write(const std::string& path, std::string_view content) {
  const std::string temporary = path + ".part" + std::to_string(::getpid());
  const int file = ::open(temporary.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail(path, temporary, errno);
  // Waits: a process that clears up may hold the new file for a moment. If the file system has no
  // locks, the file is written without one.
  while (::flock(file, LOCK_EX) != 0 && errno == EINTR) {
  }
  const auto check = [&](bool good) {
    if (good) return;
    const int error = errno;
    ::close(file);
    fail(path, temporary, error);
  };
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    check(written >= 0 || errno == EINTR);
    content.remove_prefix(as_index(std::max<ssize_t>(written, 0)));
  }
  check(::fsync(file) == 0);
  check(::rename(temporary.c_str(), path.c_str()) == 0);
  release();
  file_ = file;
}

bool HeldFile::take(const std::string& path) {
  release();
  file_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  struct stat ours {};
  struct stat there {};
  if (file_ >= 0 && ::flock(file_, LOCK_EX | LOCK_NB) == 0 && ::fstat(file_, &ours) == 0 &&
      ::stat(path.c_str(), &there) == 0 && ours.st_ino == there.st_ino)
    return true;  // otherwise another process has just replaced the file
  release();
  return false;
}

void HeldFile::release() {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

void write_atomically(const std::string& path, std::string_view content) {
  HeldFile().write(path, content);
}

void make_folders(const std::string& path) {
  std::error_code error;
  if (!path.empty()) std::filesystem::create_directories(path, error);
  if (error) throw SystemError(path + " cannot be made: " + error.message());
}

std::vector<std::string> entries_of(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string host_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  std::string text = name.data();
  std::replace(text.begin(), text.end(), '/', '_');
  return text;
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
  for (const std::uint8_t byte : digest) text += hex_text(byte);
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

std::string file_sha256(const std::string& path) {
  Sha256 hash;  // read line by line: a recording of an hour at 1 kHz has a gigabyte
  for_each_line(path, [&](const FileLine& line) {
    hash.add(line.text);
    if (line.whole) hash.add("\n");
  });
  return hash.digits();
}

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
  std::size_t begin = 0;   // offset of `held` in the file
  std::size_t looked = 0;  // length of the part of `held` that has no line feed
  while (true) {
    const std::size_t before = held.size();
    held.resize(before + part);
    const ssize_t got = ::read(file, held.data() + before, part);
    if (got < 0 && errno != EINTR) refuse();
    held.resize(before + as_index(std::max<ssize_t>(got, 0)));
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
        // The incomplete line stays; a reader recognises it as such.
      }
      ::lseek(file_, static_cast<off_t>(size_), SEEK_SET);
      throw SystemError(path_ + " cannot be written: " + std::strerror(error));
    }
    left.remove_prefix(as_index(written));
  }
  size_ += text.size();
}

void GrowingFile::sync() {
  if (::fsync(file_) != 0) throw SystemError(path_ + " cannot be written: " + std::strerror(errno));
}

}  // namespace palpate
