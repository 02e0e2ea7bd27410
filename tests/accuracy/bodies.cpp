// The table of discs, domes and inclusions in docs/accuracy.md.
#include "accuracy/bodies.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "revolved_bodies.h"
#include "run_text.h"

namespace palpate {
namespace {

// The largest error over the body's depths, with the error that the mesh states there.
std::string cell(const test::Body& body, const std::string& model, int nodes,
                 const std::string& mesh) {
  const test::TemporaryFolder folder;
  record::CaseRecord record;
  try {
    record = test::run_text(test::body_press(body, folder.path() / "body.off", nodes, model, mesh));
  } catch (const std::exception&) {
    return "-";
  }
  double worst = 0.0;
  double stated = 0.0;
  for (const test::Band& band : test::bands(body.id))
    for (const record::ContactRow& row : record.contact) {
      if (std::abs(1e3 * row.travel - band.travel) > 1e-6) continue;
      const double error = test::outside(1e3 * row.contact_force, band);
      if (std::abs(error) >= std::abs(worst)) worst = error;
      stated = std::max(stated, row.mesh_error);
    }
  char text[64];
  std::snprintf(text, sizeof text, "%.1f (%.1f)", 100.0 * worst, 100.0 * stated);
  return text;
}

}  // namespace

void print_rows(const std::string& lead, const std::string& empty,
                const std::vector<std::pair<std::string, std::string>>& rows) {
  std::vector<std::pair<std::string, std::string>> merged;
  for (const auto& [name, cells] : rows) {
    const auto same =
        std::ranges::find(merged, cells, &std::pair<std::string, std::string>::second);
    if (same != merged.end())
      same->first += "; " + name;
    else
      merged.emplace_back(name, cells);
  }
  for (const auto& [names, cells] : merged)
    std::printf("|%s %s |%s\n", (&names == &merged.front().first ? lead : empty).c_str(),
                names.c_str(), cells.c_str());
  std::fflush(stdout);
}

void bodies_table() {
  std::printf(
      "\n## Discs, domes and inclusions\n\nThe largest error at depths of up to a tenth of the "
      "finger's "
      "radius and of the thickness, in percent of the nearer edge of\nthe band, and in brackets "
      "what the mesh states (theory.md `[compliance]`). The band is that of linear elasticity and "
      "of "
      "a neo-Hookean "
      "solid\n([tests/cases/bodies.csv](../tests/cases/bodies.csv)). All bodies are surface files; "
      "the default mesh is refined where its\nerror comes from. `lump-x20` has a ball of 5 mm, 20 "
      "times as stiff, 10 mm deep, and `lump-x1` the same ball of the same\ntissue.\n\n"
      "| body | model | 200 nodes | 400 nodes | 1500 nodes | default "
      "|\n|---|---|---|---|---|---|\n");
  for (const test::Body& body : test::all_bodies()) {
    std::vector<std::pair<std::string, std::string>> rows;
    for (const char* model : {"mass_spring", "coupled_springs"}) {
      auto& [name, cells] = rows.emplace_back(model, "");
      for (const int nodes : {200, 400, 1500})
        cells += " " +
                 cell(body, model, nodes,
                      "mesh = { kind = \"tetgen\", nodes = " + std::to_string(nodes) + " }\n") +
                 " |";
      cells += " " + cell(body, model, 728, "") + " |";
    }
    print_rows(" " + body.id + " |", "  |", rows);
  }
}

}  // namespace palpate
