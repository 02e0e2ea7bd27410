// `palpate chart --frames`: times frames of 1 ms of a press in the stages of the paper's Table 2.
// The four models are pressed by 1 mm with the coupling `consistent`, by central differences in
// stable substeps and by modal coordinates, as whole bodies and with 3 rings. The stages are timed
// apart, each in all substeps of a frame; `frame` is the time of `palpate run` for 1 ms, and
// `other` what the stages leave of it, mostly the energy balance. One thread.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "page/page.h"
#include "run/bench.h"
#include "run/refined_mesh.h"
#include "scenario/words.h"

namespace palpate::cli {
namespace {

using Solver = scenario::Resolved::Solver;

struct Paper {
  double collision, force, deformation;  // ms
};
struct Model {
  const char* name;
  const char* tissue;  // the scenario's table `tissue`
  Paper paper;
};

// Chen 2007, Table 2. The paper names no tissues there. Assumed are skin for cube and head, and the
// upper leg of its Table 1 for all layers of the limb.
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
     "mesh = { kind = \"tetgen\", nodes = 570, tetrahedra = 1830 }\n",  // and the base's border
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
    for (const char* stage : {"collision", "force", "deformation", "other", "sum", "frame"})
      for (const char* part : {"_p50_ms", "_p99_ms"})
        table_.columns.push_back(std::string(stage) + part);
    for (const char* stage : {"collision", "force", "deformation", "sum"})
      table_.columns.push_back("paper_" + std::string(stage) + "_ms");
    for (const char* proof : {"force_N", "displacement_mm"}) table_.columns.emplace_back(proof);
  }

  // Times one scene and adds its row; false if the press ended early.
  bool measure(const std::string& name, const scene::Scene& scene, const Paper* paper) {
    const Solver& solver = scene.scenario.solver;
    const std::string rings = solver.rings ? std::to_string(*solver.rings) : "all";
    const char* const integrator = about(solver.integrator).word;
    talk_.progress(name + ", " + integrator + ", rings " + rings);
    const run::Bench bench = run::bench(scene, frames_);
    talk_.progress("");
    if (bench.wrong) {
      Talk::error("palpate: " + name + ", " + integrator + ", rings " + rings + ", " +
                  *bench.wrong);
      return false;
    }
    std::vector<record::Cell> row{
        name,
        static_cast<double>(scene.specimen->mesh.nodes.size()),
        static_cast<double>(scene.specimen->mesh.tetrahedra.size()),
        integrator,
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

  // The medians and the paper's times, in ms per frame of 1 ms.
  [[nodiscard]] record::Table medians() const {
    record::Table shown = page::columns_of(
        table_, {"model", "integrator", "rings", "collision_p50_ms", "force_p50_ms",
                 "deformation_p50_ms", "sum_p50_ms", "frame_p50_ms", "paper_sum_ms"});
    for (std::string& column : shown.columns)  // the caption says the unit
      column = column.substr(0, std::min(column.find("_p50"), column.find("_ms")));
    return shown;
  }

  // Of the slowest frame the time, and the stages that were timed apart.
  [[nodiscard]] std::pair<std::string, std::string> slowest() const {
    const auto ms = [&](const auto& row, const char* column) {
      const auto* value = std::get_if<double>(&cell(row, column));
      return value == nullptr ? 0.0 : *value;
    };
    const auto slow = std::ranges::max_element(table_.rows, [&](const auto& a, const auto& b) {
      return ms(a, "frame_p50_ms") < ms(b, "frame_p50_ms");
    });
    if (slow == table_.rows.end()) return {"", "no frame was measured"};
    std::pair part{0.0, "collision"};
    for (const auto& [column, name] : {std::pair{"collision_p50_ms", "collision"},
                                       {"force_p50_ms", "force"},
                                       {"deformation_p50_ms", "deformation"}})
      part = std::max(part, std::pair{ms(*slow, column), name},
                      [](const auto& a, const auto& b) { return a.first < b.first; });
    return {rounded_text(ms(*slow, "frame_p50_ms"), 3) + " ms",
            "for the slowest whole frame of 1 ms, of " +
                std::get<std::string>(cell(*slow, "model")) + " by " +
                std::get<std::string>(cell(*slow, "integrator")) +
                "; its stages, timed apart, sum to " + rounded_text(ms(*slow, "sum_p50_ms"), 3) +
                " ms, most of it for the " + part.second};
  }

  // The paper's Table 2 beside the whole meshes by its integrator.
  [[nodiscard]] record::Table beside_the_paper() const {
    record::Table table{{"the paper", "here", "verdict", "why"}, {}};
    std::vector<double> sums;
    std::string order;
    for (const auto& row : table_.rows) {
      const auto* paper = std::get_if<double>(&cell(row, "paper_sum_ms"));
      if (paper == nullptr || cell(row, "rings") != record::Cell("all") ||
          cell(row, "integrator") != record::Cell("central_difference"))
        continue;
      const auto stages = [&](const std::string& front, const std::string& end) {
        std::string text;
        for (const char* stage : {"collision", "force", "deformation", "sum"})
          text += (text.empty() ? "" : ", ") + std::string(stage) + " " +
                  rounded_text(std::get<double>(cell(row, front + stage + end)), 3);
        return text + " ms";
      };
      const std::string name = std::get<std::string>(cell(row, "model"));
      sums.push_back(std::get<double>(cell(row, "sum_p50_ms")));
      order += (order.empty() ? "" : " < ") + name;
      table.rows.push_back(
          {name + ": " + stages("paper_", "_ms"), stages("", "_p50_ms"), page::verdicts[1],
           "another computer: " + rounded_text(*paper / sums.back(), 2) + " times as fast"});
    }
    const bool grows = std::ranges::is_sorted(sums);
    table.rows.push_back({"The time grows with the model: " + order,
                          grows ? "so it does" : "it does not", page::verdicts[grows ? 0 : 1],
                          "the same meshes within 3 % of the nodes"});
    table.rows.push_back({"Tissues and sizes of the models", "docs/paper.md", page::verdicts[2],
                          "skin for cube and head, and the upper leg for the limb, are assumed"});
    return table;
  }

 private:
  // Rounds a time in ms to the resolution of the clock.
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
    add([](const run::FrameTime& frame) { return frame.other(); });
    add([](const run::FrameTime& frame) { return frame.sum(); });
    add([](const run::FrameTime& frame) { return frame.whole; });
  }

  [[nodiscard]] const record::Cell& cell(const std::vector<record::Cell>& row,
                                         const std::string& column) const {
    return row[as_index(table_.find(column))];
  }

  int frames_;
  const Talk& talk_;
  record::Table table_;
};

// Each model with both integrators, the whole mesh and 3 rings of it, unless the settings fix the
// integrator or the rings. Neither changes the mesh, which is made once.
bool measure_models(const std::vector<std::string>& settings, Table& table) {
  bool all = true;
  for (const Model& model : models) {
    const std::string name = model.name;
    const scenario::Family family = scenario::parse(
        "[tissue]\n" + std::string(model.tissue) +
            "[solver]\nmodel = \"mass_spring\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n",
        name + ".toml", settings);
    const scenario::Solver& asked = family.cases.front().scenario.solver;
    std::vector integrators{Solver::Integrator::central_difference, Solver::Integrator::modal};
    if (asked.integrator) integrators = {*asked.integrator};
    std::vector<std::optional<int>> all_rings{std::nullopt, 3};
    if (asked.rings) all_rings = {asked.rings};
    scene::Scene scene = run::build_scene(family.cases.front(), family);
    for (const auto integrator : integrators)
      for (const std::optional<int> rings : all_rings) {
        scene.scenario.solver.integrator = integrator;
        scene.scenario.solver.rings = rings;
        scene.specimen->plan = scene::plan_time(scene.scenario, *scene.specimen, {});
        all = table.measure(name, scene, &model.paper) && all;
      }
  }
  return all;
}

bool measure_scenario(const std::string& path, std::vector<std::string> settings, Table& table,
                      const Talk& talk) {
  for (const char* fixed :
       {"solver.model=mass_spring", "solver.time_step=1 ms", "output.interval=1 ms"})
    settings.emplace_back(fixed);
  scenario::Family family = scenario::read(path, settings);
  if (!family.cases.front().scenario.solver.integrator) {  // steps are timed, not statics
    settings.emplace_back("solver.integrator=central_difference");
    family = scenario::read(path, settings);
  }
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  bool all = true;
  for (const scenario::Case& one : family.cases) {
    if (one.scenario.uniform())
      throw InputError({path, 0, 0},
                       "has no finger; `--frames` times a press, so give a scenario with `indent`");
    const std::string name = family.cases.size() > 1 ? family.name + "/" + one.name : family.name;
    all = table.measure(name, run::build_scene(one, family), nullptr) && all;
  }
  return all;
}

void write_page(const Chart& command, const Table& table) {
  page::Page page("Times of a frame of 1 ms", "chart of frames");
  const auto [time, what] = table.slowest();
  page.headline(time, what);
  page.answer({"Medians of " + std::to_string(command.frames) + " frames on one core.",
               "`frame` is the time of a whole frame in `palpate run`. The stages are timed after "
               "it, each by itself on a second mesh, as in the paper's Table 2: their sum can be "
               "larger, where each finds its data no longer in the cache, or smaller, because the "
               "energy balance belongs to no stage."});
  const auto whole = [](const std::string& caption, const record::Table& rows) {
    return page::element("div", page::table(caption, rows), {{"class", "whole"}});
  };
  if (command.scenario.empty())
    page.section("Beside the paper", whole("Table 2 beside this run", table.beside_the_paper()));
  record::Table medians = table.medians();  // those of the paper are above
  medians = page::columns_of(medians, {medians.columns.begin(), medians.columns.end() - 1});
  page.section("Times", whole("Medians, ms per frame of 1 ms", medians));
  make_folders(std::filesystem::path(command.report).parent_path().string());
  write_atomically(command.report, page.html());
}

}  // namespace

int time_frames(const Chart& command, const Talk& talk) {
  Table table(command.frames, talk);
  const bool all = command.scenario.empty()
                       ? measure_models(command.settings, table)
                       : measure_scenario(command.scenario, command.settings, table, talk);
  print_result(table.table(), table.medians(), talk);
  if (!talk.json() && !talk.csv())
    talk.say("Medians, ms per frame of 1 ms; `frame` is the time of `palpate run`.");
  if (!command.report.empty()) write_page(command, table);
  return all ? exit_good : exit_diverged;
}

}  // namespace palpate::cli
