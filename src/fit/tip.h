// Closed laws of rigid tips on an elastic half-space.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palpate::fit {

// A rigid axisymmetric or pyramidal tip. Lengths in m, angles in rad.
struct Tip {
  enum class Kind { paraboloid, sphere, cone, pyramid_3, pyramid_4, flat_punch };

  Kind kind = Kind::paraboloid;
  double radius = 0.0;      // m; of curvature, or of the flat end of a punch
  double half_angle = 0.0;  // rad; between the axis and a face or the side of a cone

  [[nodiscard]] bool has_angle() const {
    return kind == Kind::cone || kind == Kind::pyramid_3 || kind == Kind::pyramid_4;
  }
};

// Force for E* = E / (1 - nu^2) = 1 Pa, in N, and its derivative, N/m; both are 0 for h <= 0.
struct TipForce {
  double force, stiffness;
};

// With a the contact radius and E* = 1 Pa:                    docs/theory.md [tips], [tip_sphere]
//   paraboloid  F = 4/3 sqrt(R) h^(3/2)                               Hertz 1881; Sneddon 1965
//   sphere      F = (a^2 + R^2) artanh(a/R) - a R, h = a artanh(a/R)              Sneddon 1965
//   cone        F = 2/pi tan(alpha) h^2                                           Sneddon 1965
//   pyramid_3   F = 0.8887 tan(alpha) h^2                                        Bilodeau 1992
//   pyramid_4   F = 0.7453 tan(alpha) h^2                                        Bilodeau 1992
//   flat_punch  F = 2 R h                                                         Sneddon 1965
[[nodiscard]] TipForce tip_force(const Tip& tip, double depth);

// Hertz's paraboloid against the exact law of a sphere at the same depth, minus 1.
[[nodiscard]] double error_of_hertz(double depth, double radius);

// The words of `--tip`: paraboloid, sphere, cone, pyramid3, pyramid4, punch.
[[nodiscard]] std::string_view word(Tip::Kind kind);
[[nodiscard]] std::optional<Tip::Kind> find_tip(std::string_view word);

// The law as text, with its source: `F = 4/3 E/(1-nu^2) sqrt(R) (h-h_0)^(3/2), Hertz 1881`.
[[nodiscard]] std::string law_text(Tip::Kind kind);

}  // namespace palpate::fit
