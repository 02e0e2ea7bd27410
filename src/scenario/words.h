// The words for the values of a scenario's choices, in the order of their enumerations, and the
// words for choices that may be left open.
#pragma once

#include "scenario/integrators.h"

namespace palpate::scenario::words {

using palpate::word;

inline constexpr auto viscosities = words_of<tissue::Viscosity>(
    {{"none", "springs only"},
     {"nodal_drag", "mass-proportional damping: every node against the ground, eq. (10)"},
     {"kelvin_voigt", "a dashpot along every spring, Fig. 4"},
     {"standard_linear_solid", "a spring and dashpot branch beside every spring"},
     {"prony", "several such branches, `[[tissue.branch]]`"}});
inline constexpr Word auto_bases{"auto", "bonded under a finger, frictionless in uniform tests"};
inline constexpr auto bases = words_of<tissue::Base>(
    {{"bonded", "it does not move"}, {"frictionless", "it slides on the table"}});
inline constexpr auto weights =
    words_of<Finger::Weight>({{"in_contact", "the weight is part of the contact force"},
                              {"apart", "the friction limit counts the weight as well, eq. (4)"}});
inline constexpr auto calibrations = words_of<finger::Calibration>(
    {{"mass", "eq. (5) alone: together they press `spheres`^(5/6) times as hard"},
     {"force",
      "on a flat they exert the force of the single sphere of `radius`, which `solid` presses in "
      "their place"}});
inline constexpr auto regressions = words_of<Output::Regression>(
    {{"none", "the computed curves alone"},
     {"logarithmic", "`F = a + b ln h`, the paper's Fig. 6"},
     {"power", "`F = A h^n`; Hertz's law has n = 1.5"},
     {"exponential", "`F = B (exp(m h) - 1)`, as of measured fingerpads"}});
inline constexpr auto papers =
    words_of<Output::Paper>({{"none", "no comparison"},
                             {"figure_6", "force against indentation and curvature"},
                             {"figure_7", "creep and recovery"}});
inline constexpr auto meshes_at = words_of<Output::Meshes>(
    {{"steps", "the end of every step"}, {"rows", "every row of the CSV files"}});
inline constexpr auto keeps =
    words_of<Slide::Keep>({{"displacement", "the depth"}, {"force", "the force"}});
inline constexpr auto laws =
    words_of<contact::CurvatureLaw>({{"elliptic", "both principal curvatures, exactly"},
                                     {"geometric", "a circle with R = 1 / sqrt(k_1 k_2)"},
                                     {"mean", "a circle with the mean curvature, eq. (2)"}});
inline constexpr auto curvature_methods = words_of<geometry::CurvatureMethod>(
    {{"quadric", "a local quadric, second order"},
     {"taubin", "eq. (6)-(9), signed; does not converge"},
     {"taubin_unsigned", "eq. (9) as printed: its arccos treats concave as convex"}});
inline constexpr auto loaded = words_of<Contact::Spread>(
    {{"pressure", "over the nodes that the contact's pressure reaches"},
     {"nearest_node", "all on one node, whose displacement grows as the mesh is refined"}});
inline constexpr auto slips = words_of<Contact::Slip>(
    {{"mindlin", "stick, partial slip, then Coulomb's limit: without a jump"},
     {"coulomb", "eq. (4) at once: mu F against the motion, and none at rest"}});
inline constexpr auto curvature_surfaces = words_of<Contact::CurvatureOn>(
    {{"rest", "of the undeformed tissue"},
     {"deformed", "of the deformed tissue; the run ends if it conforms to the finger"}});
inline constexpr auto couplings = words_of<contact::Coupling>(
    {{"one_way", "eq. (2) with the finger's displacement; the mesh does not change the force"},
     {"series",
      "the finger's displacement minus the mesh's there; counts the tissue's compliance twice"},
     {"consistent",
      "the finger's displacement minus the part of the mesh's that Hertz's law does not contain"},
     {"resolved", "the mesh represents the whole tissue; needs three cells per contact radius"}});
inline constexpr Word auto_contact_viscosities{
    "auto", "`tissue` where the scenario gives `tissue.viscosity`"};
inline constexpr auto contact_viscosities = words_of<Contact::Viscosity>(
    {{"none", "the force of the relaxed tissue"},
     {"tissue", "Lee and Radok's theory while the contact grows, Ting's while it shrinks"}});
inline constexpr Word auto_depths{
    "auto", "`neo_hookean` where `auto` or a named `layer` finds that it matters"};
inline constexpr auto depths = words_of<Contact::Depth>(
    {{"hertz", "h^(3/2), however deep"},
     {"neo_hookean", "the force times the factor of a deep press into neo-Hookean tissue"}});
inline constexpr Word auto_directions{
    "auto", "`surface` with linear kinematics, `sphere` with nonlinear ones"};
inline constexpr auto directions = words_of<Contact::Direction>(
    {{"surface", "the surface's normals at rest, consistent with small strains"},
     {"sphere", "the sphere's normals at the displaced nodes"}});
inline constexpr Word auto_models{
    "auto", "the cheapest model that meets `tolerance`, one for all cases of a sweep"};
inline constexpr Words<Model, model_table.size()> models(model_table);
inline constexpr Word auto_volumes{"auto",
                                   "`nodal` with `coupled_springs`, `none` with `mass_spring`"};
inline constexpr auto volumes =
    words_of<Solver::Volume>({{"none", "springs alone, which have a Poisson's ratio near 1/4"},
                              {"tetrahedron", "of every tetrahedron; locks towards nu = 1/2"},
                              {"nodal", "averaged over the tetrahedra around every node"}});
inline constexpr Word auto_integrators{
    "auto",
    "`quasi_static` in uniform tests, in slow presses by springs without viscosity, where the "
    "mesh's motion cannot reach the force, or where `model = \"auto\"` finds that inertia does not "
    "matter; else `central_difference`"};
inline constexpr Words<Solver::Integrator, integrator_table.size()> integrators(integrator_table);
inline constexpr auto starts = words_of<integrate::Start>(
    {{"consistent", "second order"}, {"paper", "U(-dt) = U(0), first order"}});
inline constexpr auto damping_velocities = words_of<Solver::Damping>(
    {{"centred", "the mean over this step and the one before, eq. (12)"},
     {"lagged", "of the step before: first order, and stable for shorter steps only"}});
inline constexpr auto stiffnesses = words_of<tissue::StiffnessRule>(
    {{"van_gelder", "k = E sum(V) / l^2"}, {"fitted", "least squares towards isotropy"}});
inline constexpr auto kinematics_words =
    words_of<Solver::Kinematics>({{"linear", "eq. (11)-(12)"}, {"nonlinear", "eq. (10)"}});

}  // namespace palpate::scenario::words
