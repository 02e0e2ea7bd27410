// Springs with their present lengths and directions, a few at a time: eq. (10) of Chen 2007.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tissue/network.h"

namespace palpate::tissue {

// The loops of network.h for kinematics that are not linear, vectorised with the same bits on any
// processor. Use one copy per thread.
class SpringLoop {
 public:
  // Copies the network: about 48 bytes per spring and 64 per node.
  SpringLoop(const Network& network, Kinematics kinematics);

  // Forces (N) of independent springs without memory at a displacement (m); returns the energy that
  // they store, J.
  double elastic(const Vector& displacement, Vector& force);

  // Elongations (m), their rates (m/s) at a velocity (m/s), and the force of tensions (N).
  void elongations(const Vector& displacement, std::span<double> elongation);
  void rates(const Vector& displacement, const Vector& velocity, std::span<double> rate);
  void pull(const Vector& displacement, std::span<const double> tension, Vector& force);

  static constexpr std::size_t chunk = 4;  // springs at a time

  struct alignas(64) Node {
    double displacement[4] = {};  // m, the fourth number is 0
    double force[4] = {};         // N, the fourth number is unused
  };
  struct Springs {
    bool squared = false;
    std::size_t count = 0;               // a multiple of `chunk`
    const std::int32_t* ends = nullptr;  // 2 per spring
    const double* span = nullptr;        // m, 3 per spring, at rest
    const double* rest_length = nullptr;
    const double* stiffness = nullptr;
  };

 private:
  void place(const Vector& displacement);
  void collect(Vector& force) const;

  Springs springs_;
  std::vector<std::int32_t> ends_;
  std::vector<double> span_, rest_length_, stiffness_, values_;
  std::vector<Node> nodes_;  // and one for the springs that fill up the last chunk
};

}  // namespace palpate::tissue
