// A sweep gives the same bits in lanes as case by case, with any number of workers.
#include "run/lanes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

#include "run/family.h"
#include "scenario/family.h"

namespace palpate {
namespace {

const std::atomic<bool> never = false;

std::string bits(double value) { return std::to_string(std::bit_cast<std::uint64_t>(value)) + " "; }

// All of a record that may reach a file but the time it took.
std::string fingerprint(const record::CaseRecord& record) {
  std::string text = record.name + "|" + record.chosen + "|" + record.reason + "|" +
                     record::outcome_word(record.outcome) + bits(record.last_stable_time);
  for (const record::ContactRow& row : record.contact)
    for (const double value :
         {static_cast<double>(row.step), row.time, row.travel, row.indentation, row.force,
          row.contact_force, row.friction, row.ambient, row.contact_radius, row.peak_pressure,
          row.tissue_radius, static_cast<double>(row.contacts), row.slide, row.tangential})
      text += bits(value);
  for (const record::StrainRow& row : record.strain)
    for (const double value : {static_cast<double>(row.step), row.time, row.stress, row.strain})
      text += bits(value);
  for (const record::TissueFrame& frame : record.frames) {
    for (const Vec3& node : frame.displacement)
      for (const double value : node) text += bits(value);
    for (const double value : frame.contact_pressure) text += bits(value);
  }
  for (const record::Finding& finding : record.findings) {
    text += finding.name;
    if (const auto* number = std::get_if<double>(&finding.value)) text += bits(*number);
    if (const auto* word = std::get_if<std::string>(&finding.value)) text += *word;
  }
  for (const std::string& remark : record.remarks) text += remark;
  return text;
}

std::vector<std::string> fingerprints(const std::vector<scene::Scene>& scenes, int workers,
                                      run::Lanes lanes) {
  std::vector<std::string> all;
  for (const auto& record : run::run_all(
           scenes, workers, never, [](auto, const auto&) {}, lanes))
    all.push_back(fingerprint(record));
  return all;
}

struct Sweep {
  std::string name;
  std::string text;
  std::size_t diverging = 0;  // cases
};

std::string tissue(const std::string& viscosity) {
  return "[tissue]\nviscosity = \"" + viscosity + "\"\n";
}

std::string solver(const std::string& more = "") {
  return "[solver]\nmodel = \"mass_spring\"\nintegrator = \"central_difference\"\n" + more +
         "[tissue.mesh]\nkind = \"mirrored\"\ncells = [2, 3, 2]\n";
}
const std::string five =
    "[sweep]\n\"tissue.young_modulus\" = [\"8 kPa\", \"10 kPa\", \"13 kPa\", "
    "\"17 kPa\", \"30 kPa\"]\n";
const std::string ten = five + "\"tissue.poisson_ratio\" = [0.3, 0.4]\n";
const std::string creep_and_relax =
    "[[step]]\nkind = \"creep\"\nload_time = \"0.1 s\"\nrecovery_time = \"50 ms\"\n"
    "[[step]]\nkind = \"relax\"\ntime = \"0.1 s\"\n";

std::vector<Sweep> sweeps() {
  const std::string rows = "[output]\ninterval = \"12 ms\"\n";
  return {
      {"uniform", tissue("none") + solver() + rows + creep_and_relax + ten},
      {"uniform_viscous", tissue("prony") +
                              "[[tissue.branch]]\nrelaxation_time = \"10 ms\"\nratio = 0.5\n"
                              "[[tissue.branch]]\nrelaxation_time = \"1 ms\"\nratio = 1\n" +
                              solver() + rows + creep_and_relax + five},
      {"uniform_coupled", tissue("none") + solver() + rows + creep_and_relax + five +
                              "\"solver.model\" = [\"mass_spring\", \"coupled_springs\"]\n"},
      {"uniform_drag",
       tissue("nodal_drag") + solver("start = \"paper\"\n") + rows + creep_and_relax + five},
      // The stiffest case has steps of 3 ms, which are too long: its limit is 2.5 ms.
      {"diverging",
       tissue("none") + solver("substeps = 4\nallow_unstable = true\n") + rows +
           "[[step]]\nkind = \"creep\"\nload_time = \"0.6 s\"\n" + five,
       1},
  };
}

class LanesOfCases : public testing::TestWithParam<Sweep> {};

TEST_P(LanesOfCases, give_the_bits_of_each_case_alone) {
  const auto family = scenario::parse(GetParam().text, "sweep.toml", {});
  const auto scenes = run::build_all(family, 1);
  std::vector<std::string> alone;
  std::size_t diverged = 0;
  for (const scene::Scene& scene : scenes) {
    const record::CaseRecord record = run::run_case(scene, never);
    diverged += record.outcome == record::Outcome::diverged ? 1 : 0;
    alone.push_back(fingerprint(record));
  }
  EXPECT_EQ(diverged, GetParam().diverging);
  const auto groups = run::lane_groups(scenes);
  std::size_t grouped = 0;
  for (const auto& group : groups) grouped += group.size();
  EXPECT_EQ(grouped, scenes.size());
  const auto expect_same = [&](int workers, run::Lanes lanes) {
    EXPECT_TRUE(fingerprints(scenes, workers, lanes) == alone) << workers << " workers";
  };
  expect_same(2, run::Lanes::none);
  expect_same(1, run::Lanes::where_they_pay);
  for (const int workers : {1, 2, 3}) expect_same(workers, run::Lanes::wherever_possible);
}

INSTANTIATE_TEST_SUITE_P(AllForms, LanesOfCases, testing::ValuesIn(sweeps()),
                         [](const auto& sweep) { return sweep.param.name; });

// Presses, dashpots between nodes and springs that turn have no lanes; other meshes their own.
TEST(LaneGroups, hold_cases_of_one_mesh_and_form_alone) {
  const auto groups_of = [](const std::string& text, const std::vector<std::string>& settings) {
    return run::lane_groups(run::build_all(scenario::parse(text, "sweep.toml", settings), 1));
  };
  const std::string uniform = sweeps()[0].text;
  EXPECT_EQ(groups_of(uniform, {}).size(), 1U);
  EXPECT_TRUE(groups_of(uniform, {"tissue.viscosity=kelvin_voigt"}).empty());
  EXPECT_TRUE(groups_of(uniform, {"solver.kinematics=nonlinear"}).empty());
  EXPECT_TRUE(groups_of(uniform, {"solver.integrator=quasi_static"}).empty());
  EXPECT_TRUE(groups_of(tissue("none") + solver() + "[contact]\ncoupling = \"one_way\"\n" +
                            "[[step]]\nkind = \"indent\"\nto = \"0.2 mm\"\n" + five,
                        {})
                  .empty());
  const auto both = groups_of(uniform + "\"tissue.mesh.cells\" = [[2, 3, 2], [2, 2, 2]]\n", {});
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[0].size(), 10U);
  EXPECT_EQ(both[1].size(), 10U);
}

// Forms differ by the law and by its branches; springs that turn have no lanes.
TEST(LaneGroups, keep_forms_apart) {
  const auto family = scenario::parse(
      sweeps()[0].text, "sweep.toml",
      {"tissue.viscosity=prony", "tissue.branch=[{ relaxation_time = \"1 s\", ratio = 1 }]"});
  auto scenes = run::build_all(family, 1);
  EXPECT_EQ(run::lane_groups(scenes).size(), 1U);
  scenes[1].specimen->law.branches.push_back({0.1, 0.5});
  scenes[2].specimen->law.kind = tissue::Viscosity::standard_linear_solid;
  scenes[3].specimen->kinematics = tissue::Kinematics::nonlinear;
  scenes[4].specimen->network.rest.back().z() += 1e-9;
  const auto groups = run::lane_groups(scenes);
  ASSERT_EQ(groups.size(), 4U);
  EXPECT_EQ(groups[0], (std::vector<std::size_t>{0, 5, 6, 7, 8, 9}));
}

// A set stop leaves out what has not ended.
TEST(LaneGroups, stop) {
  const auto family = scenario::parse(sweeps()[0].text, "sweep.toml", {});
  const auto scenes = run::build_all(family, 1);
  std::atomic<bool> stop = false;
  std::size_t ended = 0;
  const auto records = run::run_all(
      scenes, 1, stop,
      [&](std::size_t, const record::CaseRecord& record) {
        if (record.outcome == record::Outcome::completed) ++ended;
        stop = true;
      },
      run::Lanes::wherever_possible);
  EXPECT_LT(records.size(), scenes.size());
  EXPECT_EQ(records.size(), ended);
  for (const record::CaseRecord& record : records)
    EXPECT_EQ(record.outcome, record::Outcome::completed);
}

}  // namespace
}  // namespace palpate
