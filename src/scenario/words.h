// The words that a scenario's choices are written with, in the order of their enumerations.
#pragma once

#include <array>

#include "base/fields.h"

namespace palpate::scenario::words {

// The word of a value.
template <class Enum, std::size_t count>
[[nodiscard]] const char* word(const std::array<Word, count>& words, Enum value) {
  return words[static_cast<std::size_t>(value)].word;
}

inline constexpr std::array viscosities{
    Word{"none", "springs only"},
    Word{"nodal_drag", "drag of every node against the ground, eq. (10)"},
    Word{"kelvin_voigt", "a dashpot along every spring, Fig. 4"},
    Word{"standard_linear_solid", "a spring and dashpot branch beside every spring"},
    Word{"prony", "several such branches, `[[tissue.branch]]`"}};
inline constexpr std::array bases{
    Word{"auto", "bonded under a finger, frictionless in uniform tests"},
    Word{"bonded", "it does not move"}, Word{"frictionless", "it slides on the table"}};
inline constexpr std::array weights{Word{"in_contact", "the weight is part of the contact force"},
                                    Word{"apart", "friction counts the weight besides, eq. (4)"}};
inline constexpr std::array calibrations{
    Word{"mass", "eq. (5) alone: they press spheres^(5/6) times as hard"},
    Word{"force", "together they press a flat like the one sphere of `radius`"}};
inline constexpr std::array keeps{Word{"travel", "the depth"}, Word{"force", "the force"}};
inline constexpr std::array laws{Word{"elliptic", "both principal curvatures, exactly"},
                                 Word{"geometric", "a circle with R = 1 / sqrt(k_1 k_2)"},
                                 Word{"mean", "a circle with the mean curvature, eq. (2)"}};
inline constexpr std::array curvature_methods{
    Word{"quadric", "a local quadric, second order"},
    Word{"taubin", "eq. (6)-(9), signed; does not converge"},
    Word{"taubin_unsigned", "eq. (9) as printed: its arccos takes hollow for convex"}};
inline constexpr std::array loaded{
    Word{"pressure", "over the nodes that the contact's pressure reaches"},
    Word{"nearest_node", "all on one node, which sinks the deeper the finer the mesh is"}};
inline constexpr std::array slips{
    Word{"mindlin", "stick, partial slip, then Coulomb's limit: without a jump"},
    Word{"coulomb", "eq. (4) at once: mu F against the motion, and none at rest"}};
inline constexpr std::array curvature_surfaces{
    Word{"rest", "the tissue's own shape"},
    Word{"deformed", "as it is pressed; where it conforms to the finger the run ends"}};
inline constexpr std::array couplings{
    Word{"one_way", "eq. (2) with the finger's travel; the mesh only follows"},
    Word{"series", "travel less the mesh's sinking under the contact; counts the tissue twice"},
    Word{"consistent", "less only that sinking which Hertz does not know"},
    Word{"resolved", "the mesh carries all of the tissue; wants three cells a contact radius"}};
inline constexpr std::array contact_viscosities{
    Word{"auto", "`tissue` where the scenario gives `tissue.viscosity`"},
    Word{"none", "the force of the relaxed tissue"},
    Word{"tissue", "Lee and Radok's while the contact grows, Ting's while it shrinks"}};
inline constexpr std::array depths{
    Word{"auto", "`neo_hookean` where `model = \"auto\"` finds that it matters"},
    Word{"hertz", "h^(3/2), however deep"},
    Word{"neo_hookean", "times the factor of a deep press into neo-Hookean tissue"}};
inline constexpr std::array directions{
    Word{"auto", "`skin` with linear kinematics, `sphere` with nonlinear ones"},
    Word{"skin", "the skin's normals at rest: linear, as small strains are"},
    Word{"sphere", "the sphere's normals at the nodes as they have moved"}};
inline constexpr std::array models{
    Word{"auto", "the cheapest that meets `tolerance`"}, Word{"hertz", "eq. (1)-(4), no mesh"},
    Word{"layer", "a flat of finite thickness, exactly, no mesh"},
    Word{"mass_spring", "the paper's springs along tetrahedron edges"},
    Word{"coupled_springs", "the same springs pulling on each other, so that they have E and nu"}};
inline constexpr std::array volumes{
    Word{"auto", "`nodal` with `coupled_springs`, `none` with `mass_spring`"},
    Word{"none", "springs alone, which have a Poisson's ratio near 1/4"},
    Word{"tetrahedron", "of every tetrahedron; locks towards nu = 1/2"},
    Word{"nodal", "averaged over the tetrahedra around every node"}};
inline constexpr std::array integrators{
    Word{"auto",
         "`quasi_static` where `model = \"auto\"` finds that "
         "inertia does not matter, else `central_difference`"},
    Word{"central_difference", "explicit, eq. (12)"},
    Word{"semi_implicit_euler", "explicit, the new velocity first; first order"},
    Word{"backward_difference", "implicit Euler, first order"},
    Word{"tr_bdf2", "implicit, second order, L-stable; two solves a step"},
    Word{"quasi_static", "no inertia"},
    Word{"modal", "exact in time, linear only, up to 1000 nodes"}};
inline constexpr std::array starts{Word{"consistent", "second order"},
                                   Word{"paper", "U(-dt) = U(0), first order"}};
inline constexpr std::array damping_velocities{
    Word{"centred", "the mean over this step and the one before, eq. (12)"},
    Word{"lagged", "of the step before: first order, and stable for shorter steps only"}};
inline constexpr std::array stiffnesses{Word{"van_gelder", "k = E sum(V) / l^2"},
                                        Word{"fitted", "least squares towards isotropy"}};
inline constexpr std::array kinematics_words{Word{"linear", "eq. (11)-(12)"},
                                             Word{"nonlinear", "eq. (10)"}};

}  // namespace palpate::scenario::words
