// Large files line by line, files that grow, hashes of parts.
#include "base/files.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.h"
#include "refusal.h"

namespace {

int failing_read = 0;  // of a file, the how-manyth from now that fails; 0: none

}  // namespace

// In front of the system's: a disk that fails.
extern "C" ssize_t read(int file, void* into, size_t size) {
  if (failing_read > 0 && --failing_read == 0) {
    errno = EIO;
    return -1;
  }
  return ::syscall(SYS_read, file, into, size);
}

namespace palpate {
namespace {

class Files : public testing::Test {
 protected:
  ~Files() override { std::filesystem::remove(path_); }
  std::string path_ =
      (std::filesystem::temp_directory_path() / ("palpate-files-" + std::to_string(::getpid())))
          .string();
};

// Lines that end before, at and after the megabytes in which a file is read.
TEST_F(Files, EveryLineIsSeenOnce) {
  constexpr std::size_t part = 1 << 20;
  std::vector<std::string> lines{"",
                                 "a",
                                 std::string(part - 4, 'b'),
                                 "c",
                                 std::string(3 * part, 'd'),
                                 std::string(part - 2, 'e'),
                                 "",
                                 "end"};
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  text.pop_back();
  GrowingFile(path_).append(text);
  std::size_t number = 0;
  for_each_line(path_, [&](const FileLine& line) {
    ASSERT_LT(number, lines.size());
    EXPECT_TRUE(line.text == lines[number]) << number;
    EXPECT_EQ(text.substr(line.offset, line.text.size()) == line.text, true) << number;
    EXPECT_EQ(line.whole, ++number < lines.size());
  });
  EXPECT_EQ(number, lines.size());
  EXPECT_THROW(for_each_line(path_ + "x", [](const FileLine&) {}), InputError);
}

std::string refused(const std::string& path) {
  return test::refusal([&] { (void)read_text(path); });
}

// A disk that fails, here in the middle of the file, must not look like a shorter file.
TEST_F(Files, AReadErrorIsNoEnd) {
  std::string text(2 * (1 << 20) + 2, '\n');
  text.replace(0, 1 << 20, 1 << 20, 'a');
  text.replace((1 << 20) + 1, 1 << 20, 1 << 20, 'b');
  GrowingFile(path_).append(text);
  EXPECT_EQ(read_text(path_).size(), (2U << 20) + 2);
  failing_read = 4;
  EXPECT_EQ(refused(path_), path_ +
                                ": cannot be read: Input/output error; copy it from a disk that "
                                "works");
  failing_read = 2;
  EXPECT_THROW(for_each_line(path_, [](const FileLine&) {}), InputError);
  failing_read = 0;
}

TEST_F(Files, WhatIsNoFileIsRefused) {
  EXPECT_EQ(refused("/dev/zero"),
            "/dev/zero: has more than 64 MiB, the most that is read; give a smaller file");
  EXPECT_EQ(
      test::refusal([] { for_each_line("/dev/zero", [](const FileLine&) {}); }),
      "/dev/zero: has a line of more than 64 MiB, the most that is read; give a smaller file");
  EXPECT_EQ(refused("/"), "/: is not a file; give the path of a file");
  std::filesystem::create_symlink(path_, path_);
  EXPECT_EQ(refused(path_),
            path_ + ": cannot be read: Too many levels of symbolic links; check the path");
  std::filesystem::remove(path_);
  GrowingFile{path_};
  ASSERT_EQ(::truncate(path_.c_str(), off_t{1} << 40), 0);  // a terabyte of holes
  EXPECT_EQ(refused(path_), path_ +
                                ": has more than 2048 MiB, the most that is read; give a smaller "
                                "file");
}

// A pipe without a writer waits 10 s; here its end comes, and what was written before it.
TEST_F(Files, APipeIsRead) {
  ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
  std::thread writer([this] {
    std::ofstream pipe(path_);
    for (int i = 0; i < 3; ++i) pipe << std::string(100'000, 'x') << std::flush;
  });
  EXPECT_EQ(read_text(path_).size(), 300'000U);
  writer.join();
}

// A full disk in the middle of a line: the line is cut off again, and the file goes on behind it.
TEST_F(Files, AGrowingFileHasWholeLinesOnAFullDisk) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit limit{};
    ::getrlimit(RLIMIT_FSIZE, &limit);
    const rlim_t most = std::exchange(limit.rlim_cur, 10);
    GrowingFile file(path_);
    file.append("one\n");
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const std::string said = test::refusal<SystemError>([&] { file.append("a long line\n"); });
    limit.rlim_cur = most;
    ::setrlimit(RLIMIT_FSIZE, &limit);
    file.append("two\n");
    ::_exit(said.ends_with("cannot be written: File too large") ? 2 : 3);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_EQ(read_text(path_), "one\ntwo\n");
}

TEST_F(Files, ADeviceThatNeverEndsHasNoHash) {
  EXPECT_EQ(test::refusal([] { (void)file_sha256("/dev/zero"); }),
            "/dev/zero: has more than 64 MiB, the most that is read; give a smaller file");
}

TEST_F(Files, AGrowingFileIsNew) {
  GrowingFile file(path_);
  file.append("one\n");
  file.append("two\n");
  file.sync();
  EXPECT_EQ(read_text(path_), "one\ntwo\n");
  EXPECT_THROW(GrowingFile again(path_), SystemError);
}

TEST(Descriptor, IsClosedOnceByItsLastOwner) {
  const auto is_open = [](int file) { return ::fcntl(file, F_GETFD) >= 0; };
  int first = -1;
  int second = -1;
  {
    Descriptor one = ::open("/dev/null", O_RDONLY);
    first = one;
    Descriptor other = std::move(one);
    EXPECT_TRUE(is_open(first));
    EXPECT_EQ(other, first);
    other = ::open("/dev/null", O_WRONLY);
    EXPECT_FALSE(is_open(first));
    second = other;
    EXPECT_TRUE(is_open(second));
  }
  EXPECT_FALSE(is_open(second));
  Descriptor given = ::open("/dev/null", O_RDONLY);
  const int released = given.release();
  given = {};
  EXPECT_TRUE(is_open(released));
  EXPECT_EQ(::close(released), 0);
}

TEST(Sha256, PartsAreTheWhole) {
  Sha256 hash;
  hash.add("a");
  hash.add("");
  hash.add("bc");
  // FIPS 180-2, appendix B.1
  EXPECT_EQ(hash.digits(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(Files, AFilesHashIsThatOfItsContent) {
  for (const std::string content : {"", "abc", "abc\n", "\n\nabc"}) {
    write_atomically(path_, content);
    EXPECT_EQ(file_sha256(path_), sha256(content));
  }
  EXPECT_THROW((void)file_sha256(path_ + "x"), InputError);
}

TEST_F(Files, AHeldFileIsHeldUntilItIsReleased) {
  HeldFile other;
  EXPECT_FALSE(other.take(path_)) << "not there";
  HeldFile held;
  held.write(path_, "one");
  EXPECT_FALSE(other.take(path_));
  held.write(path_, "two");
  EXPECT_FALSE(other.take(path_)) << "the new file is held, too";
  EXPECT_EQ(read_text(path_), "two");
  held.release();
  EXPECT_TRUE(other.take(path_));
  EXPECT_FALSE(held.take(path_));
  write_atomically(path_, "three");
  EXPECT_TRUE(held.take(path_)) << "it is another file by now";
}

// As root, a device would be replaced by a file otherwise.
TEST_F(Files, APipeIsWrittenInto) {
  ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
  const int end = ::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(end, 0);
  write_atomically(path_, "through it");
  struct stat there {};
  ASSERT_EQ(::lstat(path_.c_str(), &there), 0);
  EXPECT_TRUE(S_ISFIFO(there.st_mode));
  std::string got(64, ' ');
  got.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::read(end, got.data(), got.size()))));
  ::close(end);
  EXPECT_EQ(got, "through it");
}

TEST_F(Files, AFolderIsNoFileToWrite) {
  const std::string folder = std::filesystem::path(path_).parent_path().string();
  EXPECT_THROW(write_atomically(folder, "text"), InputError);
  // Its temporary file has a longer name still.
  for (const std::size_t letters : {255U, 256U, 5000U})
    EXPECT_EQ(
        test::refusal([&] { write_atomically(std::string(letters, 'x'), "text"); }),
        std::string(letters, 'x') + ": is too long for the name of a file; give a shorter one");
}

// In the middle of the file: the process is ended by the limit of its files' size.
TEST_F(Files, AKillWhileAFileIsWrittenLeavesNothingBeside) {
  const std::string folder = path_ + "_folder";
  write_atomically(folder + "/file", "old");
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::signal(SIGXFSZ, SIG_DFL);
    try {
      write_atomically(folder + "/file", std::string(10000, 'x'));
    } catch (...) {
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(entries_of(folder), std::vector<std::string>{folder + "/file"});
  EXPECT_EQ(read_text(folder + "/file"), "old");
  std::filesystem::remove_all(folder);
}

TEST_F(Files, AReplacedFileKeepsItsMode) {
  namespace fs = std::filesystem;
  for (const unsigned mode : {0600U, 0664U, 0755U}) {
    write_atomically(path_, "old");
    fs::permissions(path_, fs::perms(mode));
    write_atomically(path_, "new");
    EXPECT_EQ(fs::status(path_).permissions(), fs::perms(mode));
    EXPECT_EQ(read_text(path_), "new");
  }
  if (::geteuid() != 0) return;  // root replaces files of others
  ASSERT_EQ(::chown(path_.c_str(), 65534, 65534), 0);
  write_atomically(path_, "newer");
  struct stat there {};
  ASSERT_EQ(::stat(path_.c_str(), &there), 0);
  EXPECT_EQ(there.st_uid, 65534U);
  EXPECT_EQ(there.st_mode & 07777U, 0755U);
}

TEST_F(Files, ALinkStaysAndItsFolderIsMade) {
  namespace fs = std::filesystem;
  const std::string folder = path_ + "_folder";
  write_atomically(folder + "/new/target", "one");
  fs::create_symlink("new/target", folder + "/link");
  write_atomically(folder + "/link", "two");
  EXPECT_TRUE(fs::is_symlink(folder + "/link"));
  EXPECT_EQ(read_text(folder + "/new/target"), "two");
  // A chain of links to a file that is not there yet.
  fs::create_symlink("link", folder + "/chain");
  fs::remove_all(folder + "/new");
  write_atomically(folder + "/chain", "three");
  EXPECT_TRUE(fs::is_symlink(folder + "/chain"));
  EXPECT_TRUE(fs::is_symlink(folder + "/link"));
  EXPECT_EQ(read_text(folder + "/new/target"), "three");
  fs::create_symlink("loop", folder + "/loop");
  EXPECT_EQ(test::refusal([&] { write_atomically(folder + "/loop", "four"); }),
            folder + "/loop: is a link that leads to itself; give another path");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace palpate
