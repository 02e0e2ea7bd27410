// `palpate chart`.
#include <stdexcept>

#include "cli/verbs.h"

namespace palpate::cli {

int chart(const Chart&, const Arguments&, const Talk&) { throw std::logic_error("not built"); }

}  // namespace palpate::cli
