// The command line as values, and the sentences for one that is not ours.
#include "cli/arguments.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace palpate::cli {
namespace {

using Words = std::vector<std::string>;
using RunCommand = Run;  // testing::Test has a Run of its own

template <class Command>
Command accepted(const Words& words) {
  const auto parsed = parse(words);
  if (const auto* wrong = std::get_if<UsageError>(&parsed))
    throw std::runtime_error(wrong->message);
  return std::get<Command>(std::get<Arguments>(parsed).verb);
}

Manner manner(const Words& words) { return std::get<Arguments>(parse(words)).manner; }

std::string refusal(const Words& words) {
  const auto parsed = parse(words);
  const auto* wrong = std::get_if<UsageError>(&parsed);
  return wrong != nullptr ? wrong->message : "accepted";
}

std::string answer(const Words& words) {
  const auto parsed = parse(words);
  const auto* text = std::get_if<Answer>(&parsed);
  return text != nullptr ? text->text : "no answer";
}

TEST(Arguments, OfRun) {
  const RunCommand run =
      accepted<RunCommand>({"run", "a.toml", "--set", "x.y=1 mm", "b.toml", "--set=z=-2", "--out",
                            "there", "--jobs", "2", "--force"});
  EXPECT_EQ(run.scenarios, (Words{"a.toml", "b.toml"}));
  EXPECT_EQ(run.settings, (Words{"x.y=1 mm", "z=-2"}));
  EXPECT_EQ(run.out, "there");
  EXPECT_EQ(run.jobs, 2);
  EXPECT_TRUE(run.force);
  EXPECT_EQ(accepted<RunCommand>({"run", "a.toml"}).out, "out");
}

TEST(Arguments, OfTheOtherVerbs) {
  EXPECT_EQ(accepted<Explain>({"explain", "tissue.mesh"}).subject, "tissue.mesh");
  const Fit fit = accepted<Fit>({"fit", "d.csv", "--x", "h", "--y", "F", "--model", "power",
                                 "--origin", "-0.5", "--case", "skin"});
  EXPECT_EQ(fit.x_origin, -0.5);  // a negative number is no option
  EXPECT_EQ(fit.columns.x + fit.columns.y + fit.columns.case_name, "hFskin");
  const Identify identify = accepted<Identify>(
      {"identify", "d.csv", "s.toml", "--unknown", "a=1..2", "--x-unit", "mm", "--skip", "3",
       "--separator", ";", "--decimal", ",", "--segment", "approach"});
  EXPECT_EQ(identify.columns.x_unit + identify.columns.separator + identify.columns.decimal,
            "mm;,");
  EXPECT_EQ(identify.columns.segment + identify.columns.compression, "approachauto");
  EXPECT_EQ(identify.columns.skip, 3);
  const Compare compare = accepted<Compare>({"compare", "a", "b", "--tolerances", "t.toml"});
  EXPECT_EQ(compare.got + compare.want + compare.tolerances, "abt.toml");
  const Golden add = accepted<Golden>({"golden", "add", "one", "two", "--reason", "why"});
  EXPECT_EQ(add.subjects, (Words{"one", "two"}));
  EXPECT_EQ(add.act, Golden::Act::add);
  EXPECT_EQ(add.reason, "why");
  const Golden check = accepted<Golden>({"golden", "check", "mine", "--junit", "a.xml"});
  EXPECT_EQ(check.options.junit, "a.xml");
  const Convert mesh = accepted<Convert>({"convert", "leg.stl", "--unit", "mm", "--edge", "3 mm",
                                          "--out", "a.node", "--out", "a.vtu", "--force"});
  EXPECT_EQ(mesh.subject + mesh.unit + mesh.edge, "leg.stlmm3 mm");
  EXPECT_EQ(mesh.out, (Words{"a.node", "a.vtu"}));
  EXPECT_TRUE(mesh.force);
  EXPECT_EQ(accepted<Convert>({"convert", "leg.stl", "--nodes", "500"}).nodes, 500);
  EXPECT_EQ(accepted<Convert>({"convert", "out/press", "--to", "csv-si"}).format, "csv-si");
  EXPECT_EQ(accepted<Chart>({"chart", "--frames", "200"}).frames, 200);
  EXPECT_EQ(accepted<Chart>({"chart", "a.toml"}).scenario, "a.toml");
  (void)accepted<Manual>({"manual"});
}

TEST(Arguments, OfEveryVerbStandBeforeOrAfterIt) {
  EXPECT_TRUE(manner({"--quiet", "run", "a.toml"}).quiet);
  EXPECT_TRUE(manner({"run", "a.toml", "--quiet"}).quiet);
  EXPECT_TRUE(manner({"-q", "run", "a.toml", "--json"}).json);
  EXPECT_FALSE(manner({"run", "a.toml"}).json);
}

TEST(Arguments, AValueMayLookLikeAnythingElse) {
  EXPECT_EQ(accepted<Golden>({"golden", "add", "one", "--reason", "--quiet is quiet"}).reason,
            "--quiet is quiet");
  EXPECT_EQ(accepted<RunCommand>({"run", "a.toml", "--out", "--there"}).out, "--there");
  EXPECT_EQ(accepted<RunCommand>({"run", "manual"}).scenarios, Words{"manual"});
  EXPECT_EQ(accepted<RunCommand>({"run", "--", "--odd.toml"}).scenarios, Words{"--odd.toml"});
}

TEST(Arguments, ThatAreWrongAreToldInOneSentence) {
  const std::pair<Words, const char*> cases[] = {
      {{"ruun", "a.toml"}, "unknown verb `ruun`; did you mean `run`?"},
      {{"xyzzy"},
       "unknown verb `xyzzy`; known: help, new, explain, run, sweep, compare, golden, data, fit, "
       "identify, device, chart, stability, reference, convert, open, manual, schema, completion"},
      {{"golden", "chek"}, "unknown verb `chek`; did you mean `check`?"},
      {{"golden"},
       "`palpate golden` wants a verb: add, check, list; `palpate golden --help` shows how to "
       "write "
       "it"},
      // Words that were verbs before 1.0.
      {{"mesh", "leg.stl"}, "`palpate mesh` is `palpate convert` now"},
      {{"export", "out/press"}, "`palpate export` is `palpate convert` now"},
      {{"report", "out"}, "`palpate report` is `palpate open` now"},
      {{"bench"}, "`palpate bench` is `palpate chart --frames 1000` now"},
      {{"golden", "bless", "press"},
       "`palpate golden bless` is `palpate golden add --force --reason TEXT` now"},
      {{"run", "a.toml", "--forse"}, "unknown option `--forse`; did you mean `--force`?"},
      {{"run", "a.toml", "--workers", "2"},
       "unknown option `--workers`; known: --help, --version, --quiet, --no-color, --json, --csv, "
       "--out, --set, --jobs, --force, --dry-run, --device, --arm, --realtime, --traffic, "
       "--expect, "
       "--surface, --max-force, --seconds, --clock"},
      {{"run", "a.toml", "--sett=x=1"}, "unknown option `--sett`; did you mean `--set`?"},
      {{"compare", "a", "b", "--jobs", "2"},
       "`palpate compare` has no option `--jobs`, which belongs to `palpate run`, "
       "`palpate sweep run`, `palpate sweep retry`, `palpate golden add`, `palpate golden check`; "
       "`palpate compare --help` lists its own"},
      {{"compare", "a", "b", "--jsom"}, "unknown option `--jsom`; did you mean `--json`?"},
      {{"--force", "run", "a.toml"},
       "option `--force` stands before its verb; write it as `palpate run ... --force`"},
      {{"run"}, "`palpate run` lacks `scenario`; `palpate run --help` shows how to write it"},
      {{"compare", "a"},
       "`palpate compare` lacks `want`; `palpate compare --help` shows how to write "
       "it"},
      {{"fit", "d.csv", "--x", "h", "--y", "F"},
       "`palpate fit` lacks `--model`; `palpate fit --help` shows how to write it"},
      {{"golden", "add"},
       "`palpate golden add` lacks `scenario`; `palpate golden add --help` shows how to write it"},
      {{"run", "a.toml", "--jobs", "-1"},
       "`palpate run` cannot be read: `--jobs` wants a number from 0 to 1024, got `-1`; `palpate "
       "run --help` shows how to write it"},
      {{"fit", "d.csv", "--x", "h", "--y", "F", "--model", "hertz", "--poisson", "2"},
       "`palpate fit` cannot be read: `--poisson` wants a number from 0 to 0.5, got `2`; `palpate "
       "fit --help` shows how to write it"},
      {{"fit", "d.csv", "--x", "t", "--y", "F", "--model", "prony", "--origin", "0 s"},
       "`palpate fit` cannot be read: `--origin` wants a plain number, got `0 s`; `palpate fit "
       "--help` shows how to write it"},
      {{"run", "a.toml", "--out"},
       "`palpate run` cannot be read: `--out` wants a value behind it; `palpate run --help` shows "
       "how to write it"},
      {{"compare", "a", "b", "c"},
       "`palpate compare` cannot be read: this word is too many: `c`; `palpate compare --help` "
       "shows how to write it"},
      {{"run", "a.toml", "--out", "a", "--out", "b"},
       "`palpate run` cannot be read: `--out` is given 2 times; give it once; `palpate run --help` "
       "shows how to write it"},
      {{"run", "a.toml", "--arm"},
       "`palpate run` cannot be read: `--arm` is used only with `--device`; `palpate run --help` "
       "shows how to write it"},
      {{"run", "a.toml", "--device", "replay:a.csv", "--dry-run"},
       "`palpate run` cannot be read: `--dry-run` does not go with `--device`; `palpate run "
       "--help` shows how to write it"},
      {{"run", "a.toml", "--device", "replay:a.csv", "--clock", "slow"},
       "a hidden option does not know `slow`; it is one of real, virtual"},
      {{"completion", "csh"}, "`shell` does not know `csh`; it is one of bash, zsh, fish"},
      {{"schema", "---"},
       "unknown option `---`; known: --help, --version, --quiet, --no-color, --json, --csv"},
  };
  for (const auto& [words, sentence] : cases) EXPECT_EQ(refusal(words), sentence);
}

TEST(Arguments, HelpAndVersionAreAnswers) {
  EXPECT_TRUE(answer({"--version"}).starts_with("palpate 0."));
  EXPECT_NE(answer({"--help"}).find("Exit codes: 0 good"), std::string::npos);
  for (const char* verb :
       {"run", "explain", "fit", "compare", "golden", "convert", "chart", "manual"})
    EXPECT_NE(answer({verb, "--help"}).find("Usage: palpate " + std::string(verb)),
              std::string::npos)
        << verb;
  // Each has an example, of itself; `palpate` alone says what it is.
  for (const commands::Command& verb : described().commands) {
    if (verb.name == "help") continue;
    const std::string text = answer({verb.name, "--help"});
    EXPECT_NE(text.find("Example: palpate " + verb.name), std::string::npos) << verb.name;
    for (const commands::Command& inner : verb.commands) {
      const std::string words = verb.name + " " + inner.name;
      EXPECT_NE(answer({verb.name, inner.name, "--help"}).find("Example: palpate " + words),
                std::string::npos)
          << words;
    }
  }
  EXPECT_NE(answer({}).find("palpate run quickstart"), std::string::npos);
  EXPECT_NE(answer({"golden", "add", "-h"}).find("Usage: palpate golden add"), std::string::npos);
}

}  // namespace
}  // namespace palpate::cli
