// Rows in SI to tables in the units of their column names.
#include "record/record.h"

#include "base/units.h"

namespace palpate::record {

Table contact_table(const std::vector<CaseRecord>& records) {
  Table table;
  table.columns = {"case",
                   "step",
                   "time_s",
                   "travel_mm",
                   "indentation_mm",
                   "force_N",
                   "contact_force_N",
                   "friction_N",
                   "ambient_N",
                   "contact_radius_mm",
                   "peak_pressure_kPa",
                   "tissue_radius_mm",
                   "contacts",
                   "slide_mm",
                   "tangential_N"};
  for (const CaseRecord& record : records)
    for (const ContactRow& row : record.contact)
      table.rows.push_back(
          {record.name, static_cast<double>(row.step), row.time, unit::mm.from_si(row.travel),
           unit::mm.from_si(row.indentation), row.force, row.contact_force, row.friction,
           row.ambient, unit::mm.from_si(row.contact_radius), unit::kPa.from_si(row.peak_pressure),
           unit::mm.from_si(row.tissue_radius), static_cast<double>(row.contacts),
           unit::mm.from_si(row.slide), row.tangential});
  return table;
}

Table strain_table(const std::vector<CaseRecord>& records) {
  Table table;
  table.columns = {"case", "step", "time_s", "stress_kPa", "strain"};
  for (const CaseRecord& record : records)
    for (const StrainRow& row : record.strain)
      table.rows.push_back({record.name, static_cast<double>(row.step), row.time,
                            unit::kPa.from_si(row.stress), row.strain});
  return table;
}

const char* outcome_word(Outcome outcome) {
  switch (outcome) {
    case Outcome::completed: return "completed";
    case Outcome::diverged: return "diverged";
    case Outcome::interrupted: return "interrupted";
  }
  return "";
}

}  // namespace palpate::record
