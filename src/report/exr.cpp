// Writes EXR images. This is the only file that includes OpenEXR.
#include "report/exr.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>
#include <OpenEXRConfig.h>

#include <array>
#include <cassert>
#include <cstdint>
#include <exception>
#include <vector>

#include "base/error.h"
#include "base/units.h"

namespace palpate::report {
namespace {

// A channel and the part of a map that it contains.
struct Shown {
  const char* channel;
  const std::vector<float> record::PressureMap::*values;
  const Unit& unit;
};
using record::PressureMap;
constexpr std::array<Shown, 5> channels{{{"pressure.Z", &PressureMap::pressure, unit::kPa},
                                         {"traction.X", &PressureMap::traction_x, unit::kPa},
                                         {"traction.Y", &PressureMap::traction_y, unit::kPa},
                                         {"traction.Z", &PressureMap::traction_z, unit::kPa},
                                         {"gap.Z", &PressureMap::gap, unit::mm}}};

// A file in memory.
class Memory final : public Imf::OStream {
 public:
  Memory() : OStream("memory") {}

  void write(const char bytes[], int count) override {
    const std::size_t end = at_ + as_index(count);
    if (end > content_.size()) content_.resize(end);
    content_.replace(at_, as_index(count), bytes, as_index(count));
    at_ = end;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = position; }

  [[nodiscard]] const std::string& content() const { return content_; }

 private:
  std::string content_;
  std::size_t at_ = 0;
};

Imf::Header header(const record::PressureMap& map,
                   const std::map<std::string, std::string>& more_attributes) {
  const auto mm = [](double metres) { return unit::mm.from_si(metres); };
  Imf::Header header(map.width, map.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const Shown& shown : channels) {
    const std::string channel = shown.channel;
    header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    header.insert("palpate:unit:" + channel.substr(0, channel.find('.')),
                  Imf::StringAttribute(shown.unit.symbol));
  }
  header.insert("palpate:pixelPitch_mm", Imf::DoubleAttribute(mm(map.pitch)));
  header.insert(
      "palpate:origin_mm",
      Imf::V3dAttribute(Imath::V3d(mm(map.origin.x()), mm(map.origin.y()), mm(map.origin.z()))));
  header.insert("palpate:time_s", Imf::DoubleAttribute(map.time));
  header.insert("palpate:contactForce_N", Imf::DoubleAttribute(map.contact_force));
  header.insert("palpate:case", Imf::StringAttribute(map.scenario_case));
  header.insert("palpate:step", Imf::IntAttribute(map.step));
  for (const auto& [name, text] : more_attributes) header.insert(name, Imf::StringAttribute(text));
  return header;
}

}  // namespace

std::string exr_bytes(const record::PressureMap& map,
                      const std::map<std::string, std::string>& more_attributes) {
  const auto width = as_index(map.width);
  assert(map.width > 0 && map.height > 0);
  std::array<std::vector<float>, channels.size()> pixels;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    assert((map.*channels[i].values).size() == width * as_index(map.height));
    for (const float value : map.*channels[i].values)
      pixels[i].push_back(static_cast<float>(channels[i].unit.from_si(static_cast<double>(value))));
  }
  try {
    Memory memory;
    {
      constexpr int no_threads = 0;
      Imf::OutputFile file(memory, header(map, more_attributes), no_threads);
      Imf::FrameBuffer frame;
      for (std::size_t i = 0; i < channels.size(); ++i)
        frame.insert(channels[i].channel,
                     Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels[i].data()),
                                sizeof(float), sizeof(float) * width));
      file.setFrameBuffer(frame);
      file.writePixels(map.height);
    }  // the destructor of the file completes its tables
    return memory.content();
  } catch (const std::exception& error) {
    throw SystemError(std::string("the pressure map cannot be written as EXR: ") + error.what());
  }
}

std::string exr_version() { return OPENEXR_VERSION_STRING; }

}  // namespace palpate::report
