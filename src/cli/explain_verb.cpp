// `palpate explain`: describes what a scenario would compute and why, or what a key means.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "base/units.h"
#include "base/vec3.h"
#include "base/written.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "page/page.h"
#include "report/answer_lines.h"
#include "report/scene_picture.h"
#include "run/answer.h"
#include "run/family.h"
#include "run/picture.h"
#include "scenario/family.h"
#include "scenario/integrators.h"
#include "scenario/programme.h"
#include "scenario/resolved.h"
#include "scenario/schema.h"
#include "scenario/words.h"
#include "scene/places.h"
#include "scene/proportions.h"
#include "scene/scene.h"
#include "scene/specimen_mesh.h"
#include "sweep/plan.h"

namespace palpate::cli {
namespace {

using Solver = scenario::Resolved::Solver;

// A choice by its word and what the manual says of it.
template <class Enum, std::size_t size>
std::string told(const Words<Enum, size>& words, Enum value) {
  const Word& one = words[as_index(value)];
  return std::string(one.word) + ": " + one.meaning;
}

std::string milliseconds(double seconds) { return rounded_text(1e3 * seconds) + " ms"; }

// For implicit methods, which have no limit, the line gives that of central differences.
std::string limit_word(const Solver& solver) {
  return solver.integrator == Solver::Integrator::semi_implicit_euler
             ? "semi-implicit Euler is stable below "
             : "central differences are stable below ";
}

std::string limit_formula(const Solver& solver) {
  if (!about(solver.integrator).explicit_steps) return " (2 / omega_max)";
  switch (scenario::damping_velocity(solver)) {
    case integrate::DampingVelocity::centred: return " (2 / omega_max)";
    case integrate::DampingVelocity::lagged:
      return " (2 (sqrt(1 + zeta^2) - zeta) / omega_max: damping lags)";
    case integrate::DampingVelocity::ahead: break;
  }
  return " (2 (sqrt(1 + zeta^2) + zeta) / omega_max)";
}

// The paper's time step, which it gives without a unit, read as s; 0 for other materials.
double literal_step(const std::string& material) {
  if (material == "skin" || material == "ligament") return 0.01;
  if (material == "muscle" || material == "upper_leg") return 0.05;
  return 0.0;
}

// The scene must have a specimen.
std::vector<std::string> explain_time(const scene::Scene& scene) {
  const scene::TimePlan& plan = scene.specimen->plan;
  const Solver& solver = scene.scenario.solver;
  const double limit = plan.limit
                           ? *plan.limit
                           : scene::stability_limit(scene.scenario, *scene.specimen, plan.contact);
  std::vector<std::string> lines;
  lines.push_back(std::string("  time         ") + about(solver.integrator).told);
  lines.push_back("  stability    " + limit_word(solver) + milliseconds(limit) +
                  limit_formula(solver));
  lines.push_back("  steps        time step " + milliseconds(plan.time_step) + " in " +
                  std::to_string(plan.substeps) +
                  (plan.substeps == 1 ? " step of " : " substeps of ") +
                  milliseconds(plan.substep) + ", " +
                  rounded_text(scene.specimen->network.springs() / plan.substep, 2) +
                  " spring updates a second of motion");
  if (solver.allow_unstable && !plan.stable())
    lines.emplace_back(
        "  warning      the step is above the stability limit and will diverge; `allow_unstable` "
        "permits it");
  const double literal = literal_step(scene.scenario.tissue.material);
  if (literal > limit)
    lines.push_back("  the paper    its literal time step of " + milliseconds(literal) + " is " +
                    rounded_text(literal / limit, 3) +
                    " times the limit: central differences would have diverged");
  return lines;
}

using Json = nlohmann::ordered_json;

Json model(const scene::Forecast& forecast) {
  Json object{{"model", scenario::traits(forecast.model).word}};
  if (forecast.cannot.empty())
    object.update({{"error", forecast.error}, {"seconds", forecast.seconds}});
  else
    object["cannot"] = forecast.cannot;
  return object;
}

// One JSON object without line feeds: the plain sentences, the criteria, the models with their
// errors, what is neglected, and of a case alone the processor time of its run. Errors and changes
// are fractions; infinite numbers are null.
std::string explain_json(const std::string& scenario, const scene::Scene& scene,
                         const run::Expected& expected, const std::optional<run::Cost>& cost) {
  Json object{{"event", "explanation"},
              {"scenario", scenario},
              {"case", scene.name},
              {"model", scenario::traits(scene.scenario.solver.model).word},
              {"named_by_scenario", scene.choice.given},
              {"error", nullptr},
              {"tolerance", scene.scenario.solver.tolerance},
              {"sentences",
               {{"model", expected.answer.model},
                {"error", expected.answer.error},
                {"neglected", expected.answer.neglected}}},
              {"neglected", Json::array()},
              {"criteria", Json::array()},
              {"models", Json::array()}};
  if (expected.answer.stated_error) object["error"] = *expected.answer.stated_error;
  for (const record::Neglected& one : expected.answer.effects)
    object["neglected"].push_back({{"effect", one.what},
                                   {"change", one.change ? Json(*one.change) : Json()},
                                   {"text", one.when},
                                   {"remedy", one.remedy}});
  for (const scene::Question& one : scene.choice.questions)
    object["criteria"].push_back({{"topic", one.asked},
                                  {"measure", one.measure},
                                  {"number", one.number},
                                  {"limit", one.threshold},
                                  {"result", one.answer}});
  for (const scene::Forecast& forecast : scene.choice.forecasts)
    object["models"].push_back(model(forecast));
  if (scene.specimen) {
    object["mesh"] = {{"nodes", scene.specimen->network.nodes()},
                      {"tetrahedra", scene.specimen->mesh.tetrahedra.size()},
                      {"springs", scene.specimen->network.springs()}};
    if (expected.mesh_error) object["mesh"]["error"] = *expected.mesh_error;
  }
  if (cost) {
    object["seconds"] = rounded(cost->seconds, 3);
    object["at_least"] = cost->at_least;
  }
  return object.dump(-1, ' ', false, Json::error_handler_t::replace);
}

class Explanation {
 public:
  Explanation(const scene::Scene& scene, const run::Expected& expected)
      : scene_(scene), expected_(expected) {}

  // The three plain sentences, then the numbers. `name` starts the text where there are several.
  std::string text(const std::string& name, const std::string& title) {
    line((name.empty() ? "" : ticked(one_line(name)) + ": ") + expected_.answer.model);
    line(expected_.answer.error);
    line(expected_.answer.neglected);
    line("\ncase " + one_line(scene_.name) + ": " + one_line(title));
    tissue();
    shape();
    regions();
    if (!scene_.scenario.uniform()) {
      finger();
      contact();
    }
    choice();
    if (scene_.specimen) {
      mesh(*scene_.specimen);
      for (const std::string& sentence : explain_time(scene_)) line(sentence);
    }
    return text_;
  }

 private:
  void line(const std::string& sentence) { text_ += sentence + "\n"; }

  void tissue() {
    const scenario::Resolved::Tissue& tissue = scene_.scenario.tissue;
    line("  tissue       " + tissue.material + ": E " +
         quantity_text(tissue.young_modulus, unit::kPa) + ", nu " +
         number_text(tissue.poisson_ratio) + ", density " +
         quantity_text(tissue.density, unit::density));
    if (!scene_.specimen && scene_.relaxation.elastic()) {
      line("  viscosity    not used");
      return;
    }
    line("  viscosity    " + scenario::viscosity_text(tissue) +
         (tissue.viscosity == tissue::Viscosity::nodal_drag
              ? "; its creep time grows with the specimen's length squared"
              : ""));
    if (!scene_.scenario.uniform())
      line(
          scene_.relaxation.elastic()
              ? "               the contact's force is that of the relaxed tissue"
              : "               in the contact too: Lee and Radok's force, Ting's on the way back");
  }

  void shape() {
    const scenario::Resolved::Tissue& tissue = scene_.scenario.tissue;
    std::string text = std::visit(
        [](const auto& one) -> std::string { return std::decay_t<decltype(one)>::word.word; },
        tissue.shape);
    if (const auto shape = scene::parametric(tissue.shape)) {
      text += ", " + size_text(geometry::extent(*shape));
    } else if (const auto* file = std::get_if<scenario::SurfaceFile>(&tissue.shape)) {
      text += " " + file->file + ", in " + file->unit;
      const scene::SurfaceTouch& touch = scene_.choice.touch;
      if (touch.size.allFinite()) text += ", " + size_text(touch.high - touch.low);
    }
    line("  shape        " + text);
    if (const auto box = body_box())
      line("  box          " + scene::box_text(*box) + ", " +
           scene::coordinates_text(scene_.scenario));
    if (!scene_.choice.touch.warning.empty())
      line((std::holds_alternative<scenario::AsMeshed>(tissue.shape) ? "  mesh file    "
                                                                     : "  mended       ") +
           scene_.choice.touch.warning);
    if (!scene_.scenario.uniform())
      for (const std::string& sentence :
           scene::disproportions(scene_.scenario, scene_.choice.touch, scene_.choice.expected))
        line("  note         " + sentence);
    press();
    if (!scene_.specimen) top();
    const geometry::SmoothSurface* const outer_surface = scene_.outer_surface();
    if (outer_surface == nullptr) return;
    const scenario::Resolved& scenario = scene_.scenario;
    const double level = scene::base_level(scenario, outer_surface->surface());
    double low = level;
    for (const Vec3& vertex : outer_surface->surface().vertices)
      low = std::min(low, vertex.dot(scenario.tissue.base_up));
    const scene::Box box = scene::box_of(outer_surface->surface().vertices);
    const double rounding = 1e-9 * (box.high - box.low).norm();
    const std::string& side = scenario.tissue.base_side;
    line("  base         " +
         (level > low + rounding
              ? "the surface up to a height of " + rounded_text(unit::mm.from_si(level)) + " mm"
              : std::string("the lowest plane")) +
         (side.empty()                   ? ""
          : scenario::direction_of(side) ? " on the side towards " + side
                                         : " on the side of the group `" + side + "`") +
         (scenario.tissue.base == tissue::Base::bonded ? " is fixed, " : " slides on the table, ") +
         percent_text(scene::base_area(scenario, outer_surface->surface(), low * Vec3::UnitZ(), 0.0)
                          .of_surface) +
         " of the surface");
  }

  // Where the finger first touches, and its way if that is not along -z.
  void press() {
    const scene::SurfaceTouch& touch = scene_.choice.touch;
    if (scene_.scenario.uniform() || touch.nowhere || !touch.size.allFinite()) return;
    const Vec3 way = -scene_.scenario.tissue.turn.row(2).transpose();
    line("  press        at " + scene::place_text(scene_.scenario, touch.position) +
         (way == -Vec3::UnitZ() ? "" : " towards " + vector_text(way, 3)) + ", " +
         scene::coordinates_text(scene_.scenario) +
         (scene_.scenario.finger.moved
              ? "; on the top, since the middle of the body's box is a gap or the rim of a hollow"
              : ""));
  }

  // In the coordinates of the file.
  [[nodiscard]] std::optional<scene::Box> body_box() const {
    const scene::SurfaceTouch& touch = scene_.choice.touch;
    if (touch.size.allFinite()) return scene::Box{touch.low, touch.high};
    if (scene_.specimen) return scene::box_in_file(scene_.scenario, scene_.specimen->mesh.nodes);
    if (scene_.solid)
      return scene::box_in_file(scene_.scenario, scene_.solid->outer_surface->surface().vertices);
    return std::nullopt;
  }

  static std::string size_text(const Vec3& size) {
    std::string text;
    for (int axis = 0; axis < 3; ++axis)
      text += (axis == 0 ? "" : " x ") + rounded_text(unit::mm.from_si(size[axis]));
    return text + " mm";
  }

  // Where the finger touches a shape without a mesh.
  void top() {
    const scene::SurfaceTouch& touch = scene_.choice.touch;
    if (!touch.curved() && !touch.tilted()) return;
    constexpr double degrees = 180.0 / std::numbers::pi;
    const double inclined = degrees * std::acos(std::min(1.0, touch.curvature.normal.z()));
    constexpr double level = 0.01;  // degrees, and what does not count
    line("  top          curvatures " + rounded_text(touch.curvature.kappa_1) + " and " +
         rounded_text(touch.curvature.kappa_2) + " 1/m, positive if convex" +
         (inclined < level
              ? ""
              : "; the surface is inclined by " + rounded_text(inclined, 3) + " degrees"));
  }

  void regions() {
    const auto& regions = scene_.scenario.regions;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const scenario::Resolved::Region& region = regions[i];
      std::string text = "  region " + std::to_string(i + 1) + "     ";
      text.resize(15, ' ');
      if (const auto* inclusion = std::get_if<scenario::Inclusion>(&region.part))
        text += "a sphere of radius " + quantity_text(inclusion->radius, unit::mm) + " around " +
                scene::place_text(scene_.scenario, {inclusion->centre[0], inclusion->centre[1],
                                                    inclusion->centre[2]});
      else if (const auto* slab = std::get_if<scenario::Slab>(&region.part))
        text += "from " + quantity_text(slab->bottom, unit::mm) + " to " +
                quantity_text(slab->top, unit::mm) + " in height";
      else
        text += part_text(std::get<scenario::TaggedRegion>(region.part));
      text += ", " + region.material + ": E " + quantity_text(region.young_modulus, unit::kPa) +
              ", nu " + rounded_text(region.poisson_ratio, 4) + ", density " +
              quantity_text(region.density, unit::density);
      if (scene_.specimen)
        text += "; " + region_size(scene_.specimen->mesh, static_cast<int>(i) + 1);
      line(text);
    }
    if (!scene::all_slabs(scene_.scenario) && scene::several_tissues(scene_.scenario) &&
        scene_.scenario.meshed() && !scene_.scenario.uniform())
      line("  note         the contact law uses E and nu of `tissue.material` in every region");
  }

  static std::string part_text(const scenario::TaggedRegion& part) {
    return part.name.empty() ? "tag " + std::to_string(part.tag) : "group `" + part.name + "`";
  }

  static std::string region_size(const geometry::TetMesh& mesh, int region) {
    int count = 0;
    double volume = 0.0;
    for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t)
      if (mesh.region(t) == region) {
        ++count;
        volume += geometry::signed_volume(mesh, t);
      }
    return std::to_string(count) + " tetrahedra, " + rounded_text(1e6 * volume) + " cm^3";
  }

  void finger() {
    const scenario::Resolved::Finger& asked = scene_.scenario.finger;
    const scene::Finger& finger = scene_.finger;
    if (asked.spheres == 1) {
      line("  finger       one sphere of radius " + quantity_text(asked.radius, unit::mm) +
           (asked.replaced == 0 ? ""
                                : ", in place of " + std::to_string(asked.replaced) +
                                      " spheres that press a flat like it"));
    } else {
      line("  finger       " + std::to_string(asked.spheres) + " spheres of radius " +
           rounded_text(unit::mm.from_si(finger.sphere_radius)) + " mm for one of " +
           quantity_text(asked.radius, unit::mm) + ": their total force on a flat is " +
           rounded_text(finger.force_factor) + " times that of the one (calibration " +
           (asked.calibration == finger::Calibration::force ? "force" : "mass") + ")");
    }
    if (finger.weight > 0.0)
      line("  weight       " + rounded_text(finger.weight) + " N, added to the force in friction");
  }

  void contact() {
    const scenario::PlainContact& contact = scene_.scenario.contact;
    line("  contact      E* " + rounded_text(unit::kPa.from_si(scene_.law().modulus)) +
         " kPa, radius " + quantity_text(scene_.law().radius, unit::mm) +
         " on a flat; the finger has " + percent_text(scene_.finger.compliance_share) +
         " of the compliance");
    if (contact.friction > 0.0) line("  friction     mu " + number_text(contact.friction));
    curvature();
    if (!scene_.specimen) return;
    line("  coupling     " + told(scenario::words::couplings, contact.coupling) +
         (scene_.layer ? "; the law is the exact one of the flat layer" : ""));
    const auto& rings = scene_.scenario.solver.rings;
    if (rings)
      line("  rings        " + std::to_string(*rings) +
           " rings of nodes around the contact move, the others are fixed");
    else
      line("  rings        all: the whole specimen moves");
  }

  void curvature() {
    const scenario::PlainContact& contact = scene_.scenario.contact;
    std::string text = "  curvature    " + told(scenario::words::laws, contact.law);
    if (scene_.specimen)
      text += std::string("; measured by `") +
              word(scenario::words::curvature_methods, contact.curvature) + "` over " +
              std::to_string(contact.curvature_rings) +
              (contact.curvature_rings == 1 ? " ring" : " rings") + " of vertices, " +
              (contact.curvature_on == scenario::Contact::CurvatureOn::rest ? "at rest"
                                                                            : "as deformed");
    line(text);
  }

  void choice() {
    const scenario::Model model = scene_.scenario.solver.model;
    line(std::string("  model        ") + scenario::traits(model).word +
         (scene_.choice.given ? ", named by the scenario; criteria of `auto`:"
                              : ", chosen by these criteria:"));
    for (const scene::Question& question : scene_.choice.questions) {
      std::string text = "    " + question.asked;
      text.resize(17, ' ');
      if (!question.measure.empty())
        text += question.measure + " " + percent_text(question.number) + ", limit " +
                percent_text(question.threshold) + ": ";
      line(text + question.answer);
    }
    const std::optional<double> mesh_error = expected_.mesh_error;
    for (const scene::Forecast& forecast : scene_.choice.forecasts) {
      const bool on_mesh = mesh_error && scenario::traits(forecast.model).meshed();
      std::string text = std::string("  ") + (forecast.model == model ? "> " : "  ") +
                         scenario::traits(forecast.model).word;
      text.resize(22, ' ');
      line(text + (forecast.cannot.empty()
                       ? "error " + error_text(forecast.known(mesh_error, model)) +
                             (on_mesh ? " on this mesh" : "")
                       : "cannot: " + forecast.cannot));
    }
    if (const std::string text = scene_.choice.shortfall(mesh_error); !text.empty())
      line("  note         " + text);
  }

  void mesh(const scene::Specimen& specimen) {
    line("  mesh         " + std::to_string(specimen.network.nodes()) + " nodes, " +
         std::to_string(specimen.mesh.tetrahedra.size()) + " tetrahedra, " +
         std::to_string(specimen.network.springs()) + " springs");
    if (!specimen.warning.empty() && specimen.warning != scene_.choice.touch.warning)
      line("  surface      " + specimen.warning);
    if (const auto& refined = specimen.refined; refined && refined->rounds > 0)
      line("  refined      from " + std::to_string(refined->start_nodes) + " nodes in " +
           count_text(as_index(refined->rounds), "round") +
           ", where the error in the force comes from, " +
           (refined->error <= refined->wanted ? "until it is below " + percent_text(refined->wanted)
                                              : "as far as `tissue.mesh.most_nodes` allows"));
    if (const auto& error = expected_.mesh_error)
      line("  mesh error   " + error_text(*error) +
           " of the force at the largest displacement, estimated on this mesh");
    if (scenario::traits(scene_.scenario.solver.model).coupled()) {
      line("  springs      coupled in every tetrahedron: it has E and nu of the tissue");
      return;
    }
    const bool several = scene::several_tissues(scene_.scenario);
    line(std::string("  springs      measured on the specimen") +
         (several ? " with `tissue.material` in all regions" : "") + ": E " +
         rounded_text(unit::kPa.from_si(specimen.measured.young_modulus)) + " kPa (" +
         rounded_text(specimen.measured.young_modulus / scene_.scenario.tissue.young_modulus) +
         " of the tissue's), nu " + rounded_text(specimen.measured.poisson_ratio) +
         (scene_.scenario.uniform() ? "; nu of the tissue is not used"
                                    : "; nu of the tissue is used in the contact only"));
  }

  const scene::Scene& scene_;
  const run::Expected& expected_;
  std::string text_;
};

// Writes the scene as it is before anything is computed; `text` explains it on a page.
void draw(const std::string& file, const scene::Scene& scene, const std::string& title,
          const std::string& text) {
  const record::ScenePicture picture = run::picture_of(scene);
  if (file.ends_with(".svg")) return write_atomically(file, report::scene_svg(picture, title));
  page::Page page(title, "scene");
  const std::size_t end = std::min(text.find("\n\n"), text.size());  // of the sentences
  page.answer(split(text.substr(0, end), '\n'));
  page.beside(report::scene_view(picture, title));
  page.script(report::scene_script());
  page.section("What would be computed", page::element("pre", trimmed(text.substr(end))));
  write_atomically(file, page.html());
}

// Of more cases than `run` takes the first alone.
scenario::Family read_or_outline(const std::string& path,
                                 const std::vector<std::string>& settings) {
  const std::string text = read_text(path);
  const std::string name = path == "-" ? "stdin" : path;
  scenario::Family family = scenario::outline_text(text, name, settings);
  if (family.design.count() <= scenario::most_cases) return scenario::parse(text, name, settings);
  family.cases = {scenario::make_case(family, 0)};
  return family;
}

// The processor time of the whole run, s; `set_up`: what the scenes took of it. Of more cases than
// `run` takes, what `palpate sweep` takes; nothing if a case of it fails.
std::optional<run::Cost> cost_of(const scenario::Family& family,
                                 const std::vector<scene::Scene>& scenes, double set_up) {
  constexpr double figures = 0.1;  // s, about, of figures and files
  if (family.design.count() <= scenes.size()) {
    run::Cost cost = run::expected_cost(scenes);
    cost.seconds += set_up + figures;
    return cost;
  }
  const std::optional<sweep::SweepForecast> cost = sweep::forecast(family, false);
  return cost ? std::optional(run::Cost{cost->seconds}) : std::nullopt;
}

void tell_cost(const scenario::Family& family, const run::Cost& cost, const Talk& talk) {
  const auto& [seconds, at_least] = cost;
  const std::size_t cases = std::max<std::size_t>(1, family.design.count());
  const double of_a_case = seconds / static_cast<double>(cases);
  if (talk.json())
    return talk.event("cost", {{"cases", cases},
                               {"seconds", rounded(seconds, 3)},
                               {"at_least", at_least},
                               {"seconds_of_a_case", rounded(of_a_case, 3)}});
  const auto text = [](double time) {
    return time < 1.0    ? rounded_text(1e3 * time, 2) + " ms"
           : time < 60.0 ? rounded_text(time, 2) + " s"
                         : duration_text(time);
  };
  print("\nThe whole takes " + std::string(at_least ? "more than " : "about ") + text(seconds) +
        " of processor time" +
        (cases == 1 ? "" : ": " + std::to_string(cases) + " cases of " + text(of_a_case)) +
        (at_least ? ", mostly less than a minute for one; `run` says how much is left.\n" : ".\n"));
}

// Of all cases together, before any has run.
std::string summary(const std::vector<scene::Scene>& scenes,
                    const std::vector<run::Expected>& expected) {
  std::vector<record::CaseRecord> records(scenes.size());
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    records[i].name = scenes[i].name;
    records[i].findings = {
        {"model", std::string(scenario::traits(scenes[i].scenario.solver.model).word)}};
    records[i].answer = expected[i].answer;
  }
  return joined(report::forecast_lines(records), "\n") + "\n";
}

// The number of the case that is explained at length: the first, or the one asked for.
std::size_t case_shown(const Explain& command, const std::vector<scene::Scene>& scenes) {
  if (command.case_name.empty()) return 0;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (scenes[i].name == command.case_name) return i;
    names.push_back(scenes[i].name);
  }
  constexpr std::size_t most = 12;
  const auto near = nearest(command.case_name, names);
  if (names.size() > most) {
    names.resize(most);
    names.emplace_back("...");
  }
  throw InputError({command.subject, 0, 0}, "has no case " + ticked(command.case_name) +
                                                (near ? "; did you mean " + ticked(*near) + "?"
                                                      : "; its cases: " + joined(names, ", ")));
}

}  // namespace

int perform(const Explain& command, const Arguments&, const Talk& talk) {
  const std::string subject = scenario::find(command.subject);  // an example with its ending
  const bool file =
      subject == "-" || subject.ends_with(".toml") || std::filesystem::exists(subject);
  if (!file) {
    if (talk.json())
      talk.event("key", {{"subject", command.subject},
                         {"text", scenario::meaning_of_key(command.subject)}});
    else
      print(scenario::meaning_of_key(command.subject));
    return exit_good;
  }
  if (!command.picture.empty() && !command.picture.ends_with(".svg") &&
      !command.picture.ends_with(".html"))
    throw InputError({command.picture, 0, 0},
                     "a picture is written as `.svg` or `.html`; give one of these endings");
  const scenario::Family family = read_or_outline(subject, command.settings);
  const double start = processor_seconds();
  const std::vector<scene::Scene> scenes = run::build_all(family, 1);
  const double set_up = processor_seconds() - start;
  std::vector<run::Expected> expected;
  for (const scene::Scene& scene : scenes) expected.push_back(run::expect(scene));
  const std::optional<run::Cost> cost = cost_of(family, scenes, set_up);
  const std::size_t shown = case_shown(command, scenes);
  const bool several = family.design.count() > 1;
  const std::string text = Explanation(scenes[shown], expected[shown])
                               .text(several ? scenes[shown].name : "", family.title);
  if (!command.picture.empty())
    draw(command.picture, scenes[shown],
         family.title + (several ? ", case " + scenes[shown].name : ""),
         Explanation(scenes[shown], expected[shown]).text("", family.title));
  if (talk.json()) {
    for (std::size_t i = 0; i < scenes.size(); ++i)
      print(explain_json(family.name, scenes[i], expected[i],
                         family.design.empty() ? cost : std::nullopt) +
            "\n");
    if (cost && !family.design.empty()) tell_cost(family, *cost, talk);
  } else {
    const bool first_of_several = scenes.size() > 1 && command.case_name.empty();
    if (first_of_several) print(summary(scenes, expected));
    if (first_of_several && cost) tell_cost(family, *cost, talk);
    if (first_of_several)
      print("\nThe first of " + std::to_string(scenes.size()) + " cases; `--case " +
            shown_word(scenes.back().name) + "` shows the last.\n");
    print_text(text);
    if (!first_of_several && cost) tell_cost(family, *cost, talk);
  }
  for (const Problem& note : family.notes) talk.say("note: " + note.text());  // the answer is first
  if (command.subject != "-") talk.next("run", command.subject);
  return exit_good;
}

}  // namespace palpate::cli
