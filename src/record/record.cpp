// Converts rows in SI units to tables in the units of the column names.
#include "record/record.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "base/units.h"

namespace palpate::record {
namespace {

void add_measured(const MeasuredRow& row, std::vector<Cell>& cells) {
  const auto& [x, y, z] = row.sent;
  cells.insert(cells.end(), {unit::mm.from_si(row.place[0]), unit::mm.from_si(row.place[1]),
                             unit::mm.from_si(0.0 - row.place[2]), known(row.force), known(x),
                             known(y), known(z), known(std::sqrt(x * x + y * y + z * z))});
}

}  // namespace

std::string Neglected::sentence() const {
  return what + ", " + when + (remedy.empty() ? "" : "; " + remedy) + ".";
}

std::string uncounted(std::span<const Neglected> effects) {
  std::string text;
  for (const Neglected& one : effects)
    if (!one.beside.empty()) text += (text.empty() ? "" : " and ") + one.beside;
  return text;
}

std::optional<double> number_of(const CaseRecord& record, std::string_view finding) {
  for (const Finding& one : record.findings)
    if (const auto* number = std::get_if<double>(&one.value);
        number != nullptr && one.name == finding)
      return *number;
  return std::nullopt;
}

std::optional<Peak> peak_of(const CaseRecord& record) {
  if (const auto force = number_of(record, "peak_force_N")) return Peak{"force", *force, " N"};
  if (record.strain.empty()) return std::nullopt;
  if (number_of(record, "elastic_strain")) {  // creep, which prescribes the stress
    const auto strain = number_of(record, "peak_strain");
    return strain ? std::optional(Peak{"strain", *strain, ""}) : std::nullopt;
  }
  double stress = 0.0;  // Pa
  for (const StrainRow& row : record.strain) stress = std::max(stress, std::abs(row.stress));
  return Peak{"stress", unit::kPa.from_si(stress), " kPa"};
}

double end_time(const CaseRecord& record) {
  if (!record.contact.empty()) return record.contact.back().time;
  return record.strain.empty() ? 0.0 : record.strain.back().time;
}

std::string reached_text(const CaseRecord& record) {
  const std::size_t rows = record.contact.size();
  if (rows < 2 && record.strain.empty()) return "";
  if (rows > 1 && record.contact[rows - 1].travel > record.contact[rows - 2].travel)
    return "up to a displacement of " +
           rounded_text(unit::mm.from_si(record.contact.back().travel), 3) + " mm";
  return "up to a time of " + rounded_text(record.last_stable_time, 3) + " s";
}

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
  const bool live =
      std::ranges::any_of(records, [](const auto& record) { return !record.measured.empty(); });
  if (live)
    for (const char* column :
         {"measured_x_mm", "measured_y_mm", "measured_travel_mm", "measured_force_N", "sent_x_N",
          "sent_y_N", "sent_z_N", "sent_force_N"})
      table.columns.emplace_back(column);
  for (const CaseRecord& record : records)
    for (std::size_t i = 0; i < record.contact.size(); ++i) {
      const ContactRow& row = record.contact[i];
      table.rows.push_back(
          {record.name, static_cast<double>(row.step), row.time, unit::mm.from_si(row.travel),
           unit::mm.from_si(row.indentation), row.force, row.contact_force, row.friction,
           row.ambient, unit::mm.from_si(row.contact_radius), unit::kPa.from_si(row.peak_pressure),
           unit::mm.from_si(row.tissue_radius), static_cast<double>(row.contacts),
           unit::mm.from_si(row.slide), row.tangential});
      if (live)
        add_measured(record.measured.empty() ? MeasuredRow{} : record.measured[i],
                     table.rows.back());
    }
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

Table measured_force_table(const std::vector<CaseRecord>& records) {
  Table table;
  table.columns = {"case", "step", "time_s", "force_N"};
  for (const CaseRecord& record : records)
    for (std::size_t i = 0; i < record.contact.size(); ++i)
      table.rows.push_back({record.name, static_cast<double>(record.contact[i].step),
                            record.contact[i].time, known(record.measured[i].force)});
  return table;
}

}  // namespace palpate::record
