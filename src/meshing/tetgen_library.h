// Calls TetGen; for use in the child process only.
#pragma once

#include <string>

#include "meshing/tetgen.h"

namespace palpate::meshing::tetgen_library {

// TetGen's exit codes according to its manual and source.
enum ExitCode {
  memory = 1,
  internal = 2,
  self_intersection = 3,
  tiny_feature = 4,
  close_facets = 5,
  input = 10
};

// Runs TetGen in this process, prints to stdout, and ends the process with an ExitCode if TetGen
// fails: for a child process that exists only for this. All tetrahedra are positive.
[[nodiscard]] geometry::TetMesh run(const geometry::Surface& surface, const std::string& switches);

// The same of pieces.
[[nodiscard]] PieceMesh run(const Pieces& pieces, const std::function<double(const Vec3&)>& size,
                            const std::string& switches);

// Keeps palpate's terminatetetgen() in the program: call it before run().
void install_exit();

}  // namespace palpate::meshing::tetgen_library
