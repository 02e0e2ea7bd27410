// Forces over time, without a model.
#include "record/measured_table.h"

#include <cmath>

namespace palpate::record {

Table measured_force_table(const std::vector<CaseRecord>& records) {
  Table table;
  table.columns = {"case", "step", "time_s", "force_N"};
  for (const CaseRecord& record : records)
    for (std::size_t i = 0; i < record.contact.size(); ++i) {
      const double force = record.measured[i].force;
      table.rows.push_back({record.name, static_cast<double>(record.contact[i].step),
                            record.contact[i].time, std::isfinite(force) ? Cell(force) : Cell()});
    }
  return table;
}

}  // namespace palpate::record
