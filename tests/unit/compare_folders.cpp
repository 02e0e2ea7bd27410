// Folders: missing, extra and differing files, each by name.
#include "compare/compare_folders.h"

#include <gtest/gtest.h>

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
  EXPECT_EQ(comparison_text(result), "");
  EXPECT_EQ(equal_text(result), "equal: 2 columns of 2 files\n");
}

TEST_F(CompareFolders, NamesWhatIsMissingExtraOrDifferent) {
  write("got/a.csv", "x\n1\n");
  write("want/a.csv", "x\n2\n");
  write("want/sub/b.csv", "x\n2\n");
  write("got/c.csv", "x\n2\n");
  const FolderComparison result = compare_folders(path("got"), path("want"), {});
  EXPECT_FALSE(result.equal());
  EXPECT_EQ(comparison_text(result),
            "a.csv: DIFFERS\n"
            "x: DIFFERS in 1 row; worst row 1: got 1, want 2, relative difference 0.5, allowed "
            "2e-09\n"
            "c.csv: DIFFERS, the file is not wanted\n"
            "sub/b.csv: DIFFERS, the file is missing\n");
}

TEST_F(CompareFolders, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(static_cast<void>(compare_folders(path("got"), path("empty"), {})), InputError);
  EXPECT_THROW(static_cast<void>(compare_folders(path("got"), path("nowhere"), {})), InputError);
}

}  // namespace
}  // namespace palpate::compare
