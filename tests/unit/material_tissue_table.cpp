// The built-in tissues are the paper's Table 1, each value with its source.
#include <gtest/gtest.h>

#include "material/tissue_table.h"
#include "temporary_folder.h"

namespace palpate::material {
namespace {

TEST(TissueTable, HasTheSixRowsOfThePaper) {
  const struct {
    const char* name;
    double density, young_modulus, poisson_ratio;
  } rows[] = {{"finger", 1370, 2050e3, 0.5},    {"skin", 1100, 72.4e3, 0.33},
              {"muscle", 1041, 6e3, 0.4},       {"bone", 1990, 1.7e10, 0.3},
              {"ligament", 1110, 33.1e3, 0.45}, {"upper_leg", 1020, 0.8e3, 0.3}};
  for (const auto& row : rows) {
    const Found found = find(row.name, "", {});
    EXPECT_EQ(found.tissue.density.value, row.density) << row.name;
    EXPECT_EQ(found.tissue.young_modulus.value, row.young_modulus) << row.name;
    EXPECT_EQ(found.tissue.poisson_ratio.value, row.poisson_ratio) << row.name;
    EXPECT_FALSE(found.tissue.title.empty()) << row.name;
    EXPECT_TRUE(found.file_text.empty()) << row.name;
  }
}

TEST(TissueTable, EveryValueHasASource) {
  for (const char* name : {"finger", "skin", "muscle", "bone", "ligament", "upper_leg"}) {
    const Tissue tissue = find(name, "", {}).tissue;
    for (const Sourced* value : {&tissue.density, &tissue.young_modulus, &tissue.poisson_ratio})
      EXPECT_FALSE(value->source.empty()) << name;
    if (std::string(name) == "finger") continue;  // elastic: it enters eq. (2) only
    for (const auto* value : {&tissue.retardation_time, &tissue.relaxation_time,
                              &tissue.instantaneous_ratio, &tissue.drag}) {
      ASSERT_TRUE(value->has_value()) << name;
      EXPECT_FALSE((*value)->source.empty()) << name;
      EXPECT_GT((*value)->value, 0.0) << name;
    }
  }
}

TEST(TissueTable, AnUnknownNameSuggestsTheNearest) {
  try {
    (void)find("musle", "", {"press.toml", 5, 12});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "press.toml:5:12: `material` does not know `musle`; did you mean `muscle`? Known here: "
        "finger, skin, muscle, bone, ligament, upper_leg; your own tables are written "
        "`file.toml#name`");
  }
}

// A table has none of its own.
TEST(TissueTable, SaysWhereASourceGoes) {
  const test::TemporaryFolder folder;
  test::write_file(folder.path() / "mine.toml",
                   "[gel]\nsource = \"us\"\ndensity = \"1000 kg/m^3\"\nyoung_modulus = \"5 kPa\"\n"
                   "poisson_ratio = 0.45\n");
  try {
    (void)find("mine.toml#gel", folder.path().string(), {"press.toml", 5, 12});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("mine.toml:2:1: `source` belongs to a value: `young_modulus = { value = "
                        "\"5 kPa\", source = \"...\" }`"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace palpate::material
