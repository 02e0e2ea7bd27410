// Folders: missing, extra and differing files, each by name.
#include "compare/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"

namespace palpate::compare {
namespace {

namespace fs = std::filesystem;

class CompareFolders : public testing::Test {
 protected:
  void SetUp() override {
    root_ =
        fs::path(testing::TempDir()) /
        ("palpate_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(root_);
    for (const char* folder : {"got/sub", "want/sub", "empty"})
      fs::create_directories(root_ / folder);
  }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string& file, const std::string& text) const {
    write_atomically((root_ / file).string(), text);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (root_ / name).string(); }

  fs::path root_;
};

TEST_F(CompareFolders, EqualWhereEveryFileIs) {
  write("got/a.csv", "x\n1\n");
  write("want/a.csv", "x\n1\n");
  write("got/sub/b.csv", "x\n2\n");
  write("want/sub/b.csv", "x\n2\n");
  write("got/run.json", "{}");  // no CSV: not compared
  const FolderComparison result = compare_folders(path("got"), path("want"), {});
  EXPECT_TRUE(result.equal());
  EXPECT_EQ(difference_lines(result), "");
  EXPECT_EQ(headline(result), "equal: 2 columns of 2 files");
}

TEST_F(CompareFolders, NamesWhatIsMissingExtraOrDifferent) {
  write("got/a.csv", "x\n1\n");
  write("want/a.csv", "x\n2\n");
  write("want/sub/b.csv", "x\n2\n");
  write("got/c.csv", "x\n2\n");
  const FolderComparison result = compare_folders(path("got"), path("want"), {});
  EXPECT_FALSE(result.equal());
  EXPECT_EQ(headline(result), "DIFFERS in 1 of 1 column of 3 files, in what files there are");
  EXPECT_EQ(difference_lines(result),
            "c.csv, file: DIFFERS, the file is not wanted\n"
            "sub/b.csv, file: DIFFERS, the file is missing\n"
            "a.csv, x: DIFFERS in 1 row; worst row 1: got 1, want 2, relative difference 0.5, "
            "allowed 2e-09\n");
}

// What a curve is drawn of comes first, then its results, and no more than eight lines.
TEST_F(CompareFolders, TellsTheCurveFirstAndEightColumns) {
  write("want/a.csv", "b,c,d,e,f,g,h,time_s,force_N,peak_x\n1,1,1,1,1,1,1,0,4,1\n");
  write("got/a.csv", "b,c,d,e,f,g,h,time_s,force_N,peak_x\n2,2,2,2,2,2,2,0,5,2\n");
  const FolderComparison result = compare_folders(path("got"), path("want"), {});
  EXPECT_EQ(headline(result), "DIFFERS in 9 of 10 columns, in force_N by 25 %");
  const std::string lines = difference_lines(result);
  EXPECT_TRUE(lines.starts_with("force_N: DIFFERS in 1 row; worst row 1: time_s 0, got 5, want 4"))
      << lines;
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 9);
  EXPECT_NE(lines.find("\nand 1 more; `--json`"), std::string::npos) << lines;
}

TEST_F(CompareFolders, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(static_cast<void>(compare_folders(path("got"), path("empty"), {})), InputError);
  EXPECT_THROW(static_cast<void>(compare_folders(path("got"), path("nowhere"), {})), InputError);
}

}  // namespace
}  // namespace palpate::compare
