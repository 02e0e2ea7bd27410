// A pressure map as an image, read back and integrated.
#include "report/exr.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/files.h"

namespace palpate::report {
namespace {

// A Hertz pressure p0 sqrt(1 - r^2/a^2), whose integral is 2/3 pi a^2 p0, on pixels of 0.1 mm;
// one row more than columns, and off the centre, so that no mirror image passes.
record::PressureMap hertz_map() {
  record::PressureMap map;
  map.width = 81;
  map.height = 82;
  map.pitch = 1e-4;
  map.origin = {-4e-3, -3e-3, 2e-2};
  map.time = 0.25;
  map.scenario_case = "skin";
  map.step = 1;
  const double a = 3e-3, p0 = 2e4;
  for (int j = 0; j < map.height; ++j)
    for (int i = 0; i < map.width; ++i) {
      const double x = map.origin.x() + i * map.pitch, y = map.origin.y() + j * map.pitch - 1e-3;
      const double outside = (x * x + y * y) / (a * a) - 1.0;
      const double pressure = p0 * std::sqrt(std::max(0.0, -outside));
      map.pressure.push_back(static_cast<float>(pressure));
      map.traction_x.push_back(static_cast<float>(0.3 * pressure));
      map.traction_y.push_back(static_cast<float>(-0.1 * pressure));
      map.traction_z.push_back(static_cast<float>(-pressure));
      map.gap.push_back(outside > 1.0 ? std::numeric_limits<float>::infinity()
                                      : static_cast<float>(1e-3 * std::max(0.0, outside)));
    }
  map.contact_force = 2.0 / 3.0 * std::numbers::pi * a * a * p0;
  return map;
}

// A channel of a file, row by row.
std::vector<float> read_channel(const std::string& path, const char* channel) {
  Imf::InputFile file(path.c_str());
  const auto window = file.header().dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
  const auto height = static_cast<std::size_t>(window.max.y - window.min.y + 1);
  std::vector<float> pixels(width * height);
  Imf::FrameBuffer frame;
  frame.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data()),
                                   sizeof(float), sizeof(float) * width));
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  return pixels;
}

class Exr : public testing::Test {
 protected:
  std::string path_ = testing::TempDir() + "palpate_exr" + std::to_string(::getpid()) + ".exr";
  void TearDown() override { std::filesystem::remove(path_); }
};

TEST_F(Exr, ReadsBackAndIntegratesToTheForce) {
  const record::PressureMap map = hertz_map();
  write_atomically(path_, exr_bytes(map, {{"palpate:scenarioSha256", "abc"}}));
  Imf::InputFile file(path_.c_str());
  const auto window = file.header().dataWindow();
  ASSERT_EQ(window.max.x - window.min.x + 1, 81);
  ASSERT_EQ(window.max.y - window.min.y + 1, 82);
  EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
  const std::vector<float> pixels = read_channel(path_, "pressure.Z");
  double force = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    // half a unit in the last place of a float, twice: Pa to kPa and back
    EXPECT_NEAR(pixels[i] * 1e3, map.pressure[i], 1.2e-7 * map.pressure[i]);
    force += static_cast<double>(pixels[i]) * 1e3 * map.pitch * map.pitch;
  }
  EXPECT_NEAR(force, record::integral(map), 1e-7 * force);  // float rounding
  EXPECT_NEAR(force, map.contact_force, 2e-3 * force);      // pixels at the rim of 30 radii
}

TEST_F(Exr, HasEveryQuantityInItsUnit) {
  const record::PressureMap map = hertz_map();
  write_atomically(path_, exr_bytes(map, {}));
  struct Wanted {
    const char* channel;
    const std::vector<float>& values;
    float per;  // SI of the channel's unit
  };
  const std::vector<Wanted> all{{"gap.Z", map.gap, 1e-3F},
                                {"pressure.Z", map.pressure, 1e3F},
                                {"traction.X", map.traction_x, 1e3F},
                                {"traction.Y", map.traction_y, 1e3F},
                                {"traction.Z", map.traction_z, 1e3F}};
  const Imf::InputFile file(path_.c_str());
  std::vector<std::string> names;
  for (auto channel = file.header().channels().begin(); channel != file.header().channels().end();
       ++channel) {
    names.emplace_back(channel.name());
    EXPECT_EQ(channel.channel().type, Imf::FLOAT) << channel.name();
  }
  ASSERT_EQ(names.size(), all.size());
  for (std::size_t c = 0; c < all.size(); ++c) {
    EXPECT_EQ(names[c], all[c].channel);
    const std::vector<float> pixels = read_channel(path_, all[c].channel);
    ASSERT_EQ(pixels.size(), all[c].values.size());
    for (std::size_t i = 0; i < pixels.size(); ++i)
      EXPECT_FLOAT_EQ(pixels[i] * all[c].per, all[c].values[i]) << all[c].channel << " " << i;
  }
  EXPECT_TRUE(std::isinf(read_channel(path_, "gap.Z").front())) << "beside the finger";
}

TEST_F(Exr, CarriesItsAttributes) {
  write_atomically(path_, exr_bytes(hertz_map(), {{"palpate:scenarioSha256", "abc"}}));
  const Imf::Header header = Imf::InputFile(path_.c_str()).header();
  const auto text = [&](const char* name) {
    return header.typedAttribute<Imf::StringAttribute>(name).value();
  };
  const auto number = [&](const char* name) {
    return header.typedAttribute<Imf::DoubleAttribute>(name).value();
  };
  EXPECT_EQ(text("palpate:unit:pressure"), "kPa");
  EXPECT_EQ(text("palpate:unit:traction"), "kPa");
  EXPECT_EQ(text("palpate:unit:gap"), "mm");
  EXPECT_EQ(text("palpate:case"), "skin");
  EXPECT_EQ(text("palpate:scenarioSha256"), "abc");
  EXPECT_DOUBLE_EQ(number("palpate:pixelPitch_mm"), 0.1);
  EXPECT_EQ(number("palpate:time_s"), 0.25);
  EXPECT_EQ(header.typedAttribute<Imf::IntAttribute>("palpate:step").value(), 1);
  const auto origin = header.typedAttribute<Imf::V3dAttribute>("palpate:origin_mm").value();
  EXPECT_DOUBLE_EQ(origin.x, -4.0);
  EXPECT_DOUBLE_EQ(origin.y, -3.0);
  EXPECT_DOUBLE_EQ(origin.z, 20.0);
}

TEST_F(Exr, SameMapSameBytes) {
  const record::PressureMap map = hertz_map();
  const std::string bytes = exr_bytes(map, {{"palpate:scenarioSha256", "abc"}});
  EXPECT_EQ(bytes, exr_bytes(map, {{"palpate:scenarioSha256", "abc"}}));
  EXPECT_NE(bytes, exr_bytes(map, {{"palpate:scenarioSha256", "abd"}}));
  write_atomically(path_, exr_bytes(map, {{"palpate:scenarioSha256", "abc"}}));
  EXPECT_EQ(read_text(path_), bytes);
}

TEST_F(Exr, KeepsWhatIsNotANumber) {
  record::PressureMap map;
  map.width = 2;
  map.height = 1;
  map.pitch = 1e-3;
  map.pressure = {std::nanf(""), 1e3F};
  map.traction_x = map.traction_y = map.traction_z = map.gap = map.pressure;
  write_atomically(path_, exr_bytes(map, {}));
  const std::vector<float> pixels = read_channel(path_, "pressure.Z");
  EXPECT_TRUE(std::isnan(pixels[0]));
  EXPECT_EQ(pixels[1], 1.0F);
}

}  // namespace
}  // namespace palpate::report
