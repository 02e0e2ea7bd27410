// Fills in what a scenario leaves open to its materials and to its other keys.
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
  if (std::ranges::find(sources.used, name) == sources.used.end()) sources.used.push_back(name);
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

// A geometry file that a key of [tissue] names; it becomes an input of the run.
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
    (void)metres_per(named.unit);
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
      if (content.empty()) throw InputError({}, "is empty; save it again, or name another file");
    } catch (const InputError& error) {
      throw InputError(place_of(document, path + ".file"),
                       "`file` names `" + one.string() + "`, which " + error.problems()[0].message);
    }
    sources.read.push_back({{one.filename().string(), content}, place});
    sources.found.geometry.insert(one.string());
  }
}

bool gives_viscosity(const Node& document, const char* table) {
  const Member* found = document.find(table);
  return found != nullptr && found->value.find("viscosity") != nullptr;
}

// Throws InputError if neither the scenario nor its material has a property that is required.
void require_tissue(const Scenario& scenario, const material::Tissue& material,
                    const Node& document) {
  const Tissue& tissue = scenario.tissue;
  if (tissue.poisson_ratio.value_or(material.poisson_ratio.value) >= 0.5)
    throw InputError(place_of(document, "tissue.material"),
                     "`" + tissue.material +
                         "` has a Poisson's ratio of 0.5, and a tissue needs less; set "
                         "`tissue.poisson_ratio = 0.49`");
  // If viscosity is not computed, viscous properties only serve estimates and may be missing.
  if (!scenario.meshed() && !viscous_contact(scenario)) return;
  const tissue::Viscosity used = law_of(scenario, material, document);
  const auto require = [&](tissue::Viscosity law, const std::optional<double>& given,
                           const std::optional<material::Sourced>& from, const char* key) {
    if (used == law && !given && !from)
      throw InputError(place_of(document, "tissue.material"),
                       "`" + tissue.material + "` has no `" + key + "`; give `tissue." + key +
                           "`, or write `" +
                           (gives_viscosity(document, "contact") ? "contact" : "tissue") +
                           ".viscosity = \"none\"`");
  };
  using tissue::Viscosity;
  require(Viscosity::kelvin_voigt, tissue.retardation_time, material.retardation_time,
          "retardation_time");
  require(Viscosity::standard_linear_solid, tissue.relaxation_time, material.relaxation_time,
          "relaxation_time");
  require(Viscosity::standard_linear_solid, tissue.instantaneous_ratio,
          material.instantaneous_ratio, "instantaneous_ratio");
  require(Viscosity::nodal_drag, tissue.drag, material.drag, "drag");
}

// Sets muscle and bone of a limb unless the scenario has regions, and the mesh unless the
// scenario has one.
void complete_shape(Scenario& scenario, const Node& document) {
  const Member* tissue = document.find("tissue");
  const auto given = [&](const char* key) {
    return tissue != nullptr && tissue->value.find(key) != nullptr;
  };
  if (std::holds_alternative<MeshFile>(scenario.tissue.mesh) && !given("shape"))
    scenario.tissue.shape = AsMeshed{};
  if (!given("mesh")) scenario.tissue.mesh = mesh_left_open(scenario);
  const auto* limb = std::get_if<LayeredLimb>(&scenario.tissue.shape);
  if (limb == nullptr || document.find("region") != nullptr) return;
  scenario.regions.clear();
  if (limb->skin_thickness > 0.0) scenario.regions.push_back({{TaggedRegion{1}, "muscle"}});
  if (limb->bone_radius > 0.0) scenario.regions.push_back({{TaggedRegion{2}, "bone"}});
}

// Sets the viscosity of the contact if the scenario leaves it open. It is included only if the
// scenario gives `tissue.viscosity`, because the viscosity of most materials is an assumption.
void complete_contact(Scenario& scenario, const Node& document) {
  using Viscosity = Contact::Viscosity;
  if (scenario.contact.viscosity) return;
  const bool hertz_knows = scenario.contact.coupling == contact::Coupling::consistent;
  const bool flows = scenario.tissue.viscosity != tissue::Viscosity::none &&
                     scenario.tissue.viscosity != tissue::Viscosity::nodal_drag;
  scenario.contact.viscosity = gives_viscosity(document, "tissue") && hertz_knows && flows
                                   ? Viscosity::tissue
                                   : Viscosity::none;
}

}  // namespace

Mesh mesh_left_open(const Scenario& scenario) {
  const bool inclusions = std::ranges::any_of(scenario.regions, [](const Region& region) {
    return std::holds_alternative<Inclusion>(region.part);
  });
  Mesh mesh = Tissue{}.mesh;
  if (inclusions || !std::holds_alternative<Cuboid>(scenario.tissue.shape)) mesh = Tetgen{};
  refinement(mesh).refine = true;
  return mesh;
}

void complete(Scenario& scenario, const Node& document) {
  complete_contact(scenario, document);
  complete_shape(scenario, document);
}

tissue::Viscosity law_of(const Scenario& scenario, const material::Tissue& material,
                         const Node& document) {
  const bool viscous_test = std::ranges::any_of(scenario.steps, [](const Step& step) {
    return std::holds_alternative<Creep>(step) || std::holds_alternative<Relax>(step);
  });
  const bool asked =
      gives_viscosity(document, "tissue") || viscous_test || viscous_contact(scenario);
  const bool timed = scenario.tissue.retardation_time || material.retardation_time;
  return asked || timed ? scenario.tissue.viscosity : tissue::Viscosity::none;
}

Materials find_materials(const Scenario& scenario, const Node& document, Sources& sources,
                         std::vector<Problem>& problems) {
  const bool readable = problems.empty();
  Materials materials;
  const auto attempt = [&](const auto& part) {
    try {
      part();
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  };
  const auto find = [&](const std::string& name, const std::string& path) {
    return find_material(name, place_of(document, path), sources);
  };
  attempt([&] {
    materials.tissue = find(scenario.tissue.material, "tissue.material");
    if (readable) require_tissue(scenario, materials.tissue, document);
  });
  for (std::size_t i = 0; i < scenario.regions.size(); ++i)
    attempt([&] {
      const std::string path = "region." + std::to_string(i + 1) + ".material";
      materials.regions.push_back(find(scenario.regions[i].material, path));
    });
  const bool meshed = scenario.meshed();
  const auto* mesh = std::get_if<MeshFile>(&scenario.tissue.mesh);
  if (mesh != nullptr && readable && meshed)
    attempt([&] {
      read_named_file({"mesh", "box.node", mesh->file, mesh->unit}, document, sources);
    });
  const auto* surface = std::get_if<SurfaceFile>(&scenario.tissue.shape);
  if (surface != nullptr && readable)  // closed forms read its curvature
    attempt([&] {
      read_named_file({"shape", "leg.stl", surface->file, surface->unit}, document, sources);
    });

  const Finger& finger = scenario.finger;
  if (scenario.uniform() ||
      (finger.rigid() && finger.spheres == 1 && finger.weight == Finger::Weight::in_contact))
    return materials;
  attempt([&] {
    materials.finger = find(finger.rigid() ? "finger" : finger.material, "finger.material");
  });
  return materials;
}

}  // namespace palpate::scenario
