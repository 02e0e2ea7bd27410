// Lookup of a column by name.
#include "record/table.h"

namespace palpate::record {

int Table::find(std::string_view column) const {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] == column) return static_cast<int>(i);
  return -1;
}

}  // namespace palpate::record
