// Cases from a CSV file, and the places of what is wrong in it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "base/files.h"
#include "scenario/resolved.h"
#include "scenario_text.h"

namespace palpate::scenario {
namespace {

namespace fs = std::filesystem;

const std::string sweep = "[sweep]\ndesign = \"csv\"\nfile = \"cases.csv\"\n";
const char* const gel =
    "[gel]\ndensity = { value = \"1000 kg/m^3\", source = \"scale\" }\nyoung_modulus = { value = "
    "\"12 kPa\", source = \"press\" }\npoisson_ratio = { value = 0.45, source = \"assumed\" }\n";

class Tables : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("palpate_tables_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    write_atomically((folder_ / name).string(), text);
  }
  [[nodiscard]] std::string scenario() const { return (folder_ / "press.toml").string(); }

  [[nodiscard]] Family of(const std::string& table) const {
    write("cases.csv", table);
    return parse(small_press + sweep, scenario(), {});
  }

  // What is said of this table, without the folder's name.
  [[nodiscard]] std::string said(const std::string& table) const {
    std::string message = "accepted";
    try {
      (void)of(table);
    } catch (const InputError& error) {
      message = error.what();
    }
    const std::string name = folder_.string() + "/";
    for (std::size_t at = message.find(name); at != std::string::npos; at = message.find(name))
      message.erase(at, name.size());
    return message;
  }

  fs::path folder_;
};

using Words = std::vector<std::string>;

TEST_F(Tables, AreCasesRowByRow) {
  const Family family =
      of("tissue.young_modulus [kPa],contact.friction,tissue.material,output.fits\n"
         "10,0.25,skin,true\n"
         "\n"
         "2.5e1, 0 ,muscle,false\n");
  EXPECT_EQ(family.design.kind(), Design::Kind::csv);
  ASSERT_EQ(family.cases.size(), 2U);
  EXPECT_EQ(family.cases[0].name, "0001");
  EXPECT_EQ(family.cases[0].scenario.tissue.young_modulus, 1e4);
  EXPECT_EQ(family.cases[1].scenario.tissue.young_modulus, 2.5e4);
  EXPECT_EQ(family.cases[0].scenario.contact.friction, 0.25);
  EXPECT_EQ(family.cases[1].scenario.tissue.material, "muscle");
  EXPECT_FALSE(family.cases[1].scenario.output.fits);
  EXPECT_EQ(family.cases[1].swept[0],
            (std::pair<std::string, std::string>{"tissue.young_modulus", "2.5e1 kPa"}));
  EXPECT_EQ(family.design.keys(),
            (Words{"tissue.young_modulus", "contact.friction", "tissue.material", "output.fits"}));
  ASSERT_EQ(family.inputs.size(), 2U);
  EXPECT_EQ(family.inputs[1].name, "cases.csv");
}

TEST_F(Tables, TakeUnitsInCellsQuotesAndListsToo) {
  const Family family =
      of("\xef\xbb\xbf\"step.1.to\",tissue.shape.size,title\r\n"
         "0.1 mm,\"[\"\"60 mm\"\", \"\"60 mm\"\", \"\"30 mm\"\"]\",\"a, \"\"b\"\"\"\r\n"
         "20 mN,\"[\"\"61 mm\"\", \"\"60 mm\"\", \"\"30 mm\"\"]\",plain\r\n");
  ASSERT_EQ(family.cases.size(), 2U);
  EXPECT_EQ(std::get<Indent>(family.cases[0].scenario.steps[0]).to.value, 1e-4);
  EXPECT_TRUE(std::get<Indent>(family.cases[1].scenario.steps[0]).to.second);
  EXPECT_EQ(std::get<Cuboid>(family.cases[1].scenario.tissue.shape).size[0], 0.061);
  EXPECT_EQ(family.cases[0].scenario.title, "a, \"b\"");
  EXPECT_EQ(family.cases[1].scenario.title, "plain");
}

TEST_F(Tables, NameFilesBesideTheScenario) {
  write("my.toml", gel);
  const Family family = of("tissue.material,tissue.viscosity\nskin,none\nmy.toml#gel,none\n");
  EXPECT_EQ(filled(family.cases[1]).tissue.young_modulus, 12000.0);
  EXPECT_EQ(family.cases[1].files, Words{"my.toml"});
  EXPECT_EQ(family.cases[0].files, Words{});
  EXPECT_EQ(said("tissue.material\nskin\ndata/my.toml#gel\n"),
            "cases.csv:3:1: `data/my.toml#gel` lies in another folder, where a copy of this table "
            "among results would not find it; put the file beside the scenario and write its bare "
            "name");
}

TEST_F(Tables, TellTheCellOfAMistake) {
  const std::pair<const char*, const char*> cases[] = {
      {"",
       "cases.csv:1:1: the file has no header; name a key a column, as `tissue.young_modulus "
       "[kPa]`"},
      {"contact.friction\n",
       "cases.csv:1:1: the file has a header alone; add a row for every case"},
      {"contact.friction,\n1,2\n",
       "cases.csv:1:18: the header has an empty cell; name a key, as `tissue.young_modulus [kPa]`"},
      {"contact.friction;finger.radius\n1;2\n",
       "cases.csv:1:1: the header has one cell, `contact.friction;finger.radius`; separate cells "
       "by "
       "commas"},
      {"contact.friction,contact.friction\n1,2\n",
       "cases.csv:1:18: `contact.friction` has two columns; keep one of the two"},
      {"contact.friction,finger.radius\n1,2 mm\n1\n",
       "cases.csv:3:1: this row has 1 cells, and the header has 2; give a value for every column"},
      {"contact.friction,finger.radius\n1,2 mm,3\n",
       "cases.csv:2:8: this row has 3 cells, and the header has 2; give a value for every column"},
      {"contact.friction,finger.radius\n1,\n",
       "cases.csv:2:3: `finger.radius` has no value here; give one in every row"},
      {"title\n\"a\n",
       "cases.csv:2:1: a quoted cell does not end before its comma; close it by "
       "`\"`, and double the quotes inside it"},
      {"title\n\"a\" b\n",
       "cases.csv:2:1: a quoted cell does not end before its comma; close it by "
       "`\"`, and double the quotes inside it"},
      {"contact.friction\n0\n-1\n",
       "cases.csv:3:1: `friction` must be at least 0, got `-1`; give a value in that range"},
      {"contact.friction\n0\nnan\n",
       "cases.csv:3:1: `friction` wants a finite number, got `nan`; write one as `0.5`"},
      {"contact.friction\n0\n1e400\n",
       "cases.csv:3:1: `friction` wants a finite number, got `1e400`; write one as `0.5`"},
      {"finger.radius [kPa]\n1\n",
       "cases.csv:2:1: `radius` wants a length, got `1 kPa`, a pressure; write it as `1 mm`"},
      {"contact.frictoin\n1\n",
       "cases.csv:1:1: `frictoin` is not a key here; did you mean `friction`?"},
      {"step.2.to\n1 mm\n",
       "cases.csv:1:1: `step.2.to` cannot be set: `2` is none of the list's entries; count them "
       "from 1 to 1, or append one by `2.kind`"},
      {"\x01\x02", "cases.csv:1:1: this is not a text file; give a CSV file"},
      {"title\n\xff\n", "cases.csv:2:1: this is not UTF-8 text; save the file as UTF-8"},
  };
  for (const auto& [table, sentence] : cases) EXPECT_EQ(said(table), sentence) << table;
}

TEST_F(Tables, AreAskedForAsAFile) {
  const auto refusal = [&](const std::string& text) {
    try {
      (void)parse(small_press + text, "press.toml", {});
      return std::string("accepted");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(refusal("[sweep]\ndesign = \"csv\"\n"),
            "press.toml:5:10: `design = \"csv\"` lacks `file`; write `file = \"cases.csv\"`");
  EXPECT_EQ(refusal("[sweep]\ndesign = \"csv\"\nfile = 3\n"),
            "press.toml:6:8: `file` wants a text, got an integer; write it as `file = "
            "\"cases.csv\"`");
  EXPECT_EQ(refusal("[sweep]\ndesign = \"csv\"\nfile = \"no.csv\"\n"),
            "press.toml:6:8: `file` names `no.csv`, which cannot be read: No such file or "
            "directory; check the path");
  EXPECT_EQ(refusal(sweep + "\"contact.friction\" = [1]\n"),
            "press.toml:7:1: with `design = \"csv\"` keys are columns of the file; make "
            "`contact.friction` one of them");
}

TEST_F(Tables, MayHaveManyRows) {
  write("my.toml", gel);
  std::string table = "tissue.young_modulus [kPa],tissue.material,tissue.viscosity\n";
  for (int i = 1; i <= 3000; ++i)
    table += std::to_string(i) + (i == 2345 ? ",my.toml#gel" : ",skin") + ",none\n";
  write("cases.csv", table);
  const Family family = outline_text(small_press + sweep, scenario(), {});
  EXPECT_EQ(family.design.count(), 3000U);
  EXPECT_EQ(make_case(family, 2999).scenario.tissue.young_modulus, 3e6);
  // The one row that names a file is found, so that the file is among the inputs.
  ASSERT_EQ(family.inputs.size(), 3U);
  EXPECT_EQ(family.inputs[2].name, "my.toml");
}

}  // namespace
}  // namespace palpate::scenario
