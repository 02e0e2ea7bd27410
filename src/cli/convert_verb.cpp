// `palpate convert`: meshes a surface or scenario, prints the quality of a mesh, and writes it;
// writes results in the formats of other tools.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <system_error>

#include "base/doing.h"
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/units.h"
#include "base/whole_folder.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "meshing/mesh_check.h"
#include "meshing/mesh_files.h"
#include "meshing/surface_files.h"
#include "meshing/surface_remeshing.h"
#include "meshing/surface_repair.h"
#include "meshing/tetgen_body.h"
#include "record/csv.h"
#include "report/export.h"
#include "report/vtu.h"
#include "run/choose.h"
#include "run/refined_mesh.h"
#include "run/solid_press.h"
#include "scenario/family.h"
#include "scene/scene.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

constexpr double meshing_time = 120.0;  // s, time limit of TetGen, as in a run

enum class Kind { surface, mesh, scenario, results };

std::string ending_of(const std::string& path) {
  return lower_case(fs::path(path).extension().string());
}

Kind kind_of(const std::string& path) {
  const std::string ending = ending_of(path);
  if (fs::is_regular_file(path) && fs::is_empty(path))
    throw InputError({path}, "is empty; save it again, or name another file");
  if (ending == ".csv" || fs::is_directory(path)) return Kind::results;
  for (const char* known : {".stl", ".obj", ".ply", ".off", ".vtp"})
    if (ending == known) return Kind::surface;
  if (ending == ".node" || ending == ".ele") return Kind::mesh;
  if (meshing::holds_cells(path))
    return meshing::read_cells(path).solids.empty() ? Kind::surface : Kind::mesh;
  if (ending == ".toml") return Kind::scenario;
  if (ending.empty() && !fs::exists(path))
    throw InputError({path, 0, 0}, "cannot be read: No such file or directory; check the path");
  throw InputError({path, 0, 0},
                   "is neither a surface (.stl, .obj, .ply, .off, .vtp) nor a mesh (.msh, .vtu, "
                   ".vtk, .inp, .mesh, .node, .ele) nor a scenario (.toml) nor results (a folder, "
                   ".csv); save it as one of them");
}

// Refuses options that have no effect on this kind of subject.
void check_options(const Convert& command, Kind kind) {
  if (kind == Kind::results) {
    if (command.format.empty())
      refuse("`palpate convert` lacks the format that results are written in; write `--to csv-si`");
    if (command.out.size() > 1) refuse("results go into one folder; give `--out` once");
    for (const auto& [option, given] : {std::pair{"--unit", !command.unit.empty()},
                                        {"--nodes", command.nodes > 0},
                                        {"--edge", !command.edge.empty()},
                                        {"--repair-up-to", command.repair_up_to.has_value()},
                                        {"--set", !command.settings.empty()}})
      if (given) refuse("`" + std::string(option) + "` is not for results; leave it out");
    return;
  }
  if (!command.format.empty() || !command.case_name.empty())
    refuse("`--to` and `--case` are for results, and " + command.subject +
           " is none; leave them out, or give the folder of a result");
  if (kind == Kind::scenario && !command.unit.empty())
    refuse("a scenario names the units of its files itself; remove `--unit`");
  if (kind != Kind::scenario && !fs::exists(command.subject))
    throw InputError({command.subject, 0, 0}, "is not there; check the path");
  if (kind != Kind::scenario && command.unit.empty())
    refuse("`palpate convert` lacks the unit of the coordinates in " + command.subject +
           "; write `--unit mm`");
  if (kind != Kind::scenario && !command.settings.empty())
    refuse("`--set` is for scenarios; leave it out");
  if (kind != Kind::surface && command.repair_up_to)
    refuse(kind == Kind::mesh
               ? "`--repair-up-to` is for surfaces, " + command.subject + " is a mesh; leave it out"
               : "`--repair-up-to` is for surfaces; write `--set tissue.shape.repair_up_to=0.1`");
  if (kind == Kind::surface || (command.nodes == 0 && command.edge.empty())) return;
  const std::string option = command.nodes > 0 ? "`--nodes`" : "`--edge`";
  if (kind == Kind::mesh)
    refuse(option + " is for surfaces, " + command.subject + " is a mesh already; leave it out");
  refuse(option +
         " is for surfaces; write `--set tissue.mesh.nodes=728` or another key of `tissue.mesh`");
}

double unit_of(const std::string& symbol) {
  try {
    return metres_per(symbol);
  } catch (const std::invalid_argument&) {
    refuse("`--unit` wants a unit of length, got `" + symbol + "`; write `--unit mm`");
  }
}

bool is_surface_file(const std::string& out) {
  return ending_of(out) == ".off" || ending_of(out) == ".stl";
}

// The names of the files that are written for an `--out`.
std::vector<std::string> files_of(const std::string& out) {
  const fs::path path(out);
  const std::string ending = path.extension().string();
  if (ending == ".vtu" || is_surface_file(out)) return {out};
  if (ending != ".node" && ending != ".ele")
    throw InputError(
        {out, 0, 0},
        "`--out` wants the ending `.node`, `.ele` or `.vtu`, or `.off` or `.stl` for a surface");
  return {fs::path(path).replace_extension(".node").string(),
          fs::path(path).replace_extension(".ele").string()};
}

// Refuses output files that cannot be written, before any computation.
void check_outputs(const Convert& command, Kind kind) {
  for (const std::string& out : command.out) {
    if (is_surface_file(out) && kind != Kind::surface)
      throw InputError({out, 0, 0}, "is for surfaces; write a mesh as `.node` or `.vtu`");
    for (const std::string& file : files_of(out)) {
      if (!fs::exists(file)) continue;
      if (fs::is_directory(file)) throw InputError({file, 0, 0}, "is a folder; name a file");
      std::error_code unrelated;
      for (const std::string& read :
           ending_of(command.subject) == ".node" || ending_of(command.subject) == ".ele"
               ? files_of(command.subject)
               : std::vector<std::string>{})
        if (fs::equivalent(file, read, unrelated))
          throw InputError({file, 0, 0}, "is the input file; give another name to `--out`");
    }
  }
}

// Also writes the surface where that is asked for.
geometry::TetMesh mesh_of_surface(const Convert& command, const Talk& talk) {
  set_doing({"repair of the surface", 0, 2});
  meshing::Target target{.nodes = command.nodes};
  if (!command.edge.empty()) target.edge_length = positive_of("--edge", command.edge, unit::mm);
  meshing::RepairOrder order{.unit = command.unit};
  if (command.repair_up_to) order.most_missing = *command.repair_up_to;
  auto [surface, mended, part] = meshing::whole_surface(
      meshing::read_surface(command.subject, unit_of(command.unit)), command.subject, order);
  if (!mended.empty()) talk.say("note: " + mended);
  for (const std::string& out : command.out) {
    if (!is_surface_file(out)) continue;
    if (!command.force && fs::exists(out))
      throw InputError({out, 0, 0}, "is there already; give another name, or `--force`");
    meshing::write_surface(out, surface, unit_of(command.unit));
  }
  if (target.nodes == 0 && target.edge_length == 0.0)
    target.edge_length = meshing::spacing_of(surface);
  set_doing({"tetrahedra", 1, 2});
  auto [mesh, warning] = meshing::tetgen_file(std::move(surface), {}, target, meshing_time);
  if (!warning.empty()) talk.say("note: " + warning);
  return mesh;
}

// The scene of the first case.
scene::Scene scene_of(const Convert& command, const Talk& talk) {
  const scenario::Family family = scenario::read(command.subject, command.settings);
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  const scenario::Case& first = family.cases.front();
  if (family.cases.size() > 1)
    talk.say("note: " + command.subject + " has " + std::to_string(family.cases.size()) +
             " cases; this is the mesh of the first, " + first.name);
  scene::SpecimenShapes shapes;
  scene::Scene scene =
      run::build_scene(first, family, shapes, run::choose(first, shapes, run::Models::quick));
  if (!scene.specimen && !scene.solid)
    throw InputError(place_of(family.document, "solver.model"),
                     "the scenario is computed by `" +
                         std::string(scenario::traits(scene.scenario.solver.model).word) +
                         "`, which has no mesh; give `--set solver.model=mass_spring` to see the "
                         "one it would have");
  return scene;
}

// A table of one row, to which columns are added.
class Report {
 public:
  void add(const std::string& name, record::Cell value) {
    table_.columns.push_back(name);
    table_.rows.front().push_back(std::move(value));
  }
  void count(const std::string& name, std::size_t value) { add(name, static_cast<double>(value)); }

  void mesh(const geometry::TetMesh& mesh, const scenario::Resolved* scenario) {
    const geometry::OuterSurface outer_surface = geometry::outer_surface(mesh);
    count("nodes", mesh.nodes.size());
    count("tetrahedra", mesh.tetrahedra.size());
    count("surface_vertices", outer_surface.nodes.size());
    count("surface_triangles", outer_surface.surface.triangles.size());
    add("volume_mm3", 1e9 * geometry::volume(mesh));
    add("surface_area_mm2", 1e6 * geometry::area(outer_surface.surface));
    Vec3 low = mesh.nodes.front();
    Vec3 high = low;
    for (const Vec3& node : mesh.nodes) {
      low = low.cwiseMin(node);
      high = high.cwiseMax(node);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name(1, "xyz"[axis]);
      add("lowest_" + name + "_mm", unit::mm.from_si(low[axis]));
      add("highest_" + name + "_mm", unit::mm.from_si(high[axis]));
    }
    regions(mesh, scenario);
    shapes(meshing::quality(mesh), mesh.tetrahedra.size());
  }

  [[nodiscard]] const record::Table& table() const { return table_; }

 private:
  void regions(const geometry::TetMesh& mesh, const scenario::Resolved* scenario) {
    struct Share {
      std::size_t tetrahedra = 0;
      double volume = 0.0;
    };
    std::map<int, Share> shares;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      Share& share = shares[mesh.region(static_cast<int>(t))];
      ++share.tetrahedra;
      share.volume += geometry::signed_volume(mesh, static_cast<int>(t));
    }
    count("regions", shares.size());
    for (const auto& [number, share] : shares) {
      const std::string name = "region_" + std::to_string(number);
      if (scenario != nullptr)
        add(name + "_material", number == 0 ? scenario->tissue.material
                                            : scenario->regions[as_index(number) - 1].material);
      count(name + "_tetrahedra", share.tetrahedra);
      add(name + "_volume_mm3", 1e9 * share.volume);
    }
  }

  void shapes(const meshing::Quality& quality, std::size_t tetrahedra) {
    constexpr double degrees = 180.0 / std::numbers::pi;
    add("smallest_dihedral_angle_deg", degrees * quality.smallest_angle);
    add("largest_dihedral_angle_deg", degrees * quality.largest_angle);
    add("share_of_angles_below_10_deg",
        quality.angles[0] / (6.0 * static_cast<double>(tetrahedra)));
    add("largest_edge_ratio", quality.largest_edge_ratio);
    add("smallest_mean_ratio", quality.smallest_mean_ratio);
    add("shortest_edge_mm", unit::mm.from_si(quality.shortest_edge));
    add("longest_edge_mm", unit::mm.from_si(quality.longest_edge));
    add("smallest_tetrahedron_mm3", 1e9 * quality.smallest_volume);
    add("largest_tetrahedron_mm3", 1e9 * quality.largest_volume);
    add("limiting_tetrahedron", static_cast<double>(quality.limiting_tetrahedron));
    add("limiting_altitude_mm", unit::mm.from_si(quality.shortest_altitude));
  }

  record::Table table_{{}, {{}}};
};

std::string vtu_text(const geometry::TetMesh& mesh) {
  const std::vector<Vec3> still(mesh.nodes.size(), Vec3::Zero());
  return report::vtu_bytes({.mesh = mesh, .displacement = still});
}

// Files with this very mesh are its own, and need not be replaced.
void refuse_other_files(const std::string& out, const geometry::TetMesh& mesh) {
  const bool own =
      ending_of(out) == ".vtu" ? holds(out, vtu_text(mesh)) : meshing::holds_node_ele(out, mesh);
  for (const std::string& file : files_of(out))
    if (!own && fs::exists(file))
      throw InputError({file, 0, 0},
                       "is there already and is another mesh; give another name, or `--force`");
}

void write(const std::string& out, const geometry::TetMesh& mesh) {
  if (ending_of(out) == ".vtu")
    write_atomically(out, vtu_text(mesh));
  else
    meshing::write_node_ele(out, mesh);
}

// The file of the curves in a result folder, or the file itself.
std::string curve_file_of(const std::string& result) {
  if (!fs::is_directory(result)) return result;
  for (const char* name : {"force_indentation.csv", "strain_time.csv"})
    if (const fs::path file = fs::path(result) / name; fs::exists(file)) return file.string();
  throw InputError({result, 0, 0},
                   "holds neither force_indentation.csv nor strain_time.csv; give the folder of a "
                   "result, or a CSV file");
}

std::string name_of(const std::string& result) {
  fs::path path = fs::path(result).lexically_normal();
  if (path.filename().empty()) path = path.parent_path();
  return fs::is_directory(result) ? path.filename().string() : path.stem().string();
}

// Adds the radius of the finger if the result folder contains the scenario.
void add_radii(const std::string& result, std::vector<report::ExportCurve>& curves) {
  const fs::path file = fs::path(result) / "scenario.toml";
  if (!fs::is_directory(result) || !fs::exists(file)) return;
  try {
    const scenario::Family family = scenario::read(file.string(), {});
    for (report::ExportCurve& curve : curves)
      for (const scenario::Case& one : family.cases)
        if (one.name == curve.name || family.cases.size() == 1)
          curve.tip_radius = one.scenario.finger.radius;
  } catch (const InputError&) {  // an edited scenario.toml does not prevent it
  }
}

void keep_case(std::vector<report::ExportCurve>& curves, const std::string& wanted,
               const std::string& file) {
  std::vector<std::string> names;
  for (const report::ExportCurve& curve : curves) names.push_back(curve.name);
  std::erase_if(curves, [&](const report::ExportCurve& curve) { return curve.name != wanted; });
  if (!curves.empty()) return;
  throw InputError({file, 0, 0}, "has no case `" + wanted + "`; " +
                                     did_you_mean(wanted, names, "cases: " + joined(names, ", ")));
}

// A case's name as a file name: characters special to file systems or shells become `_`.
std::string file_name(const std::string& name) {
  std::string safe;
  for (const char c : name) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       c == '.' || c == '-' || c == '_' || c == '+' || c == '=';
    safe += plain ? c : '_';
  }
  return safe.empty() || safe[0] == '.' ? "_" + safe : safe;
}

int write_results(const Convert& command, const Talk& talk) {
  const std::string out = command.out.empty() ? "." : command.out.front();
  const auto formats = report::export_formats();
  const report::ExportFormat& format =
      *std::ranges::find_if(formats, [&](const auto& one) { return one.name == command.format; });
  const std::string file = curve_file_of(command.subject);
  std::vector<report::ExportCurve> curves =
      report::export_curves(record::read_csv(file), name_of(command.subject));
  if (curves.empty())
    throw InputError({file, 0, 0}, "holds no rows; run the scenario again, or give another file");
  if (!command.case_name.empty()) keep_case(curves, command.case_name, file);
  add_radii(command.subject, curves);

  // All texts and names are made before the first file, so that a refusal writes no file.
  std::vector<std::pair<fs::path, std::string>> files;
  std::set<fs::path> names;
  for (const report::ExportCurve& curve : curves) {
    const fs::path path = fs::path(out) / (file_name(curve.name) + std::string(format.ending));
    if (!names.insert(path).second)
      throw InputError({file, 0, 0}, "two cases would be written to " + path.string() +
                                         "; write them one by one with `--case` and `--out`");
    std::error_code ignored;
    if (fs::equivalent(path, file, ignored))
      throw InputError({path.string(), 0, 0},
                       "is the file to be converted and is not replaced; give another `--out`");
    try {
      files.emplace_back(path, format.text(curve));
    } catch (const InputError& error) {
      throw InputError({file, 0, 0}, error.problems().front().message);
    }
    if (!command.force && fs::exists(path) && !holds(path.string(), files.back().second))
      throw InputError({path.string(), 0, 0},
                       "is there already and says something else; give `--force` to replace it, or "
                       "another `--out`");
  }
  make_folders(out);
  for (const auto& [path, text] : files) {
    write_atomically(path.string(), text);
    talk.say("wrote " + path.string());
    talk.event("wrote", {{"file", path.string()}});
  }
  return exit_good;
}

}  // namespace

int perform(const Convert& command, const Arguments&, const Talk& talk) {
  const Kind kind = kind_of(command.subject);
  check_options(command, kind);
  if (kind == Kind::results) return write_results(command, talk);
  check_outputs(command, kind);
  Report report;
  geometry::TetMesh mesh;
  if (kind == Kind::scenario) {
    const scene::Scene scene = scene_of(command, talk);
    if (scene.solid) {
      talk.say(
          "note: the elements of `solid` have ten nodes; this is the mesh of their corners, and of "
          "a half or a quarter of the body where mirrors make it whole");
      mesh = run::SolidPress(scene).corners();
      report.mesh(mesh, &scene.scenario);
    } else {
      if (!scene.specimen->warning.empty()) talk.say("note: " + scene.specimen->warning);
      mesh = scene.specimen->mesh;
      report.mesh(mesh, &scene.scenario);
      report.count("springs", as_index(scene.specimen->network.springs()));
      report.add("stable_step_ms",
                 unit::ms.from_si(scene::stability_limit(scene.scenario, *scene.specimen,
                                                         scene.specimen->plan.contact)));
    }
  } else {
    if (kind == Kind::surface) {
      const ProgressLine line(talk, [&](double) { return command.subject; });
      mesh = mesh_of_surface(command, talk);
    } else {
      meshing::NamedMesh read = meshing::read_mesh(command.subject, unit_of(command.unit));
      mesh = std::move(read.mesh);
      for (const std::string& sentence : {read.warning, read.straightened})
        if (!sentence.empty()) talk.say("note: " + sentence);
      for (const auto& [name, number] : read.names)
        talk.say("note: region " + std::to_string(number) + " is `" + name + "`");
      meshing::refuse_size(mesh.nodes, "the mesh of " + command.subject, command.unit,
                           "tissue.mesh.unit");
      meshing::check(mesh, command.subject, 0.0);
    }
    report.mesh(mesh, nullptr);
  }
  if (!command.force)
    for (const std::string& out : command.out)
      if (!is_surface_file(out)) refuse_other_files(out, mesh);
  for (const std::string& out : command.out)
    if (!is_surface_file(out)) write(out, mesh);
  const record::Table turned = names_and_values(report.table());
  print_result(talk.json() ? report.table() : turned, turned, talk);
  return exit_good;
}

}  // namespace palpate::cli
