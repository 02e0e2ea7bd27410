// Prints tables of docs/accuracy.md: every model's error on blocks, in uniform tests and on the
// scenes of `auto`. No test: it takes minutes. `./dev accuracy` runs it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/bodies.h"
#include "base/text.h"
#include "blocks.h"
#include "plot/gnuplot_text.h"
#include "run/family.h"
#include "run_text.h"
#include "scenario/words.h"

namespace palpate {
namespace {

using scenario::Model;

using test::run_text;

std::string percent(std::optional<double> part) {
  if (!part) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", 100.0 * *part);
  return text;
}

std::optional<double> block_error(const test::Block& block, const std::string& model,
                                  const std::string& mesh, const std::string& volume = "auto") {
  try {
    return test::error_of(
        block, {"solver.model=" + model, "tissue.mesh=" + mesh, "solver.volume=" + volume});
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

void blocks_table() {
  struct Mesh {
    const char* name;
    const char* text;
  };
  const Mesh meshes[] = {{"structured 140", "{kind=\"mirrored\",cells=[3,4,6]}"},
                         {"TetGen 164", "{kind=\"tetgen\",nodes=164}"},
                         {"structured 405", "{kind=\"mirrored\",cells=[8,8,4]}"},
                         {"TetGen 728", "{kind=\"tetgen\",nodes=728}"},
                         {"TetGen 1500", "{kind=\"tetgen\",nodes=1500}"}};
  std::printf(
      "## Blocks under a rigid sphere\n\n"
      "The largest error over all depths of the block, in percent of the nearer edge of the band "
      "between the two readings of\nlinear elasticity; 0 means inside the band. `hertz` and "
      "`layer` have no mesh. The band was computed by an independent\nprogram: "
      "[tests/elasticity](../tests/elasticity/README.md) describes the blocks, the depths and the "
      "forces.\n\n"
      "| block | hertz | layer | model |");
  for (const Mesh& mesh : meshes) std::printf(" %s |", mesh.name);
  std::printf("\n|---|---|---|---|");
  for (std::size_t i = 0; i < std::size(meshes); ++i) std::printf("---|");
  std::printf("\n");
  for (const test::Block& block : test::blocks()) {
    const auto hertz = block_error(block, "hertz", meshes[0].text);
    const auto layer = block_error(block, "layer", meshes[0].text);
    const std::pair<const char*, const char*> model_traits[] = {
        {"mass_spring", "none"}, {"mass_spring", "nodal"}, {"coupled_springs", "nodal"}};
    std::vector<std::pair<std::string, std::string>> rows;
    for (const auto& [model, volume] : model_traits) {
      const bool added = model == std::string("mass_spring") && volume == std::string("nodal");
      auto& [name, cells] =
          rows.emplace_back(model + std::string(added ? ", nodal volume" : ""), "");
      for (const Mesh& mesh : meshes)
        cells += " " + percent(block_error(block, model, mesh.text, volume)) + " |";
    }
    print_rows(" " + block.name + " | " + percent(hertz) + " | " + percent(layer) + " |",
               "  |  |  |", rows);
  }
}

// Force at 1 mm over the middle of the band, against the number of nodes, as a gnuplot script.
void figure(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) return;
  std::string script =
      plot::gnuplot_head("accuracy", {.height = 700}) +
      "set multiplot layout 2,1\nset xlabel 'nodes'\nset ylabel 'force over the "
      "middle of the band'\nset yrange [0.9:1.1]\nset key bottom right samplen 1.5 font ',12'\n" +
      plot::gnuplot_logarithmic("x", 100.0, 4000.0) + "set xrange [100:4000]\n";
  const std::pair<const char*, const char*> panels[] = {
      {"block30-nu45", "60 x 60 x 30 mm, nu 0.45"}, {"block10-nu45", "60 x 60 x 10 mm, nu 0.45"}};
  for (const auto& [wanted, title] : panels)
    for (const test::Block& block : test::blocks()) {
      if (block.name != wanted) continue;
      const test::Block::Row& row = block.rows.back();
      const double middle = 0.5 * (row.low + row.high);
      std::vector<std::pair<std::string, std::string>> curves;  // equal ones once: data and names
      const std::pair<const char*, const char*> model_traits[] = {
          {"mass_spring", "none"}, {"mass_spring", "nodal"}, {"coupled_springs", "nodal"}};
      for (const auto& [model, volume] : model_traits) {
        std::string points;
        for (const int nodes : {164, 400, 728, 1500, 3000}) {
          auto settings = block.settings;
          settings.push_back(std::string("solver.model=") + model);
          settings.push_back(std::string("solver.volume=") + volume);
          settings.push_back("tissue.mesh={kind=\"tetgen\",nodes=" + std::to_string(nodes) + "}");
          const auto record = run_text(test::programme(block), settings);
          points += std::to_string(nodes) + "," +
                    rounded_text(record.contact.back().force / middle, 7) + "\n";
        }
        const bool added = model == std::string("mass_spring") && volume == std::string("nodal");
        const std::string name = model + std::string(added ? ", nodal volume" : "");
        const auto same =
            std::ranges::find(curves, points, &std::pair<std::string, std::string>::first);
        if (same == curves.end())
          curves.emplace_back(points, name);
        else
          same->second += "; " + name;
      }
      script += "set title '" + std::string(title) +
                "'\nset object 1 rectangle from graph 0, first " + rounded_text(row.low / middle) +
                " to graph 1, first " + rounded_text(row.high / middle) +
                " fillcolor rgb '#dddddd' fillstyle solid noborder behind\n";
      std::string plots;
      for (std::size_t i = 0; i < curves.size(); ++i) {
        const std::string data = "$" + block.name.substr(0, 7) + std::to_string(i);
        script += data + " << EOD\nnodes,force\n" + curves[i].first + "EOD\n";
        plots +=
            (i > 0 ? ", " : "plot ") + data +
            " using 1:2 with linespoints pointtype 7 pointsize 0.6 linewidth 2 linecolor rgb '#" +
            plot::line_colours.at(i) + "' title '" + curves[i].second + "'";
      }
      script += plots + "\nunset object 1\n";
    }
  std::fputs((script + "unset multiplot\n").c_str(), file);
  std::fclose(file);
}

// Strain of creep under a stress, stress of relaxation under a strain, over the closed form.
void uniform_table() {
  std::printf(
      "\n## Uniform tests\n\nThe largest error of creep, recovery (relative to the strain at its "
      "beginning) and relaxation of a block between\nfrictionless platens, compared with the "
      "closed form, in percent; 300 nodes from TetGen, quasi-static rows of 10 ms.\n\n"
      "| nu | model | Kelvin-Voigt creep and recovery | standard linear solid relaxation |\n"
      "|---|---|---|---|\n");
  for (const double nu : {0.0, 0.25, 0.33, 0.45, 0.49}) {
    for (const char* model : {"mass_spring", "coupled_springs"}) {
      const std::vector<std::string> common{std::string("solver.model=") + model,
                                            "solver.integrator=quasi_static",
                                            "tissue.poisson_ratio=" + number_text(nu),
                                            "tissue.mesh={kind=\"tetgen\",nodes=300}",
                                            "output.interval=10 ms",
                                            "tissue.young_modulus=10 kPa"};
      auto creeping = common;
      creeping.emplace_back("tissue.retardation_time=0.1 s");
      const auto creep = run_text(
          "[tissue]\nviscosity = \"kelvin_voigt\"\n[[step]]\nkind = \"creep\"\nstress = \"0.1 "
          "kPa\"\nload_time = \"0.5 s\"\nrecovery_time = \"0.5 s\"\n",
          creeping);
      double worst = 0.0;
      for (const auto& row : creep.strain) {
        const double end = 0.01 * -std::expm1(-5.0);
        const double exact = row.time <= 0.5 ? 0.01 * -std::expm1(-row.time / 0.1)
                                             : end * std::exp(-(row.time - 0.5) / 0.1);
        worst = std::max(worst, std::abs(row.strain - exact) / end);
      }
      auto relaxing = common;
      relaxing.emplace_back("tissue.relaxation_time=0.1 s");
      relaxing.emplace_back("tissue.instantaneous_ratio=3");
      const auto relax = run_text(
          "[tissue]\nviscosity = \"standard_linear_solid\"\n[[step]]\nkind = \"relax\"\nstrain = "
          "0.01\ntime = \"0.5 s\"\n",
          relaxing);
      double worst_stress = 0.0;
      for (const auto& row : relax.strain) {
        const double exact = 100.0 * (1.0 + 2.0 * std::exp(-row.time / 0.1));
        worst_stress = std::max(worst_stress, std::abs(row.stress / exact - 1.0));
      }
      std::printf("| %s | %s | %.3f | %.3f |\n", number_text(nu).c_str(), model, 100.0 * worst,
                  100.0 * worst_stress);
    }
  }
}

}  // namespace
}  // namespace palpate

// The first argument names the gnuplot script of the figure; a second one the only table to write:
// `blocks`, `bodies` or `uniform`; `figure` makes the script alone.
int main(int count, char** arguments) {
  const std::string only = count > 2 ? arguments[2] : "";
  const auto wanted = [&](const char* table) { return only.empty() || only == table; };
  if (wanted("blocks")) {
    palpate::blocks_table();
    std::printf(
        "\n![Force against nodes](accuracy.svg)\n\nThe same at 1 mm on TetGen's meshes. The grey "
        "band is that of linear elasticity. The force at rest of both\nkinds of springs comes from "
        "the "
        "same finite elements.\n");
  }
  if (count > 1 && wanted("figure")) palpate::figure(arguments[1]);
  if (wanted("bodies")) palpate::bodies_table();
  if (wanted("uniform")) palpate::uniform_table();
}
