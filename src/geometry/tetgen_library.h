// TetGen's own run, for the child process alone.
#pragma once

#include <string>

#include "geometry/tetgen.h"

namespace palpate::geometry::tetgen_library {

// TetGen's exit codes as its manual and source give them.
enum ExitCode {
  memory = 1,
  internal = 2,
  self_intersection = 3,
  tiny_feature = 4,
  close_facets = 5,
  input = 10
};

// Runs TetGen in this process. Prints to stdout, and ends the process with an ExitCode where
// TetGen fails: only for a child that exists for this. The tetrahedra are positive.
[[nodiscard]] TetMesh run(const Surface& surface, const std::string& switches);

// Keeps our terminatetetgen() in the program: call it before run().
void install_exit();

}  // namespace palpate::geometry::tetgen_library
