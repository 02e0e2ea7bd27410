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
    const Ended ended = palpate(folder_.path(), {"run", name + ".toml"});
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
           "[tissue]\nyoung_modulus = \"20 kPa\"\nbase = \"frictionless\"\n"
           "shape = { kind = \"disc\", radius = \"6 mm\", height = \"5 mm\" }\n"
           "[solver]\nmodel = \"coupled_springs\"\nintegrator = \"quasi_static\"\n"
           "[[step]]\nkind = \"compress\"\nstrain = 0.02\nrate = \"0.1 1/s\"\n",
           "strain_time.csv", "stress_kPa");
  // Its end is a polygon of about 30 corners, with 0.7 % less than the circle's area; sections
  // between two rings of points are rounder. Measured 0.2 %.
  EXPECT_NEAR(stress, 20.0 * 0.02, 0.007 * 20.0 * 0.02);
}

// Far from its sides a disc is the layer whose force an integral equation gives.
TEST_F(ADiscOfTissue, is_a_layer_where_it_is_wide_and_softer_where_it_is_narrow) {
  const auto press = [](const std::string& shape, const std::string& model) {
    return "[tissue]\nyoung_modulus = \"20 kPa\"\npoisson_ratio = 0.4\nshape = { " + shape +
           " }\n[finger]\nmaterial = \"rigid\"\nradius = \"4 mm\"\n[solver]\nmodel = \"" + model +
           "\"\n[[step]]\nkind = \"indent\"\nto = \"0.2 mm\"\n[output]\nfigures = false\n";
  };
  const auto force = [&](const std::string& name, const std::string& text) {
    return last(name, text, "force_indentation.csv", "force_N");
  };
  const double layer = force(
      "layer", press("kind = \"cuboid\", size = [\"200 mm\", \"200 mm\", \"5 mm\"]", "layer"));
  const auto disc = [&](const std::string& name, const std::string& radius) {
    return force(name, press("kind = \"disc\", height = \"5 mm\", radius = \"" + radius + "\"",
                             "coupled_springs"));
  };
  EXPECT_NEAR(disc("wide", "12 mm") / layer, 1.0, 0.05);  // `solver.tolerance`
  EXPECT_LT(disc("narrow", "2 mm") / layer, 0.97);
}

}  // namespace
}  // namespace palpate::test
