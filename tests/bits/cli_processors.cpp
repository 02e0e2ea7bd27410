// The same bits on every processor: results do not depend on what the C library chooses by it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "program.h"
#include "scenario/schema.h"

namespace palpate::test {
namespace {

// Kinds of processor as the C library sees them: this one, one without fused multiply-add, and one
// of the first with 64 bits (glibc's manual, "Hardware Capability Tunables").
constexpr std::array<const char*, 3> processors{
    "", "glibc.cpu.hwcaps=-FMA,-FMA4",
    "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX,-AVX512F,-AVX512VL,-SSE4_2,-SSE4_1,-SSSE3,-ERMS"};

Ended run_on(const char* processor, const fs::path& folder, const std::string& out,
             const std::string& scenario) {
  return run_program({.arguments = {"run", scenario, "--quiet", "--out", out},
                      .folder = folder,
                      .set = {{"GLIBC_TUNABLES", processor}}});
}

// Every file of the three results but run.json, which has times of the clock, and
// contents.sha256, which has the hash of run.json.
void expect_the_same(const fs::path& folder, const std::string& result) {
  const fs::path here = folder / "0" / result;
  ASSERT_GE(names_in(here).size(), 4U);
  for (const char* kind : {"1", "2"}) {
    const fs::path other = folder / kind / result;
    ASSERT_EQ(names_in(here), names_in(other));
    for (const std::string& name : names_in(here)) {
      if (name == "run.json" || name == "contents.sha256") continue;
      EXPECT_TRUE(read_file(here / name) == read_file(other / name)) << name << " differs";
    }
  }
}

void expect_the_same_on_every_processor(const fs::path& folder, const std::string& scenario,
                                        const std::string& result) {
  for (std::size_t i = 0; i < processors.size(); ++i) {
    const Ended ended = run_on(processors[i], folder, std::to_string(i), scenario);
    ASSERT_EQ(ended.code, 0) << ended.err;
  }
  expect_the_same(folder, result);
}

std::vector<std::string> golden_scenarios() {
  std::vector<std::string> names;
  for (const std::string& name : names_in(project_file("golden")))
    if (name != "meshes") names.push_back(name);
  return names;
}

class ProcessorsGolden : public testing::TestWithParam<std::string> {};

TEST_P(ProcessorsGolden, give_the_same_bytes) {
  const TemporaryFolder folder;
  expect_the_same_on_every_processor(
      folder.path(), project_file("golden/" + GetParam() + "/scenario.toml"), "scenario");
}

INSTANTIATE_TEST_SUITE_P(of, ProcessorsGolden, testing::ValuesIn(golden_scenarios()),
                         [](const auto& info) { return info.param; });

std::vector<std::string> starter_kinds() {
  std::vector<std::string> kinds;
  for (const scenario::Starter& starter : scenario::starters())
    kinds.emplace_back(starter.word.word);
  return kinds;
}

class ProcessorsStarter : public testing::TestWithParam<std::string> {};

TEST_P(ProcessorsStarter, give_the_same_bytes) {
  const TemporaryFolder folder;
  const Ended made = palpate(folder.path(), {"new", GetParam()});
  ASSERT_EQ(made.code, 0) << made.err;
  expect_the_same_on_every_processor(folder.path(), GetParam() + ".toml", GetParam());
}

INSTANTIATE_TEST_SUITE_P(of, ProcessorsStarter, testing::ValuesIn(starter_kinds()),
                         [](const auto& info) { return info.param; });

// What a command prints, or nothing.
std::string printed(const std::string& command) {
  std::string text;
  FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  std::array<char, 4096> part{};
  while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe))
    text.append(part.data(), size);
  return ::pclose(pipe) == 0 ? text : std::string();
}

// The dynamic symbols that a file defines or asks for, without their versions.
std::set<std::string> symbols(const std::string& file, const std::string& which) {
  std::istringstream lines(printed("nm -D -P " + which + " '" + file + "'"));
  std::set<std::string> names;
  for (std::string line; std::getline(lines, line);)
    names.insert(line.substr(0, line.find_first_of("@ ")));
  return names;
}

// The files that a program loads, by their names' beginnings and paths.
std::vector<std::string> libraries_of(const std::string& program) {
  std::istringstream lines(printed("ldd '" + program + "'"));
  std::vector<std::string> paths;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t arrow = line.find("=> /");
    if (arrow != std::string::npos)
      paths.push_back(line.substr(arrow + 3, line.find(" (", arrow) - arrow - 3));
  }
  return paths;
}

// Exact by definition, or without arithmetic, so that all processors agree.
const std::set<std::string> exact{
    "ceil",         "floor",       "trunc",      "round",      "lround",        "llround",
    "rint",         "lrint",       "llrint",     "nearbyint",  "fmod",          "remainder",
    "fma",          "sqrt",        "fabs",       "copysign",   "fmin",          "fmax",
    "fdim",         "frexp",       "ldexp",      "scalbn",     "logb",          "ilogb",
    "modf",         "nan",         "nextafter",  "ceilf",      "floorf",        "roundf",
    "sqrtf",        "fmodf",       "truncf",     "rintf",      "ldexpf",        "frexpf",
    "frexpl",       "ldexpl",      "fesetround", "fegetround", "feclearexcept", "fetestexcept",
    "feholdexcept", "feupdateenv", "fesetenv",   "fegetenv"};

// Not asked: the C and C++ runtimes, of which palpate uses nothing that calls mathematics; and what
// comes with Ceres's archive without being called, since fits are solved by Eigen's dense
// decompositions (fit/ceres_fit.cpp): sparse solvers, LAPACK, BLAS and Fortran's runtime.
const std::vector<std::string> apart{"libm.so",    "libc.so",     "libstdc++.so", "libcxsparse",
                                     "libcholmod", "liblapack",   "libblas",      "libf77blas",
                                     "libatlas",   "libopenblas", "libgfortran",  "libquadmath"};

class ProcessorsProgram : public testing::TestWithParam<const char*> {};

// Neither the program nor a library that it loads takes a function of the C library's mathematics
// whose last bit may differ between processors: those are the program's own (base/mathematics.cpp).
TEST_P(ProcessorsProgram, takes_only_exact_functions_of_the_mathematics_library) {
  const std::vector<std::string> libraries = libraries_of(GetParam());
  const auto is_mathematics = [](const std::string& path) {
    return path.find("/libm.so") != std::string::npos;
  };
  const auto mathematics = std::find_if(libraries.begin(), libraries.end(), is_mathematics);
  ASSERT_NE(mathematics, libraries.end());
  const std::set<std::string> offered = symbols(*mathematics, "--defined-only");
  const std::set<std::string> own = symbols(GetParam(), "--defined-only");
  ASSERT_TRUE(offered.contains("exp") && offered.contains("floor"));
  ASSERT_TRUE(own.contains("pow")) << "METIS and Ceres would take the C library's";
  std::vector<std::string> files{GetParam()};
  for (const std::string& path : libraries) {
    const std::string name = fs::path(path).filename().string();
    const auto is_apart = [&](const std::string& start) { return name.starts_with(start); };
    if (std::none_of(apart.begin(), apart.end(), is_apart)) files.push_back(path);
  }
  for (const std::string& file : files)
    for (const std::string& name : symbols(file, "--undefined-only"))
      EXPECT_TRUE(!offered.contains(name) || exact.contains(name) || own.contains(name))
          << file << " takes `" << name << "` of the C library";
}

INSTANTIATE_TEST_SUITE_P(of, ProcessorsProgram, testing::Values(PALPATE_PROGRAM, PALPATE_EMULATOR));

}  // namespace
}  // namespace palpate::test
