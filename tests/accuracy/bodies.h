// The table of discs, domes and inclusions in docs/accuracy.md.
#pragma once

namespace palpate {

// Prints the table to stdout; takes minutes.
void bodies_table();

}  // namespace palpate
