// Properties from materials, where the scenario does not override them.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/files.h"
#include "base/units.h"
#include "material/tissue_table.h"
#include "scenario/family.h"

namespace palpate::scenario {
namespace {

void use(const std::string& name, Sources& sources) {
  if (std::find(sources.used.begin(), sources.used.end(), name) == sources.used.end())
    sources.used.push_back(name);
}

const material::Tissue& find_material(const std::string& name, const Place& place,
                                      Sources& sources) {
  const std::size_t hash = name.find('#');
  const std::string file = std::filesystem::path(name.substr(0, hash)).filename().string();
  if (hash != std::string::npos) use(file, sources);
  for (const Library* library : {&sources.known, &std::as_const(sources.found)})
    if (const auto known = library->tissues.find(name); known != library->tissues.end())
      return known->second;
  material::Found found = material::find(name, sources.folder, place);
  if (!found.file_text.empty()) sources.read.push_back({{file, found.file_text}, place});
  return sources.found.tissues.emplace(name, found.tissue).first->second;
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

// The geometry in files that a key of [tissue] names, as inputs of the run.
struct NamedFile {
  const char* key;      // "mesh"
  const char* example;  // "box.node"
  const std::string& file;
  const std::string& unit;
};

void read_named_file(const NamedFile& named, const Node& document, Sources& sources) {
  const std::string path = std::string("tissue.") + named.key;
  const Place place = place_of(document, path);
  const std::string quoted = std::string("`") + named.key + "`";
  if (named.file.empty())
    throw InputError(
        place, quoted + " of kind `file` lacks `file`; write `file = \"" + named.example + "\"`");
  if (named.unit.empty())
    throw InputError(place, quoted + " lacks the unit of its coordinates; write `unit = \"mm\"`");
  try {
    (void)parse_quantity("1 " + named.unit, unit::mm);
  } catch (const std::invalid_argument&) {
    throw InputError(
        place_of(document, path + ".unit"),
        "`unit` wants a unit of length, got `" + named.unit + "`; write `unit = \"mm\"`");
  }
  const auto file = std::filesystem::path(sources.folder) / named.file;
  std::vector<std::filesystem::path> files{file};
  if (file.extension() == ".node" || file.extension() == ".ele") {
    files = {file, file};
    files[0].replace_extension(".node");
    files[1].replace_extension(".ele");
  }
  for (const auto& one : files) {
    use(one.filename().string(), sources);
    if (sources.known.geometry.contains(one.string())) continue;
    std::string content;
    try {
      content = read_text(one.string());
    } catch (const InputError& error) {
      throw InputError(place_of(document, path + ".file"),
                       "`file` names `" + one.string() + "`, which " + error.problems()[0].message);
    }
    sources.read.push_back({{one.filename().string(), content}, place});
    sources.found.geometry.insert(one.string());
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
  // Where nothing flows, the material's values serve estimates and need not be there.
  const bool flows = scenario.meshed() || scenario.viscous_contact();
  const auto fill = [&](std::optional<double>& value, const auto& from, const char* key) {
    if (flows || from) fill_viscous(value, from, key, tissue, document);
  };
  if (tissue.viscosity == tissue::Viscosity::kelvin_voigt)
    fill(tissue.retardation_time, material.retardation_time, "retardation_time");
  if (tissue.viscosity == tissue::Viscosity::standard_linear_solid) {
    fill(tissue.relaxation_time, material.relaxation_time, "relaxation_time");
    fill(tissue.instantaneous_ratio, material.instantaneous_ratio, "instantaneous_ratio");
  }
  if (tissue.viscosity == tissue::Viscosity::nodal_drag) fill(tissue.drag, material.drag, "drag");
}

void fill_in_substance(Substance& substance, const material::Tissue& material,
                       const Solver& solver) {
  if (!substance.density) substance.density = material.density.value;
  if (!substance.young_modulus) substance.young_modulus = material.young_modulus.value;
  const bool honoured = solver.model != Solver::Model::mass_spring ||
                        solver.volume == Solver::Volume::nodal ||
                        solver.volume == Solver::Volume::tetrahedron;
  if (honoured && !substance.poisson_ratio) substance.poisson_ratio = material.poisson_ratio.value;
}

// A limb's muscle and bone, unless the scenario says what its regions are; the mesh of shapes that
// are no boxes, unless it says how.
void complete_shape(Scenario& scenario, const Node& document) {
  const Member* tissue = document.find("tissue");
  const auto given = [&](const char* key) {
    return tissue != nullptr && tissue->value.find(key) != nullptr;
  };
  if (std::holds_alternative<MeshFile>(scenario.tissue.mesh) && !given("shape"))
    scenario.tissue.shape = AsMeshed{};
  if (!given("mesh") && !std::holds_alternative<Cuboid>(scenario.tissue.shape))
    scenario.tissue.mesh = Tetgen{};
  const auto* limb = std::get_if<LayeredLimb>(&scenario.tissue.shape);
  if (limb == nullptr || document.find("region") != nullptr) return;
  scenario.regions.clear();
  if (limb->skin_thickness > 0.0)
    scenario.regions.emplace_back(TaggedRegion{.tag = 1, .substance = {.material = "muscle"}});
  if (limb->bone_radius > 0.0)
    scenario.regions.emplace_back(TaggedRegion{.tag = 2, .substance = {.material = "bone"}});
}

// The viscosity of the contact, where the scenario leaves it open: most materials' viscosity is
// assumed, and a force does not take part in an assumption that nobody made in the scenario.
void complete_contact(Scenario& scenario, const Node& document) {
  using Viscosity = Contact::Viscosity;
  if (scenario.contact.viscosity != Viscosity::automatic) return;
  const Member* tissue = document.find("tissue");
  const bool given = tissue != nullptr && tissue->value.find("viscosity") != nullptr;
  const bool hertz_knows = scenario.contact.coupling == contact::Coupling::consistent;
  const bool flows = scenario.tissue.viscosity != tissue::Viscosity::none &&
                     scenario.tissue.viscosity != tissue::Viscosity::nodal_drag;
  scenario.contact.viscosity = given && hertz_knows && flows ? Viscosity::tissue : Viscosity::none;
}

void fill_in_finger(Finger& finger, const material::Tissue& rubber) {
  if (!finger.density) finger.density = rubber.density.value;
  if (finger.material == "rigid") return;
  if (!finger.young_modulus) finger.young_modulus = rubber.young_modulus.value;
  if (!finger.poisson_ratio) finger.poisson_ratio = rubber.poisson_ratio.value;
}

}  // namespace

void fill_in(Scenario& scenario, const Node& document, Sources& sources,
             std::vector<Problem>& problems) {
  const bool readable = problems.empty();
  complete_contact(scenario, document);
  const auto attempt = [&](const auto& part) {
    try {
      part();
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  };
  attempt([&] {
    const material::Tissue& material =
        find_material(scenario.tissue.material, place_of(document, "tissue.material"), sources);
    if (readable) fill_in_tissue(scenario, material, document);
  });
  complete_shape(scenario, document);
  for (std::size_t i = 0; i < scenario.regions.size(); ++i) {
    Substance& substance =
        std::visit([](auto& one) -> Substance& { return one.substance; }, scenario.regions[i]);
    const Place place = place_of(document, "region." + std::to_string(i + 1) + ".material");
    attempt([&] {
      const material::Tissue& material = find_material(substance.material, place, sources);
      if (readable) fill_in_substance(substance, material, scenario.solver);
    });
  }
  const bool meshed = scenario.meshed();
  const auto* mesh = std::get_if<MeshFile>(&scenario.tissue.mesh);
  if (mesh != nullptr && readable && meshed)
    attempt([&] {
      read_named_file({"mesh", "box.node", mesh->file, mesh->unit}, document, sources);
    });
  const auto* surface = std::get_if<SurfaceFile>(&scenario.tissue.shape);
  if (surface != nullptr && readable && meshed)
    attempt([&] {
      read_named_file({"shape", "leg.stl", surface->file, surface->unit}, document, sources);
    });

  Finger& finger = scenario.finger;
  const bool rigid = finger.material == "rigid";
  if (scenario.uniform() ||
      (rigid && finger.spheres == 1 && finger.weight == Finger::Weight::in_contact))
    return;
  attempt([&] {
    const material::Tissue& rubber = find_material(rigid ? "finger" : finger.material,
                                                   place_of(document, "finger.material"), sources);
    if (readable) fill_in_finger(finger, rubber);
  });
}

}  // namespace palpate::scenario
