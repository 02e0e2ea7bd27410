// The words and groups of all findings.
#include "report/finding_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

#include "base/text.h"
#include "plot/gnuplot_text.h"

namespace palpate::report {
namespace {

enum Group : std::size_t { course, peak, error, gauge, validity, mesh, time, checks };

struct Row {
  std::string_view name;
  Group group;
  std::string_view unit;  // `%`: the finding is a part of 1
  std::string_view label;
};

constexpr std::array finding_rows{
    Row{"outcome", course, "", "how the case ended"},
    Row{"last_stable_time_s", course, "s", "last stable time"},
    Row{"model", course, "", "model that ran"},
    Row{"display_scale", course, "", "factor of this case in figures; the CSV files are in N"},
    Row{"peak_force_N", peak, "N", "largest force"},
    Row{"peak_friction_N", peak, "N", "largest tangential force that friction allows"},
    Row{"peak_indentation_mm", peak, "mm", "effective depth there"},
    Row{"peak_travel_mm", peak, "mm", "displacement of the finger there"},
    Row{"local_curvature_per_m", peak, "1/m", "curvature of the surface there, convex positive"},
    Row{"signed_curvature_per_m", peak, "1/m", "the same with the signs of the votes"},
    Row{"surface_displacement_mm", peak, "mm", "largest displacement of the loaded node"},
    Row{"friction_jump_N", peak, "N", "largest change of the tangential force between two rows"},
    Row{"turning_drop", peak, "%", "part of the force that is lost where the finger turns back"},
    Row{"edge_reaction_over_force", peak, "%", "part of the force that the fixed edge carries"},
    Row{"peak_strain", peak, "%", "largest strain"},
    Row{"elastic_strain", peak, "%", "final strain under the first stress"},
    Row{"predicted_error", error, "%", "error of the force, estimated before the run"},
    Row{"stated_error", error, "%", "error of the force, estimated after the run"},
    Row{"mesh_error", error, "%", "error of the mesh in the largest force"},
    Row{"predicted_force_over_hertz", error, "", "force over Hertz's force, estimated"},
    Row{"force_over_hertz", error, "", "force over Hertz's force, computed"},
    Row{"measured_verdict", gauge, "", "measured force against the model's"},
    Row{"measured_causes", gauge, "", "likely causes of the difference"},
    Row{"measured_difference_N", gauge, "N", "measured minus computed force, root mean square"},
    Row{"measured_difference", gauge, "%", "the same over the largest computed force"},
    Row{"measured_allowed", gauge, "%", "difference that is allowed"},
    Row{"measured_offset_N", gauge, "N", "force before contact, median"},
    Row{"measured_noise_N", gauge, "N", "force before contact, standard deviation"},
    Row{"measured_drift_N", gauge, "N", "force after contact minus before"},
    Row{"measured_stiffness", gauge, "", "measured over computed force, by least squares"},
    Row{"measured_surface_mm", gauge, "mm", "how much lower the specimen lies"},
    Row{"measured_hysteresis", gauge, "%", "energy lost in the cycle, measured"},
    Row{"model_hysteresis", gauge, "%", "energy lost in the cycle, computed"},
    Row{"measured_contact_mm", gauge, "mm", "displacement at first contact, measured"},
    Row{"model_contact_mm", gauge, "mm", "displacement at first contact, computed"},
    Row{"measured_release_mm", gauge, "mm", "displacement at release, measured"},
    Row{"model_release_mm", gauge, "mm", "displacement at release, computed"},
    Row{"depth_ratio", validity, "", "effective depth over radius, h / R"},
    Row{"contact_radius_ratio", validity, "", "contact radius over radius, a / R"},
    Row{"thickness_ratio", validity, "", "contact radius over the height of the specimen"},
    Row{"curvature_ratio", validity, "", "ratio of the two curvatures at first contact"},
    Row{"force_over_pull_off", validity, "", "force over an adhesive pull-off force"},
    Row{"thickness_effect", validity, "%", "more force by the finite thickness"},
    Row{"side_effect", validity, "%", "change by free sides of flat layers"},
    Row{"body_effect", validity, "%", "change of a half-space's force by the body's size"},
    Row{"edge_effect", validity, "%", "bound of what a near edge changes"},
    Row{"deep_effect", validity, "%", "change by large depth in soft, large-strain tissue"},
    Row{"viscous_effect", validity, "%", "change by viscosity"},
    Row{"inertia_effect", validity, "%", "change by inertia"},
    Row{"finger_compliance_share", validity, "%", "the finger's part of the compliance"},
    Row{"effective_modulus_kPa", validity, "kPa", "effective modulus E* of finger and tissue"},
    Row{"peak_stress_kPa", peak, "kPa", "largest stress"},
    Row{"secant_modulus_kPa", peak, "kPa", "largest stress over the final strain"},
    Row{"young_modulus_kPa", validity, "kPa", "Young's modulus of the tissue"},
    Row{"needed_device_damping_N_s_per_m", validity, "N s/m", "damping that the device needs"},
    Row{"passive_depth_mm", validity, "mm", "depth above which the device damps too little"},
    Row{"nodes", mesh, "", "nodes"},
    Row{"mirrored_copies", mesh, "", "parts that the mesh stands for, by its mirrors"},
    Row{"meshes", mesh, "", "meshes whose forces are extrapolated"},
    Row{"factorisations", mesh, "", "factorisations of the finest mesh's stiffness"},
    Row{"nodes_before_refining", mesh, "", "nodes before refining"},
    Row{"tetrahedra", mesh, "", "tetrahedra"},
    Row{"springs", mesh, "", "springs"},
    Row{"springs_young_modulus_kPa", mesh, "kPa", "Young's modulus of the springs, measured"},
    Row{"springs_poisson_ratio", mesh, "", "Poisson's ratio of the springs, measured"},
    Row{"kept_modes", mesh, "", "modes that are used"},
    Row{"locking", mesh, "", "displacement over that of the mesh that resists volume less"},
    Row{"stable_time_step_ms", time, "ms", "longest stable time step"},
    Row{"time_step_ms", time, "ms", "time step"},
    Row{"substeps", time, "", "solver steps per `solver.time_step`"},
    Row{"damping_ratio", time, "", "damping ratio of the lowest mode"},
    Row{"creep_half_time_s", time, "s", "time until half of the final strain"},
    Row{"pressure_map_imbalance", checks, "%", "pressure maps against the force"},
    Row{"friction_imbalance", checks, "%", "pressure maps against the friction limit"},
    Row{"energy_imbalance", checks, "%", "energy that is not accounted for"},
    Row{"dropped_inertia", checks, "%", "motion that follows without inertia"},
    Row{"solution_error", checks, "%", "error of the solutions, as energy"},
};

}  // namespace

const std::vector<FindingGroup>& finding_groups() {
  static const std::vector<FindingGroup> groups{
      {"Course", "How the case ran and ended."},
      {"Peak", "The values at the largest force or strain."},
      {"Error of the model", "What is known about the error of the force, as a part of it."},
      {"Measured and computed", "The gauge of a live run against the model."},
      {"Validity",
       "Sizes that decide whether the model's assumptions hold; a change is a part of the force."},
      {"Mesh", "The mesh that stood for the tissue."},
      {"Time", "The steps in time."},
      {"Checks", "Balances that would be zero in exact arithmetic on an infinitely fine mesh."},
      {"More", "Values that the scenario names."}};
  return groups;
}

FindingWords words_of_finding(const std::string& name) {
  const auto row = std::ranges::find(finding_rows, name, &Row::name);
  if (row != finding_rows.end())
    return {.group = row->group, .label = std::string(row->label), .unit = std::string(row->unit)};
  return {.group = finding_groups().size() - 1, .label = name};
}

std::string finding_text(const record::Finding& finding, int digits) {
  if (const auto* word = std::get_if<std::string>(&finding.value)) return *word;
  const auto* number = std::get_if<double>(&finding.value);
  if (number == nullptr) return "–";
  const std::string unit = words_of_finding(finding.name).unit;
  if (unit == "%") return plot::tick_text(100.0 * *number, std::min(digits, 3)) + " %";
  return plot::tick_text(*number, digits) + (unit.empty() ? "" : " " + unit);
}

int warranted_digits(const record::Answer& answer) {
  const double error = answer.stated_error.value_or(0.05);
  return error > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 2, 4) : 4;
}

std::string warranted_text(double value, double low, double high) {
  const double half = 0.5 * (high - low);
  if (!std::isfinite(half) || half <= 0.0 || value == 0.0) return rounded_text(value);
  const int digits = static_cast<int>(std::floor(std::log10(std::abs(value)))) -
                     static_cast<int>(std::floor(std::log10(half))) + 2;
  return rounded_text(value, std::clamp(digits, 1, 4));
}

double finding_number(const record::CaseRecord& record, std::string_view name) {
  return record::number_of(record, name).value_or(std::numeric_limits<double>::quiet_NaN());
}

std::string finding_word(const record::CaseRecord& record, std::string_view name) {
  for (const record::Finding& finding : record.findings)
    if (finding.name == name)
      if (const auto* word = std::get_if<std::string>(&finding.value)) return *word;
  return {};
}

}  // namespace palpate::report
