// `palpate golden add --reason`: what is kept beside results that were replaced.
#include <gtest/gtest.h>

#include "base/document.h"
#include "base/text.h"
#include "program.h"

namespace palpate::test {
namespace {

class Reason : public testing::Test {
 protected:
  Reason() {
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

  Ended add(const std::string& reason,
            const std::vector<std::pair<std::string, std::string>>& environment = {}) const {
    return run_program({.arguments = {"golden", "add", "golden/press/scenario.toml", "--force",
                                      "--reason", reason},
                        .folder = folder_.path(),
                        .set = environment});
  }
  [[nodiscard]] Node kept() const {
    return read_toml((folder_ / "golden/press/expected/baseline.toml").string());
  }

  TemporaryFolder folder_;
};

TEST_F(Reason, is_kept_with_commit_and_compiler) {
  const std::string head = git({"rev-parse", "HEAD"});
  const Ended ended = add("the first \"one\"");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(names_in(folder_ / "golden/press/expected"),
            (std::set<std::string>{"baseline.toml", "findings.csv", "fits.csv",
                                   "force_indentation.csv"}));
  const Node note = kept();
  EXPECT_EQ(note.find("reason")->value.text, "the first \"one\"");
  EXPECT_EQ(note.find("commit")->value.text, head);
  EXPECT_FALSE(note.find("compiler")->value.text.empty());
  ASSERT_EQ(palpate(folder_.path(), {"golden", "check", "golden"}).code, 0);
}

TEST_F(Reason, says_that_files_differ_from_the_commit) {
  write_file(folder_ / "golden/press/scenario.toml",
             "title = \"x\"\n" + read_file(folder_ / "golden/press/scenario.toml"));
  ASSERT_EQ(add("why").code, 0);
  EXPECT_EQ(kept().find("commit")->value.text, git({"rev-parse", "HEAD"}) + "-dirty");
}

TEST_F(Reason, files_that_are_no_longer_written_go) {
  write_file(folder_ / "golden/press/expected/strain_time.csv", "case\n");
  ASSERT_EQ(add("why").code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "golden/press/expected/strain_time.csv"));
}

// One folder is exchanged for the other, so that a kill leaves no reason beside the results of
// another.
TEST_F(Reason, is_that_of_the_results) {
  ASSERT_EQ(add("why").code, 0);
  ASSERT_EQ(
      palpate(folder_.path(), {"golden", "add", "golden/press/scenario.toml", "--force"}).code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "golden/press/expected/baseline.toml"));
  EXPECT_FALSE(fs::exists(folder_ / "golden/press/baseline.toml"));
}

TEST_F(Reason, not_by_a_machine) {
  const Ended ended = add("why", {{"CI", "true"}});
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "palpate: `CI` is set")) << ended.err;
  EXPECT_FALSE(fs::exists(folder_ / "golden/press/expected"));
}

TEST_F(Reason, needs_no_repository) {
  fs::remove_all(folder_ / ".git");
  const Ended ended = add("why", {{"GIT_CEILING_DIRECTORIES", folder_.path().parent_path()}});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(kept().find("commit"), nullptr);
}

}  // namespace
}  // namespace palpate::test
