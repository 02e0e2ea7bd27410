// The table of discs, domes and inclusions in docs/accuracy.md.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace palpate {

// Prints the rows (name and cells) of one block or body. Those with equal cells are one row with
// the names of all. `lead` are the cells before the names; the following rows have `empty` there.
void print_rows(const std::string& lead, const std::string& empty,
                const std::vector<std::pair<std::string, std::string>>& rows);

// Prints the table to stdout; takes minutes.
void bodies_table();

}  // namespace palpate
