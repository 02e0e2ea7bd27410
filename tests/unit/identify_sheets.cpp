// Scripts of the figures of an identification.
#include "identify/tables.h"

#include <gtest/gtest.h>

#include "identify/identify.h"

namespace palpate::identify {
namespace {

// Noise about zero needs no tick below it; a force that pulls does.
TEST(IdentifiedSheet, AxisEndsBelowZeroOnlyForWhatIsThere) {
  Identification found;
  found.x = {0.0, 1e-3, 2e-3};
  found.model = {0.0, 0.4, 1.0};
  const auto tight = [&](double least) {
    found.measured = {least, 0.4, 1.0};
    return identified_sheet("press", found, "").script.find("set autoscale yfixmin") !=
           std::string::npos;
  };
  EXPECT_FALSE(tight(0.0));
  EXPECT_TRUE(tight(-0.02));
  EXPECT_FALSE(tight(-0.2));
}

}  // namespace
}  // namespace palpate::identify
