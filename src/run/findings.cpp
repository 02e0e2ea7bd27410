// Findings on the specimen, on the contact at the largest force, and on integrals of the maps.
#include "run/findings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/symmetric_solver.h"
#include "base/text.h"
#include "base/units.h"
#include "contact/hertz.h"
#include "contact/passivity.h"
#include "contact/patch.h"
#include "geometry/curvature.h"
#include "mechanics/contacts.h"
#include "run/answer.h"
#include "scenario/integrators.h"
#include "scene/estimates.h"
#include "scene/first_touch.h"
#include "scene/places.h"
#include "scene/proportions.h"
#include "scene/specimen_mesh.h"
#include "tissue/coupled.h"
#include "tissue/network.h"

namespace palpate::run {
namespace {

struct Point {
  double x = 0.0;
  double y = 0.0;
};

// The x at which the straight line from a to b has the given y, with a.y < y <= b.y.
double crossing(const Point& a, const Point& b, double y) {
  if (y == b.y) return b.x;
  return a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
}

}  // namespace

std::optional<double> force_at_indentation(const scenario::PlainScenario& scenario,
                                           const record::CaseRecord& record, double depth) {
  const auto first = std::ranges::find_if(scenario.steps, [](const auto& step) {
    return std::holds_alternative<scenario::Indent>(step);
  });
  const int number = static_cast<int>(first - scenario.steps.begin()) + 1;
  std::optional<Point> before;
  for (const record::ContactRow& row : record.contact) {
    if (row.step > number) break;
    const Point here{row.force, row.indentation};
    if (row.step == number && before && here.y >= depth) return crossing(*before, here, depth);
    if (here.y < depth) before = here;
  }
  return std::nullopt;
}

std::optional<double> creep_half_time(const record::CaseRecord& record, double elastic_strain) {
  const auto first =
      std::ranges::find_if(record.strain, [](const auto& row) { return row.stress > 0.0; });
  constexpr double rounding = 1e-12;
  const double half = 0.5 * elastic_strain;
  std::optional<Point> before;
  for (auto row = first; row != record.strain.end(); ++row) {
    if (row->step != first->step || row->stress <= 0.0) break;
    const Point here{row->time - first->time, row->strain};
    if (here.y >= (1.0 - rounding) * half) return before ? crossing(*before, here, half) : 0.0;
    before = here;
  }
  return std::nullopt;
}

namespace {

using record::Finding;

std::string millimetres(double length) { return rounded_text(unit::mm.from_si(length), 3) + " mm"; }

class Findings {
 public:
  Findings(const scene::Scene& scene, record::CaseRecord& record)
      : scene_(scene),
        traits_(scenario::traits(scene.scenario.solver.model)),
        record_(record),
        before_(record.findings) {
    record_.findings.clear();
    const auto peak =
        std::ranges::max_element(record_.contact, {}, &record::ContactRow::contact_force);
    if (peak != record_.contact.end()) peak_ = *peak;
  }

  void all() {
    add("outcome", std::string(record::outcome_word(record_.outcome)));
    add("last_stable_time_s", record_.last_stable_time);
    add("model", traits_.word);
    surface();
    if (scene_.specimen) specimen(*scene_.specimen);
    if (record_.contact.size() > 1) contact();  // the first row is before the press
    if (!record_.strain.empty()) strain();
    const auto& scales = scene_.scenario.output.display_scale;
    if (!scales.empty()) {
      const auto scale = scales.find(scene_.name);
      add("display_scale", scale == scales.end() ? 1.0 : scale->second);
    }
    for (const Finding& finding : before_) {
      record_.findings.push_back(finding);
      if (finding.name == "energy_imbalance" && std::get<double>(finding.value) > 0.05)
        warning(
            percent_text(std::get<double>(finding.value)) +
            " of the energy is not accounted for: the first step or all of them are too long for "
            "what happens in them; set a shorter `output.interval` or more `solver.substeps`");
    }
    record_.answer = answer(scene_, record_);
    known_failures();
  }

 private:
  void add(const std::string& name, record::Cell value) {
    record_.findings.push_back({name, std::move(value)});
  }
  void warning(const std::string& sentence) { record_.warnings.push_back(sentence); }

  void surface() {
    const std::string& mended = scene_.choice.touch.warning;
    if (!mended.empty()) warning(mended);
    const scenario::Resolved& scenario = scene_.scenario;
    const scene::SurfaceTouch& touch = scene_.choice.touch;
    if (scenario.finger.moved)
      warning(
          "at the middle of the body's box there is a gap, or the rim of a hollow, so that the "
          "finger presses the top at " +
          scene::place_text(scenario, touch.position) + "; set `finger.at` for another place");
    const bool flat = !touch.known() || (!touch.curved() && !touch.tilted());
    if (!flat && (scenario.finger.replaced > 0 || mechanics::presses_as_one(scene_)))
      warning(
          "several spheres press a flat like the one that they stand for, and this surface less: " +
          std::string(scenario.finger.replaced > 0
                          ? "`solid` has pressed the one; `coupled_springs` presses each of them"
                          : "each of them was pressed; `solid` presses the one"));
    if (!scenario.uniform())
      for (const std::string& sentence : scene::disproportions(scenario, touch, expected_))
        warning(sentence);
    const geometry::SmoothSurface* const outer_surface = scene_.outer_surface();
    if (outer_surface == nullptr || scenario.uniform() || !touch.known() || !touch.size.allFinite())
      return;
    // Of a body from a file it is known what lies straight behind the press; a load spreads by
    // about 45 degrees.
    constexpr double least_under = 0.1;
    const geometry::Surface& body = outer_surface->surface();
    const double level = scenario.tissue.held_from_below() ? scene::base_level(scenario, body)
                                                           : scene::box_of(body.vertices).low.z();
    const scene::BaseArea base =
        scene::base_area(scenario, body, touch.position, touch.position.z() - level);
    const bool free = !scene::parametric(scenario.tissue.shape) && !std::isfinite(touch.to_base);
    if (free || base.under_press < least_under)
      warning((free ? "nothing straight behind the press is fixed"
                    : "only " + percent_text(base.under_press) +
                          " of the surface behind the press is fixed") +
              ": the body bends or turns there; see the base in `palpate explain`, and set "
              "`tissue.base_height` or `tissue.base_side` if it is fixed elsewhere");
  }

  void specimen(const scene::Specimen& specimen) {
    const double table_modulus = scene_.scenario.tissue.young_modulus;
    const double modulus = specimen.measured.young_modulus;
    add("nodes", static_cast<double>(specimen.network.nodes()));
    if (const auto& refined = specimen.refined;
        refined && refined->start_nodes != specimen.network.nodes())
      add("nodes_before_refining", static_cast<double>(refined->start_nodes));
    if (!specimen.warning.empty() && specimen.warning != scene_.choice.touch.warning)
      warning(specimen.warning);
    if (!specimen.straightened.empty()) warning(specimen.straightened);
    add("tetrahedra", static_cast<double>(specimen.mesh.tetrahedra.size()));
    add("springs", static_cast<double>(specimen.network.springs()));
    add("young_modulus_kPa", unit::kPa.from_si(table_modulus));
    add("springs_young_modulus_kPa", unit::kPa.from_si(modulus));
    add("springs_poisson_ratio", specimen.measured.poisson_ratio);
    if (specimen.plan.limit) add("stable_time_step_ms", unit::ms.from_si(*specimen.plan.limit));
    add("time_step_ms", unit::ms.from_si(specimen.plan.substep));
    add("substeps", static_cast<double>(specimen.plan.substeps));
    add("damping_ratio", damping_ratio(specimen));
    if (scene_.scenario.uniform()) sampling(specimen);
    if (!specimen.plan.stable())
      warning("the step is " + rounded_text(specimen.plan.substep / *specimen.plan.limit, 3) +
              " times the stability limit: this motion grows from rounding, do not trust it");
    if (std::abs(modulus / table_modulus - 1.0) > 0.05)
      warning("the springs as a whole are " +
              percent_text(std::abs(modulus / table_modulus - 1.0)) +
              (modulus > table_modulus ? " stiffer" : " softer") +
              " than the tissue's Young's modulus, measured on the specimen");
  }

  // Rows that are too far apart to show the ringing of the body.
  void sampling(const scene::Specimen& specimen) {
    const scenario::Resolved& scenario = scene_.scenario;
    if (!about(scenario.solver.integrator).inertia ||
        scene::uniform_ringing(scenario) < 0.2 * scenario.solver.tolerance)
      return;
    const double period = 2.0 * std::numbers::pi / lowest_frequency(specimen) /
                          std::sqrt(specimen.law.instantaneous_ratio());
    if (scenario.output.interval < 0.5 * period) return;
    warning("the body vibrates with a period of about " + quantity_text(period, unit::ms) +
            ", and rows are " + quantity_text(scenario.output.interval, unit::ms) +
            " apart: the curve does not resolve it; remove `solver.integrator`, or set "
            "`output.interval` to a tenth of the period");
  }

  // Of the lowest axial mode of a bar on a fixed base, 1/s.             docs/theory.md [damping]
  double lowest_frequency(const scene::Specimen& specimen) const {
    const double speed =
        std::sqrt(specimen.measured.young_modulus / scene_.scenario.tissue.density);
    return std::numbers::pi * speed / (2.0 * specimen.measured.height);
  }

  double damping_ratio(const scene::Specimen& specimen) const {
    const double omega = lowest_frequency(specimen);
    if (specimen.law.kind == tissue::Viscosity::kelvin_voigt)
      return 0.5 * specimen.law.time * omega;
    if (specimen.law.kind == tissue::Viscosity::nodal_drag) return 0.5 * specimen.law.drag / omega;
    return 0.0;
  }

  void contact() {
    const record::ContactRow& peak = peak_;
    const double radius = scene_.law().radius;
    const double thickness = scene_.thickness();
    add("effective_modulus_kPa", unit::kPa.from_si(scene_.law().modulus));
    add("finger_compliance_share", scene_.finger.compliance_share);
    add("peak_force_N", peak.force);
    add("peak_friction_N", peak.friction);
    add("peak_indentation_mm", unit::mm.from_si(peak.indentation));
    add("peak_travel_mm", unit::mm.from_si(peak.travel));
    for (const double depth : scene_.scenario.output.force_at) force_at(depth);
    less_deep(peak.mesh_error);
    if (scene_.scenario.tissue.law.kind == tissue::Viscosity::none &&
        std::ranges::any_of(scene_.scenario.steps, [](const scenario::Step& step) {
          return std::holds_alternative<scenario::Hold>(step);
        }))
      warning(
          "the tissue is elastic, so that nothing relaxes or creeps during `hold`; give its table "
          "`retardation_time`, or `relaxation_time` and `instantaneous_ratio`, if it does");
    add("local_curvature_per_m", 1.0 / peak.tissue_radius);
    add("depth_ratio", peak.indentation / radius);
    add("contact_radius_ratio", peak.contact_radius / radius);
    add("thickness_ratio", peak.contact_radius / thickness);
    // JKR pull-off 1.5 pi w R at w = 0.05 J/m^2, of the order of wet skin
    //                                                                     docs/theory.md [adhesion]
    const double pull_off = 1.5 * std::numbers::pi * 0.05 * radius;
    add("force_over_pull_off", peak.contact_force / pull_off);
    if (states_mesh_error(scene_)) {
      add("mesh_error", peak.mesh_error);
      if (scene_.specimen && peak.mesh_error > scene_.scenario.solver.tolerance)
        warning("the mesh's own error in the force is " + error_text(peak.mesh_error) +
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
      warning("the greatest force is below ten times the adhesive pull-off of about " +
              rounded_text(pull_off, 2) +
              " N: a measurement would show adhesion, which is not modelled");
  }

  // Meshes of `solid` are made for the deepest displacement.      docs/theory.md [solid_force]
  void less_deep(double at_most) {
    const std::vector<double>& asked = scene_.scenario.output.force_at;
    if (!traits_.solid || asked.empty()) return;
    const double least = *std::ranges::min_element(asked);
    const auto row = std::ranges::find_if(
        record_.contact, [&](const auto& one) { return one.indentation >= least; });
    if (row == record_.contact.end()) return;
    const double error = row->mesh_error * row->indentation / least;
    if (error > 1.5 * at_most)
      warning("the error of `solid` grows with the inverse of the displacement, to about " +
              percent_text(error) + " of the force at " + quantity_text(least, unit::mm) +
              "; a run that ends there has a smaller one");
  }

  void force_at(double depth) {
    const std::string text = quantity_text(depth, unit::mm);
    std::string name = "force_at_" + text + "_N";
    std::ranges::replace(name, ' ', '_');
    const std::optional<double> force = force_at_indentation(scene_.scenario, record_, depth);
    if (force) return add(name, *force);
    add(name, std::monostate{});
    warning("the first `indent` did not reach the indentation of " + text +
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
      // eq. (4): mu P integrated over the map, plus mu times the weight W of [hand_force]
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
    // Of a curved body without a coarse mesh, and of a depth without a table, nothing is known.
    const auto& shape = scene_.scenario.tissue.shape;
    const bool half_space = std::holds_alternative<scenario::HalfSpace>(shape);
    const bool layers = half_space || std::holds_alternative<scenario::Cuboid>(shape);
    const bool body = half_space || expected_.measured;
    const auto where = [](bool known, double value) {
      return known ? record::Cell(value) : record::Cell();
    };
    add("thickness_effect", where(layers, expected_.thickness));
    add("side_effect", where(layers && body, expected_.sides));
    add("body_effect", where(body, expected_.size));
    add("edge_effect", where(expected_.contact_radius > 0.0, expected_.edge));
    add("deep_effect", where(expected_.depth_ratio.has_value(), expected_.deep));
    add("viscous_effect", expected_.viscous);
    add("inertia_effect", expected_.inertia);
    add("curvature_ratio", expected_.curvature_ratio);
    if (const auto* forecast = scene_.choice.taken()) add("predicted_error", forecast->error);
    const auto mesh_error =
        states_mesh_error(scene_) ? std::optional(peak.mesh_error) : std::nullopt;
    if (const auto stated = stated_error(scene_, mesh_error)) add("stated_error", *stated);
    if (const std::string text = scene_.choice.shortfall(mesh_error); !text.empty()) warning(text);
    const scene::SurfaceTouch& touch = scene_.choice.touch;
    if (!touch.known() || peak.travel <= 0.0) return;
    const auto law = contact::contact_law(scene_.scenario.contact.law,
                                          {scene_.finger.whole.radius, scene_.finger.whole.modulus},
                                          touch.curvature);
    if (!law) return;
    const auto [depth, normal] = touch.pressed(scene_.finger.whole.radius, peak.travel);
    if (expected_.measured) add("predicted_force_over_hertz", 1.0 + expected_.size);
    add("force_over_hertz", peak.contact_force / (normal.z() * law->point.force(depth)));
  }

  void validity(const record::ContactRow& peak) {
    const auto coupling = scene_.scenario.contact.coupling;
    const scene::Estimates& e = expected_;
    const bool mesh = traits_.meshed();
    const double depth = peak.indentation / scene_.law().radius;
    const auto& ratio = scene_.depth_ratio;  // where it is used
    if (!contact::mesh_is_tissue(coupling) && !traits_.solid && ratio &&
        peak.travel > ratio->last_depth() && depth > 0.1)
      warning("the displacement reached " + quantity_text(peak.travel, unit::mm) +
              ", and the factor for deep presses is known up to " +
              quantity_text(ratio->last_depth(), unit::mm) + " here: the force may be off by " +
              percent_text(e.deep_error) + "; press less deep" +
              (e.inertia > scene_.scenario.solver.tolerance
                   ? ""  // which `solid` does not have
                   : ", or take `solver.model = \"solid\"`"));
    if (mesh && coupling == contact::Coupling::series)
      warning("series coupling counts the tissue's compliance twice: on a half-space " +
              percent_text(1.0 - std::pow(1.0 + (1.0 - scene_.finger.compliance_share), -1.5)) +
              " of the force is lost, and the force depends on the mesh");
    const double ratio_error =
        mesh ? std::abs(scene_.specimen->measured.poisson_ratio -
                        std::min(scene_.scenario.tissue.poisson_ratio, 0.4995))
             : 0.0;
    if (ratio_error > 0.05 && contact::mesh_is_tissue(coupling))
      warning("the springs have a Poisson's ratio of " +
              rounded_text(scene_.specimen->measured.poisson_ratio, 2) + ", the tissue " +
              number_text(scene_.scenario.tissue.poisson_ratio) +
              ": the effect of sides and other tissues may be wrong by about " +
              percent_text(ratio_error * (std::abs(e.size) + 0.05)) +
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
          warning(
              "Kelvin-Voigt does not relax: after the impulse of a strain applied at once the "
              "stress is constant; use `viscosity = \"standard_linear_solid\"`");
          break;
        }
  }

  // Of a press whose settings select a method that fails: a fixed edge too near, volumes that lock,
  // a load on one node, curvature without sign, friction that jumps, Kelvin-Voigt tissue under a
  // finger that turns back, and a stiffness that a device cannot render passively.
  //                                                                     docs/theory.md [failures]
  void known_failures() {
    if (peak_.contact_force <= 0.0) return;
    if (scene_.specimen) {
      edge();
      locking();
      one_node();
      unsigned_curvature();
    }
    sudden_friction();
    turning_back();
    device();
  }

  [[nodiscard]] double tolerance() const { return scene_.scenario.solver.tolerance; }

  // A fixed edge at the distance rho acts like a bonded base there, which raises the force by the
  // factor 1 + c sqrt(R h) / rho, c = 0.86 at nu = 0.27 to 1.13 at 1/2.  docs/theory.md [failures]
  void edge() {
    if (!scene_.scenario.solver.rings) return;
    const double share = record::number_of(record_, "edge_reaction_over_force").value_or(0.0);
    const scene::Specimen& specimen = *scene_.specimen;
    const scene::FirstTouch touch = scene::first_touch(scene_);
    std::vector<int> start;
    for (const int vertex : specimen.surface->surface().triangles[as_index(touch.at.triangle)])
      start.push_back(specimen.outer_surface[as_index(vertex)]);
    const tissue::Part part =
        tissue::part_around(specimen.network, start, *scene_.scenario.solver.rings);
    const Vec3 centre = specimen.surface->position(touch.at);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < part.nodes.size(); ++i)
      if (part.edge[i] != 0) nearest = std::min(nearest, (part.network.rest[i] - centre).norm());
    if (!std::isfinite(nearest)) return;
    constexpr double least = 0.86;
    const double stiffening = least * peak_.contact_radius / nearest;
    if (share <= tolerance() || stiffening <= tolerance()) return;
    warning("the edge of the part that moves is " + millimetres(nearest) +
            " from the contact and carries " + percent_text(share) +
            " of its force: a base that near stiffens a half-space by at least " +
            percent_text(stiffening) + "; give more `solver.rings`, or \"all\"");
  }

  // Mean static displacement of the surface under a Hertz pressure of 1 N, m/N; 0 if not rigid.
  [[nodiscard]] double surface_displacement(const tissue::Network& network) const {
    const scene::Specimen& specimen = *scene_.specimen;
    SymmetricSolver solver;
    if (!solver.prepare(tissue::stiffness_matrix(network), specimen.held)) return 0.0;
    const contact::Patch patch = scene::first_patch(scene_, peak_.contact_radius);
    contact::Spread spread;
    contact::Spreader(*specimen.surface).spread(patch, spread);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * network.nodes());
    for (std::size_t k = 0; k < spread.vertices.size(); ++k)
      load.segment<3>(3 * specimen.outer_surface[as_index(spread.vertices[k])]) -=
          spread.shares[k] * patch.normal;
    Eigen::VectorXd moved;
    return solver.solve(load, moved) ? load.dot(moved) : 0.0;
  }

  // Compares with the same mesh with volumes averaged at nodes.
  void locking() {
    const scenario::Resolved::Solver& solver = scene_.scenario.solver;
    if (solver.volume != tissue::Volume::tetrahedron || !scenario::traits(solver.model).coupled() ||
        !scene_.scenario.regions.empty())
      return;
    const scene::Specimen& specimen = *scene_.specimen;
    const double ratio = specimen.measured.poisson_ratio;
    tissue::Network averaged = specimen.network;
    const std::array tissues{tissue::Isotropic{specimen.measured.young_modulus,
                                               std::min(ratio, scene::most_poisson_ratio)}};
    tissue::couple(averaged, specimen.mesh, tissues, tissue::Volume::nodal, scene::own_share);
    const double locked = surface_displacement(averaged) / surface_displacement(specimen.network);
    add("locking", locked);
    constexpr double most = 1.25;  // meshes that do not lock differ by up to 12 % (nu = 0.45)
    if (locked > most)
      warning("volumes of single tetrahedra lock at nu " + rounded_text(ratio) +
              ": under the finger the mesh moves " + rounded_text(locked, 2) +
              " times less than with volumes averaged at nodes; write `solver.volume = \"nodal\"`");
  }

  // The displacement is of the order F / (E l) with the cell size l and does not converge.
  void one_node() {
    if (scene_.scenario.contact.spread != scenario::Contact::Spread::nearest_node) return;
    const double sunk =
        unit::mm.to_si(record::number_of(record_, "surface_displacement_mm").value_or(0.0));
    warning("all of the force is on one node, which has sunk by " + millimetres(sunk) +
            ": it would move about twice as far on a mesh of half the cells' size; write "
            "`contact.spread = \"pressure\"`");
  }

  void unsigned_curvature() {
    if (scene_.scenario.contact.curvature != geometry::CurvatureMethod::taubin_unsigned) return;
    const geometry::SmoothSurface& surface = *scene_.specimen->surface;
    const geometry::SurfacePoint at = scene::first_touch(scene_).at;
    const auto mean = [&](geometry::CurvatureMethod method) {
      const geometry::CurvatureStars stars(
          surface.surface(), surface.neighbours(),
          {.method = method, .rings = scene_.scenario.contact.curvature_rings});
      const auto found = geometry::between(stars.at_corners(surface.surface(), at.triangle),
                                           {at.weights[0], at.weights[1], at.weights[2]});
      return 0.5 * (found.curvature.kappa_1 + found.curvature.kappa_2);
    };
    const double kept = mean(geometry::CurvatureMethod::taubin);
    const double lost = mean(geometry::CurvatureMethod::taubin_unsigned);
    add("signed_curvature_per_m", kept);
    if (std::abs(lost - kept) > tolerance() * std::abs(lost))
      warning(
          "curvature without its sign is " + rounded_text(lost, 3) + " 1/m where the tissue has " +
          rounded_text(kept, 3) +
          " 1/m: it is hollow there in some direction; write `contact.curvature = \"quadric\"`");
  }

  // Without sticking, the whole friction force appears or vanishes from one row to the next.
  void sudden_friction() {
    const scenario::PlainContact& contact = scene_.scenario.contact;
    if (contact.slip != scenario::Contact::Slip::coulomb || contact.friction <= 0.0) return;
    double jump = 0.0;
    for (std::size_t i = 1; i < record_.contact.size(); ++i)
      jump = std::max(jump,
                      std::abs(record_.contact[i].tangential - record_.contact[i - 1].tangential));
    add("friction_jump_N", jump);
    if (jump > 0.5 * contact.friction * peak_.contact_force)
      warning("friction jumped by " + rounded_text(jump, 3) +
              " N between two rows: at rest eq. (4) has no direction, and in the hand it chatters; "
              "write `contact.slip = \"mindlin\"`");
  }

  // The dashpots of a Kelvin-Voigt contact follow the rate, which changes its sign at once.
  void turning_back() {
    if (scene_.relaxation.elastic() ||
        scene_.scenario.tissue.viscosity != tissue::Viscosity::kelvin_voigt)
      return;
    const auto& rows = record_.contact;
    const auto& steps = scene_.scenario.steps;
    double before = 0.0;
    double after = 0.0;
    double drop = 0.0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      if (rows[i].step == rows[i - 1].step ||
          !std::holds_alternative<scenario::Retract>(steps[as_index(rows[i].step - 1)]) ||
          rows[i - 1].contact_force <= 0.0)
        continue;
      const double one = 1.0 - rows[i].contact_force / rows[i - 1].contact_force;
      if (one <= drop) continue;
      drop = one;
      before = rows[i - 1].contact_force;
      after = rows[i].contact_force;
    }
    if (drop <= 0.0) return;
    add("turning_drop", drop);
    if (drop > tolerance())
      warning("when the finger turned back the force fell from " + rounded_text(before, 3) +
              " to " + rounded_text(after, 3) +
              " N within a row: Kelvin-Voigt's dashpots follow the rate, which turns at once; "
              "write `tissue.viscosity = \"standard_linear_solid\"`");
  }

  void device() {
    const scenario::Device& asked = scene_.scenario.device;
    if (!asked.damping) return;
    const contact::SampledDevice device{.damping = *asked.damping, .frame = asked.frame};
    contact::PointLaw law;
    law.coefficient = contact::hertz::force(1.0, scene_.law().radius, scene_.law().modulus);
    const double needed = contact::needed_damping(law.stiffness(peak_.indentation), device);
    const double depth = contact::passive_depth(law, device);
    add("needed_device_damping_N_s_per_m", needed);
    add("passive_depth_mm", unit::mm.from_si(depth));
    if (needed > *asked.damping)
      warning("a device of " + quantity_text(*asked.damping, unit::N_s_per_m) + " and frames of " +
              quantity_text(asked.frame, unit::ms) + " generates energy below " +
              millimetres(depth) + ": at " + millimetres(peak_.indentation) +
              " the contact needs " + rounded_text(needed, 3) +
              " N s/m (Colgate and Brown); shorten `device.frame`, or press less deep");
  }

  const scene::Scene& scene_;
  const scenario::ModelTraits& traits_;
  record::CaseRecord& record_;
  std::vector<Finding> before_;
  record::ContactRow peak_;  // with the largest contact force
  const scene::Estimates& expected_ = scene_.choice.expected;
};

}  // namespace

void add_findings(const scene::Scene& scene, record::CaseRecord& record) {
  Findings(scene, record).all();
}

}  // namespace palpate::run
