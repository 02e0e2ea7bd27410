// An upright cylinder, such as a biopsy punch takes, against truths that know no disc.
#include <gtest/gtest.h>

#include <cmath>

#include "program.h"
#include "record/csv.h"

namespace palpate::test {
namespace {

class ADiscOfTissue : public testing::Test {
 protected:
  // The last value of a column.
  double last(const std::string& name, const std::string& scenario, const std::string& file,
              const std::string& column) {
    write_file(folder_ / (name + ".toml"), scenario);
    const Ended ended = palpate(folder_.path(), {"run", name + ".toml", "--force"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    if (ended.code != 0) return NAN;
    const record::Table table = record::read_csv(folder_ / "out" / name / file);
    return std::get<double>(table.rows.back()[static_cast<std::size_t>(table.find(column))]);
  }

  TemporaryFolder folder_;
};

// Between slippery platens the strain is even: stress = E strain, whatever the radius.
TEST_F(ADiscOfTissue, yields_as_hooke_says_between_slippery_platens) {
  const double stress =
      last("squeezed",
           "[tissue]\nyoung_modulus = \"20 kPa\"\nbase = \"frictionless\"\nviscosity = \"none\"\n"
           "shape = { kind = \"disc\", radius = \"6 mm\", height = \"5 mm\" }\n"
           "[solver]\nmodel = \"coupled_springs\"\nintegrator = \"quasi_static\"\n"
           "[[step]]\nkind = \"compress\"\nstrain = 0.02\nrate = \"0.1 1/s\"\n",
           "strain_time.csv", "stress_kPa");
  // Its end is a polygon of about 30 corners, with 0.7 % less than the circle's area; sections
  // between two rings of points are rounder. Measured 0.2 %.
  EXPECT_NEAR(stress, 20.0 * 0.02, 0.007 * 20.0 * 0.02);
}

// An axisymmetric program of finite elements with large strains gives the force on it:
// disc30-10-nu0.45 of tests/cases/bodies.csv, mN.
TEST_F(ADiscOfTissue, has_the_force_of_an_axisymmetric_program) {
  for (const auto& [travel, force] :
       {std::pair{"0.5 mm", 186.498}, {"1 mm", 604.155}, {"2 mm", 2081.78}}) {
    const std::string scenario =
        "[tissue]\nyoung_modulus = \"72.4 kPa\"\npoisson_ratio = 0.45\n"
        "shape = { kind = \"disc\", radius = \"30 mm\", height = \"10 mm\" }\n"
        "[finger]\nmaterial = \"rigid\"\nradius = \"11 mm\"\n[[step]]\nkind = \"indent\"\nto = \"" +
        std::string(travel) + "\"\n[output]\nfigures = false\n";
    const std::string name = "disc" + std::string(1, travel[0]);
    const double found = 1e3 * last(name, scenario, "force_indentation.csv", "force_N");
    const double stated = last(name, scenario, "findings.csv", "stated_error");
    EXPECT_NEAR(found, force, stated * force) << travel;
    EXPECT_LT(stated, 0.05) << travel;
  }
}

}  // namespace
}  // namespace palpate::test
