// A sweep's merged table is the same bytes whatever shards, workers, order and stops made it.
#include "sweep_folder.h"

namespace palpate::sweep {
namespace {

// Meshes of two sizes that are moved step by step; one case diverges: its steps of 3 ms are too
// long.
const std::string meshes =
    "[tissue]\nviscosity = \"none\"\n"
    "[solver]\nmodel = \"mass_spring\"\nintegrator = \"central_difference\"\nsubsteps = 4\n"
    "allow_unstable = true\n[output]\ninterval = \"12 ms\"\n"
    "[[step]]\nkind = \"creep\"\nload_time = \"0.6 s\"\nrecovery_time = \"60 ms\"\n"
    "[sweep]\n\"tissue.mesh\" = [{ kind = \"mirrored\", cells = [2, 3, 2] }, "
    "{ kind = \"mirrored\", cells = [2, 2, 2] }]\n"
    "\"tissue.young_modulus\" = [\"8 kPa\", \"10 kPa\", \"13 kPa\", \"17 kPa\", \"30 kPa\"]\n";

// Presses that share what their bodies of unit modulus sink, and the equations of their layers.
const std::string presses =
    "[solver]\nmodel = \"coupled_springs\"\n"
    "[tissue]\nmesh = { kind = \"kuhn\", cells = [3, 3, 2] }\n"
    "[output]\npressure_maps = false\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n"
    "rate = \"20 mm/s\"\n[sweep]\n"
    "\"tissue.young_modulus\" = [\"8 kPa\", \"13 kPa\", \"30 kPa\"]\n"
    "\"tissue.poisson_ratio\" = [0.33, 0.45]\n\"solver.model\" = [\"coupled_springs\", "
    "\"layer\"]\n";

class SweepBits : public SweepFolder {
 protected:
  // The plan with no rows.
  SweepPlan afresh(const SweepPlan& plan) const {
    fs::remove_all(fs::path(plan.folder) / "results");
    return read_plan(plan.folder, "this one");
  }
  void expect_same_from_all_ways(const std::string& text, bool curves) {
    SweepOrder asked = order(text);
    if (curves) asked.curves = SweepOrder::Curves::kept;
    const SweepPlan plan = read_plan(plan_sweep(asked).folder, "this one");
    run(plan);
    const std::string expected = merged(plan);
    const std::string curve = curves ? merged(plan, "strain_time.csv") : "";
    for (const std::size_t shards : {1U, 2U, 3U, 7U})
      for (const int workers : {1, 3}) {
        const SweepPlan again = afresh(plan);
        for (std::size_t shard = shards; shard > 0; --shard)  // the last cases first
          run(again, {.shard = {shard, shards}, .workers = workers});
        EXPECT_EQ(merged(again), expected) << shards << " shards, " << workers << " workers";
        if (!curves) continue;
        EXPECT_EQ(merged(again, "strain_time.csv"), curve);
      }
  }
};

TEST_F(SweepBits, meshes_in_all_ways) { expect_same_from_all_ways(meshes, true); }

TEST_F(SweepBits, formulas_in_all_ways) { expect_same_from_all_ways(formulas, false); }

TEST_F(SweepBits, presses_in_all_ways) { expect_same_from_all_ways(presses, false); }

// Rows are on the disk long before all cases of a block have been prepared.
TEST_F(SweepBits, rows_come_while_others_wait) {
  std::string many = presses;
  many.replace(many.find("[\"8 kPa\""), std::string("[\"8 kPa\", \"13 kPa\", \"30 kPa\"]").size(),
               "{ from = \"1 kPa\", to = \"100 kPa\", points = 128, scale = \"log\" }");
  const SweepPlan plan = this->plan(many);
  std::atomic<bool> stop = false;
  const SweepEnd end =
      run_sweep(plan, {}, stop, [&](const SweepProgress& now) { stop = now.done > 0; });
  EXPECT_EQ(end.all, 512U);
  EXPECT_GT(end.completed, 0U);
  EXPECT_GT(end.missing, 0U);
}

TEST_F(SweepBits, one_case_diverges_and_says_so) {
  const SweepPlan plan = this->plan(meshes);
  const SweepEnd end = run(plan);
  EXPECT_EQ(end.all, 10U);
  EXPECT_GE(end.failed, 1U);
  const SweepTotals totals = count_results(plan, SweepResults(plan));
  EXPECT_EQ(totals.diverged, end.failed);
  EXPECT_EQ(totals.completed, 10U - end.failed);
}

// Failed cases that are run anew leave the table as it was; it says nothing of attempts.
TEST_F(SweepBits, a_retry_changes_nothing_where_nothing_changed) {
  const SweepPlan plan = this->plan(meshes);
  run(plan);
  const std::string expected = merged(plan);
  run(plan, {.which = SweepTask::Which::failed});
  const SweepResults results(plan);
  std::size_t second = 0;
  for (std::size_t i = 0; i < plan.count(); ++i) second += results.at(i).head.attempt == 2 ? 1 : 0;
  EXPECT_EQ(second, count_results(plan, results).diverged);
  EXPECT_EQ(merged(plan), expected);
}

// Stopped again and again, each time as soon as something has been done.
TEST_F(SweepBits, stops_change_nothing) {
  const SweepPlan plan = this->plan(meshes);
  run(plan);
  const std::string expected = merged(plan);
  const SweepPlan again = afresh(plan);
  int runs = 0;
  for (bool interrupted = true; interrupted; ++runs) {
    std::atomic<bool> stop = false;
    const SweepEnd end =
        run_sweep(again, {}, stop, [&](const SweepProgress& now) { stop = now.done > 0; });
    interrupted = end.missing > 0;
    ASSERT_LT(runs, 11) << "no run got anywhere";
  }
  EXPECT_EQ(merged(again), expected);
}

}  // namespace
}  // namespace palpate::sweep
