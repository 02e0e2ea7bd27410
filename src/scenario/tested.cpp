// What a case tests, in the words of its pages.
#include "scenario/tested.h"

#include <algorithm>
#include <filesystem>
#include <initializer_list>

#include "base/text.h"
#include "base/units.h"

namespace palpate::scenario {
namespace {

std::string mm(double metres) { return rounded_text(unit::mm.from_si(metres), 4) + " mm"; }

class Words {
 public:
  Words(const Case& one, const std::vector<std::string>& varied, const Touched& touched)
      : one_(one), scenario_(one.scenario), varied_(varied), touched_(touched) {}

  [[nodiscard]] std::vector<std::string> all() const {
    std::vector<std::string> parts{tissue(), shape(), regions(),
                                   scenario_.uniform() ? between_plates() : press()};
    std::erase(parts, "");
    return parts;
  }

 private:
  // Whether no varied key is one of these, or contains one, or lies in one.
  [[nodiscard]] bool common(std::initializer_list<const char*> keys) const {
    const auto within = [](const std::string& inner, const std::string& outer) {
      return inner == outer || inner.starts_with(outer + ".");
    };
    return std::none_of(varied_.begin(), varied_.end(), [&](const std::string& key) {
      return std::any_of(keys.begin(), keys.end(),
                         [&](const char* of) { return within(key, of) || within(of, key); });
    });
  }

  // `skin, E 72.4 kPa`
  static std::string material(const std::string& name, double modulus) {
    return name.substr(name.rfind('#') + 1) + ", E " + rounded_text(unit::kPa.from_si(modulus), 3) +
           " kPa";
  }

  [[nodiscard]] std::string tissue() const {
    const Tissue& tissue = scenario_.tissue;
    std::vector<std::string> parts;
    const std::string known = material(
        tissue.material, tissue.young_modulus.value_or(one_.materials.tissue.young_modulus.value));
    const std::size_t modulus = known.rfind(", E ");
    if (common({"tissue.material"})) parts.push_back(known.substr(0, modulus));
    if (common({"tissue.material", "tissue.young_modulus"}))
      parts.push_back(known.substr(modulus + 2));
    if (common({"tissue.material", "tissue.poisson_ratio"}))
      parts.push_back("nu " + rounded_text(poisson_ratio(one_), 3));
    if (tissue.viscosity == tissue::Viscosity::none && common({"tissue"}))
      parts.emplace_back("elastic");
    return parts.empty() ? "" : "Tissue: " + joined(parts, ", ");
  }

  [[nodiscard]] std::string shape() const {
    if (!common({"tissue.shape", "tissue.mesh"})) return "";
    const auto& shape = scenario_.tissue.shape;
    if (const auto* box = std::get_if<Cuboid>(&shape)) {
      std::string size;
      for (const double edge : box->size)
        size += (size.empty() ? "" : " x ") + rounded_text(unit::mm.from_si(edge), 4);
      return "block of " + size + " mm";
    }
    if (const auto* surface = std::get_if<SurfaceFile>(&shape))
      return std::filesystem::path(surface->file).filename().string();
    if (std::holds_alternative<AsMeshed>(shape)) return "";
    std::string word =
        std::visit([](const auto& any) { return std::string(any.word.word); }, shape);
    std::replace(word.begin(), word.end(), '_', word.starts_with("half") ? '-' : ' ');
    return word;
  }

  [[nodiscard]] std::string regions() const {
    const std::vector<Region>& regions = scenario_.regions;
    constexpr std::size_t most = 3;
    if (regions.size() > most) return std::to_string(regions.size()) + " regions of other tissue";
    if (!common({"region"})) return "";
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < regions.size(); ++i)
      parts.push_back(
          "region " + std::to_string(i + 1) + ": " +
          material(regions[i].material, regions[i].young_modulus.value_or(
                                            one_.materials.regions[i].young_modulus.value)));
    return joined(parts, "; ");
  }

  static std::string target(const Indent& indent) {
    return indent.to.second ? "to " + quantity_text(indent.to.value, unit::N) : mm(indent.to.value);
  }

  // What follows the first press, of a loading history that is not longer than a sentence.
  [[nodiscard]] std::string afterwards(std::size_t first) const {
    const std::vector<Step>& steps = scenario_.steps;
    constexpr std::size_t most = 4;
    if (!common({"step"}) || first + 1 >= steps.size()) return "";
    if (steps.size() > most) return ", in " + std::to_string(steps.size()) + " steps";
    std::string text;
    for (std::size_t i = first + 1; i < steps.size(); ++i) {
      text += ", then ";
      if (const auto* hold = std::get_if<Hold>(&steps[i]))
        text += "held for " + quantity_text(hold->time, unit::s);
      if (const auto* retract = std::get_if<Retract>(&steps[i]))
        text += "withdrawn to " + mm(retract->to);
      if (const auto* slide = std::get_if<Slide>(&steps[i]))
        text += "slid by " + mm(slide->by) +
                (slide->keep == Slide::Keep::force ? " at the same force" : "");
      if (const auto* indent = std::get_if<Indent>(&steps[i])) text += "pressed " + target(*indent);
    }
    return text;
  }

  [[nodiscard]] std::string press() const {
    const std::vector<Step>& steps = scenario_.steps;
    const auto presses = [](const Step& step) { return std::holds_alternative<Indent>(step); };
    const auto first = std::find_if(steps.begin(), steps.end(), presses);
    if (first == steps.end()) return "";
    const bool once = std::count_if(first, steps.end(), presses) == 1;
    const Finger& finger = scenario_.finger;
    std::string text = "pressed";
    if (common({"step"}))
      text += " " +
              (once && !touched_.depth.empty() ? touched_.depth : target(std::get<Indent>(*first)));
    if (common({"finger"}))
      text += (finger.spheres == 1
                   ? std::string(" by a sphere")
                   : " by " + std::to_string(finger.spheres) + " spheres that stand for one") +
              " of radius " + mm(finger.radius) + touched_.place;
    return text + afterwards(static_cast<std::size_t>(first - steps.begin()));
  }

  // `creep under 1 kPa for 5 s, then recovery for 5 s`
  [[nodiscard]] std::string between_plates() const {
    if (!common({"step"})) return "";
    std::vector<std::string> parts;
    for (const Step& step : scenario_.steps) {
      if (const auto* creep = std::get_if<Creep>(&step))
        parts.push_back("creep under " + quantity_text(creep->stress, unit::kPa) + " for " +
                        quantity_text(creep->load_time, unit::s) + ", then recovery for " +
                        quantity_text(creep->recovery_time, unit::s));
      if (const auto* relax = std::get_if<Relax>(&step))
        parts.push_back("relaxation at a strain of " + percent_text(relax->strain) + " for " +
                        quantity_text(relax->time, unit::s));
      if (const auto* compress = std::get_if<Compress>(&step))
        parts.push_back("compression to a strain of " + percent_text(compress->strain) + " in " +
                        quantity_text(compress->ramp_time(), unit::s) +
                        (compress->hold_time > 0.0
                             ? ", then held for " + quantity_text(compress->hold_time, unit::s)
                             : "") +
                        (compress->platen == tissue::Base::bonded ? "; upper platen bonded"
                                                                  : "; upper platen slides"));
    }
    return joined(parts, "; ");
  }

  const Case& one_;
  const Scenario& scenario_;
  const std::vector<std::string>& varied_;
  const Touched& touched_;
};

}  // namespace

std::vector<std::string> tested(const Case& one, const std::vector<std::string>& varied,
                                const Touched& touched) {
  return Words(one, varied, touched).all();
}

}  // namespace palpate::scenario
