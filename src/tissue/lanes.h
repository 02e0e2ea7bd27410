// The choice of instructions for vectorised loops.
#pragma once

namespace palpate::tissue {

// Those that every processor of this architecture has, or the widest that this processor has. Both
// give the same bits.
enum class Lanes { portable, widest };

}  // namespace palpate::tissue
