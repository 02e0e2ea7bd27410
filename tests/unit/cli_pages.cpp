// What a newcomer asks for: help, pages, a scenario to begin with, a dry run, the standard input.
#include <gtest/gtest.h>

#include <filesystem>

#include "base/files.h"
#include "program.h"
#include "scenario/schema.h"
#include "temporary_folder.h"

namespace palpate::test {
namespace {

TEST(Pages, HelpOfAVerbIsThatOfItsOption) {
  const TemporaryFolder folder;
  EXPECT_EQ(palpate(folder.path(), {"help", "sweep", "run"}).out,
            palpate(folder.path(), {"sweep", "run", "--help"}).out);
  EXPECT_EQ(palpate(folder.path(), {"help"}).out, palpate(folder.path(), {"--help"}).out);
  EXPECT_EQ(palpate(folder.path(), {"-V"}).out, palpate(folder.path(), {"--version"}).out);
  const Ended wrong = palpate(folder.path(), {"help", "rum"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(says(wrong, "did you mean `run`?")) << wrong.err;
}

TEST(Pages, NameEveryVerbAndKey) {
  const TemporaryFolder folder;
  const std::string help = palpate(folder.path(), {"complete", ""}).out;
  const std::string page = palpate(folder.path(), {"manual", "commands", "--man"}).out;
  const std::string markdown = palpate(folder.path(), {"manual", "commands"}).out;
  for (const char* verb : {"run", "explain", "sweep", "completion", "open"}) {
    EXPECT_NE(help.find("\n" + std::string(verb) + "\t"), std::string::npos) << verb;
    EXPECT_NE(page.find("\n.SS palpate " + std::string(verb) + " "), std::string::npos) << verb;
    EXPECT_NE(markdown.find("\n## palpate " + std::string(verb) + "\n"), std::string::npos);
  }
  const std::string keys = palpate(folder.path(), {"manual", "--man"}).out;
  EXPECT_TRUE(keys.starts_with(".TH \"palpate\\-scenario\" 5"));
  EXPECT_NE(keys.find("\\fByoung_modulus\\fR"), std::string::npos);
  const Ended emulator =
      run_program({.arguments = {"--man"}, .folder = folder.path(), .program = PALPATE_EMULATOR});
  EXPECT_TRUE(emulator.out.starts_with(".TH \"palpate\\-emulator\" 1")) << emulator.err;
}

TEST(Pages, AnIndexSaysHowLongARunTook) {
  const TemporaryFolder folder;
  write_file(
      folder / "out/a/report.html",
      "<!doctype html>\n<title>a – palpate run</title>\n<div class=\"answer\"><p>One.</p></div>\n");
  write_file(folder / "out/a/run.json",
             R"({"finished": [{"timings_s": {"run": 1.25}}, {"timings_s": {"run": 1.25}}]})");
  write_file(folder / "out/b/report.html", "<title>b – palpate sweep</title>\n");
  const Ended opened = palpate(folder.path(), {"open", "out"});
  ASSERT_EQ(opened.code, 0) << opened.err;
  const std::string index = read_page(folder / "out/index.html");
  EXPECT_NE(index.find(" It took 2.5 s."), std::string::npos) << index;
  EXPECT_EQ(index.find("It took"), index.rfind("It took")) << "b has no times";
}

// Results with one title are told apart by their folders, not by the names of their pages.
TEST(Pages, AnIndexTellsEqualTitlesApart) {
  const TemporaryFolder folder;
  for (const char* name : {"out/a/r", "out/b/r"})
    write_file(folder / name / "report.html", "<title>A press – palpate run</title>\n");
  ASSERT_EQ(palpate(folder.path(), {"open", "out"}).code, 0);
  const std::string index = read_file(folder / "out/index.html");
  for (const char* heading : {">A press</a>", ">A press (b/r)</a>"})
    EXPECT_NE(index.find(heading), std::string::npos) << heading << index;
}

// A folder's name is no scheme: a page opens where the link of the index says. A link to itself, of
// which nobody can say what it is, is no report.
TEST(Pages, AnIndexHasLinksToFoldersOfAnyName) {
  const TemporaryFolder folder;
  const std::string name = "out/javascript:alert(1)?#";
  write_file(folder / "s.toml", "[solver]\nmodel = \"hertz\"\n[[step]]\nkind = \"indent\"\n");
  ASSERT_EQ(
      palpate(folder.path(), {"run", "s.toml", "--out", name, "--set", "output.figures=false"})
          .code,
      0);
  fs::create_symlink("loop", folder / "out/loop");
  const Ended opened = palpate(folder.path(), {"open", "out"});
  ASSERT_EQ(opened.code, 0) << opened.err;
  const std::string index = read_file(folder / "out/index.html");
  EXPECT_NE(index.find("href=\"./javascript%3Aalert%281%29%3F%23/s/report.html\""),
            std::string::npos)
      << index;
}

TEST(Pages, KeysAreListedOnceWithTheirWords) {
  std::set<std::string> paths;
  for (const FlatKey& key : scenario::settable_keys()) {
    EXPECT_TRUE(paths.insert(key.path).second) << key.path;
    if (key.path == "contact.coupling") {
      EXPECT_EQ(key.words.size(), 4U);
    }
  }
  for (const char* path : {"schema", "tissue.young_modulus", "tissue.shape.kind", "step.1.to",
                           "tissue.branch.1.ratio", "region.1.radius"})
    EXPECT_TRUE(paths.contains(path)) << path;
}

TEST(NewScenario, OfEveryKindRunsAsItIs) {
  const TemporaryFolder folder;
  for (const scenario::Starter& starter : scenario::starters()) {
    const std::string kind = starter.word.word;
    const std::string file = kind + ".toml";
    EXPECT_EQ(palpate(folder.path(), {"new", kind}).code, 0);
    EXPECT_EQ(read_text((folder.path() / file).string()), starter.text);
    const std::vector<std::string> smaller =
        kind == "organ" ? std::vector<std::string>{"--set", "tissue.mesh.nodes=300"}
                        : std::vector<std::string>{};
    const Ended ended = palpate(folder.path(), {"run", file}, smaller);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_TRUE(fs::exists(folder.path() / "out" / kind / "findings.csv"));
  }
  const Ended twice = palpate(folder.path(), {"new", "press"});
  EXPECT_EQ(twice.code, 2);
  EXPECT_TRUE(says(twice, "press.toml: exists; give another name")) << twice.err;
  EXPECT_EQ(palpate(folder.path(), {"new", "press", "--force"}).code, 0);
  EXPECT_EQ(palpate(folder.path(), {"new", "press", "-"}).out, scenario::starters()[0].text);
}

// A program without its examples, such as one that was copied alone, promises what it can do.
TEST(NewScenario, IsTheBeginningWhereThereAreNoExamples) {
  const TemporaryFolder folder;
  const fs::path alone = folder / "bin/palpate";
  fs::create_directories(alone.parent_path());
  fs::copy_file(PALPATE_PROGRAM, alone);
  const auto ran = [&](const std::vector<std::string>& words) {
    return run_program({.arguments = words, .folder = folder.path(), .program = alone.string()});
  };
  const std::string welcome = ran({}).out;
  EXPECT_EQ(welcome.find("quickstart"), std::string::npos) << welcome;
  EXPECT_LT(welcome.find("palpate new press "), welcome.find("palpate run press.toml "));
  for (const auto& [name, kind] : {std::pair("quickstart", "press"), std::pair("creep", "creep")}) {
    const Ended ended = ran({"run", name});
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(says(ended, std::string(name) +
                                ": is neither a file nor an installed example; `palpate new " +
                                kind + "` writes " + kind + ".toml, a scenario to begin with"))
        << ended.err;
  }
  EXPECT_NE(palpate(folder.path(), {}).out.find("palpate run quickstart"), std::string::npos);
}

TEST(DryRun, SaysWhatWouldBeComputedAndWritesNothing) {
  const TemporaryFolder folder;
  (void)palpate(folder.path(), {"new", "sweep"});
  const std::set<std::string> before = names_in(folder.path());
  const Ended ended = palpate(folder.path(), {"run", "sweep.toml", "--dry-run"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(ended.out.starts_with("out/sweep: 10 cases would be computed")) << ended.out;
  EXPECT_NE(ended.out.find("\n  5 kPa_10 mm: layer, error about "), std::string::npos) << ended.out;
  EXPECT_EQ(names_in(folder.path()), before);
  EXPECT_EQ(
      palpate(folder.path(), {"run", "sweep.toml", "--dry-run", "--set", "step.1.to=3 kPa"}).code,
      2);
  const Ended lines = palpate(folder.path(), {"run", "sweep.toml", "--dry-run", "--json"});
  EXPECT_TRUE(lines.out.starts_with("{\"event\":\"planned\",\"scenario\":\"sweep\"")) << lines.out;
}

TEST(StandardInput, IsAScenarioOrACurve) {
  const TemporaryFolder folder;
  const auto shell = [&](const std::string& line) {
    return run_program({.arguments = {"-c", line},
                        .folder = folder.path(),
                        .set = {{"PALPATE", PALPATE_PROGRAM}},
                        .program = "/bin/sh"});
  };
  const Ended ran = shell("\"$PALPATE\" new press - | \"$PALPATE\" run -");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(fs::exists(folder.path() / "out/stdin/force_indentation.csv"));
  const std::string rest = " --x indentation_mm --y contact_force_N --model power";
  const Ended piped = shell("\"$PALPATE\" fit - " + rest + " < out/stdin/force_indentation.csv");
  EXPECT_EQ(piped.code, 0) << piped.err;
  EXPECT_EQ(piped.out, shell("\"$PALPATE\" fit out/stdin/force_indentation.csv" + rest).out);
  const Ended broken = shell("echo 'schema = 2' | \"$PALPATE\" explain -");
  EXPECT_EQ(broken.code, 2);
  EXPECT_TRUE(says(broken, "stdin:1:10: `schema` must be 1")) << broken.err;
}

TEST(OpenResult, PrintsThePathWithoutADesktop) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "result");
  const std::vector<std::string> no_display{"DISPLAY", "WAYLAND_DISPLAY"};
  const auto open = [&] {
    return run_program(
        {.arguments = {"open", "result"}, .folder = folder.path(), .unset = no_display});
  };
  EXPECT_EQ(open().code, 2);
  (void)folder.file("result/figure_b.svg", "<svg/>");
  (void)folder.file("result/figure_a.svg", "<svg/>");
  EXPECT_TRUE(open().out.ends_with("result/figure_a.svg\n"));
  (void)folder.file("result/report.html", "<html/>");
  EXPECT_TRUE(open().out.ends_with("result/report.html\n"));
  const Ended told = run_program(
      {.arguments = {"open", "result", "--json"}, .folder = folder.path(), .unset = no_display});
  EXPECT_TRUE(told.out.starts_with("{\"event\":\"page\",\"path\":\"/")) << told.out;
  EXPECT_TRUE(told.out.ends_with("/result/report.html\",\"shown\":false}\n")) << told.out;

  // A desktop's opener is asked where there is a display.
  (void)folder.file("xdg-open", "#!/bin/sh\nbasename \"$1\" > opened\n");
  fs::permissions(folder.path() / "xdg-open", fs::perms::owner_all);
  const Ended shown = run_program(
      {.arguments = {"open", "result"},
       .folder = folder.path(),
       .set = {{"DISPLAY", ":9"}, {"PATH", folder.path().string() + ":/usr/bin:/bin"}}});
  EXPECT_EQ(shown.out, "");
  EXPECT_EQ(read_text((folder.path() / "opened").string()), "report.html\n");
}

// `script` gives the program a terminal.
TEST(Colours, AreLeftOutWhereNobodyWantsThem) {
  const TemporaryFolder folder;
  const auto typed = [&](const std::string& before, const std::string& options) {
    return run_program(
               {.arguments = {"-qec",
                              before + " '" PALPATE_PROGRAM "' run f.toml --force " + options,
                              "/dev/null"},
                .folder = folder.path(),
                .set = {{"TERM", "xterm"}, {"PATH", "/nothing"}, {"SHELL", "/bin/sh"}},
                .unset = {"NO_COLOR"},
                .program = "/usr/bin/script"})
        .out;
  };
  (void)folder.file("f.toml",
                    "schema = 1\n[output]\npressure_maps = false\n[[step]]\nto = \"1 mm\"\n");
  const std::string yellow = "\033[33mwarning:";  // there is no gnuplot at /nothing
  EXPECT_NE(typed("", "").find(yellow), std::string::npos) << typed("", "");
  for (const std::string& plain :
       {typed("NO_COLOR=1", ""), typed("", "--no-color"), typed("TERM=dumb", "")}) {
    EXPECT_EQ(plain.find("\033[33m"), std::string::npos) << plain;
    EXPECT_NE(plain.find("warning:"), std::string::npos) << plain;
  }
}

}  // namespace
}  // namespace palpate::test
