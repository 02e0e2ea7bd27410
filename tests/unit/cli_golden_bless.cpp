// `palpate golden bless`: where it refuses, and what it makes in a clean repository.
#include <gtest/gtest.h>

#include "base/document.h"
#include "base/text.h"
#include "program.h"

namespace palpate::test {
namespace {

class Bless : public testing::Test {
 protected:
  Bless() {
    write_file(folder_ / "golden/press/scenario.toml",
               "[solver]\nmodel = \"hertz\"\n[[step]]\nkind = \"indent\"\n"
               "[output]\ninterval = \"100 ms\"\nfigures = false\n");
    git({"init", "-q"});
    commit();
  }

  std::string git(std::vector<std::string> arguments) const {
    // Who commits, whatever this machine's settings say.
    const std::vector<std::string> who{
        "-c", "user.name=test", "-c", "user.email=test@localhost", "-c", "commit.gpgsign=false"};
    arguments.insert(arguments.begin(), who.begin(), who.end());
    const Ended ended =
        run_program({.arguments = arguments, .folder = folder_.path(), .program = "git"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    return trimmed(ended.out);
  }
  void commit() const {
    git({"add", "-A"});
    git({"commit", "-q", "-m", "all"});
  }

  Ended bless(const std::string& reason = "the first \"one\"",
              const std::vector<std::pair<std::string, std::string>>& environment = {}) const {
    return run_program({.arguments = {"golden", "bless", "press", "--reason", reason},
                        .folder = folder_.path(),
                        .set = environment});
  }
  [[nodiscard]] bool blessed() const { return fs::exists(folder_ / "golden/press/expected"); }

  TemporaryFolder folder_;
};

TEST_F(Bless, in_a_clean_tree) {
  const std::string head = git({"rev-parse", "HEAD"});
  const Ended ended = bless();
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(names_in(folder_ / "golden/press/expected"),
            (std::set<std::string>{"findings.csv", "fits.csv", "force_indentation.csv"}));
  const Node note = read_toml((folder_ / "golden/press/blessed.toml").string());
  EXPECT_EQ(note.find("reason")->value.text, "the first \"one\"");
  EXPECT_EQ(note.find("commit")->value.text, head);
  EXPECT_FALSE(note.find("compiler")->value.text.empty());
  ASSERT_EQ(palpate(folder_.path(), {"run", "golden/press/scenario.toml"}).code, 0);
  EXPECT_EQ(palpate(folder_.path(), {"compare", "out/scenario", "golden/press/expected"}).code, 0);
}

TEST_F(Bless, again_before_a_commit) {
  ASSERT_EQ(bless().code, 0);
  EXPECT_EQ(bless("another").code, 0) << "its own files do not make the tree dirty";
}

TEST_F(Bless, files_that_are_no_longer_written_go) {
  write_file(folder_ / "golden/press/expected/strain_time.csv", "case\n");
  commit();
  ASSERT_EQ(bless().code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "golden/press/expected/strain_time.csv"));
}

TEST_F(Bless, not_by_a_machine) {
  const Ended ended = bless("why", {{"CI", "true"}});
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "palpate: `CI` is set")) << ended.err;
  EXPECT_FALSE(blessed());
}

TEST_F(Bless, not_in_a_dirty_tree) {
  write_file(folder_ / "golden/press/scenario.toml",
             "title = \"x\"\n" + read_file(folder_ / "golden/press/scenario.toml"));
  Ended ended = bless();
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "uncommitted changes (M golden/press/scenario.toml)")) << ended.err;
  commit();
  write_file(folder_ / "new.cpp", "");
  ended = bless();
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "uncommitted changes (?? new.cpp)")) << ended.err;
  EXPECT_FALSE(blessed());
}

TEST_F(Bless, not_without_a_reason) {
  Ended ended = palpate(folder_.path(), {"golden", "bless", "press"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "`palpate golden bless` lacks `--reason`")) << ended.err;
  ended = bless("  ");
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "`--reason` is empty")) << ended.err;
  EXPECT_FALSE(blessed());
}

TEST_F(Bless, not_what_is_not_there) {
  const Ended ended = palpate(folder_.path(), {"golden", "bless", "prss", "--reason", "why"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "golden/prss/scenario.toml: is not there")) << ended.err;
}

TEST_F(Bless, not_outside_a_repository) {
  fs::remove_all(folder_ / ".git");
  const Ended ended =
      run_program({.arguments = {"golden", "bless", "press", "--reason", "why"},
                   .folder = folder_.path(),
                   .set = {{"GIT_CEILING_DIRECTORIES", folder_.path().parent_path()}}});
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "needs the project's git history")) << ended.err;
  EXPECT_FALSE(blessed());
}

}  // namespace
}  // namespace palpate::test
