// The keys of the finger, the contact, the device, the solver and the output.
#include "scenario/field_tables.h"

#include <algorithm>

#include "scenario/integrators.h"
#include "scenario/words.h"

namespace palpate::scenario {

using namespace words;

Conditions::Conditions(const Scenario& scenario) {
  const bool meshed = scenario.meshed();
  const std::optional<Model>& model = scenario.solver.model;
  const std::string when = !meshed && !model ? "on another `tissue.shape` than `half_space`"
                                             : "with " + models_that(std::mem_fn(&Rung::meshed));
  mesh = {meshed, when, Use::Otherwise::note};
  mesh_physics = {meshed, when};
  springs = meshed
                ? Use{!model || rung(*model).independent(),
                      "with " + models_that(std::mem_fn(&Rung::independent)), Use::Otherwise::note}
                : mesh;
  based = model && rung(*model).thickness ? Use{} : mesh;
  formula = {!model || !rung(*model).meshed(),
             "with " + models_that([](const Rung& one) { return !one.meshed(); }),
             Use::Otherwise::note};
  // If steps of both kinds are mixed, the mixture is reported instead of the keys of the finger.
  const bool presses = !std::all_of(scenario.steps.begin(), scenario.steps.end(), loads_end_faces);
  finger = {presses || scenario.steps.empty(),
            "by steps with a finger (indent, hold, retract, slide)"};
  pressed_mesh = meshed ? Use{finger.used, finger.when, Use::Otherwise::note} : mesh;
}

void finger_fields(FieldVisitor& visitor, Finger& finger) {
  visitor.text({"material", "`finger` (the paper's silicone rubber), any tissue, or `rigid`."},
               finger.material);
  visitor.quantity({"radius", "Radius of the single sphere that has the finger's mass."},
                   finger.radius, unit::mm, between(1e-9, 1e3));
  visitor.count({"spheres", "Sphere bodies of equal mass that make up the finger, eq. (5)."},
                finger.spheres, between(1, 64));
  visitor.choice({"calibration",
                  "Which property several spheres share with the single sphere that they replace.",
                  {finger.spheres > 1, "with more than one of `spheres`", Use::Otherwise::note}},
                 finger.calibration, calibrations);
  visitor.quantity_or("auto", {"x", "Where it presses; `auto`: the middle of the specimen."},
                      finger.x, unit::mm, {});
  visitor.quantity_or("auto", {"y", "Likewise."}, finger.y, unit::mm, {});
  const Use elastic{!finger.rigid(), "where the finger is not `rigid`"};
  visitor.quantity({"young_modulus", "Default: the material's.", elastic}, finger.young_modulus,
                   unit::kPa, above(0));
  visitor.number({"poisson_ratio", "Default: the material's.", elastic}, finger.poisson_ratio,
                 {.low = -1, .high = 0.5, .low_allowed = false});
  visitor.choice({"weight", "How the finger's weight is counted."}, finger.weight, weights);
  visitor.quantity({"density",
                    "Default: the material's.",
                    {finger.weight == Finger::Weight::apart, "with `weight = \"apart\"`"}},
                   finger.density, unit::density, above(0));
}

void contact_fields(FieldVisitor& visitor, Contact& contact, const Conditions& use) {
  visitor.choice({"coupling", "How contact law and mesh share the tissue's compliance.", use.mesh},
                 contact.coupling, couplings);
  visitor.choice({"law", "How the tissue's curvature enters the contact law."}, contact.law, laws);
  visitor.choice({"curvature", "How curvature is computed on a mesh.", use.mesh}, contact.curvature,
                 curvature_methods);
  visitor.choice({"curvature_on", "The surface whose curvature is used.", use.mesh},
                 contact.curvature_on, curvature_surfaces);
  visitor.count({"curvature_rings",
                 "Rings of vertices around the contact that curvature depends on.", use.mesh},
                contact.curvature_rings, between(1, 8));
  visitor.choice_or(auto_contact_viscosities,
                    {"viscosity", "Whether the contact force includes the tissue's viscosity."},
                    contact.viscosity, contact_viscosities);
  visitor.choice_or(auto_depths, {"depth", "How the force grows in a deep press."}, contact.depth,
                    depths);
  visitor.choice_or(auto_sizes,
                    {"size", "How much of the body the force of a formula knows.", use.formula},
                    contact.size, sizes);
  visitor.choice_or(auto_directions,
                    {"direction",
                     "The direction in which `resolved` measures gaps and applies forces.",
                     {contact.coupling == contact::Coupling::resolved,
                      "with `coupling = \"resolved\"`", Use::Otherwise::note}},
                    contact.direction, directions);
  visitor.choice({"spread", "How a contact force is distributed over nodes.", use.mesh},
                 contact.spread, loaded);
  visitor.number({"friction", "Coulomb's coefficient mu."}, contact.friction, at_least(0));
  visitor.choice(
      {"slip",
       "How friction sets in. With `coupling = \"consistent\"` on a bonded base the mesh tells "
       "how far the tissue follows the finger; otherwise it does so as a half-space.",
       {contact.friction > 0.0, "with `friction` above 0", Use::Otherwise::note}},
      contact.slip, slips);
  visitor.quantity({"ambient_force", "F_a of eq. (1), added to the force."}, contact.ambient_force,
                   unit::N, {});
}

void device_fields(FieldVisitor& visitor, Device& device) {
  visitor.quantity(
      {"damping", "The device's own; if given, findings say what it displays passively."},
      device.damping, unit::N_s_per_m, at_least(0));
  visitor.quantity({"frame",
                    "Time from one force to the next.",
                    {device.damping.has_value(), "with `device.damping`", Use::Otherwise::note}},
                   device.frame, unit::ms, above(0));
}

void solver_fields(FieldVisitor& visitor, Solver& solver, const Conditions& use) {
  visitor.choice_or(auto_models, {"model", "A rung of the ladder of models."}, solver.model,
                    models);
  visitor.number({"tolerance", "Relative error of the force that `auto` accepts."},
                 solver.tolerance,
                 {.low = 0, .high = 1, .low_allowed = false, .high_allowed = false});
  visitor.choice({"stiffness", "Spring stiffness from Young's modulus.", use.springs},
                 solver.stiffness, stiffnesses);
  visitor.choice_or(auto_volumes, {"volume", "How a change of volume is resisted.", use.mesh},
                    solver.volume, volumes);
  visitor.choice({"kinematics", "Whether springs keep their directions or rotate.", use.mesh},
                 solver.kinematics, kinematics_words);
  visitor.choice_or(auto_integrators, {"integrator", "The time integrator.", use.mesh},
                    solver.integrator, integrators);
  using Integrator = Solver::Integrator;
  const Integrator integrator = solver.integrator.value_or(Integrator::central_difference);
  const bool central = integrator == Integrator::central_difference;
  const auto of_steps = [&](bool used, const char* when) {
    return use.mesh.used ? Use{used, when, Use::Otherwise::note} : use.mesh;
  };
  const Use centred = of_steps(central, "with `integrator = \"central_difference\"`");
  const Use stepped = of_steps(about(integrator).explicit_steps,
                               "with an explicit `integrator`, as \"central_difference\"");
  visitor.choice({"start", "How the first time step is made.", centred}, solver.start, starts);
  visitor.choice({"damping", "The velocity with which drag and dashpots act in a step.", centred},
                 solver.damping, damping_velocities);
  visitor.quantity_or("auto", {"time_step", "`auto`: the output interval.", use.mesh},
                      solver.time_step, unit::ms, above(0));
  visitor.count_or("auto",
                   {"substeps",
                    "Equal parts of a time step; `auto`: as many as stability, or the accuracy "
                    "of implicit methods, requires.",
                    use.mesh},
                   solver.substeps, between(1, 1e8));
  visitor.flag({"allow_unstable", "Run an explicit step above the stability limit, to see it fail.",
                stepped},
               solver.allow_unstable);
  visitor.count_or("all",
                   {"rings",
                    "Rings of nodes around the contact that move; other nodes are fixed. This is "
                    "the paper's method, for comparisons with it: a frame of the whole mesh takes "
                    "less time by `modal`.",
                    use.pressed_mesh},
                   solver.rings, between(1, 1000));
  visitor.count_or(
      "auto",
      {"modes",
       "The lowest modes, which `modal` keeps; the others follow without inertia. "
       "`auto`: 128, from 1000 nodes on 32, or all of them where the force follows from the "
       "whole motion.",
       solver.integrator == Integrator::modal || !solver.integrator
           ? use.pressed_mesh
           : Use{false, "with `integrator = \"modal\"`", Use::Otherwise::note}},
      solver.modes, between(1, 1e6));
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
  visitor.flag({"report", "A page with answer, figures and findings, `report.html`."},
               output.report);
  visitor.choice({"paper",
                  "Which figure of Chen 2007 the page sets its results beside.",
                  {output.report, "with `report`", Use::Otherwise::note}},
                 output.paper, papers);
  visitor.flag({"pdf", "Figures as PDF too."}, output.pdf);
  visitor.flag({"png", "Figures and pressure maps as PNG too."}, output.png);
  visitor.choice(
      {"regression",
       "The regression of `fits.csv` that is drawn over the force in figures.",
       {output.fits && output.figures, "with `fits` and `figures`", Use::Otherwise::note}},
      output.regression, regressions);
  visitor.flag({"tissue", "Deformed meshes for ParaView.", use.pressed_mesh}, output.tissue);
  visitor.choice({"tissue_at",
                  "When the meshes of `tissue` are written.",
                  {output.tissue, "with `tissue`", Use::Otherwise::note}},
                 output.tissue_at, meshes_at);
  visitor.flag({"picture", "A picture of the scene.", use.pressed_mesh}, output.picture);
  visitor.numbers_by_name(
      {"display_scale", "Factors by case, for figures and an extra fit; CSV stays in newtons."},
      output.display_scale, above(0));
}

}  // namespace palpate::scenario
