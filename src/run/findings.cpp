// Findings on the specimen, on the contact at the largest force, and on integrals of the maps.
#include "run/findings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/text.h"
#include "base/units.h"
#include "run/answer.h"
#include "run/known_failures.h"
#include "run/readings.h"
#include "scenario/integrators.h"
#include "scene/estimates.h"

namespace palpate::run {
namespace {

using record::Finding;

class Findings {
 public:
  Findings(const scene::Scene& scene, record::CaseRecord& record)
      : scene_(scene),
        rung_(scenario::rung(scene.scenario.solver.model)),
        record_(record),
        before_(record.findings) {
    record_.findings.clear();
  }

  void all() {
    add("outcome", std::string(record::outcome_word(record_.outcome)));
    add("last_stable_time_s", record_.last_stable_time);
    add("model", rung_.word);
    if (scene_.specimen) specimen(*scene_.specimen);
    if (!record_.contact.empty()) contact();
    if (!record_.strain.empty()) strain();
    const auto& scales = scene_.scenario.output.display_scale;
    if (!scales.empty()) {
      const auto scale = scales.find(scene_.name);
      add("display_scale", scale == scales.end() ? 1.0 : scale->second);
    }
    for (const Finding& finding : before_) {
      record_.findings.push_back(finding);
      if (finding.name == "energy_imbalance" && std::get<double>(finding.value) > 0.05)
        remark(percent_text(std::get<double>(finding.value)) +
               " of the energy is not accounted for: the first step or all of them are too long "
               "for what happens in them; set a shorter `output.interval` or more "
               "`solver.substeps`");
    }
    record_.answer = answer(scene_, record_);
  }

 private:
  void add(const std::string& name, record::Cell value) {
    record_.findings.push_back({name, std::move(value)});
  }
  void remark(const std::string& sentence) { record_.remarks.push_back(sentence); }

  void specimen(const scene::Specimen& specimen) {
    const double table_modulus = scene_.scenario.tissue.young_modulus;
    const double modulus = specimen.measured.young_modulus;
    add("nodes", static_cast<double>(specimen.network.nodes()));
    if (const auto& refined = specimen.refined;
        refined && refined->start_nodes != specimen.network.nodes())
      add("nodes_before_refining", static_cast<double>(refined->start_nodes));
    if (!specimen.remark.empty()) remark(specimen.remark);
    add("tetrahedra", static_cast<double>(specimen.mesh.tetrahedra.size()));
    add("springs", static_cast<double>(specimen.network.springs()));
    add("young_modulus_kPa", unit::kPa.from_si(table_modulus));
    add("network_young_modulus_kPa", unit::kPa.from_si(modulus));
    add("network_poisson_ratio", specimen.measured.poisson_ratio);
    if (specimen.plan.limit) add("stable_time_step_ms", unit::ms.from_si(*specimen.plan.limit));
    add("time_step_ms", unit::ms.from_si(specimen.plan.substep));
    add("substeps", static_cast<double>(specimen.plan.substeps));
    add("damping_ratio", damping_ratio(specimen));
    if (!specimen.plan.stable())
      remark("the step is " + rounded_text(specimen.plan.substep / *specimen.plan.limit, 3) +
             " times the stability limit: this motion grows from rounding, do not trust it");
    if (std::abs(modulus / table_modulus - 1.0) > 0.05)
      remark("the spring network is " + percent_text(std::abs(modulus / table_modulus - 1.0)) +
             (modulus > table_modulus ? " stiffer" : " softer") +
             " than the tissue's Young's modulus, measured on the specimen");
  }

  // Of the lowest axial mode of a bar on a fixed base.                       docs/theory.md (55)
  double damping_ratio(const scene::Specimen& specimen) const {
    const double speed =
        std::sqrt(specimen.measured.young_modulus / scene_.scenario.tissue.density);
    const double omega = std::numbers::pi * speed / (2.0 * specimen.measured.height);
    if (specimen.law.kind == tissue::Viscosity::kelvin_voigt)
      return 0.5 * specimen.law.time * omega;
    if (specimen.law.kind == tissue::Viscosity::nodal_drag) return 0.5 * specimen.law.drag / omega;
    return 0.0;
  }

  void contact() {
    const auto peak = *std::max_element(
        record_.contact.begin(), record_.contact.end(),
        [](const auto& a, const auto& b) { return a.contact_force < b.contact_force; });
    const double radius = scene_.law().radius;
    const double thickness = scene_.thickness();
    add("effective_modulus_kPa", unit::kPa.from_si(scene_.law().modulus));
    add("finger_compliance_share", scene_.finger.compliance_share);
    add("peak_force_N", peak.force);
    add("peak_friction_N", peak.friction);
    add("peak_indentation_mm", unit::mm.from_si(peak.indentation));
    add("peak_travel_mm", unit::mm.from_si(peak.travel));
    for (const double depth : scene_.scenario.output.force_at) force_at(depth);
    add("local_curvature_per_m", 1.0 / peak.tissue_radius);
    add("depth_ratio", peak.indentation / radius);
    add("contact_radius_ratio", peak.contact_radius / radius);
    add("thickness_ratio", peak.contact_radius / thickness);
    // JKR pull-off 1.5 pi w R at w = 0.05 J/m^2, of the order of wet skin    docs/theory.md (44)
    const double pull_off = 1.5 * std::numbers::pi * 0.05 * radius;
    add("force_over_pull_off", peak.contact_force / pull_off);
    if (scene_.specimen && scene_.scenario.contact.coupling == contact::Coupling::consistent) {
      add("mesh_error", peak.mesh_error);
      if (peak.mesh_error > scene_.scenario.solver.tolerance)
        remark("the mesh's own error in the force is " + error_text(peak.mesh_error) +
               ", above the tolerance of " + percent_text(scene_.scenario.solver.tolerance) +
               (scene_.specimen->refined
                    ? ": refining stopped at " + std::to_string(scene_.specimen->network.nodes()) +
                          " nodes; raise `tissue.mesh.most_nodes`"
                    : ": set `tissue.mesh.refine = true`, or take a finer mesh"));
    }
    identities();
    predictions(peak);
    validity(peak);
    if (peak.contact_force < 10.0 * pull_off)
      remark("the greatest force is below ten times the adhesive pull-off of about " +
             rounded_text(pull_off, 2) +
             " N: a measurement would show adhesion, which is not "
             "modelled");
  }

  void force_at(double depth) {
    const std::string text = quantity_text(depth, unit::mm);
    std::string name = "force_at_" + text + "_N";
    std::replace(name.begin(), name.end(), ' ', '_');
    const std::optional<double> force = force_at_indentation(scene_.scenario, record_, depth);
    if (force) return add(name, *force);
    add(name, std::monostate{});
    remark("the first `indent` did not reach the indentation of " + text +
           " that `output.force_at` asks for: that force is not known; press deeper");
  }

  void identities() {
    double map_error = 0.0;
    double friction_error = 0.0;
    for (const record::PressureMap& map : record_.maps) {
      if (map.contact_force <= 0.0) continue;
      const double force = record::integral(map);
      map_error = std::max(map_error, std::abs(force / map.contact_force - 1.0));
      const double mu = scene_.scenario.contact.friction;
      if (mu <= 0.0) continue;
      // eq. (4): mu P integrated over the map, plus mu times the weight W of docs/theory.md (6)
      const auto row = std::find_if(
          record_.contact.rbegin(), record_.contact.rend(),
          [&](const auto& one) { return one.step == map.step && one.time <= map.time; });
      friction_error = std::max(
          friction_error, std::abs(mu * (force + scene_.finger.weight) / row->friction - 1.0));
    }
    if (record_.maps.empty()) return;
    add("pressure_map_imbalance", map_error);
    add("friction_imbalance", friction_error);
  }

  // The estimates on which the choice of the model was based, and the force to compare them with.
  void predictions(const record::ContactRow& peak) {
    add("thickness_effect", expected_.thickness);
    add("side_effect", expected_.sides);
    add("body_effect", expected_.curved_body);
    add("deep_effect", expected_.deep);
    add("viscous_effect", expected_.viscous);
    add("inertia_effect", expected_.inertia);
    add("curvature_ratio", expected_.curvature_ratio);
    if (const auto* forecast = scene_.choice.taken()) add("predicted_error", forecast->error);
    const bool states =
        scene_.specimen && scene_.scenario.contact.coupling == contact::Coupling::consistent;
    const auto mesh_error = states ? std::optional(peak.mesh_error) : std::nullopt;
    if (const auto stated = stated_error(scene_, mesh_error)) add("stated_error", *stated);
    if (const std::string text = scene_.choice.shortfall(mesh_error); !text.empty()) remark(text);
    const scene::SurfaceTouch& touch = scene_.choice.touch;
    if (!touch.known() || peak.travel <= 0.0) return;
    const auto law = contact::contact_law(scene_.scenario.contact.law,
                                          {scene_.finger.whole.radius, scene_.finger.whole.modulus},
                                          touch.curvature);
    if (!law) return;
    const auto [depth, normal] = touch.pressed(scene_.finger.whole.radius, peak.travel);
    if (std::isfinite(expected_.thickness))
      add("predicted_force_over_hertz", (1.0 + expected_.thickness) * (1.0 - expected_.sides));
    add("force_over_hertz", peak.contact_force / (normal.z() * law->point.force(depth)));
  }

  void validity(const record::ContactRow& peak) {
    const auto coupling = scene_.scenario.contact.coupling;
    const scene::Estimates& e = expected_;
    const bool mesh = rung_.meshed();
    const double depth = peak.indentation / scene_.law().radius;
    const auto& ratio = expected_.depth_ratio;
    if (!contact::mesh_is_tissue(coupling) && ratio && peak.travel > ratio->last_depth() &&
        depth > 0.1)
      remark("the travel reached " + quantity_text(peak.travel, unit::mm) +
             ", and the factor for deep presses is known up to " +
             quantity_text(ratio->last_depth(), unit::mm) + " here: the force is off by about " +
             percent_text(std::abs(e.deep) + e.deep_error) +
             "; press less deep, or compare with `coupling = \"resolved\"`");
    if (mesh && coupling == contact::Coupling::series)
      remark("series coupling counts the tissue's compliance twice: on a half-space " +
             percent_text(1.0 - std::pow(1.0 + (1.0 - scene_.finger.compliance_share), -1.5)) +
             " of the force is lost, and the force depends on the mesh");
    const double ratio_error =
        mesh ? std::abs(scene_.specimen->measured.poisson_ratio -
                        std::min(scene_.scenario.tissue.poisson_ratio, 0.4995))
             : 0.0;
    if (ratio_error > 0.05 && contact::mesh_is_tissue(coupling))
      remark("the springs have a Poisson's ratio of " +
             rounded_text(scene_.specimen->measured.poisson_ratio, 2) + ", the tissue " +
             number_text(scene_.scenario.tissue.poisson_ratio) +
             ": the effect of sides and other tissues may be wrong by about " +
             percent_text(ratio_error * (e.sides + e.curved_body + 0.05)) +
             " of the force; `coupled_springs` has the tissue's ratio");
  }

  void strain() {
    double largest = 0.0;
    for (const record::StrainRow& row : record_.strain)
      largest = std::max(largest, std::abs(row.strain));
    add("peak_strain", largest);
    for (const scenario::Step& step : scene_.scenario.steps)
      if (const auto* creep = std::get_if<scenario::Creep>(&step)) {
        const double elastic = creep->stress / scene_.specimen->pressed.young_modulus;
        const std::optional<double> half = creep_half_time(record_, elastic);
        add("elastic_strain", elastic);
        add("creep_half_time_s", half ? record::Cell(*half) : record::Cell());
        break;
      }
    for (const scenario::Step& step : scene_.scenario.steps)
      if (const auto* compress = std::get_if<scenario::Compress>(&step)) {
        double stress = 0.0;
        for (const record::StrainRow& row : record_.strain) stress = std::max(stress, row.stress);
        add("peak_stress_kPa", unit::kPa.from_si(stress));
        add("secant_modulus_kPa", unit::kPa.from_si(stress / compress->strain));
        break;
      }
    if (scene_.specimen->law.kind == tissue::Viscosity::kelvin_voigt)
      for (const scenario::Step& step : scene_.scenario.steps)
        if (std::holds_alternative<scenario::Relax>(step)) {
          remark(
              "Kelvin-Voigt does not relax: after the impulse of a strain applied at once the "
              "stress is constant; use `viscosity = \"standard_linear_solid\"`");
          break;
        }
  }

  const scene::Scene& scene_;
  const scenario::Rung& rung_;
  record::CaseRecord& record_;
  std::vector<Finding> before_;
  const scene::Estimates& expected_ = scene_.choice.expected;
};

}  // namespace

void add_findings(const scene::Scene& scene, record::CaseRecord& record) {
  Findings(scene, record).all();
  add_known_failures(scene, record);
}

}  // namespace palpate::run
