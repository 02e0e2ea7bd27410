// How TetGen gives up: by ending the child process with its code.
//
// TetGen 1.5 frees its mesh, throws the code, and frees the mesh again on the way out, which
// crashes and loses the code. Its terminatetetgen() is a weak symbol, so this one takes its place;
// it cannot stand where tetgen.h is included, which defines it inline.
#include <unistd.h>

#include "geometry/tetgen_library.h"

class tetgenmesh;

void terminatetetgen(tetgenmesh*, int code);  // NOLINT: TetGen's name

void terminatetetgen(tetgenmesh*, int code) { _exit(code); }

namespace palpate::geometry::tetgen_library {

void install_exit() {}

}  // namespace palpate::geometry::tetgen_library
