// The table of a command line, and the pages and candidates that are made from it.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "commands/command.h"

namespace palpate::commands {
namespace {

struct Sample {
  CLI::App app{"Bakes bread.", "bake"};
  std::string flour;
  std::vector<std::string> settings;
  std::vector<std::string> loaves;
  int minutes = 40;
  bool quiet = false;
  std::string hidden;

  Sample() {
    app.add_flag("--quiet,-q", quiet, "Says nothing");
    CLI::App* loaf = app.add_subcommand("loaf", "A loaf");
    loaf->add_option("name", loaves, "Names")->required();
    loaf->add_option("--flour", flour, "Kind of flour")->check(CLI::IsMember({"rye", "wheat"}));
    loaf->add_option("--minutes", minutes, "In the oven")
        ->capture_default_str()
        ->check(CLI::Range(1, 90));
    loaf->add_option("--set", settings, "Sets a key")->type_name("KEY=VALUE");
    loaf->add_option("--hidden", hidden)->group("");
    CLI::App* oven = app.add_subcommand("oven", "The oven");
    oven->add_subcommand("heat", "Heats it")->add_option("--door", flour)->type_name("open|shut");
    app.footer("Exit codes: 0.");
  }
};

TEST(Commands, AreReadFromTheParser) {
  const Sample sample;
  const Command bake = describe(sample.app);
  ASSERT_EQ(bake.commands.size(), 2U);
  EXPECT_EQ(bake.ending, "Exit codes: 0.");
  const Command& loaf = *bake.find("loaf");
  EXPECT_EQ(synopsis(loaf, "bake "), "bake loaf NAME... [OPTION]...");
  ASSERT_EQ(loaf.options.size(), 3U);  // neither --help nor --hidden
  EXPECT_EQ(loaf.options[0].words(), (std::vector<std::string>{"rye", "wheat"}));
  EXPECT_EQ(loaf.options[1].fallback, "40");
  EXPECT_EQ(loaf.options[1].value, "INT");
  EXPECT_TRUE(bake.find("oven")->find("heat") != nullptr && bake.find("heat") == nullptr);
}

TEST(Commands, MakeAManPageWhoseTextIsNoCommandOfRoff) {
  const Sample sample;
  const std::string page = man_page({"bake", 1, "bread", "bake 1"}, describe(sample.app),
                                    "## Files\n\n| name | meaning |\n| --- | --- |\n"
                                    "| .bakerc | Read `first`. |\n\n.not a macro\n");
  EXPECT_TRUE(page.starts_with(".TH \"bake\" 1 \"\" \"bake 1\"\n.SH NAME\nbake \\- bread\n"));
  EXPECT_NE(page.find(".TP\n\\fB\\-\\-minutes INT\\fR\nIn the oven; default \\fB40\\fR.\n"),
            std::string::npos)
      << page;
  EXPECT_NE(page.find(".SS bake oven heat"), std::string::npos);
  EXPECT_NE(page.find(".SH FILES\n.TP\n\\fB.bakerc\\fR\nRead \\fBfirst\\fR.\n"), std::string::npos)
      << page;
  EXPECT_NE(page.find("\n\\&.not a macro\n"), std::string::npos);
}

TEST(Commands, MakeAPageInMarkdown) {
  const Sample sample;
  const std::string page = markdown_page(describe(sample.app), "The end.\n");
  EXPECT_NE(page.find("## bake loaf\n\n```\nbake loaf NAME... [OPTION]...\n```\n"),
            std::string::npos);
  EXPECT_NE(page.find("| `--flour rye/wheat` | Kind of flour. |\n"), std::string::npos) << page;
  EXPECT_TRUE(page.ends_with("The end.\n"));
}

std::string offered(const std::vector<std::string>& words) {
  const Sample sample;
  const std::vector<FlatKey> keys{{"dough.salt", "In grams.", {}},
                                  {"dough.kind", "", {{"sour", "slow"}, {"yeast", ""}}}};
  const std::vector<std::string> examples{"basic"};
  return complete(describe(sample.app), words, keys, examples);
}

TEST(Completion, OffersVerbsOptionsWordsKeysAndFiles) {
  EXPECT_EQ(offered({"l"}), "loaf\tA loaf\n");
  EXPECT_EQ(offered({""}), "loaf\tA loaf\noven\tThe oven\n");
  EXPECT_EQ(offered({"oven", ""}), "heat\tHeats it\n");
  EXPECT_EQ(offered({"oven", "heat", "--door", ""}), "open\t\nshut\t\n");
  EXPECT_EQ(offered({"-"}),
            "--help\tPrint this help message and exit\n-h\tPrint this help message "
            "and exit\n--quiet\tSays nothing\n-q\tSays nothing\n");
  EXPECT_EQ(offered({"loaf", "--f"}), "--flour\tKind of flour\n");
  EXPECT_EQ(offered({"loaf", "--flour", "w"}), "wheat\t\n");
  EXPECT_EQ(offered({"loaf", "--flour=w"}), "--flour=wheat\t\n");
  EXPECT_EQ(offered({"--quiet", "loaf", "--set", "dough.k"}), "dough.kind=\t\n");
  EXPECT_EQ(offered({"loaf", "--set", "dough.kind=s"}), "dough.kind=sour\tslow\n");
  EXPECT_EQ(offered({"loaf", "--set=dough.kind=s"}), "--set=dough.kind=sour\tslow\n");
  EXPECT_EQ(offered({"loaf", "one", ""}), ":files\n");
  EXPECT_EQ(offered({"bread", ""}), "loaf\tA loaf\noven\tThe oven\n");
  EXPECT_EQ(offered({}), offered({""}));
}

}  // namespace
}  // namespace palpate::commands
