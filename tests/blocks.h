// Spheres on blocks as an independent finite-element program found them:
// tests/elasticity/README.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/text.h"
#include "record/csv.h"
#include "run_text.h"

namespace palpate::test {

// Forces at growing depths of one block; the truth lies between the two ways to read linear
// elasticity, contact vertical at the undeformed radius and contact along the sphere's normal.
struct Block {
  std::string name;
  std::vector<std::string> settings;  // of the scenario
  std::string below;                  // the layer under the top one, of the scenario
  double height = 0.0;                // mm
  bool aside = false;                 // pressed off the middle
  struct Row {
    double depth, low, high;  // mm, N
  };
  std::vector<Row> rows;
};

inline std::vector<Block> blocks() {
  const record::Table table =
      record::read_csv(std::string(PALPATE_SOURCE_DIR) + "/tests/elasticity/forces.csv");
  std::vector<Block> found;
  for (const auto& row : table.rows) {
    const auto number = [&](const char* column) {
      return std::get<double>(row[static_cast<std::size_t>(table.find(column))]);
    };
    const auto word = [&](const char* column) {
      return std::get<std::string>(row[static_cast<std::size_t>(table.find(column))]);
    };
    if (found.empty() || found.back().name != word("scene")) {
      const auto length = [&](const char* column) {
        return "\"" + number_text(number(column)) + " mm\"";
      };
      const bool layered = number("top_layer_mm") > 0.0;
      found.push_back(
          {word("scene"),
           {"tissue.shape.size=[" + length("length_mm") + "," + length("width_mm") + "," +
                length("height_mm") + "]",
            "finger.radius=" + length("radius_mm"),
            "tissue.young_modulus=\"" +
                number_text(number(layered ? "top_layer_youngs_kPa" : "youngs_kPa")) + " kPa\"",
            "tissue.poisson_ratio=" + number_text(number("poisson")),
            std::string("tissue.base=") + (word("base") == "clamped" ? "bonded" : "frictionless")},
           layered
               ? "[[region]]\nkind = \"slab\"\nmaterial = \"skin\"\ntop = \"" +
                     number_text(number("height_mm") - number("top_layer_mm")) +
                     " mm\"\nyoung_modulus = \"" + number_text(number("youngs_kPa")) + " kPa\"\n"
               : "",
           number("height_mm"),
           number("offset_mm") != 0.0,
           {}});
      if (found.back().aside)
        found.back().settings.push_back(
            "finger.x=\"" + number_text(0.5 * number("length_mm") + number("offset_mm")) + " mm\"");
    }
    const double vertical = 1e-3 * number("vertical_mN");
    const double normal = 1e-3 * number("normal_mN");
    found.back().rows.push_back(
        {number("depth_mm"), std::min(vertical, normal), std::max(vertical, normal)});
  }
  return found;
}

// One step to every depth of the table.
inline std::string programme(const Block& block) {
  std::string text =
      block.below +
      "[tissue]\nviscosity = \"none\"\nshape = { kind = \"cuboid\" }\n[finger]\nmaterial = "
      "\"rigid\"\n[solver]\nintegrator = \"quasi_static\"\n[output]\ninterval = \"1 s\"\n"
      "pressure_maps = false\n";
  double before = 0.0;
  for (const Block::Row& row : block.rows) {
    text += "[[step]]\nkind = \"indent\"\nto = \"" + number_text(row.depth) + " mm\"\nrate = \"" +
            number_text(row.depth - before) + " mm/s\"\n";
    before = row.depth;
  }
  return text;
}

// The distance from the band, relative to its nearer edge, where it is greatest; inside it 0.
// Nothing where the run did not get there.
inline std::optional<double> error_of(const Block& block, std::vector<std::string> settings) {
  settings.insert(settings.begin(), block.settings.begin(), block.settings.end());
  // Springs without a volume term refuse a ratio of a region's own.
  if (!block.below.empty() &&
      std::find(settings.begin(), settings.end(), "solver.model=mass_spring") == settings.end())
    settings.push_back("region.1.poisson_ratio=0.45");
  const record::CaseRecord record = run_text(programme(block), settings);
  double worst = 0.0;
  for (const Block::Row& row : block.rows) {
    const auto at = std::find_if(record.contact.begin(), record.contact.end(), [&](const auto& r) {
      return std::abs(1e3 * r.travel - row.depth) < 1e-9;
    });
    if (at == record.contact.end()) return std::nullopt;
    const double error = at->force < row.low    ? at->force / row.low - 1.0
                         : at->force > row.high ? at->force / row.high - 1.0
                                                : 0.0;
    if (std::abs(error) > std::abs(worst)) worst = error;
  }
  return worst;
}

}  // namespace palpate::test
