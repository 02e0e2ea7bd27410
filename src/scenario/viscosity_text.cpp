// A tissue's viscous law in words.
#include "scenario/viscosity_text.h"

#include "base/text.h"
#include "base/units.h"

namespace palpate::scenario {

std::string viscosity_text(const Resolved::Tissue& tissue) {
  using tissue::Viscosity;
  switch (tissue.viscosity) {
    case Viscosity::none: break;
    case Viscosity::nodal_drag:
      return "nodal drag, d/m " + quantity_text(tissue.law.drag, unit::per_second);
    case Viscosity::kelvin_voigt:
      return "Kelvin-Voigt, retardation time " + quantity_text(tissue.law.time, unit::s);
    case Viscosity::standard_linear_solid:
      return "standard linear solid, relaxation time " +
             quantity_text(tissue.law.longest_time(), unit::s) + ", E_0 / E_inf " +
             number_text(tissue.law.instantaneous_ratio());
    case Viscosity::prony: {
      std::string text = "Prony series, relaxation";
      for (const Branch& branch : tissue.branches)
        text += (&branch == tissue.branches.data() ? " time " : "; time ") +
                quantity_text(branch.relaxation_time, unit::s) + ", ratio " +
                number_text(branch.ratio);
      return text;
    }
  }
  return "none";
}

}  // namespace palpate::scenario
