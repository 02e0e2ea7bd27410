// The elementary functions of the program: as right as is said, and the same bits everywhere.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <ostream>
#include <random>

namespace palpate::test {
namespace {

// The C library's function of the same name in the wider format, whose 64 bits leave an error of
// 0.0005 ulp of the narrower one.
struct Function {
  const char* name;
  double (*ours)(double);
  long double (*wide)(long double);
  double low, high;  // of the argument, or of its logarithm to base 2
  bool logarithmic;
  std::uint64_t bits;  // a hash of the results for a thousand arguments
};
std::ostream& operator<<(std::ostream& out, const Function& function) {
  return out << function.name;
}

double argument(const Function& function, std::minstd_rand& random) {
  const double share = static_cast<double>(random()) / static_cast<double>(random.max());
  const double x = function.low + share * (function.high - function.low);
  if (!function.logarithmic) return x;
  const double whole = std::floor(x);
  return std::ldexp(1.0 + (x - whole), static_cast<int>(whole));
}

// How many numbers lie between two of the same sign.
std::int64_t distance(double a, double b) {
  return std::abs(std::bit_cast<std::int64_t>(a) - std::bit_cast<std::int64_t>(b));
}

class Mathematics : public testing::TestWithParam<Function> {};

// 1 ulp from the true value, and so at most 1 from the nearest number.
TEST_P(Mathematics, is_within_one_ulp) {
  std::minstd_rand random(1);
  for (int i = 0; i < 10000; ++i) {
    const double x = argument(GetParam(), random);
    const auto want = static_cast<double>(GetParam().wide(static_cast<long double>(x)));
    const double got = GetParam().ours(x);
    ASSERT_EQ(std::signbit(got), std::signbit(want)) << x;
    ASSERT_LE(distance(got, want), 1) << x;
  }
}

// FNV-1a over the bytes of the results.
TEST_P(Mathematics, has_the_same_bits_everywhere) {
  std::minstd_rand random(1);
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (int i = 0; i < 1000; ++i) {
    auto bits = std::bit_cast<std::uint64_t>(GetParam().ours(argument(GetParam(), random)));
    for (int byte = 0; byte < 8; ++byte, bits >>= 8U)
      hash = (hash ^ (bits & 0xffU)) * 0x100000001b3U;
  }
  EXPECT_EQ(hash, GetParam().bits) << std::hex << "0x" << hash;
}

constexpr auto all = std::to_array<Function>({
    {"exp", std::exp, std::exp, -700, 700, false, 0x49e2423064025a33U},
    {"exp2", std::exp2, std::exp2, -1000, 1000, false, 0xa8e0199c45e21eaaU},
    {"expm1", std::expm1, std::expm1, -60, 0, true, 0x2e6e5aafef417855U},
    {"log", std::log, std::log, -1000, 1000, true, 0x99adbce385092279U},
    {"log_near_1", std::log, std::log, 0.9, 1.1, false, 0x68bf9c9ea797ba76U},
    {"log2", std::log2, std::log2, -1000, 1000, true, 0x6135674b03a127bdU},
    {"log10", std::log10, std::log10, -1000, 1000, true, 0xff6b559970b7b5d5U},
    {"log1p", std::log1p, std::log1p, -60, 3, true, 0xca3e2c49c2656c7cU},
    {"cbrt", std::cbrt, std::cbrt, -1000, 1000, true, 0x39068dad9fcd9738U},
    {"sin", std::sin, std::sin, -100, 100, false, 0xb17a41d8bc3e79d0U},
    {"cos", std::cos, std::cos, -100, 100, false, 0x983126840927afa7U},
    {"tan", std::tan, std::tan, -100, 100, false, 0xa86758993459a299U},
    {"asin", std::asin, std::asin, -1, 1, false, 0xb254a8d8a2b12e08U},
    {"acos", std::acos, std::acos, -1, 1, false, 0xcff3a3eec7e7a564U},
    {"atan", std::atan, std::atan, -100, 100, false, 0xb7bcbe5f52868525U},
    {"sinh", std::sinh, std::sinh, -10, 10, false, 0x3f16244d270557dcU},
    {"cosh", std::cosh, std::cosh, -10, 10, false, 0x26879790311a3b21U},
    {"tanh", std::tanh, std::tanh, -60, 3, true, 0xf5ec0a85a704459cU},
    {"asinh", std::asinh, std::asinh, -60, 10, true, 0x5f35b212dd248ffbU},
    {"acosh", std::acosh, std::acosh, 1, 100, false, 0xcaec0074f2fb6766U},
    {"atanh", std::atanh, std::atanh, -60, -1, true, 0xcf131b8677ba6915U},
    {"erf", std::erf, std::erf, -5, 5, false, 0x6ab4319a7bca1828U},
    {"lgamma", std::lgamma, std::lgamma, 3, 100, false, 0x1a0b47b08449b85aU},
    {"tgamma", std::tgamma, std::tgamma, 0.1, 50, false, 0x9d72f024139aa6f7U},
    {"pow_1.5", [](double x) { return std::pow(x, 1.5); },
     [](long double x) { return std::pow(x, 1.5L); }, -600, 600, true, 0x7c095a2f9515af03U},
    {"pow_of_10", [](double x) { return std::pow(10.0, x); },
     [](long double x) { return std::pow(10.0L, x); }, -300, 300, false, 0x1c6ec589ae5ca83fU},
    {"atan2", [](double x) { return std::atan2(x, 2.0); },
     [](long double x) { return std::atan2(x, 2.0L); }, -30, 30, false, 0x640a7a3a4dbfa6e0U},
    {"hypot", [](double x) { return std::hypot(x, 2.0); },
     [](long double x) { return std::hypot(x, 2.0L); }, -30, 30, false, 0xacd31bd815d775beU},
});
INSTANTIATE_TEST_SUITE_P(of, Mathematics, testing::ValuesIn(all), [](const auto& info) {
  std::string name = info.param.name;
  for (char& letter : name)
    if (letter == '.') letter = '_';
  return name;
});

TEST(MathematicsAt, the_ends_of_what_is_defined) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  volatile double zero = 0.0;  // volatile: computed by the program, not by the compiler
  volatile double one = 1.0;
  volatile double minus = -1.0;
  EXPECT_EQ(std::exp(zero), 1.0);
  EXPECT_EQ(std::log(one), 0.0);
  EXPECT_EQ(std::log(zero), -infinity);
  EXPECT_TRUE(std::isnan(std::log(minus)));
  EXPECT_EQ(std::exp(one * 1000.0), infinity);
  EXPECT_EQ(std::exp(minus * 1000.0), 0.0);
  EXPECT_EQ(std::pow(zero, 0.5), 0.0);
  EXPECT_EQ(std::pow(minus * 2.0, 3.0), -8.0);
  EXPECT_TRUE(std::isnan(std::pow(minus, 0.5)));
  EXPECT_EQ(std::cbrt(one * 27.0), 3.0);
  EXPECT_EQ(std::hypot(one * 3.0, 4.0), 5.0);
  EXPECT_EQ(std::cos(zero), 1.0);
  EXPECT_EQ(std::expm1(zero), 0.0);
  EXPECT_TRUE(std::isnan(std::exp(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace palpate::test
