// What a case tests, in the words of its pages.
#include "scenario/tested.h"

#include <algorithm>
#include <filesystem>

#include "base/text.h"
#include "base/units.h"

namespace palpate::scenario {
namespace {

using Keys = std::vector<std::string>;

// Whether no varied key is one of these, or contains one, or lies in one.
bool common(const Keys& varied, const Keys& keys) {
  const auto within = [](const std::string& inner, const std::string& outer) {
    return inner == outer || inner.starts_with(outer + ".");
  };
  return std::ranges::none_of(varied, [&](const std::string& key) {
    return std::ranges::any_of(
        keys, [&](const std::string& of) { return within(key, of) || within(of, key); });
  });
}

std::string mm(double metres) { return rounded_text(unit::mm.from_si(metres), 4) + " mm"; }

std::string modulus_text(double modulus) {
  return "E " + rounded_text(unit::kPa.from_si(modulus), 3) + " kPa";
}

std::string material_name(const std::string& name) { return name.substr(name.rfind('#') + 1); }

std::string tissue_text(const Case& one, const Keys& varied) {
  const Tissue& tissue = one.scenario.tissue;
  Keys parts;
  if (common(varied, {"tissue.material"})) parts.push_back(material_name(tissue.material));
  if (common(varied, {"tissue.material", "tissue.young_modulus"}))
    parts.push_back(
        modulus_text(tissue.young_modulus.value_or(one.materials.tissue.young_modulus.value)));
  if (common(varied, {"tissue.material", "tissue.poisson_ratio"}))
    parts.push_back("nu " + rounded_text(poisson_ratio(one), 3));
  if (tissue.viscosity == tissue::Viscosity::none && common(varied, {"tissue"}))
    parts.emplace_back("elastic");
  return parts.empty() ? "" : "Tissue: " + joined(parts, ", ");
}

std::string shape_text(const Shape& shape) {
  if (const auto* box = std::get_if<Cuboid>(&shape)) {
    Keys edges;
    for (const double edge : box->size) edges.push_back(rounded_text(unit::mm.from_si(edge), 4));
    return "block of " + joined(edges, " x ") + " mm";
  }
  if (const auto* surface = std::get_if<SurfaceFile>(&shape))
    return std::filesystem::path(surface->file).filename().string();
  if (std::holds_alternative<AsMeshed>(shape)) return "";
  std::string word = std::visit([](const auto& any) { return std::string(any.word.word); }, shape);
  std::ranges::replace(word, '_', word.starts_with("half") ? '-' : ' ');
  return word;
}

// `region 1: skin, E 1000 kPa`; of more than three their number.
std::string regions_text(const Case& one) {
  const std::vector<Region>& regions = one.scenario.regions;
  constexpr std::size_t most = 3;
  if (regions.size() > most) return std::to_string(regions.size()) + " regions of other tissue";
  Keys parts;
  for (std::size_t i = 0; i < regions.size(); ++i)
    parts.push_back("region " + std::to_string(i + 1) + ": " + material_name(regions[i].material) +
                    ", " +
                    modulus_text(regions[i].young_modulus.value_or(
                        one.materials.regions[i].young_modulus.value)));
  return joined(parts, "; ");
}

std::string target_text(const Indent& indent) {
  return indent.to.second ? "to " + quantity_text(indent.to.value, unit::N) : mm(indent.to.value);
}

std::string step_text(const Step& step) {
  if (const auto* hold = std::get_if<Hold>(&step))
    return "held for " + quantity_text(hold->time, unit::s);
  if (const auto* retract = std::get_if<Retract>(&step)) return "withdrawn to " + mm(retract->to);
  if (const auto* slide = std::get_if<Slide>(&step))
    return "slid by " + mm(slide->by) +
           (slide->keep == Slide::Keep::force ? " at the same force" : "");
  if (const auto* creep = std::get_if<Creep>(&step))
    return "creep under " + quantity_text(creep->stress, unit::kPa) + " for " +
           quantity_text(creep->load_time, unit::s) + ", then recovery for " +
           quantity_text(creep->recovery_time, unit::s);
  if (const auto* relax = std::get_if<Relax>(&step))
    return "relaxation at a strain of " + percent_text(relax->strain) + " for " +
           quantity_text(relax->time, unit::s);
  if (const auto* compress = std::get_if<Compress>(&step))
    return "compression to a strain of " + percent_text(compress->strain) + " in " +
           quantity_text(compress->ramp_time(), unit::s) +
           (compress->hold_time > 0.0
                ? ", then held for " + quantity_text(compress->hold_time, unit::s)
                : "") +
           "; upper platen " + (compress->platen == tissue::Base::bonded ? "bonded" : "slides");
  return "pressed " + target_text(std::get<Indent>(step));
}

// The first press with its finger, and what follows it, where that is not longer than a sentence.
std::string pressed_text(const Case& one, const Keys& varied, const Touched& touched) {
  const std::vector<Step>& steps = one.scenario.steps;
  const auto presses = [](const Step& step) { return std::holds_alternative<Indent>(step); };
  const auto first = std::ranges::find_if(steps, presses);
  if (first == steps.end()) return "";
  const bool told = common(varied, {"step"});
  const bool reached = !touched.depth.empty() && std::ranges::count_if(steps, presses) == 1;
  const Finger& finger = one.scenario.finger;
  std::string text = "pressed";
  if (told) text += " " + (reached ? touched.depth : target_text(std::get<Indent>(*first)));
  if (common(varied, {"finger"}))
    text += (finger.spheres == 1
                 ? std::string(" by a sphere")
                 : " by " + std::to_string(finger.spheres) + " spheres that stand for one") +
            " of radius " + mm(finger.radius) + touched.place;
  constexpr std::size_t most = 4;
  if (!told || first + 1 == steps.end()) return text;
  if (steps.size() > most) return text + ", in " + std::to_string(steps.size()) + " steps";
  for (auto step = first + 1; step != steps.end(); ++step) text += ", then " + step_text(*step);
  return text;
}

}  // namespace

std::vector<std::string> tested(const Case& one, const std::vector<std::string>& varied,
                                const Touched& touched) {
  Keys parts{tissue_text(one, varied)};
  if (common(varied, {"tissue.shape", "tissue.mesh"}))
    parts.push_back(shape_text(one.scenario.tissue.shape));
  if (common(varied, {"region"})) parts.push_back(regions_text(one));
  if (!one.scenario.uniform())
    parts.push_back(pressed_text(one, varied, touched));
  else if (common(varied, {"step"}))
    for (const Step& step : one.scenario.steps) parts.push_back(step_text(step));
  std::erase(parts, "");
  return parts;
}

}  // namespace palpate::scenario
