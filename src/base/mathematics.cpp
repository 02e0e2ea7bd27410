// The elementary functions of both programs: the same bits on every processor and with every C
// library.
//
// The C library chooses its exp, log, sin ... by the processor (with fused multiply-add or
// without), so that their last bits differ between machines. These definitions stand in front of
// its own for palpate and, since the linker exports them, for every library that palpate loads
// (TetGen, METIS, Ceres, OpenEXR). They are SLEEF's deterministic functions in plain C: at most 1
// ulp from the true value (the error function's complement 1.5), about 30 to 140 ns each. Shibata
// and Petrogalli, IEEE Trans. Parallel Distrib. Syst. 31 (2020) 1316. sqrt, fmod, floor and their
// like are exact whoever computes them and stay the C library's. tests/bits/cli_processors.cpp
// reads which are called.
//
// No header declares them here: <cmath> does so for those who call them, and would give the
// compiler leave to put one in place of another.
#include <sleef.h>

#define PALPATE_OF_ONE(name, accuracy)                                         \
  double name(double x) { return Sleef_cinz_##name##d1_##accuracy##purec(x); } \
  float name##f(float x) { return Sleef_cinz_##name##f1_##accuracy##purec(x); }
#define PALPATE_OF_TWO(name, accuracy)                                                      \
  double name(double x, double y) { return Sleef_cinz_##name##d1_##accuracy##purec(x, y); } \
  float name##f(float x, float y) { return Sleef_cinz_##name##f1_##accuracy##purec(x, y); }

extern "C" {

// GCC's and Clang's complex number, which std::complex<double> is passed as.
__extension__ typedef double _Complex Complex;

PALPATE_OF_ONE(exp, u10)
PALPATE_OF_ONE(exp2, u10)
PALPATE_OF_ONE(exp10, u10)
PALPATE_OF_ONE(expm1, u10)
PALPATE_OF_ONE(log, u10)
PALPATE_OF_ONE(log2, u10)
PALPATE_OF_ONE(log10, u10)
PALPATE_OF_ONE(log1p, u10)
PALPATE_OF_ONE(cbrt, u10)
PALPATE_OF_ONE(sin, u10)
PALPATE_OF_ONE(cos, u10)
PALPATE_OF_ONE(tan, u10)
PALPATE_OF_ONE(asin, u10)
PALPATE_OF_ONE(acos, u10)
PALPATE_OF_ONE(atan, u10)
PALPATE_OF_ONE(sinh, u10)
PALPATE_OF_ONE(cosh, u10)
PALPATE_OF_ONE(tanh, u10)
PALPATE_OF_ONE(asinh, u10)
PALPATE_OF_ONE(acosh, u10)
PALPATE_OF_ONE(atanh, u10)
PALPATE_OF_ONE(erf, u10)
PALPATE_OF_ONE(erfc, u15)
PALPATE_OF_ONE(tgamma, u10)
PALPATE_OF_ONE(lgamma, u10)
PALPATE_OF_TWO(pow, u10)
PALPATE_OF_TWO(atan2, u10)
PALPATE_OF_TWO(hypot, u05)

double cabs(Complex z) {
  return Sleef_cinz_hypotd1_u05purec(__extension__ __real__ z, __extension__ __imag__ z);
}
void sincos(double x, double* sine, double* cosine) {
  *sine = Sleef_cinz_sind1_u10purec(x);
  *cosine = Sleef_cinz_cosd1_u10purec(x);
}
void sincosf(float x, float* sine, float* cosine) {
  *sine = Sleef_cinz_sinf1_u10purec(x);
  *cosine = Sleef_cinz_cosf1_u10purec(x);
}

}  // extern "C"
