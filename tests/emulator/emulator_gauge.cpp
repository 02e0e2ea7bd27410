// The gauge and its command language, with the guide's own examples.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "emulator/gauge.h"

namespace emulator {
namespace {

Gauge silent(double resolution = 2e-3) {
  return make_gauge({.capacity = 100.0, .resolution = resolution, .noise = 0.0, .filter = 0}, 1);
}

void load(Gauge& gauge, double force) {
  for (int i = 0; i < 1024; ++i) sample(gauge, force);
}

std::size_t unit(std::string_view symbol) {
  for (std::size_t i = 0; i < force_units.size(); ++i)
    if (force_units[i].symbol == symbol) return i;
  return force_units.size();
}

// Series 4 guide p. 16: `-18.78 lbF<CR><LF>` is 18.78 lbF of tension, `4.285 N<CR><LF>` 4.285 N of
// compression.
TEST(EmulatorGauge, WritesReadingsAsTheGuideDoes) {
  Gcl2 language;
  Gauge coarse = silent(0.02 * 4.4482216152605);
  coarse.unit = unit("lbF");
  load(coarse, -18.78 * 4.4482216152605);
  EXPECT_EQ(obey(language, coarse, "?"), "-18.78 lbF\r\n");
  Gauge fine = silent(5e-3);
  load(fine, 4.285);
  EXPECT_EQ(obey(language, fine, "?"), "4.285 N\r\n");
  EXPECT_EQ(obey(language, fine, "?C"), "4.285 N\r\n");
}

// Series 5 guide p. 19: V1.00;LBF;CUR;FLTC8;FLTP1;AOUT00;AOFF5;FULL;MIT;POL;B0
TEST(EmulatorGauge, ListsItsSettingsAsTheGuideDoes) {
  Gcl2 language{.list = ListStyle::pol};
  Gauge gauge = silent();
  EXPECT_EQ(obey(language, gauge, "LB"), "");
  EXPECT_EQ(obey(language, gauge, "FLTC8"), "");
  EXPECT_EQ(obey(language, gauge, "FLTP1"), "");
  EXPECT_EQ(obey(language, gauge, "LIST"),
            "V1.00;LBF;CUR;FLTC8;FLTP1;AOUT00;AOFF5;FULL;MIT;POL;B0\r\n");
}

// The record that a driver of this stand and gauge reads (LabKit, decodeSettings).
TEST(EmulatorGauge, ListsPolarityWhereItCanBeSet) {
  Gcl2 language;
  Gauge gauge = silent();
  EXPECT_EQ(obey(language, gauge, "FLTC3"), "");
  EXPECT_EQ(obey(language, gauge, "LIST"),
            "V1.00;N;CUR;FLTC3;FLTP1;AOUT0;AOFF5;FULL;IPOL0;OPOL0;B0\r\n");
  load(gauge, 2.0);
  EXPECT_EQ(obey(language, gauge, "IPOL1"), "");
  EXPECT_EQ(obey(language, gauge, "PC"), "");
  EXPECT_EQ(obey(language, gauge, "LIST"),
            "V1.00;N;PC;FLTC3;FLTP1;AOUT0;AOFF5;FULL;IPOL1;OPOL0;B0\r\n");
  EXPECT_EQ(obey(language, gauge, "?C"), "-2.000 N\r\n");
  EXPECT_EQ(obey(language, gauge, "OPOL1"), "");
  EXPECT_EQ(obey(language, gauge, "?C"), "2.000 N\r\n");
  EXPECT_EQ(obey(language, gauge, "NUM"), "");
  EXPECT_EQ(obey(language, gauge, "?C"), "2.000\r\n");
}

// Series 5 guide p. 19: *10 illegal command, *11 not applicable, *12 invalid specifier, *22 too
// large.
TEST(EmulatorGauge, RefusesWithTheGuidesCodes) {
  Gcl2 language;
  Gauge gauge = silent();
  for (const char* illegal : {"FOO", "?X", "n", "cur", "LISTX", "FLT"})
    EXPECT_EQ(obey(language, gauge, illegal), "*10\r\n") << illegal;
  for (const char* not_applicable : {"?ET", "?A", "KN", "MN"})  // units a 100 N gauge lacks
    EXPECT_EQ(obey(language, gauge, not_applicable), "*11\r\n") << not_applicable;
  for (const char* bad : {"FLTC", "FLTCx", "FLTC1.5", "FLTC-1", "AOUT3", "IPOLa"})
    EXPECT_EQ(obey(language, gauge, bad), "*12\r\n") << bad;
  for (const char* large : {"FLTC11", "AOUT251", "AOFF31", "FLTP99999999999"})
    EXPECT_EQ(obey(language, gauge, large), "*22\r\n") << large;
  EXPECT_EQ(obey(language, gauge, ""), "");
}

TEST(EmulatorGauge, ShowsEveryUnitInItsOwnSteps) {
  Gauge gauge = make_gauge({.noise = 0.0, .filter = 0}, 1);  // 10 N, steps of 0.002 N
  load(gauge, 5.0);
  const struct {
    const char* symbol;
    double step;
    const char* text;
  } rows[] = {{"N", 0.002, "5.000 N"},       {"mN", 2.0, "5000 mN"},
              {"lbF", 0.0005, "1.1240 lbF"},  // 1.12404
              {"ozF", 0.01, "17.98 ozF"},     // 17.9847
              {"kgF", 0.0002, "0.5098 kgF"},  // 0.50986, the nearest even 1e-4
              {"gF", 0.2, "509.8 gF"}};
  for (const auto& row : rows) {
    gauge.unit = unit(row.symbol);
    EXPECT_NEAR(display_step(gauge, gauge.unit), row.step, 1e-9 * row.step) << row.symbol;
    EXPECT_EQ(shown(gauge, Reading::current), row.text);
  }
  load(gauge, -1e-6);
  EXPECT_EQ(shown(gauge, Reading::current), "0.0 gF") << "no minus before nothing";
}

TEST(EmulatorGauge, AveragesSoThatARampComesLate) {
  Gauge gauge = silent();
  gauge.filter = 8;
  for (int i = 0; i < 4000; ++i) sample(gauge, 1e-3 * i);
  // A mean of n samples shows what was (n - 1) / 2 samples ago; a count is 2 mN / 64.
  EXPECT_NEAR(value_of(gauge, Reading::current), 1e-3 * (3999 - 255 / 2.0), 2e-3 / 64.0);
}

TEST(EmulatorGauge, MakesTheNoiseItWasTold) {
  Gauge gauge = make_gauge({.noise = 0.05, .filter = 0}, 7);
  double sum = 0.0;
  double squares = 0.0;
  const int samples = 20000;
  for (int i = 0; i < samples; ++i) {
    sample(gauge, 1.0);
    const double value = value_of(gauge, Reading::current) - 1.0;
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / samples, 0.0, 5.0 * 0.05 / std::sqrt(samples));  // five standard errors
  EXPECT_NEAR(std::sqrt(squares / samples), 0.05, 0.05 * 5.0 / std::sqrt(2.0 * samples));
  Gauge other = make_gauge({.noise = 0.05, .filter = 0}, 8);
  sample(other, 1.0);
  Gauge again = make_gauge({.noise = 0.05, .filter = 0}, 8);
  sample(again, 1.0);
  EXPECT_EQ(value_of(other, Reading::current), value_of(again, Reading::current));
}

TEST(EmulatorGauge, ZeroesKeepsPeaksAndOverloads) {
  Gcl2 language;
  Gauge gauge = silent();
  load(gauge, 1.0);
  EXPECT_EQ(obey(language, gauge, "Z"), "");
  EXPECT_EQ(obey(language, gauge, "?"), "0.000 N\r\n");
  load(gauge, 4.0);
  load(gauge, -1.0);
  EXPECT_EQ(obey(language, gauge, "?PC"), "3.000 N\r\n");
  EXPECT_EQ(obey(language, gauge, "?PT"), "-2.000 N\r\n");
  EXPECT_EQ(obey(language, gauge, "CLR"), "");
  EXPECT_EQ(obey(language, gauge, "?PC"), "0.000 N\r\n");
  load(gauge, 111.0);  // above 110 % of 100 N, though zeroed below it
  EXPECT_EQ(obey(language, gauge, "?"), "OVERLOAD\r\n");
  language.overload = OverloadReply::saturated;
  EXPECT_EQ(obey(language, gauge, "?"), "110.000 N\r\n");
}

}  // namespace
}  // namespace emulator
