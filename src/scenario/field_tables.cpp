// The keys of what presses, of the contact, the solver and the output.
#include "scenario/field_tables.h"

#include <algorithm>

#include "scenario/integrators.h"
#include "scenario/words.h"

namespace palpate::scenario {

using namespace words;

Conditions::Conditions(const Scenario& scenario) {
  const bool meshed = scenario.meshed();
  const char* const when = !meshed && scenario.solver.model == Solver::Model::automatic
                               ? "on another `tissue.shape` than `half_space`"
                               : "with `solver.model = \"mass_spring\"` or `\"coupled_springs\"`";
  mesh = {meshed, when, Use::Otherwise::note};
  mesh_physics = {meshed, when};
  springs = meshed ? Use{scenario.solver.model != Solver::Model::coupled_springs,
                         "with `solver.model = \"mass_spring\"`", Use::Otherwise::note}
                   : mesh;
  based = scenario.solver.model == Solver::Model::layer ? Use{} : mesh;
  // Of steps of both kinds, the mixture is the mistake, not the finger.
  const bool presses = std::any_of(scenario.steps.begin(), scenario.steps.end(), [](const Step& s) {
    return !std::holds_alternative<Creep>(s) && !std::holds_alternative<Relax>(s);
  });
  finger = {presses || scenario.steps.empty(),
            "by steps with a finger (indent, hold, retract, slide)"};
  pressed_mesh = meshed ? Use{finger.used, finger.when, Use::Otherwise::note} : mesh;
}

void finger_fields(FieldVisitor& visitor, Finger& finger) {
  visitor.text({"material", "`finger` (the paper's silicone rubber), any tissue, or `rigid`."},
               finger.material);
  visitor.quantity({"radius", "Of the one sphere that has the finger's mass."}, finger.radius,
                   unit::mm, above(0));
  visitor.count({"spheres", "Sphere bodies of equal mass that make up the finger, eq. (5)."},
                finger.spheres, between(1, 64));
  visitor.choice({"calibration",
                  "What several spheres keep of the one that they replace.",
                  {finger.spheres > 1, "with more than one of `spheres`", Use::Otherwise::note}},
                 finger.calibration, calibrations);
  visitor.quantity_or("auto", {"x", "Where it presses; `auto`: the middle of the specimen."},
                      finger.x, unit::mm, {});
  visitor.quantity_or("auto", {"y", "Likewise."}, finger.y, unit::mm, {});
  const Use elastic{finger.material != "rigid", "where the finger is not `rigid`"};
  visitor.quantity({"young_modulus", "Default: the material's.", elastic}, finger.young_modulus,
                   unit::kPa, above(0));
  visitor.number({"poisson_ratio", "Default: the material's.", elastic}, finger.poisson_ratio,
                 {.low = -1, .high = 0.5, .low_allowed = false});
  visitor.choice({"weight", "Where the finger's own weight counts."}, finger.weight, weights);
  visitor.quantity({"density",
                    "Default: the material's.",
                    {finger.weight == Finger::Weight::apart, "with `weight = \"apart\"`"}},
                   finger.density, unit::density, above(0));
}

void contact_fields(FieldVisitor& visitor, Contact& contact, const Conditions& use) {
  visitor.choice({"coupling", "How the contact sits on the mesh.", use.mesh}, contact.coupling,
                 couplings);
  visitor.choice({"law", "How the tissue's curvature enters."}, contact.law, laws);
  visitor.choice({"curvature", "How curvature is read from a mesh.", use.mesh}, contact.curvature,
                 curvature_methods);
  visitor.choice({"curvature_on", "Whose curvature.", use.mesh}, contact.curvature_on,
                 curvature_surfaces);
  visitor.count(
      {"curvature_rings", "Rings of vertices around the contact that it is read from.", use.mesh},
      contact.curvature_rings, between(1, 8));
  visitor.choice({"viscosity", "Whether the force knows the tissue's viscosity."},
                 contact.viscosity, contact_viscosities);
  visitor.choice({"depth", "How the force grows when the press is deep."}, contact.depth, depths);
  visitor.choice({"direction",
                  "Along what `resolved` measures gaps and presses.",
                  {contact.coupling == contact::Coupling::resolved,
                   "with `coupling = \"resolved\"`", Use::Otherwise::note}},
                 contact.direction, directions);
  visitor.choice({"spread", "How a contact's force is shared by the mesh's nodes.", use.mesh},
                 contact.spread, loaded);
  visitor.number({"friction", "Coulomb's coefficient mu."}, contact.friction, at_least(0));
  visitor.choice({"slip",
                  "How friction sets in.",
                  {contact.friction > 0.0, "with `friction` above 0", Use::Otherwise::note}},
                 contact.slip, slips);
  visitor.quantity({"ambient_force", "F_a of eq. (1), added to the force."}, contact.ambient_force,
                   unit::N, {});
}

void device_fields(FieldVisitor& visitor, Device& device) {
  visitor.quantity(
      {"damping", "Its own; where given, the findings say what it can show passively."},
      device.damping, unit::N_s_per_m, at_least(0));
  visitor.quantity({"frame",
                    "From one force to the next.",
                    {device.damping.has_value(), "with `device.damping`", Use::Otherwise::note}},
                   device.frame, unit::ms, above(0));
}

void solver_fields(FieldVisitor& visitor, Solver& solver, const Conditions& use) {
  visitor.choice({"model", "The rung of the ladder."}, solver.model, models);
  visitor.number({"tolerance", "Relative error of the force that `auto` may leave."},
                 solver.tolerance,
                 {.low = 0, .high = 1, .low_allowed = false, .high_allowed = false});
  visitor.choice({"stiffness", "Spring stiffness from Young's modulus.", use.springs},
                 solver.stiffness, stiffnesses);
  visitor.choice({"volume", "How a change of volume is resisted.", use.mesh}, solver.volume,
                 volumes);
  visitor.choice({"kinematics", "Springs about their rest directions, or truly turning.", use.mesh},
                 solver.kinematics, kinematics_words);
  visitor.choice({"integrator", "How time is stepped.", use.mesh}, solver.integrator, integrators);
  const bool automatic = solver.integrator == Solver::Integrator::automatic;
  const bool central = automatic || solver.integrator == Solver::Integrator::central_difference;
  const auto of_steps = [&](bool used, const char* when) {
    return use.mesh.used ? Use{used, when, Use::Otherwise::note} : use.mesh;
  };
  const Use centred = of_steps(central, "with `integrator = \"central_difference\"`");
  const Use stepped = of_steps(automatic || explicit_steps(solver.integrator),
                               "with an explicit `integrator`, as \"central_difference\"");
  visitor.choice({"start", "The step before the first.", centred}, solver.start, starts);
  visitor.choice({"damping", "The velocity that drag and dashpots take in a step.", centred},
                 solver.damping, damping_velocities);
  visitor.quantity_or("auto", {"time_step", "`auto`: the output interval.", use.mesh},
                      solver.time_step, unit::ms, above(0));
  visitor.count_or("auto",
                   {"substeps",
                    "Each time step is cut into; `auto`: as many as stability, or for "
                    "implicit methods accuracy, asks for.",
                    use.mesh},
                   solver.substeps, between(1, 1e8));
  visitor.flag({"allow_unstable",
                "Run an explicit step above the limit all the same, to see it "
                "fail.",
                stepped},
               solver.allow_unstable);
  visitor.count_or(
      "all",
      {"rings", "Rings of nodes around the contact that move; the others stand.", use.pressed_mesh},
      solver.rings, between(1, 1000));
}

void output_fields(FieldVisitor& visitor, Output& output, const Conditions& use) {
  visitor.quantity({"interval", "Time between rows of the CSV files."}, output.interval, unit::ms,
                   above(0));
  visitor.quantity_list({"force_at",
                         "Indentations at which the force of the first `indent` is a finding, such "
                         "as `force_at_1_mm_N`.",
                         use.finger},
                        output.force_at, unit::mm, above(0));
  visitor.flag({"pressure_maps",
                "An EXR map at the end of every step.",
                {use.finger.used, use.finger.when, Use::Otherwise::note}},
               output.pressure_maps);
  visitor.flag({"fits", "Regressions of the curves."}, output.fits);
  visitor.flag({"figures", "SVG figures by gnuplot."}, output.figures);
  visitor.flag({"pdf", "Figures as PDF too."}, output.pdf);
  visitor.flag(
      {"tissue", "The deformed mesh at the end of every step, for ParaView.", use.pressed_mesh},
      output.tissue);
  visitor.flag({"picture", "A picture of the scene.", use.pressed_mesh}, output.picture);
  visitor.numbers_by_name(
      {"display_scale", "Factors by case, for figures and an extra fit; CSV stays in newtons."},
      output.display_scale, above(0));
}

}  // namespace palpate::scenario
