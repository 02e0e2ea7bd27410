// Rows on the disk: whatever happens to a file, a row is either there or known to be missing.
#include "record/journal.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>

#include "base/error.h"
#include "temporary_folder.h"

namespace palpate::record {
namespace {

namespace fs = std::filesystem;
using Whose = JournalFile::Whose;

const std::string identity(64, 'a');

Table row(double number, const std::string& word = "a word") {
  return {{"number", "word"}, {{number, word}}};
}

std::string line_of(const Table& table) {
  std::string line = sealed_line(table, identity);
  EXPECT_EQ(line.back(), '\n');
  line.pop_back();
  EXPECT_EQ(line.find('\n'), std::string::npos);
  return line;
}

// This text is a promise: rows of earlier runs are read as long as the greeting has this number.
TEST(SealedLine, HasThisForm) {
  EXPECT_EQ(sealed_line({{"a", "b"}, {{1.5, "x\\y\nz"}}}, "me").substr(16),
            "\ta,b\\n1.5,\"x\\\\y\\nz\"\\n\n");
}

TEST(SealedLine, IsReadBack) {
  const Table table = row(0.1 + 0.2, "a\ttab, a \"quote\", a back\\slash, a \\n\nand a line\r");
  const auto back = read_line(line_of(table), identity);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->columns, table.columns);
  EXPECT_EQ(back->rows, table.rows);
}

TEST(SealedLine, ColumnsAreFoundByTheirNames) {
  const auto back = read_line(line_of(row(2.0)), identity);
  ASSERT_TRUE(back);
  ASSERT_NE(value_in<double>(*back, "number"), nullptr);
  EXPECT_EQ(*value_in<double>(*back, "number"), 2.0);
  EXPECT_EQ(*value_in<std::string>(*back, "word"), "a word");
  EXPECT_EQ(value_in<std::string>(*back, "number"), nullptr) << "a number is no word";
  EXPECT_EQ(value_in<double>(*back, "missing"), nullptr);
}

// A seal is no secret: another program may have written what is behind a good one.
TEST(SealedLine, OneThatIsNotOneRowIsNone) {
  EXPECT_FALSE(read_line(line_of({{"number"}, {}}), identity)) << "no row";
  EXPECT_FALSE(read_line(line_of({{"number"}, {{1.0}, {2.0}}}), identity)) << "two rows";
  EXPECT_FALSE(read_line(line_of({{"twice", "twice"}, {{1.0, 2.0}}}), identity)) << "no table";
}

TEST(SealedLine, OneThatIsTornIsNone) {
  const std::string line = line_of(row(1.0));
  for (std::size_t length = 0; length < line.size(); ++length) {
    EXPECT_FALSE(read_line(std::string_view(line).substr(0, length), identity)) << length;
    EXPECT_FALSE(read_line(std::string_view(line).substr(length + 1), identity)) << length;
  }
}

TEST(SealedLine, OneWithAWrongByteIsNone) {
  const std::string line = line_of(row(1.0));
  for (std::size_t at = 0; at < line.size(); ++at)
    for (const int change : {1, 32, 128}) {
      std::string wrong = line;
      wrong[at] = static_cast<char>(wrong[at] ^ change);
      EXPECT_FALSE(read_line(wrong, identity)) << at;
    }
}

TEST(SealedLine, OneOfAnotherIdentityIsNone) {
  EXPECT_FALSE(read_line(line_of(row(1.0)), std::string(64, 'b')));
}

class JournalOnDisk : public testing::Test {
 protected:
  // The numbers of the rows in a file, as far as they are there, and what is said of the file.
  std::pair<std::vector<double>, JournalFile> numbers_in(const std::string& path,
                                                         const std::string& whose = identity) {
    std::vector<double> numbers;
    const JournalFile file = read_journal(path, whose, [&](const Table& each, const FileLine&) {
      const auto* number = value_in<double>(each, "number");
      if (number != nullptr) numbers.push_back(*number);
      return number != nullptr;
    });
    return {numbers, file};
  }
  // A file of rows 1, 2 and 3.
  [[nodiscard]] std::string three() const {
    Journal journal(folder_, "part", identity);
    for (const double number : {1.0, 2.0, 3.0}) journal.add(row(number));
    journal.sync();
    return journal.path();
  }
  static void write(const std::string& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
  }

  test::TemporaryFolder root_;
  std::string folder_ = (root_ / "rows").string();
};

using Numbers = std::vector<double>;

TEST_F(JournalOnDisk, EveryRowIsThereAgain) {
  const auto [numbers, file] = numbers_in(three());
  EXPECT_EQ(numbers, (Numbers{1.0, 2.0, 3.0}));
  EXPECT_EQ(file.rows, 3U);
  EXPECT_EQ(file.whose, Whose::ours);
  EXPECT_TRUE(file.warnings().empty());
}

TEST_F(JournalOnDisk, EveryWriterHasAFileOfItsOwn) {
  EXPECT_TRUE(journal_files(folder_).empty()) << "there is no folder";
  const std::set<std::string> paths{three(), three()};
  write(folder_ + "/notes.txt", "mine");
  const auto found = journal_files(folder_);
  EXPECT_EQ(std::set<std::string>(found.begin(), found.end()), paths);
  EXPECT_EQ(paths.size(), 2U);
  EXPECT_TRUE(fs::path(found[0]).filename().string().starts_with("part_"));
}

TEST_F(JournalOnDisk, AFileTornAnywhereHasAllRowsBeforeThat) {
  const std::string path = three();
  const std::string whole = read_text(path);
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    write(path, whole.substr(0, length));
    const auto lines = std::count(whole.begin(), whole.begin() + static_cast<long>(length), '\n');
    const auto [numbers, file] = numbers_in(path);
    EXPECT_EQ(static_cast<long>(numbers.size()), std::max(lines - 1, 0L)) << length;
    EXPECT_EQ(file.torn, length > 0 && whole[length - 1] != '\n') << length;
    EXPECT_EQ(file.corrupt, 0U) << length;
    EXPECT_EQ(file.warnings().size(), file.torn ? 1U : 0U) << length;
  }
}

// The first line, too: rows stand for themselves.
TEST_F(JournalOnDisk, AWrongByteCostsItsOwnRow) {
  const std::string path = three();
  const std::string whole = read_text(path);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string wrong = whole;
    wrong[at] = whole[at] == 'x' ? 'y' : 'x';
    write(path, wrong);
    // A line feed that is lost joins two lines; the last one leaves a torn line.
    const auto line = std::count(whole.begin(), whole.begin() + static_cast<long>(at), '\n');
    Numbers expected{1.0, 2.0, 3.0};
    if (line > 0) std::erase(expected, static_cast<double>(line));
    if (whole[at] == '\n') std::erase(expected, static_cast<double>(line + 1));
    const auto [numbers, file] = numbers_in(path);
    EXPECT_EQ(numbers, expected) << at;
    EXPECT_EQ(file.whose, Whose::ours) << at;
  }
}

TEST_F(JournalOnDisk, ARowThatIsNotUnderstoodIsCorrupt) {
  Journal journal(folder_, "part", identity);
  journal.add(row(1.0));
  journal.add({{"word"}, {{"a column is missing"}}});
  journal.add({{"later", "number"}, {{"a column is not known", 3.0}}});
  const auto [numbers, file] = numbers_in(journal.path());
  EXPECT_EQ(numbers, (Numbers{1.0, 3.0}));
  EXPECT_EQ(file.corrupt, 1U);
  EXPECT_EQ(
      file.warnings(),
      std::vector<std::string>{journal.path() + " has 1 corrupt line; its row counts as missing"});
}

TEST_F(JournalOnDisk, RowsOfSomebodyElseCountForNothing) {
  const auto [numbers, file] = numbers_in(three(), std::string(64, 'b'));
  EXPECT_TRUE(numbers.empty());
  EXPECT_EQ(file.whose, Whose::another);
  EXPECT_EQ(file.warnings(),
            std::vector<std::string>{file.path +
                                     " belongs to another plan, chart or version and is ignored"});
}

// A file that may not grow is a disk that is full.
TEST_F(JournalOnDisk, AFullDiskKeepsWhatWasThere) {
  std::signal(SIGXFSZ, SIG_IGN);
  Journal journal(folder_, "part", identity);
  journal.add(row(1.0));
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit tight{fs::file_size(journal.path()) + 20, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &tight);
  EXPECT_THROW(journal.add(row(2.0)), SystemError);
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(read_text(journal.path()).back(), '\n') << "half a line was left";
  journal.add(row(3.0));
  EXPECT_EQ(numbers_in(journal.path()).first, (Numbers{1.0, 3.0}));
}

}  // namespace
}  // namespace palpate::record
