// What Chen 2007 states about Figures 6 and 7, number by number (docs/paper.md).
#include "report/paper_section.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "base/units.h"
#include "report/finding_words.h"

namespace palpate::report {
namespace {

using Records = std::vector<record::CaseRecord>;

struct Rows {
  record::Table table{{"the paper", "here", "do they agree?", "why"}, {}};
  void add(const std::string& paper, const std::string& here, const std::string& verdict,
           const std::string& why) {
    table.rows.push_back({paper, here, verdict, why});
  }
};

std::string agrees(bool yes) { return yes ? "yes" : "no"; }

// Eq. (2) with Table 1, for the row of the largest force: the row's own indentation, and the radius
// with the curvature of the surface there.
struct Predicted {
  double indentation = 0.0;  // m
  double force = 0.0;        // N, of the run
  double equation = 0.0;     // N, of eq. (2)
};
Predicted predicted(const scenario::Family& family, const record::CaseRecord& record) {
  const auto most = std::max_element(
      record.contact.begin(), record.contact.end(),
      [](const auto& a, const auto& b) { return a.contact_force < b.contact_force; });
  if (most == record.contact.end()) return {};
  const double modulus = unit::kPa.to_si(finding_number(record, "effective_modulus_kPa"));
  const double curvature = std::isfinite(most->tissue_radius) ? 1.0 / most->tissue_radius : 0.0;
  const double radius =
      1.0 / (1.0 / scenario::case_named(family, record.name).scenario.finger.radius + curvature);
  const double depth = most->indentation;
  // F = 4/3 E* sqrt(R) h^(3/2)                                              Chen 2007 eq. (2)
  return {depth, most->contact_force,
          4.0 / 3.0 * modulus * std::sqrt(radius) * depth * std::sqrt(depth)};
}

void add_forces(Rows& rows, const scenario::Family& family, const Records& records) {
  for (const record::CaseRecord& record : records) {
    const Predicted one = predicted(family, record);
    if (!(one.equation > 0.0)) continue;
    const double off = one.force / one.equation - 1.0;
    constexpr double rounding = 1e-3;  // a thousandth is less than the digits of Table 1
    rows.add("Eq. (2) with Table 1, " + record.name + " at " +
                 rounded_text(unit::mm.from_si(one.indentation), 3) +
                 " mm: " + rounded_text(one.equation, 4) + " N",
             rounded_text(one.force, 4) + " N", agrees(std::abs(off) < rounding),
             std::abs(off) < rounding
                 ? "the run computes eq. (2)"
                 : "another law than eq. (2) ran here: " + finding_word(record, "model"));
  }
}

void add_order(Rows& rows, const Records& records) {
  std::vector<std::pair<double, std::string>> forces;
  for (const record::CaseRecord& record : records)
    for (const char* tissue : {"skin", "ligament", "muscle", "upper_leg"})
      if (record.name == tissue)
        forces.emplace_back(finding_number(record, "peak_force_N"), tissue);
  if (forces.size() < 4) return;
  std::sort(forces.rbegin(), forces.rend());
  std::string order;
  for (const auto& [force, tissue] : forces) order += (order.empty() ? "" : " > ") + tissue;
  const std::string wanted = "skin > ligament > muscle > upper_leg";
  rows.add("Order of the forces: " + wanted, order, agrees(order == wanted),
           "the order of the moduli of Table 1");
}

void add_fit(Rows& rows, const std::vector<fit::NamedFit>& fits) {
  double least = INFINITY, most = -INFINITY, power_low = INFINITY, power_high = -INFINITY;
  for (const fit::NamedFit& named : fits) {
    if (named.curve != "force_indentation") continue;
    if (named.fit.model == fit::Model::logarithmic) {
      least = std::min(least, named.fit.r2);
      most = std::max(most, named.fit.r2);
    }
    if (named.fit.model == fit::Model::power) {
      power_low = std::min(power_low, named.fit.parameters.at(1).estimate);
      power_high = std::max(power_high, named.fit.parameters.at(1).estimate);
    }
  }
  if (!std::isfinite(least) || !std::isfinite(power_low)) return;
  rows.add("The curves are drawn as F = a + b ln h",
           "R² of " + rounded_text(least, 3) + " to " + rounded_text(most, 3), "cannot",
           "eq. (2) gives a convex h^(3/2); a logarithm is concave and starts below zero");
  rows.add("Eq. (2): the exponent of h is 1.5",
           rounded_text(power_low, 5) + " to " + rounded_text(power_high, 5),
           agrees(std::abs(power_low - 1.5) < 5e-3 && std::abs(power_high - 1.5) < 5e-3),
           "the power law fitted to the rows");
}

// F / F_flat = (1 + R_1 kappa)^(-1/2)                     eq. (2) with 1/R = 1/R_1 + kappa
void add_curvatures(Rows& rows, const scenario::Family& family, const Records& records) {
  double worst = 0.0;
  std::size_t count = 0;
  for (const record::CaseRecord& flat : records) {
    if (finding_number(flat, "local_curvature_per_m") != 0.0) continue;
    for (const record::CaseRecord& bent : records) {
      const double curvature = finding_number(bent, "local_curvature_per_m");
      const std::string material = scenario::case_named(family, flat.name).scenario.tissue.material;
      if (scenario::case_named(family, bent.name).scenario.tissue.material != material ||
          curvature == 0.0)
        continue;
      const double ratio =
          finding_number(bent, "peak_force_N") / finding_number(flat, "peak_force_N");
      const double radius = scenario::case_named(family, bent.name).scenario.finger.radius;
      worst = std::max(worst, std::abs(ratio * std::sqrt(1.0 + radius * curvature) - 1.0));
      ++count;
    }
  }
  if (count == 0) return;
  constexpr double rounding = 1e-3;
  rows.add("Eq. (2): the force over that on a flat is (1 + R κ)^(-1/2)",
           "at most " + percent_text(worst) + " off in " + std::to_string(count) + " cases",
           agrees(worst < rounding), "the same depth on every curvature");
}

void add_strains(Rows& rows, const scenario::Family& family, const Records& records) {
  for (const record::CaseRecord& record : records) {
    const scenario::Case& one = scenario::case_named(family, record.name);
    const double modulus = one.materials.tissue.young_modulus.value;
    for (const scenario::Step& step : one.scenario.steps) {
      const auto* creep = std::get_if<scenario::Creep>(&step);
      if (creep == nullptr) continue;
      const double strain = creep->stress / modulus;
      const double here = finding_number(record, "elastic_strain");
      constexpr double rounding = 1e-3;
      rows.add("Table 1, " + record.name +
                   ": the strain goes to stress / E = " + rounded_text(strain, 4),
               rounded_text(here, 4), agrees(std::abs(here / strain - 1.0) < rounding),
               "the springs are scaled to the tissue's modulus");
      rows.add("Stiffer tissues settle later",
               "half of the final strain of " + record.name + " after " +
                   rounded_text(finding_number(record, "creep_half_time_s"), 3) + " s",
               "cannot",
               "a dashpot along every spring settles with eta / E, sooner where E is larger; the "
               "paper's curves show oscillation, or viscosities that it does not list");
      const double limit = finding_number(record, "stable_time_step_ms");
      if (std::isfinite(limit))
        rows.add("A time step of " +
                     rounded_text(unit::ms.from_si(family.base.output.interval), 3) + " ms",
                 "stable up to " + rounded_text(limit, 3) +
                     " ms; the interval of the rows is the "
                     "paper's",
                 "cannot", "a wave would cross many cells within the paper's step");
      break;
    }
  }
  rows.add("The right half is called relaxation", "it is recovery: strain after unloading",
           "cannot", "relaxation is the stress at a constant strain");
}

}  // namespace

page::Markup paper_section(const scenario::Family& family, const Records& records,
                           const std::vector<fit::NamedFit>& fits) {
  using Paper = scenario::Output::Paper;
  Rows rows;
  if (family.base.output.paper == Paper::figure_6) {
    add_order(rows, records);
    add_curvatures(rows, family, records);
    constexpr std::size_t most_rows = 8;
    if (records.size() <= most_rows) add_forces(rows, family, records);
    add_fit(rows, fits);
  } else if (family.base.output.paper == Paper::figure_7) {
    add_strains(rows, family, records);
  }
  if (rows.table.rows.empty()) return {};
  return page::element("p",
                       "Chen, Wu, Sun and Heng (2007) print no numbers in this figure: what can be "
                       "compared are the statements and equations of their text.") +
         page::table("The paper beside this run", rows.table);
}

}  // namespace palpate::report
