// A finding and a remark for each of the known failures.
#include "run/known_failures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/symmetric_solver.h"
#include "base/text.h"
#include "base/units.h"
#include "contact/hertz.h"
#include "contact/passivity.h"
#include "contact/patch.h"
#include "geometry/curvature.h"
#include "scene/first_touch.h"
#include "tissue/coupled.h"
#include "tissue/part.h"
#include "tissue/springs.h"

namespace palpate::run {
namespace {

using scenario::Contact;

std::string millimetres(double length) { return rounded_text(unit::mm.from_si(length), 3) + " mm"; }

class KnownFailures {
 public:
  KnownFailures(const scene::Scene& scene, record::CaseRecord& record)
      : scene_(scene),
        record_(record),
        peak_(*std::max_element(
            record.contact.begin(), record.contact.end(),
            [](const auto& a, const auto& b) { return a.contact_force < b.contact_force; })) {}

  void all() {
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

 private:
  void add(const char* name, double value) { record_.findings.push_back({name, value}); }
  void remark(const std::string& sentence) { record_.remarks.push_back(sentence); }

  [[nodiscard]] double tolerance() const { return scene_.scenario.solver.tolerance; }

  // A fixed edge at the distance rho acts like a bonded base there, which raises the force by the
  // factor 1 + c sqrt(R h) / rho, c = 0.86 at nu = 0.27 to 1.13 at 1/2.    docs/theory.md (85)
  void edge() {
    if (!scene_.scenario.solver.rings) return;
    double share = 0.0;
    for (const record::Finding& finding : record_.findings)
      if (finding.name == "edge_reaction_over_force") share = std::get<double>(finding.value);
    const scene::Specimen& specimen = *scene_.specimen;
    const scene::FirstTouch touch = scene::first_touch(scene_);
    std::vector<int> start;
    for (const int vertex : specimen.surface->surface().triangles[as_index(touch.at.triangle)])
      start.push_back(specimen.skin[as_index(vertex)]);
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
    remark("the edge of the part that moves is " + millimetres(nearest) +
           " from the contact and carries " + percent_text(share) +
           " of its force: a base that near stiffens a half-space by at least " +
           percent_text(stiffening) + "; give more `solver.rings`, or \"all\"");
  }

  // Mean static displacement of the skin under a Hertz pressure of 1 N, m/N; 0 if not rigid.
  [[nodiscard]] double sinking(const tissue::Network& network) const {
    const scene::Specimen& specimen = *scene_.specimen;
    SymmetricSolver solver;
    if (!solver.prepare(tissue::stiffness_matrix(network), specimen.held)) return 0.0;
    contact::Patch patch;
    patch.at = scene::first_touch(scene_).at;
    patch.position = specimen.surface->position(patch.at);
    patch.normal = specimen.surface->normal(patch.at);
    patch.axis = patch.normal.unitOrthogonal();
    patch.a = patch.b = peak_.contact_radius;
    contact::Spread spread;
    contact::Spreader(*specimen.surface).spread(patch, spread);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * network.nodes());
    for (std::size_t k = 0; k < spread.vertices.size(); ++k)
      load.segment<3>(3 * specimen.skin[as_index(spread.vertices[k])]) -=
          spread.shares[k] * patch.normal;
    Eigen::VectorXd moved;
    return solver.solve(load, moved) ? load.dot(moved) : 0.0;
  }

  // Compares with the same mesh with volumes averaged at nodes.
  void locking() {
    const scenario::Resolved::Solver& solver = scene_.scenario.solver;
    if (solver.volume != tissue::Volume::tetrahedron || !scenario::rung(solver.model).coupled() ||
        !scene_.scenario.regions.empty())
      return;
    const scene::Specimen& specimen = *scene_.specimen;
    const double ratio = specimen.measured.poisson_ratio;
    tissue::Network averaged = specimen.network;
    const std::array tissues{tissue::Isotropic{specimen.measured.young_modulus,
                                               std::min(ratio, scene::most_poisson_ratio)}};
    tissue::couple(averaged, specimen.mesh, tissues, tissue::Volume::nodal, scene::own_share);
    const double locked = sinking(averaged) / sinking(specimen.network);
    add("locking", locked);
    constexpr double most = 1.25;  // meshes that do not lock differ by up to 12 % (nu = 0.45)
    if (locked > most)
      remark("volumes of single tetrahedra lock at nu " + rounded_text(ratio) +
             ": under the finger the mesh sinks " + rounded_text(locked, 2) +
             " times less than with volumes averaged at nodes; write `solver.volume = \"nodal\"`");
  }

  // The displacement is of the order F / (E l) with the cell size l and does not converge.
  void one_node() {
    if (scene_.scenario.contact.spread != Contact::Spread::nearest_node) return;
    double sunk = 0.0;
    for (const record::Finding& finding : record_.findings)
      if (finding.name == "sinking_mm") sunk = unit::mm.to_si(std::get<double>(finding.value));
    remark("all of the force is on one node, which has sunk by " + millimetres(sunk) +
           ": it would sink about twice as deep on a mesh of half the cells' size; write "
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
      remark("curvature without its sign is " + rounded_text(lost, 3) +
             " 1/m where the tissue has " + rounded_text(kept, 3) +
             " 1/m: it is hollow there in some direction; write `contact.curvature = \"quadric\"`");
  }

  // Without sticking, the whole friction force appears or vanishes from one row to the next.
  void sudden_friction() {
    const scenario::PlainContact& contact = scene_.scenario.contact;
    if (contact.slip != Contact::Slip::coulomb || contact.friction <= 0.0) return;
    double jump = 0.0;
    for (std::size_t i = 1; i < record_.contact.size(); ++i)
      jump = std::max(jump,
                      std::abs(record_.contact[i].tangential - record_.contact[i - 1].tangential));
    add("friction_jump_N", jump);
    if (jump > 0.5 * contact.friction * peak_.contact_force)
      remark("friction jumped by " + rounded_text(jump, 3) +
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
      remark("when the finger turned back the force fell from " + rounded_text(before, 3) + " to " +
             rounded_text(after, 3) +
             " N within a row: Kelvin-Voigt's dashpots follow the rate, which turns at once; write "
             "`tissue.viscosity = \"standard_linear_solid\"`");
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
      remark("a device of " + quantity_text(*asked.damping, unit::N_s_per_m) + " and frames of " +
             quantity_text(asked.frame, unit::ms) + " generates energy below " +
             millimetres(depth) + ": at " + millimetres(peak_.indentation) + " the contact needs " +
             rounded_text(needed, 3) +
             " N s/m (Colgate and Brown); shorten `device.frame`, or press less deep");
  }

  const scene::Scene& scene_;
  record::CaseRecord& record_;
  record::ContactRow peak_;
};

}  // namespace

void add_known_failures(const scene::Scene& scene, record::CaseRecord& record) {
  if (!record.contact.empty()) KnownFailures(scene, record).all();
}

}  // namespace palpate::run
