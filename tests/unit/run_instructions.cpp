// Instructions that steps and frames take, counted by valgrind: numbers that repeat, unlike times.
// Their ratios to the plain step are kept in tests/bench/instructions.csv.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace palpate {
namespace {

// What a command prints on both its streams.
std::string printed(const std::string& command) {
  std::string text;
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return text;
  std::array<char, 4096> part;
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) text += part.data();
  ::pclose(pipe);
  return text;
}

// Of one call; set-up and warming are not counted.
double per_call(const std::string& kernel) {
  constexpr int times = 20;
  const std::string text = printed(
      "valgrind --tool=callgrind --instr-atstart=no "
      "--callgrind-out-file=/dev/null " PALPATE_INSTRUCTIONS " " +
      kernel + " " + std::to_string(times));
  const std::string key = "Collected : ";
  const auto at = text.rfind(key);  // modes are found in a child, which says how many it has before
  EXPECT_NE(at, std::string::npos) << text;
  return at == std::string::npos ? 0.0 : std::stod(text.substr(at + key.size())) / times;
}

std::map<std::string, double> kept() {
  std::ifstream file(PALPATE_SOURCE_DIR "/tests/bench/instructions.csv");
  std::map<std::string, double> ratios;
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "kernel,over_plain_linear_step");
  while (std::getline(file, line)) {
    const auto comma = line.find(',');
    ratios[line.substr(0, comma)] = std::stod(line.substr(comma + 1));
  }
  return ratios;
}

TEST(Instructions, ratios_to_the_plain_step_are_what_they_were) {
  std::istringstream names(printed(PALPATE_INSTRUCTIONS));
  const double plain = per_call("step_linear_plain");
  ASSERT_GT(plain, 1000.0);
  EXPECT_NEAR(per_call("step_linear_plain"), plain, 1e-3 * plain);  // counted, not timed
  const std::map<std::string, double> ratios = kept();
  std::size_t count = 0;
  for (std::string name; std::getline(names, name); ++count) {
    const double ratio = per_call(name) / plain;
    std::printf("%s,%.4f\n", name.c_str(), ratio);
    ASSERT_TRUE(ratios.contains(name)) << name;
    // Room for the machine: valgrind offers AVX2 or not, and patches of a frame depend on rounding.
    EXPECT_LT(ratio, 1.3 * ratios.at(name)) << name << " has become slower";
    EXPECT_GT(ratio, 0.6 * ratios.at(name)) << name << " has become faster: renew the table";
  }
  EXPECT_EQ(count, ratios.size());
}

}  // namespace
}  // namespace palpate
