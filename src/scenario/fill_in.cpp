// Properties from materials, where the scenario does not override them.
#include <algorithm>
#include <filesystem>

#include "base/files.h"
#include "base/units.h"
#include "material/tissue_table.h"
#include "scenario/family.h"

namespace palpate::scenario {
namespace {

// The first input is the scenario itself, of which the results hold the echo, `scenario.toml`.
void remember_input(std::vector<InputFile>& inputs, const InputFile& added, const Place& place) {
  if (added.name == "scenario.toml")
    throw InputError(place, "`" + added.name +
                                "` is the name of the echo among the results; rename "
                                "the file");
  for (std::size_t i = 1; i < inputs.size(); ++i) {
    if (inputs[i].name != added.name) continue;
    if (inputs[i].content == added.content) return;
    throw InputError(place, "two different files are called `" + added.name +
                                "`, and a result folder holds a copy of each; rename one");
  }
  inputs.push_back(added);
}

material::Tissue find_material(const std::string& name, const Place& place,
                               const std::string& folder, std::vector<InputFile>& inputs) {
  material::Found found = material::find(name, folder, place);
  if (!found.file_text.empty())
    remember_input(inputs,
                   {std::filesystem::path(name.substr(0, name.find('#'))).filename().string(),
                    found.file_text},
                   place);
  return found.tissue;
}

// A viscous property from the material; an error where neither has it.
void fill_viscous(std::optional<double>& value, const std::optional<material::Sourced>& from,
                  const char* key, const Tissue& tissue, const Node& document) {
  if (value) return;
  if (!from)
    throw InputError(place_of(document, "tissue.material"),
                     "`" + tissue.material + "` has no `" + key + "`; give `tissue." + key +
                         "`, or set another `tissue.viscosity`");
  value = from->value;
}

void read_mesh_file(const MeshFile& mesh, const Node& document, const std::string& folder,
                    std::vector<InputFile>& inputs) {
  const Place place = place_of(document, "tissue.mesh");
  if (mesh.file.empty())
    throw InputError(place, "`mesh` of kind `file` lacks `file`; write `file = \"box.node\"`");
  if (mesh.unit.empty())
    throw InputError(place, "`mesh` lacks the unit of its coordinates; write `unit = \"mm\"`");
  try {
    (void)parse_quantity("1 " + mesh.unit, unit::mm);
  } catch (const std::invalid_argument&) {
    throw InputError(
        place_of(document, "tissue.mesh.unit"),
        "`unit` wants a unit of length, got `" + mesh.unit + "`; write `unit = \"mm\"`");
  }
  for (const char* extension : {".node", ".ele"}) {
    auto path = std::filesystem::path(folder) / mesh.file;
    path.replace_extension(extension);
    std::string content;
    try {
      content = read_text(path.string());
    } catch (const InputError& error) {
      throw InputError(
          place_of(document, "tissue.mesh.file"),
          "`file` names `" + path.string() + "`, which " + error.problems()[0].message);
    }
    remember_input(inputs, {path.filename().string(), content}, place);
  }
}

void fill_in_tissue(Scenario& scenario, const material::Tissue& material, const Node& document) {
  Tissue& tissue = scenario.tissue;
  if (!tissue.density) tissue.density = material.density.value;
  if (!tissue.young_modulus) tissue.young_modulus = material.young_modulus.value;
  if (!tissue.poisson_ratio) tissue.poisson_ratio = material.poisson_ratio.value;
  if (*tissue.poisson_ratio >= 0.5)
    throw InputError(place_of(document, "tissue.material"),
                     "`" + tissue.material +
                         "` has a Poisson's ratio of 0.5, and a tissue needs "
                         "less; set `tissue.poisson_ratio = 0.49`");
  if (scenario.solver.model == Solver::Model::hertz) return;
  if (tissue.viscosity == tissue::Viscosity::kelvin_voigt)
    fill_viscous(tissue.retardation_time, material.retardation_time, "retardation_time", tissue,
                 document);
  if (tissue.viscosity == tissue::Viscosity::standard_linear_solid) {
    fill_viscous(tissue.relaxation_time, material.relaxation_time, "relaxation_time", tissue,
                 document);
    fill_viscous(tissue.instantaneous_ratio, material.instantaneous_ratio, "instantaneous_ratio",
                 tissue, document);
  }
  if (tissue.viscosity == tissue::Viscosity::nodal_drag)
    fill_viscous(tissue.drag, material.drag, "drag", tissue, document);
}

void fill_in_finger(Finger& finger, const material::Tissue& rubber) {
  if (!finger.density) finger.density = rubber.density.value;
  if (finger.material == "rigid") return;
  if (!finger.young_modulus) finger.young_modulus = rubber.young_modulus.value;
  if (!finger.poisson_ratio) finger.poisson_ratio = rubber.poisson_ratio.value;
}

}  // namespace

void fill_in(Scenario& scenario, const Node& document, const std::string& folder,
             std::vector<InputFile>& inputs, std::vector<Problem>& problems) {
  const bool readable = problems.empty();
  const auto attempt = [&](const auto& part) {
    try {
      part();
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  };
  attempt([&] {
    const material::Tissue material = find_material(
        scenario.tissue.material, place_of(document, "tissue.material"), folder, inputs);
    if (readable) fill_in_tissue(scenario, material, document);
  });
  const auto* mesh = std::get_if<MeshFile>(&scenario.tissue.mesh);
  if (mesh != nullptr && readable && scenario.solver.model != Solver::Model::hertz)
    attempt([&] { read_mesh_file(*mesh, document, folder, inputs); });

  Finger& finger = scenario.finger;
  const bool rigid = finger.material == "rigid";
  if (scenario.uniform() || (rigid && finger.weight == Finger::Weight::in_contact)) return;
  attempt([&] {
    const material::Tissue rubber = find_material(
        rigid ? "finger" : finger.material, place_of(document, "finger.material"), folder, inputs);
    if (readable) fill_in_finger(finger, rubber);
  });
}

}  // namespace palpate::scenario
