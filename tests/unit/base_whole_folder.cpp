// Whatever happens while a folder is written and put in its place: the old result or the new one is
// there, whole, and no file of a user is lost.
#include "base/whole_folder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>

#include "base/error.h"
#include "file_faults.h"
#include "temporary_folder.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using State = WholeFolder::State;
using Names = std::set<std::string>;
using Contents = std::vector<std::pair<std::string, std::string>>;

class WholeFolders : public testing::Test {
 protected:
  ~WholeFolders() override { test::file_faults = {}; }

  static void write(const fs::path& path, const std::string& content) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << content;
  }
  static Names names_in(const fs::path& folder) {
    Names names;
    if (!fs::exists(folder)) return names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
    return names;
  }
  [[nodiscard]] Names names_in_out() const { return names_in(root_ / "out"); }
  [[nodiscard]] std::string read(const std::string& name) const {
    return read_text(place_ + "/" + name);
  }

  // Writes a result and puts it in its place.
  std::vector<std::string> put(const Contents& files, Replace replace = Replace::any,
                               State content = State::complete) const {
    WholeFolder folder(place_, "result", replace);
    folder.open();
    for (const auto& [name, text] : files) folder.write(name, text);
    return folder.put(content);
  }
  // Runs in a process of its own; its exit code, or less the signal that ended it.
  static int in_a_child(const std::function<void()>& work) {
    const pid_t child = ::fork();
    if (child == 0) {
      work();
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
  }
  // The exit code of a child that does some work and is killed at the end of it.
  static void killed_after(const std::function<void()>& work) {
    EXPECT_EQ(in_a_child([&] {
                work();
                ::raise(SIGKILL);
              }),
              -SIGKILL);
  }
  // The names in the list, each of which has the content that the list says; empty where one has
  // not, or there is no list.
  [[nodiscard]] Names whole_names() const {
    Names names;
    if (!fs::exists(place_ + "/contents.sha256")) return names;
    std::istringstream list(read("contents.sha256"));
    for (std::string line; std::getline(list, line);) {
      if (line.starts_with("#")) continue;
      const std::string name = line.substr(66);
      if (!fs::exists(place_ + "/" + name) ||
          file_sha256(place_ + "/" + name) != line.substr(0, 64))
        return {};
      names.insert(name);
    }
    return names;
  }
  static std::string refusal(const std::function<void()>& work) {
    try {
      work();
      return "accepted";
    } catch (const InputError& error) {
      return error.problems().front().message;
    } catch (const SystemError& error) {
      return std::string("system: ") + error.what();
    }
  }
  [[nodiscard]] std::string refused(Replace replace) const {
    return refusal([&] { WholeFolder(place_, "result", replace).refuse_what_is_there(); });
  }

  test::TemporaryFolder root_;
  std::string place_ = (root_ / "out/a").string();
};

TEST_F(WholeFolders, AReplacedOneKeepsItsMode) {
  put({{"a.csv", "1"}});
  fs::permissions(place_, fs::perms(0700));
  put({{"a.csv", "2"}});
  EXPECT_EQ(read("a.csv"), "2");
  EXPECT_EQ(fs::status(place_).permissions(), fs::perms(0700));
}

TEST_F(WholeFolders, AResultHasAListOfItsFiles) {
  EXPECT_TRUE(put({{"b.csv", "b"}, {"inputs/a.csv", ""}}).empty());
  EXPECT_EQ(names_in_out(), Names{"a"});
  EXPECT_EQ(names_in(place_), (Names{"b.csv", "contents.sha256", "inputs"}));
  EXPECT_EQ(read("contents.sha256"), "# palpate result, complete\n" + sha256("b") + "  b.csv\n" +
                                         sha256("") + "  inputs/a.csv\n");
  EXPECT_EQ(
      std::system(
          ("cd " + place_ + " && sha256sum --check --strict --status contents.sha256").c_str()),
      0);
}

TEST_F(WholeFolders, NothingStandsThereBeforeAllDoes) {
  WholeFolder folder(place_, "result", Replace::any);
  EXPECT_FALSE(fs::exists(root_ / "out"));
  folder.open();
  folder.write("a.csv", "a");
  write(folder.file("b.csv"), "b");
  folder.add({"b.csv"});
  EXPECT_THROW(folder.add({"c.csv"}), InputError);
  EXPECT_EQ(folder.files()[1].sha256, sha256("b"));
  EXPECT_FALSE(fs::exists(place_));
  EXPECT_EQ(folder.put(State::complete, {"a warning of " + folder.file("b.csv")}),
            std::vector<std::string>{"a warning of " + place_ + "/b.csv"});
  EXPECT_EQ(whole_names(), (Names{"a.csv", "b.csv"}));
  EXPECT_EQ(folder.path(), place_);
}

TEST_F(WholeFolders, ReplacedIsWhatWasOursAndNothingElse) {
  for (const bool exchange : {true, false}) {
    test::file_faults.has_exchange = exchange;
    fs::remove_all(root_ / "out");
    (void)put({{"same.csv", "1"}, {"gone.csv", "1"}, {"edited.gp", "1"}});
    write(place_ + "/edited.gp", "mine");
    write(place_ + "/notes.txt", "mine");
    write(place_ + "/new.csv", "mine");
    write(place_ + "/new.csv.before", "mine, too");
    write(place_ + "/papers/thesis.tex", "mine");
    fs::create_symlink("notes.txt", place_ + "/link");
    fs::create_symlink("notes.txt", place_ + "/gone");
    const auto said = put({{"same.csv", "2"}, {"edited.gp", "2"}, {"new.csv", "2"}});
    EXPECT_EQ(names_in_out(), Names{"a"});
    EXPECT_EQ(names_in(place_),
              (Names{"contents.sha256", "same.csv", "edited.gp", "edited.gp.before", "new.csv",
                     "new.csv.before", "new.csv.before-2", "notes.txt", "papers", "link", "gone"}));
    EXPECT_EQ(whole_names(), (Names{"same.csv", "edited.gp", "new.csv"}));
    EXPECT_EQ(read("same.csv"), "2");
    EXPECT_EQ(read("edited.gp.before"), "mine");
    EXPECT_EQ(read("papers/thesis.tex"), "mine");
    EXPECT_EQ(read("new.csv.before"), "mine, too");
    EXPECT_EQ(read("new.csv.before-2"), "mine");
    ASSERT_EQ(said.size(), 2U);
    EXPECT_EQ(said[0], place_ +
                           "/edited.gp.before is the `edited.gp` of the replaced result; it is "
                           "kept because it is not, or no longer, as palpate wrote it");
  }
}

// Once more, with a file that was kept before.
TEST_F(WholeFolders, AFileThatWasKeptIsKeptAgain) {
  (void)put({{"a.csv", "1"}});
  for (const char* text : {"2", "3", "4"}) {
    write(place_ + "/a.csv", "mine of " + std::string(text));
    (void)put({{"a.csv", text}});
  }
  EXPECT_EQ(names_in(place_), (Names{"contents.sha256", "a.csv", "a.csv.before", "a.csv.before-2",
                                     "a.csv.before-3"}));
}

TEST_F(WholeFolders, WhatIsNotReplacedIsSaidBeforehand) {
  EXPECT_EQ(refused(Replace::incomplete), "accepted") << "nothing is there";
  fs::create_directories(place_);
  EXPECT_EQ(refused(Replace::incomplete), "accepted") << "an empty folder";
  (void)put({{"a.csv", "1"}}, Replace::incomplete, State::incomplete);
  EXPECT_EQ(refused(Replace::incomplete), "accepted") << "of an interrupted run";
  (void)put({{"a.csv", "1"}}, Replace::incomplete);
  EXPECT_EQ(refused(Replace::incomplete),
            "holds a finished result; give `--force` to replace it, or another `--out`");
  EXPECT_EQ(refused(Replace::any), "accepted");
  const auto foreign = [](const std::string& kind) {
    return "is there already and is not a " + kind +
           " that palpate wrote (its `contents.sha256` is missing or says something else); rename "
           "it, or give another `--out`";
  };
  EXPECT_EQ(refusal([&] { WholeFolder(place_, "map", Replace::any).refuse_what_is_there(); }),
            foreign("map"));
  fs::remove(place_ + "/contents.sha256");
  EXPECT_EQ(refused(Replace::any), foreign("result"));
  fs::remove_all(place_);
  write(place_, "a file");
  EXPECT_EQ(refused(Replace::any), foreign("result"));
  fs::remove(place_);
  fs::create_symlink("nowhere", place_);
  EXPECT_EQ(refused(Replace::any), foreign("result"));
}

TEST_F(WholeFolders, WhatCameMeanwhileStays) {
  const auto beside = [&](Replace replace, State content, const std::function<void()>& meanwhile) {
    fs::remove_all(root_ / "out");
    WholeFolder folder(place_, "result", replace);
    folder.open();
    folder.write("a.csv", "new");
    meanwhile();
    const auto said = folder.put(content);
    EXPECT_EQ(said.size(), 1U);
    EXPECT_EQ(folder.path(), folder.partial());
    EXPECT_EQ(read_text(folder.path() + "/a.csv"), "new");
    EXPECT_EQ(names_in_out().size(), 2U);
    return said.empty() ? "" : said.front().substr(place_.size(), 36);
  };
  const auto foreign = [&] { write(place_ + "/a.csv", "mine"); };
  EXPECT_EQ(beside(Replace::any, State::complete, foreign), " is not a result and is not replaced");
  EXPECT_EQ(read("a.csv"), "mine");
  const auto finished = [&] { (void)put({{"a.csv", "theirs"}}); };
  EXPECT_EQ(beside(Replace::incomplete, State::complete, finished),
            " is a finished result and is not rep");
  EXPECT_EQ(beside(Replace::any, State::incomplete, finished),
            " is a finished result and is not rep");
  EXPECT_EQ(read("a.csv"), "theirs");
  // What stays beside stays: a later process does not take it for left over, nor for its own.
  EXPECT_EQ(refused(Replace::any), "accepted");
  EXPECT_EQ(names_in_out().size(), 2U);
  EXPECT_EQ(read("a.csv"), "theirs");
}

TEST_F(WholeFolders, TwoAtOnceDoNotMeet) {
  WholeFolder one(place_, "result", Replace::any);
  WholeFolder two(place_, "result", Replace::any);
  one.open();
  two.open();
  one.write("one.csv", "1");
  two.write("two.csv", "2");
  EXPECT_EQ(one.left_beside(), std::vector<std::string>{two.partial()});
  const WholeFolder third(place_, "result", Replace::any);  // clears nothing up: both are at it
  EXPECT_TRUE(one.put(State::complete).empty());
  EXPECT_EQ(whole_names(), Names{"one.csv"});
  EXPECT_TRUE(two.put(State::complete).empty());
  EXPECT_EQ(whole_names(), Names{"two.csv"});
  EXPECT_EQ(names_in_out(), Names{"a"});
}

// Processes that put results as fast as they can: there is one at every moment, and at the end.
TEST_F(WholeFolders, ManyProcessesAtOnceAlwaysLeaveAWholeResult) {
  (void)put({{"a.csv", "0"}});
  write(place_ + "/notes.txt", "mine");
  constexpr int at_once = 4;
  constexpr int all = 100;
  const auto begin = [&](int number) {
    if (::fork() != 0) return;
    const std::string name = std::to_string(number);
    const std::string said = refusal([&] {
      for (const std::string& sentence : put({{"a.csv", name}, {name + ".csv", "x"}}))
        throw SystemError(sentence);
    });
    std::fputs(said == "accepted" ? "" : (said + "\n").c_str(), stderr);
    ::_exit(said == "accepted" ? 0 : 2);
  };
  int begun = 0;
  while (begun < at_once) begin(begun++);
  for (int ended = 0; ended < all;) {
    ASSERT_TRUE(fs::exists(place_ + "/contents.sha256"));
    int status = 0;
    if (::waitpid(-1, &status, WNOHANG) <= 0) continue;
    ASSERT_EQ(status, 0);
    ++ended;
    if (begun < all) begin(begun++);
  }
  EXPECT_EQ(whole_names().size(), 2U);
  EXPECT_EQ(names_in(place_).size(), 4U);  // the list, two files, the notes
  EXPECT_EQ(read("notes.txt"), "mine");
  EXPECT_EQ(names_in_out(), Names{"a"});
}

TEST_F(WholeFolders, WhatIsNotPutIsRemovedUnlessItKeepsSomething) {
  {
    WholeFolder folder(place_, "result", Replace::any);
    folder.open();
    folder.keep("rows.csv");
    folder.write("a.csv", "1");
  }
  EXPECT_TRUE(names_in_out().empty()) << "the rows did not come";
  {
    WholeFolder folder(place_, "result", Replace::any);
    folder.open();
    folder.keep("case_001/findings.csv");
    write(folder.file("case_001/findings.csv"), "1");
  }
  EXPECT_EQ(names_in_out().size(), 1U);
}

// Of the process that was killed nothing is left but what it promised to keep.
TEST_F(WholeFolders, WhatAKilledProcessLeftIsRemovedUnlessItKeepsSomething) {
  const auto leave = [&](const char* kept, const char* file) {
    killed_after([&] {
      WholeFolder folder(place_, "result", Replace::any);
      folder.open();
      if (*kept != '\0') folder.keep(kept);
      write(folder.file(file), "1");
    });
  };
  leave("", "a.csv");
  leave("rows.csv", "a.csv");
  leave("rows.csv", "rows.csv");
  leave("case_001/findings.csv", "case_001/curve.csv");
  leave("case_001/findings.csv", "case_001/findings.csv");
  EXPECT_EQ(names_in_out().size(), 2U) << "each clears up what the one before has left";
  write(place_ + ".partial-1/rows.csv", "a folder without a list");
  fs::create_directories(place_ + ".partial-2");
  write(place_ + ".partial-notes", "a file");
  EXPECT_EQ(refused(Replace::any), "accepted");
  Names kept;
  for (const std::string& left : WholeFolder(place_, "result", Replace::any).left_beside())
    for (const std::string& name : names_in(left)) kept.insert(name);
  EXPECT_EQ(kept, (Names{"contents.sha256", "rows.csv", "case_001"}));
  EXPECT_EQ(names_in_out().size(), 4U);
}

TEST_F(WholeFolders, WhatALivingProcessWritesIsLeftAlone) {
  int ready[2];
  int over[2];
  ASSERT_EQ(::pipe(ready) + ::pipe(over), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(over[1]);
    WholeFolder folder(place_, "result", Replace::any);
    folder.open();
    char byte = 0;
    if (::write(ready[1], "x", 1) != 1 || ::read(over[0], &byte, 1) != 0) ::_exit(1);
    folder.write("a.csv", "1");
    ::_exit(folder.put(State::complete).empty() ? 0 : 2);
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_EQ(refused(Replace::any), "accepted");
  EXPECT_EQ(names_in_out().size(), 1U);
  ::close(over[1]);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(whole_names(), Names{"a.csv"});
}

// Killed before each of its calls in turn, with and without an old result, with and without
// exchange: what stands at the place is whole, and a later process finds one and leaves nothing.
TEST_F(WholeFolders, KilledAnywhereItIsTheOldOneOrTheNewOne) {
  const Contents old{{"a.csv", "old"}, {"old.csv", "old"}};
  const Contents fresh{{"a.csv", "new"}, {"new.csv", "new"}};
  for (const bool exchange : {true, false})
    for (const bool replaces : {true, false}) {
      int kills = 0;
      std::set<std::string> seen;
      for (int at = 1;; ++at, ++kills) {
        fs::remove_all(root_ / "out");
        if (replaces) {
          (void)put(old);
          write(place_ + "/notes.txt", "mine");
        }
        test::file_faults.has_exchange = exchange;
        const int ended = in_a_child([&] {
          test::file_faults.changes = 0;
          test::file_faults.kill_before = at;
          (void)put(fresh);
        });
        if (ended == 0) break;
        ASSERT_EQ(ended, -SIGKILL);
        const Names whole = whole_names();
        // With exchange there is no moment without a result.
        if (replaces && exchange) {
          EXPECT_FALSE(whole.empty()) << at;
        }
        EXPECT_EQ(whole.empty(), !fs::exists(place_)) << at;
        (void)WholeFolder(place_, "result", Replace::incomplete);
        if (replaces) {
          EXPECT_FALSE(whole_names().empty()) << at;
          EXPECT_EQ(read("notes.txt"), "mine") << at;
        }
        if (!whole_names().empty()) {
          seen.insert(read("a.csv"));
          EXPECT_EQ(names_in(place_).size(), replaces ? 4U : 3U) << at;
        }
        EXPECT_EQ(names_in_out(), whole_names().empty() ? Names{} : Names{"a"}) << at;
        test::file_faults.has_exchange = true;
      }
      EXPECT_GT(kills, replaces ? 8 : 4);
      EXPECT_EQ(seen, replaces ? (Names{"old", "new"}) : Names{"new"});
    }
}

// A later process that is killed while it clears up leaves the rest to the next one.
TEST_F(WholeFolders, KilledWhileItClearsUpIsNoHarmEither) {
  for (const bool exchange : {true, false})
    for (int first = 1; first < 12; ++first)
      for (int at = 1;; ++at) {
        fs::remove_all(root_ / "out");
        (void)put({{"a.csv", "old"}});
        write(place_ + "/notes.txt", "mine");
        test::file_faults.has_exchange = exchange;
        (void)in_a_child([&] {
          test::file_faults.changes = 0;
          test::file_faults.kill_before = first;
          (void)put({{"new.csv", "new"}});
        });
        const int ended = in_a_child([&] {
          test::file_faults.changes = 0;
          test::file_faults.kill_before = at;
          (void)WholeFolder(place_, "result", Replace::incomplete);
        });
        test::file_faults.has_exchange = true;
        (void)WholeFolder(place_, "result", Replace::incomplete);
        EXPECT_EQ(whole_names().size(), 1U) << first << ", " << at;
        EXPECT_EQ(read("notes.txt"), "mine") << first << ", " << at;
        EXPECT_EQ(names_in_out(), Names{"a"}) << first << ", " << at;
        if (ended == 0) break;
      }
}

// What an interrupted run kept is not put in place by anybody but a user.
TEST_F(WholeFolders, AnIncompleteResultThatWasKilledStaysBeside) {
  killed_after([&] {
    test::file_faults.changes = 0;
    WholeFolder folder(place_, "result", Replace::any);
    folder.open();
    folder.keep("case_001/findings.csv");
    write(folder.file("case_001/findings.csv"), "1");
    folder.write("a.csv", "1");
    test::file_faults.kill_before = test::file_faults.changes + 5;
    (void)folder.put(State::incomplete);
  });
  (void)WholeFolder(place_, "result", Replace::any);
  EXPECT_FALSE(fs::exists(place_));
  EXPECT_EQ(names_in_out().size(), 1U);
}

// As nobody, for root may write everywhere.
TEST_F(WholeFolders, AFolderThatTakesNothingIsAnErrorAndTheOldResultStays) {
  (void)put({{"a.csv", "old"}});
  fs::permissions(root_.path(), fs::perms::all);
  const auto as_nobody = [&](const std::function<void()>& work) {
    return in_a_child([&] {
      if (::geteuid() == 0 && (::setegid(65534) != 0 || ::seteuid(65534) != 0)) ::_exit(3);
      if (refusal(work).starts_with("system: ")) ::_exit(2);
    });
  };
  fs::permissions(root_ / "out", fs::perms(0555));
  EXPECT_EQ(as_nobody([&] { (void)put({{"a.csv", "new"}}); }), 2);
  EXPECT_EQ(read("a.csv"), "old");
  EXPECT_EQ(names_in_out(), Names{"a"});
  // From one moment to the next.
  fs::permissions(root_ / "out", fs::perms::all);
  EXPECT_EQ(as_nobody([&] {
              WholeFolder folder(place_, "result", Replace::any);
              folder.open();
              folder.write("a.csv", "new");
              ::seteuid(0);
              fs::permissions(root_ / "out", fs::perms(0555));
              ::seteuid(65534);
              (void)folder.put(State::complete);
            }),
            2);
  EXPECT_EQ(read("a.csv"), "old");
  EXPECT_EQ(names_in_out().size(), 2U) << "what was written is whole and stays";
}

// What was kept for a kill only does not become part of a result by an error of the disk that
// passes.
TEST_F(WholeFolders, AnErrorThatPassesLeavesNothingUnlisted) {
  bool reached = true;
  for (int call = 1; reached; ++call) {
    fs::remove_all(root_ / "out");
    WholeFolder folder(place_, "result", Replace::any);
    folder.open();
    folder.write("a.csv", "1");
    write(folder.file("case_001/findings.csv"), "1");
    test::file_faults = {.fail_at = call, .fail_with = EIO};
    const std::string said = refusal([&] { (void)folder.put(State::complete); });
    reached = test::file_faults.calls >= call;
    test::file_faults = {};
    if (said == "accepted") {
      EXPECT_EQ(names_in(place_), (Names{"a.csv", "contents.sha256"})) << "at call " << call;
    }
  }
}

// So that power that is lost leaves a whole result, each of its files is on the disk before.
TEST_F(WholeFolders, ACompleteResultWaitsForTheDisk) {
  const auto calls = [&](State content) {
    fs::remove_all(root_ / "out");
    test::file_faults = {};
    (void)put({{"a.csv", "1"}, {"b.csv", "2"}, {"c.csv", "3"}}, Replace::any, content);
    return test::file_faults.calls;
  };
  EXPECT_EQ(calls(State::complete) - calls(State::incomplete), 3 * 2);  // open() and fsync()
}

TEST_F(WholeFolders, ALinkInThePlaceOfAFileIsTheUsers) {
  (void)put({{"a.csv", "1"}});
  write(root_ / "mine.csv", "1");
  fs::remove(place_ + "/a.csv");
  fs::create_symlink(root_ / "mine.csv", place_ + "/a.csv");
  (void)put({{"a.csv", "2"}});
  EXPECT_TRUE(fs::is_symlink(place_ + "/a.csv.before"));
  EXPECT_EQ(read("a.csv"), "2");
}

TEST_F(WholeFolders, AFullDiskIsAnErrorAndTheOldResultStays) {
  (void)put({{"a.csv", "old"}});
  EXPECT_EQ(in_a_child([&] {
              std::signal(SIGXFSZ, SIG_IGN);
              const rlimit limit{100, 100};
              ::setrlimit(RLIMIT_FSIZE, &limit);
              const std::string said = refusal([&] {
                (void)put({{"a.csv", "new"}, {"b.csv", std::string(200, 'b')}});
              });
              ::_exit(said.ends_with("b.csv cannot be written: File too large") ? 2 : 3);
            }),
            2);
  EXPECT_EQ(in_a_child([&] {
              std::signal(SIGXFSZ, SIG_IGN);
              const rlimit limit{100, 100};
              ::setrlimit(RLIMIT_FSIZE, &limit);
              const std::string said = refusal([&] { (void)put({{"a.csv", "new"}}); });
              ::_exit(said.ends_with("contents.sha256 cannot be written: File too large") ? 2 : 3);
            }),
            2)
      << "the list itself";
  EXPECT_EQ(read("a.csv"), "old");
  EXPECT_EQ(names_in_out(), Names{"a"});
}

TEST_F(WholeFolders, AResultBehindASymbolicLinkIsReplacedWhereItIs) {
  write(root_ / "elsewhere/a/notes.txt", "mine");
  fs::remove(root_ / "elsewhere/a/notes.txt");
  fs::create_directories(root_ / "out");
  fs::create_symlink(root_ / "elsewhere/a", place_);
  (void)put({{"a.csv", "1"}});
  (void)put({{"a.csv", "2"}});
  EXPECT_TRUE(fs::is_symlink(place_));
  EXPECT_EQ(read("a.csv"), "2");
  EXPECT_EQ(names_in(root_ / "elsewhere"), Names{"a"});
}

}  // namespace
}  // namespace palpate
