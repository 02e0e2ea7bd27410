// Large files line by line, files that grow, hashes of parts.
#include "base/files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"

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

TEST_F(Files, AGrowingFileIsNew) {
  GrowingFile file(path_);
  file.append("one\n");
  file.append("two\n");
  file.sync();
  EXPECT_EQ(read_text(path_), "one\ntwo\n");
  EXPECT_THROW(GrowingFile again(path_), SystemError);
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

}  // namespace
}  // namespace palpate
