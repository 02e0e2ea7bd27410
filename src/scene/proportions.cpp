// Compares displacement, finger and body.
#include "scene/proportions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "meshing/mesh_check.h"
#include "scene/places.h"

namespace palpate::scene {
namespace {

// Of the thickness, for the tissue's share of a displacement.
constexpr double through = 0.9;
constexpr double deep = 0.5;

// Of the longest side of the body's box in its file, m.
double length(const SurfaceTouch& touch) { return (touch.high - touch.low).maxCoeff(); }

// "; with another unit of `tissue.shape` ...", of a body from a file.
std::string unit_text(const scenario::Resolved& scenario, const SurfaceTouch& touch) {
  const auto* surface = std::get_if<scenario::SurfaceFile>(&scenario.tissue.shape);
  const auto* mesh = std::get_if<scenario::MeshFile>(&scenario.tissue.mesh);
  const bool meshed = std::holds_alternative<scenario::AsMeshed>(scenario.tissue.shape);
  if (surface == nullptr && (mesh == nullptr || !meshed)) return "";
  const std::string others =
      meshing::other_units(length(touch), surface != nullptr ? surface->unit : mesh->unit);
  return std::string(" and `unit` of `tissue.") + (surface != nullptr ? "shape`" : "mesh`") +
         (others.empty() ? "" : ": " + others);
}

// As the body lies in its file.
std::string size_text(const SurfaceTouch& touch) {
  const Vec3 size = touch.high - touch.low;
  std::string text;
  for (int axis = 0; axis < 3; ++axis)
    text += (axis == 0 ? "" : " x ") + rounded_text(unit::mm.from_si(size[axis]), 3);
  return text + " mm";
}

std::string mm_text(double length) { return rounded_text(unit::mm.from_si(length), 3) + " mm"; }

// How far from the surface `finger.at` may be, and from the place that is pressed.
double near(const scenario::Resolved& scenario, const SurfaceTouch& touch) {
  constexpr double share = 0.1;
  return std::max(scenario.finger.radius, share * length(touch));
}

// "the finger comes from outside and meets the body at ... mm, 40 mm before the place of `at`", if
// it does; otherwise empty.
std::string meets_before(const scenario::Resolved& scenario, const SurfaceTouch& touch) {
  if (!scenario.finger.height || touch.nowhere || !touch.size.allFinite()) return "";
  const double before = touch.position.z() - *scenario.finger.height;
  if (before <= near(scenario, touch)) return "";
  return "the finger comes from outside the body and meets it at " +
         place_text(scenario, touch.position) + ", " + mm_text(before) +
         " before the place of `at`";
}

}  // namespace

std::size_t step_through(const scenario::Resolved& scenario, const SurfaceTouch& touch,
                         const Estimates& estimates) {
  if (!touch.size.allFinite()) return 0;
  for (std::size_t i = 0; i < scenario.steps.size(); ++i)
    if (const auto* indent = std::get_if<scenario::Indent>(&scenario.steps[i]))
      if (!indent->to.second &&
          (estimates.tissue_share * indent->to.value > through * touch.to_base ||
           indent->to.value > length(touch)))
        return i + 1;
  return 0;
}

void refuse_through(const scenario::Resolved& scenario, const SurfaceTouch& touch,
                    const Estimates& estimates, const scenario::Family& family) {
  const std::size_t step = step_through(scenario, touch, estimates);
  if (step == 0) return;
  const double to = std::get<scenario::Indent>(scenario.steps[step - 1]).to.value;
  throw InputError(
      place_of(family.document, "step." + std::to_string(step) + ".to"),
      "`to` of " + quantity_text(to, unit::mm) +
          (std::isfinite(touch.to_base)
               ? (estimates.tissue_share * to < touch.to_base
                      ? " takes more than " + percent_text(through) + " of the "
                      : std::string(" presses through the ")) +
                     (touch.tissue_to_base < touch.to_base ? "hollow body" : "tissue") +
                     ", which is " + mm_text(touch.to_base) +
                     " thick between the finger and what holds it"
               : " is more than the length of the body, which is " + size_text(touch)) +
          "; press less deep, or check the size of the body" + unit_text(scenario, touch));
}

void refuse_beside(const scenario::Resolved& scenario, const SurfaceTouch& touch,
                   const scenario::Family& family) {
  if (!touch.size.allFinite()) return;
  const std::string before = meets_before(scenario, touch);
  if (!before.empty() && scenario.finger.towards.empty())
    throw InputError(
        place_of(family.document, "finger.at"),
        before +
            ", which lies on an inner wall, or on a surface so rough that its normal leads through "
            "another place; give a place on the outside, `finger.towards`, or a smoother surface");
  const double distance = scenario.finger.beside;
  if (distance <= near(scenario, touch)) return;
  throw InputError(place_of(family.document, "finger.at"),
                   "`at` is " + mm_text(distance) + " from the surface of the body, which has " +
                       box_text({touch.low, touch.high}) + ", " + coordinates_text(scenario) +
                       "; give a place on the surface, and check its unit" +
                       unit_text(scenario, touch));
}

std::vector<std::string> disproportions(const scenario::Resolved& scenario,
                                        const SurfaceTouch& touch, const Estimates& estimates) {
  std::vector<std::string> found;
  if (!touch.size.allFinite()) return found;
  const std::string units = unit_text(scenario, touch);
  const double travel = estimates.tissue_share * estimates.travel;
  const double hollow = touch.to_base - touch.tissue_to_base;
  if (travel > deep * touch.tissue_to_base)
    found.push_back(
        "the press takes " + percent_text(travel / touch.tissue_to_base) +
        " of the tissue, which is " + mm_text(touch.tissue_to_base) +
        " thick between the finger and what holds it" +
        (hollow > 0.0 ? " (without " + mm_text(hollow) + " that are hollow)" : "") +
        ": few tissues are tested at such strains; press less deep, or check the size of the body" +
        units);
  else if (hollow > 0.0 && travel > hollow)
    found.push_back("the press is deeper than the " + mm_text(hollow) +
                    " that are hollow under the finger: the curve of `solid` ends where the walls "
                    "meet, and springs pass through each other there; press less deep");
  const double width = touch.size.head<2>().minCoeff();
  const double radius = scenario.finger.radius;
  if (radius > width || estimates.contact_radius > 0.5 * width)
    found.push_back("the finger of radius " + mm_text(radius) +
                    " is wider than the body, which is " + size_text(touch) +
                    ": it presses like a plate; check `finger.radius`" + units);
  if (const std::string before = meets_before(scenario, touch); !before.empty())
    found.push_back(before + "; change `finger.at` or `finger.towards` if that is not meant");
  constexpr double aslant = 10.0;  // degrees
  const double off = std::acos(std::clamp(touch.around.z(), -1.0, 1.0)) * 180.0 / std::numbers::pi;
  if (off > aslant) {
    std::string towards;
    for (const double part : Vec3(-scenario.tissue.turn.transpose() * touch.around))
      towards +=
          (towards.empty() ? "" : " ") + rounded_text(std::abs(part) < 0.005 ? 0.0 : part, 2);
    found.push_back(
        "the press is along the normal at the place of `at`, and the mean normal of "
        "the surface around is " +
        rounded_text(off, 2) +
        " degrees off it; if another direction is meant, give it, as `finger.towards "
        "= \"" +
        towards + "\"` for the mean");
  }
  constexpr double longest = 2.0;  // m
  if (!units.empty() && length(touch) > longest)
    found.push_back("the body is " + size_text(touch) + "; check its size" + units);
  return found;
}

}  // namespace palpate::scene
