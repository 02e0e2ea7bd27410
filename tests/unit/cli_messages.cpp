// Through the real program: the sentence on stderr, nothing on stdout, exit code 2, no result.
#include <gtest/gtest.h>

#include <filesystem>

#include "program.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

class Messages : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    test::write_file(folder_ / name, text);
  }

  // What the program says in the test's own folder; the arguments are words of a shell.
  [[nodiscard]] test::Ended palpate(const std::string& arguments) const {
    return test::run_program({.arguments = {"-c", "'" PALPATE_PROGRAM "' " + arguments},
                              .folder = folder_.path(),
                              .program = "sh"});
  }

  void expect_refused(const std::string& arguments, const std::string& sentence) const {
    const test::Ended said = palpate(arguments);
    EXPECT_EQ(said.code, 2) << arguments;
    EXPECT_EQ(said.out, "") << arguments;
    EXPECT_EQ(said.err, sentence + "\n") << arguments;
    EXPECT_FALSE(fs::exists(folder_ / "out")) << arguments;
  }

  test::TemporaryFolder folder_;
};

const std::string press = "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\n";

// A terminal obeys them, and names come from files: ESC, DEL, and CSI as two bytes of UTF-8.
TEST_F(Messages, HaveNoControlCharacters) {
  write("s.toml", press + "\"a\\u001b[31m\\u007f\\u009b\" = 1\n");
  const test::Ended said = palpate("run s.toml");
  EXPECT_EQ(said.code, 2);
  EXPECT_NE(said.err.find("a\\x1b[31m\\x7f\\x9b"), std::string::npos) << said.err;
  EXPECT_EQ(said.err.find('\x1b'), std::string::npos);
}

// A build server obeys lines that begin with `::`, and folders may have any name.
TEST_F(Messages, NamesOfFilesEndNoLine) {
  const std::string name = "a\n::error::b";
  fs::create_directory(folder_ / name);
  write(name + "/scenario.toml", press);
  for (const std::string verb : {"add", "check", "list", "add"}) {  // the second time it is refused
    if (verb == "check")
      write(name + "/scenario.toml", "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n");  // differs
    const test::Ended said = palpate("golden " + verb + " '" + name + "/scenario.toml'");
    for (const std::string& text : {said.out, said.err})
      EXPECT_EQ(("\n" + text).find("\n::error"), std::string::npos) << text;
    EXPECT_NE((said.out + said.err).find("a\\x0a::error::b"), std::string::npos) << verb;
  }
}

TEST_F(Messages, TitlesAndNamesAreNoCommands) {
  const std::string name = "a\n::error::b.toml";
  write(name, "title = \"c\\u000a::error::d\"\n" + press);
  for (const std::string verb : {"explain", "run"}) {
    const test::Ended said = palpate(verb + " '" + name + "'");
    EXPECT_EQ(said.code, 0) << said.err;
    for (const std::string& text : {said.out, said.err})
      EXPECT_EQ(("\n" + text).find("\n::"), std::string::npos) << text;
    if (verb == "explain") {
      EXPECT_NE(said.out.find("c\\x0a::error::d"), std::string::npos) << said.out;
    }
  }
}

TEST_F(Messages, OneOfEachClass) {
  const std::pair<std::string, std::string> cases[] = {
      {"[tissue]\nyoung_modulos = \"60 kPa\"\n",
       "press.toml:5:1: `young_modulos` is not a key here; did you mean `young_modulus`?"},
      {"[tissue]\nmesh = { file = \"box.msh\", unit = \"mm\", up = \"y\" }\n",
       "press.toml:5:41: `up` is not a key here; write `tissue.shape = { kind = \"as_meshed\", up "
       "= "
       "\"y\" }`"},
      {"[tisue]\n", "press.toml:4:2: `tisue` is not a key here; did you mean `tissue`?"},
      {"[solver]\nmodel = \"hertz\"\n[tissue]\ndensity = \"1100 kg/m^3\"\n",
       "press.toml:7:1: `density` has no effect here: it is used only with `solver.model = "
       "\"mass_spring\"` or `\"coupled_springs\"`; remove it or change that"},
      {"rate = \"3 kPa\"\n",
       "press.toml:4:8: `rate` wants a speed, got `3 kPa`, a pressure; write it as `3 mm/s`"},
      {"rate = \"3\"\n",
       "press.toml:4:8: `rate` wants a speed with its unit, got `3`; write it as `3 mm/s`"},
      {"[tissue]\npoisson_ratio = 0.5\n",
       "press.toml:5:17: `poisson_ratio` must be above -1 and below 0.5, got `0.5`; for a "
       "tissue that keeps its volume give 0.49, which lowers the force by 1.3 % on deep tissue and "
       "by more on a thin layer"},
      {"[contact]\nfriction = nan\n",
       "press.toml:5:12: `friction` wants a finite number, got `nan`; write one as `0.5`"},
      {"[contact]\nfriction = 1e400\n",
       "press.toml:5:12: `1e400` is a number that no double can hold; write one between -1e300 and "
       "1e300"},
      {"to = \"3 mm\"\n", "press.toml:4:1: `to` is given twice; keep one of the two"},
      {"[solver]\ntolerance = \"5 %\"\n",
       "press.toml:5:13: `tolerance` wants a pure number, got a text `5 %`; write it as `tolerance "
       "= 0.05`"},
      {"[contact]\nfriction = \"high\"\n",
       "press.toml:5:12: `friction` wants a pure number, got a text `high`; write it as `friction "
       "= "
       "0.5`"},
      {"[contact]\nfriction = -1\n[finger]\nradius = \"0 mm\"\n",
       "press.toml:5:12: `friction` must be at least 0, got `-1`; give a value in that range\n"
       "press.toml:7:10: `radius` must be at least 1e-06 mm and at most 1e+06 mm, got `0 mm`; give "
       "a value in that range"},
  };
  for (const auto& [text, sentence] : cases) {
    write("press.toml", press + text);
    expect_refused("run press.toml", sentence);
    expect_refused("explain press.toml", sentence);
  }
}

TEST_F(Messages, FilesThatAreNone) {
  write("empty.toml", "");
  write("binary.toml", std::string("\x7f\x45LF\x02\x01\x00", 7));
  expect_refused("run empty.toml",
                 "empty.toml:1:1: the file is empty; a scenario starts with `schema = 1`");
  expect_refused("run binary.toml", "binary.toml:1:1: this is not a text file; give a TOML file");
  expect_refused("run no.toml",
                 "no.toml: cannot be read: No such file or directory; check the path");
  expect_refused("run .", ".: is not a file; give the path of a file");
  expect_refused("run no.toml empty.toml",
                 "no.toml: cannot be read: No such file or directory; check the path\n"
                 "empty.toml:1:1: the file is empty; a scenario starts with `schema = 1`");
}

TEST_F(Messages, FilesOfBodiesThatAreNone) {
  for (const std::string ending : {"stl", "obj", "ply", "off", "msh"}) {
    const std::string file = "empty." + ending;
    write(file, "");
    expect_refused("convert --unit mm " + file,
                   file + ": is empty; save it again, or name another file");
    for (const std::string table : {"shape", "mesh"}) {
      if ((table == "mesh") != (ending == "msh")) continue;
      write("press.toml",
            press + "[tissue]\n" + table + " = { file = \"" + file + "\", unit = \"mm\" }\n");
      expect_refused("run press.toml",
                     "press.toml:5:" + std::to_string(table.size() + 13) + ": `file` names `" +
                         file + "`, which is empty; save it again, or name another file");
    }
  }
  write("cells.mesh",
        "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n30 0 0 0\n0 30 0 0\n"
        "0 0 30 0\nTetrahedra\n1\n1 2 3 4 0\nEnd\n");
  write("press.toml", press + "[tissue]\nshape = { file = \"cells.mesh\", unit = \"mm\" }\n");
  expect_refused("run press.toml",
                 "press.toml:5:18: cells.mesh: holds solid cells; name it in `tissue.mesh` in "
                 "place of `tissue.shape`, as `mesh = { file = ..., unit = \"mm\" }`");
}

TEST_F(Messages, SettingsAndArguments) {
  write("press.toml", press);
  expect_refused("run press.toml --set finger.radius=-1 --set 'step.1.to=3 kPa'",
                 "--set finger.radius=-1: `radius` wants a length with its unit, as text, got an "
                 "integer `-1`; write it as `radius = \"-1 mm\"`\n"
                 "--set step.1.to=3 kPa: `to` wants a length or a force, got `3 kPa`, a pressure; "
                 "write it as `3 mm`");
  expect_refused("ruun press.toml", "palpate: unknown verb `ruun`; did you mean `run`?");
  expect_refused("new pres", "palpate: `kind` does not know `pres`; did you mean `press`?");
  expect_refused("run press.toml --forse",
                 "palpate: unknown option `--forse`; did you mean `--force`?");
  expect_refused("run",
                 "palpate: `palpate run` lacks `scenario`; `palpate run --help` shows how to "
                 "write it");
}

TEST_F(Messages, ExplainKnowsKeysAndTables) {
  const test::Ended friction = palpate("explain contact.friction");
  EXPECT_EQ(friction.code, 0);
  EXPECT_EQ(friction.err, "");
  EXPECT_EQ(friction.out,
            "`[contact]`: `friction`\n  value:   number >= 0\n  default: `0`\n  Coulomb's "
            "coefficient mu.\n");
  EXPECT_EQ(palpate("explain friction").out, friction.out);
  EXPECT_NE(palpate("explain step.1.rate").out.find("`step`, `kind = \"retract\"`: `rate`"),
            std::string::npos);
  EXPECT_NE(palpate("explain contact").out.find("`[contact]`: `coupling`"), std::string::npos);
  expect_refused("explain contact.fricton",
                 "palpate: `contact.fricton` is neither a file nor a key; "
                 "did you mean `contact.friction`?");
  expect_refused("explain finger.coupling",
                 "palpate: `finger.coupling` is neither a file nor a key; "
                 "did you mean `contact.coupling`?");
  expect_refused("explain xyzzyxyzzy",
                 "palpate: `xyzzyxyzzy` is neither a file nor a key; `palpate "
                 "manual` lists all keys");
}

TEST_F(Messages, AWordThatIsNoKeyIsFoundInTheManualAndTheTissues) {
  const std::string muscle = palpate("explain muscle").out;
  EXPECT_NE(muscle.find("young_modulus = { value = \"6 kPa\""), std::string::npos) << muscle;
  EXPECT_EQ(muscle.find("[bone]"), std::string::npos) << muscle;
  const std::string travel = palpate("explain travel").out;
  EXPECT_NE(travel.find("\n  step.to: Displacement below the undeformed surface"),
            std::string::npos)
      << travel;
  EXPECT_NE(palpate("complete run a --set finger.material=").out.find("finger.material=rigid\t"),
            std::string::npos);
}

TEST_F(Messages, AnswersGoToStdout) {
  for (const char* asked :
       {"--help", "run --help", "explain --help", "fit --help", "compare --help",
        "golden add --help", "golden check --help", "manual --help", "--version", "manual"}) {
    const test::Ended said = palpate(asked);
    EXPECT_EQ(said.code, 0) << asked;
    EXPECT_EQ(said.err, "") << asked;
    EXPECT_NE(said.out, "") << asked;
  }
}

}  // namespace
}  // namespace palpate
