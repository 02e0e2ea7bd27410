// Compares what a model represents with the estimates of all effects.
#include "run/left_out.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "scenario/integrators.h"

namespace palpate::run {
namespace {

std::string would(double change) {
  return std::string("which would ") + (change < 0.0 ? "take " : "add ") +
         percent_text(std::abs(change)) + (change < 0.0 ? " off" : " to") + " the force";
}

class LeftOuts {
 public:
  explicit LeftOuts(const scene::Scene& scene)
      : scene_(scene),
        rung_(scenario::rung(scene.scenario.solver.model)),
        e_(scene.choice.expected) {}

  std::vector<LeftOut> all() {
    if (scene_.scenario.uniform()) {
      ringing();
    } else {
      size();
      overhang();
      double_counting();
      large_strains();
      viscosity();
      waves();
    }
    std::stable_sort(all_.begin(), all_.end(), [](const LeftOut& a, const LeftOut& b) {
      return std::abs(a.change) > std::abs(b.change);
    });
    return std::move(all_);
  }

 private:
  [[nodiscard]] double tolerance() const { return scene_.scenario.solver.tolerance; }
  [[nodiscard]] bool one_way() const {
    return scene_.scenario.contact.coupling == contact::Coupling::one_way;
  }
  [[nodiscard]] bool mesh_is_tissue() const {
    return contact::mesh_is_tissue(scene_.scenario.contact.coupling);
  }
  void omit(const std::string& what, double change, const std::string& when,
            const std::string& remedy = "", const std::string& beside = "") {
    all_.push_back({what, change, when, remedy, beside});
  }

  void size() {
    if (scene_.size_ratio) return;
    const std::string free = one_way()             ? "leave out `contact.coupling`"
                             : scene_.choice.given ? "leave out `solver.model`"
                                                   : "";
    const bool none = !rung_.thickness || one_way();
    if (none && e_.thickness * e_.tissue_share > tolerance())
      omit("the thickness of the tissue", e_.thickness, would(e_.thickness), free);
    if ((none || !rung_.sides) && e_.sides > tolerance())
      omit("the sides of the body", -e_.sides, would(-e_.sides), free);
    if (none && e_.curved_body > 0.0 && e_.narrow > tolerance())
      omit("the width of the body and of its base", -e_.narrow, would(-e_.narrow), free);
  }

  void overhang() {
    const double most = e_.overhang * (2.0 - e_.overhang);  // as ModelErrors counts it
    if (!mesh_is_tissue() && most > 0.2 * tolerance())
      omit("that the contact reaches beyond an edge of the body", -most,
           "which may take up to " + percent_text(most) + " off the force",
           "press farther from the edge");
  }

  // By how much a half-space under `series` is too soft.                    docs/theory.md (10)
  void double_counting() {
    if (!scene_.specimen || scene_.scenario.contact.coupling != contact::Coupling::series) return;
    const double change = std::pow(2.0 - scene_.finger.compliance_share, 1.5) - 1.0;
    omit("counting the softness of the tissue once only", change, would(change),
         "leave out `contact.coupling`", "the softness that counts twice");
  }

  void large_strains() {
    if (rung_.solid || scene_.depth_ratio || std::abs(e_.deep) < 0.2 * tolerance()) return;
    std::string remedy;
    if (mesh_is_tissue())
      remedy = "set `solver.model = \"neo_hookean\"`";
    else if (e_.depth_ratio)
      remedy = "add `contact.depth = \"neo_hookean\"`";
    omit("large strains", e_.deep, would(e_.deep) + " where it is deepest", remedy);
  }

  void viscosity() {
    if (!scene_.relaxation.elastic() || (mesh_is_tissue() && !rung_.solid) ||
        e_.viscous <= 0.2 * tolerance())
      return;
    std::string remedy = "add `contact.viscosity = \"tissue\"`";
    if (rung_.solid) remedy = "";
    if (one_way()) remedy += " and leave out `contact.coupling`";
    omit("viscosity", e_.viscous, would(e_.viscous) + " while pressing", remedy, "viscosity");
  }

  void waves() {
    if (e_.inertia <= tolerance()) return;
    const std::string when = would(e_.inertia) + " at this speed";
    if (!rung_.inertia) return omit("waves in the tissue", e_.inertia, when, mesh_with_waves());
    if (scene::inertia_reaches_force(scene_.scenario) || mesh_is_tissue()) return;
    omit("waves in the tissue", e_.inertia, when,
         "take an integrator with inertia and `tissue.viscosity = \"none\"`, or "
         "`contact.coupling = \"resolved\"`");
  }

  // Waves reach the force of a mesh where its springs do not damp them.
  [[nodiscard]] std::string mesh_with_waves() const {
    if (rung_.solid) return "";
    std::string mesh = "set `solver.model = \"coupled_springs\"`";
    if (scene_.scenario.tissue.viscosity != tissue::Viscosity::none)
      mesh += " and `tissue.viscosity = \"none\"`";
    return mesh;
  }

  void ringing() {
    const double inertia = scene::uniform_inertia(scene_.scenario);
    if (about(scene_.scenario.solver.integrator).inertia || inertia < tolerance()) return;
    omit("the ringing of the body", inertia,
         "which would change the strain by up to " + percent_text(inertia),
         "set `solver.integrator = \"central_difference\"`");
  }

  const scene::Scene& scene_;
  const scenario::Rung& rung_;
  const scene::Estimates& e_;
  std::vector<LeftOut> all_;
};

}  // namespace

std::vector<LeftOut> left_out(const scene::Scene& scene) { return LeftOuts(scene).all(); }

}  // namespace palpate::run
