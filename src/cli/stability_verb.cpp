// `palpate stability`.
#include <stdexcept>

#include "cli/verbs.h"

namespace palpate::cli {

int stability(const Stability&, const Arguments&, const Talk&) { throw std::logic_error("not built"); }

}  // namespace palpate::cli
