// `palpate bench`: frames of 1 ms of a press, in the stages of the paper's Table 2. The four models
// are pressed 1 mm with coupling `consistent`, by central differences in stable substeps and in
// modal coordinates, the whole body and 3 rings of it. A frame is detection over the deformed skin
// once, forces once, and the mesh's substeps; `frame` is what `palpate run` takes for the same
// millisecond, forces and energy balance in every substep. One thread.
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/text.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "record/csv.h"
#include "run/bench.h"
#include "scenario/words.h"

namespace palpate::cli {
namespace {

using scenario::Solver;

struct Paper {
  double collision, force, deformation;  // ms
};
struct Model {
  const char* name;
  const char* tissue;  // tables of the scenario
  Paper paper;
};

// Chen 2007, Table 2. The paper says no tissues here: skin where the name says none, and the limb's
// layers are all the upper leg of its Table 1.
constexpr Model models[] = {
    {"cube",
     "material = \"skin\"\nshape = { kind = \"cuboid\" }\n"
     "mesh = { kind = \"kuhn\", cells = [3, 4, 6] }\n",
     {0.12, 0.25, 0.08}},
    {"head",
     "material = \"skin\"\nshape = { kind = \"ellipsoid\" }\n"
     "mesh = { kind = \"tetgen\", nodes = 456, tetrahedra = 1470 }\n",
     {0.29, 0.36, 0.15}},
    {"ligament",
     "material = \"ligament\"\nshape = { kind = \"ligament\" }\n"
     "mesh = { kind = \"tetgen\", nodes = 601, tetrahedra = 1900 }\n",
     {0.37, 0.43, 0.21}},
    {"upper_leg",
     "material = \"upper_leg\"\nshape = { kind = \"layered_limb\" }\n"
     "mesh = { kind = \"tetgen\", nodes = 728, tetrahedra = 2550 }\n"
     "[[region]]\nkind = \"tagged\"\ntag = 1\nmaterial = \"upper_leg\"\n"
     "[[region]]\nkind = \"tagged\"\ntag = 2\nmaterial = \"upper_leg\"\n",
     {0.31, 0.57, 0.29}},
};

class Table {
 public:
  explicit Table(int frames, const Talk& talk) : frames_(frames), talk_(talk) {
    table_.columns = {"model", "nodes",    "tetrahedra", "integrator",
                      "rings", "coupling", "substeps",   "frames"};
    for (const char* stage : {"collision", "force", "deformation", "sum", "frame"})
      for (const char* part : {"_p50_ms", "_p99_ms"})
        table_.columns.push_back(std::string(stage) + part);
    for (const char* stage : {"collision", "force", "deformation", "sum"})
      table_.columns.push_back("paper_" + std::string(stage) + "_ms");
    for (const char* proof : {"force_N", "displacement_mm"}) table_.columns.emplace_back(proof);
  }

  // False where the press ended early.
  bool measure(const std::string& name, const scene::Scene& scene, const Paper* paper) {
    const Solver& solver = scene.scenario.solver;
    const std::string rings = solver.rings ? std::to_string(*solver.rings) : "all";
    talk_.progress(name + ", " +
                   scenario::words::word(scenario::words::integrators, solver.integrator) +
                   ", rings " + rings);
    const run::Bench bench = run::bench(scene, frames_);
    talk_.progress("");
    if (bench.wrong) {
      Talk::error("palpate: " + name + ", " +
                  scenario::words::word(scenario::words::integrators, solver.integrator) +
                  ", rings " + rings + ", " + *bench.wrong);
      return false;
    }
    std::vector<record::Cell> row{
        name,
        static_cast<double>(scene.specimen->mesh.nodes.size()),
        static_cast<double>(scene.specimen->mesh.tetrahedra.size()),
        scenario::words::word(scenario::words::integrators, solver.integrator),
        solver.rings ? record::Cell(static_cast<double>(*solver.rings)) : record::Cell("all"),
        scenario::words::word(scenario::words::couplings, scene.scenario.contact.coupling),
        static_cast<double>(scene.specimen->plan.substeps),
        static_cast<double>(bench.frames.size())};
    add_percentiles(bench, row);
    if (paper != nullptr) {
      const double sum = paper->collision + paper->force + paper->deformation;
      for (const double time : {paper->collision, paper->force, paper->deformation, sum})
        row.emplace_back(to_nanoseconds(time));
    } else {
      row.resize(row.size() + 4);
    }
    row.emplace_back(bench.force);
    row.emplace_back(1e3 * bench.displacement);
    table_.rows.push_back(std::move(row));
    return true;
  }

  [[nodiscard]] const record::Table& table() const { return table_; }

  // The medians beside the paper's times, for people.
  [[nodiscard]] std::string readable() const {
    std::string text;
    char line[200];
    std::snprintf(line, sizeof line, "%-12s %-20s %5s %9s %8s %8s %8s %8s %8s %8s\n", "model",
                  "integrator", "rings", "collision", "force", "deform", "sum", "sum p99", "frame",
                  "paper");
    text += line;
    for (const auto& row : table_.rows) {
      std::snprintf(line, sizeof line, "%-12s %-20s %5s %9s %8s %8s %8s %8s %8s %8s\n",
                    shown(row, "model").c_str(), shown(row, "integrator").c_str(),
                    shown(row, "rings").c_str(), shown(row, "collision_p50_ms").c_str(),
                    shown(row, "force_p50_ms").c_str(), shown(row, "deformation_p50_ms").c_str(),
                    shown(row, "sum_p50_ms").c_str(), shown(row, "sum_p99_ms").c_str(),
                    shown(row, "frame_p50_ms").c_str(), shown(row, "paper_sum_ms").c_str());
      text += line;
    }
    return text + "ms a frame of 1 ms: medians; `frame` is what `palpate run` takes for it";
  }

 private:
  // ms, to what the clock tells.
  static double to_nanoseconds(double time) { return std::round(1e6 * time) / 1e6; }

  static void add_percentiles(const run::Bench& bench, std::vector<record::Cell>& row) {
    const auto add = [&](const auto& time_of) {
      std::vector<double> times;
      for (const run::FrameTime& frame : bench.frames) times.push_back(time_of(frame));
      for (const double share : {0.5, 0.99})
        row.emplace_back(to_nanoseconds(1e3 * run::percentile(times, share)));
    };
    add([](const run::FrameTime& frame) { return frame.collision; });
    add([](const run::FrameTime& frame) { return frame.force; });
    add([](const run::FrameTime& frame) { return frame.deformation; });
    add([](const run::FrameTime& frame) { return frame.sum(); });
    add([](const run::FrameTime& frame) { return frame.whole; });
  }

  [[nodiscard]] std::string shown(const std::vector<record::Cell>& row, const char* column) const {
    const record::Cell& cell = row[static_cast<std::size_t>(table_.find(column))];
    if (const auto* word = std::get_if<std::string>(&cell)) return *word;
    if (const auto* number = std::get_if<double>(&cell)) return rounded_text(*number, 3);
    return "-";
  }

  int frames_;
  const Talk& talk_;
  record::Table table_;
};

// Each model once; what the rows differ in does not change its mesh.
bool measure_models(Table& table) {
  bool all = true;
  for (const Model& model : models) {
    const std::string name = model.name;
    const scenario::Family family = scenario::parse(
        "[tissue]\n" + std::string(model.tissue) +
            "[solver]\nmodel = \"mass_spring\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n",
        name + ".toml", {});
    scene::Scene scene = scene::build(family.cases.front(), family);
    for (const auto integrator :
         {Solver::Integrator::central_difference, Solver::Integrator::modal})
      for (const std::optional<int> rings : {std::optional<int>(), std::optional<int>(3)}) {
        scene.scenario.solver.integrator = integrator;
        scene.scenario.solver.rings = rings;
        scene.specimen->plan = scene::plan_time(scene.scenario, *scene.specimen, {});
        all = table.measure(name, scene, &model.paper) && all;
      }
  }
  return all;
}

bool measure_scenario(const std::string& path, Table& table, const Talk& talk) {
  const scenario::Family family = scenario::read(
      path, {"solver.model=mass_spring", "solver.time_step=1 ms", "output.interval=1 ms"});
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  bool all = true;
  for (const scenario::Case& one : family.cases) {
    if (one.scenario.uniform())
      throw InputError({path, 0, 0},
                       "has no finger; `palpate bench` times a press, so give a scenario with "
                       "`indent`");
    const std::string name = family.cases.size() > 1 ? family.name + "/" + one.name : family.name;
    all = table.measure(name, scene::build(one, family), nullptr) && all;
  }
  return all;
}

}  // namespace

int bench(const Bench& command, const Talk& talk) {
  Table table(command.frames, talk);
  bool all = true;
  if (command.scenarios.empty()) all = measure_models(table);
  for (const std::string& path : command.scenarios)
    all = measure_scenario(path, table, talk) && all;
  print(talk.json() ? json_lines(table.table()) : record::csv_text(table.table()));
  if (::isatty(STDERR_FILENO) == 1) talk.say(table.readable());
  return all ? exit_good : exit_diverged;
}

}  // namespace palpate::cli
