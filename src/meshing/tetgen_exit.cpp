// Replaces TetGen's exit on errors: the child process ends with TetGen's code.
//
// TetGen 1.5 frees its mesh, throws the code, and frees the mesh again on the way out, which
// crashes and loses the code. Its terminatetetgen() is a weak symbol and is replaced by this one,
// which cannot be in a file that includes tetgen.h, because that defines it inline.
#include <unistd.h>

#include "meshing/tetgen_library.h"

class tetgenmesh;

void terminatetetgen(tetgenmesh*, int code);  // NOLINT: TetGen's name

void terminatetetgen(tetgenmesh*, int code) { _exit(code); }

namespace palpate::meshing::tetgen_library {

void install_exit() {}

}  // namespace palpate::meshing::tetgen_library
