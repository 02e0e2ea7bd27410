// A plan says which cases there are, once and for all; what it refuses, it refuses in a sentence.
#include "sweep/plan.h"

#include <sys/wait.h>

#include <set>

#include "base/files.h"
#include "base/text.h"
#include "sweep/row.h"
#include "sweep_folder.h"

namespace palpate::sweep {
namespace {

class Plans : public SweepFolder {
 protected:
  [[nodiscard]] std::string planning(const std::string& text) const {
    const SweepOrder asked = order(text);
    return refusal([&] { (void)plan_sweep(asked); });
  }
  [[nodiscard]] std::string reading(const std::string& program = "this one") const {
    return refusal([&] { (void)read_plan((root_ / "out/s_sweep").string(), program); });
  }
};

// A TOML list, and a line feed.
std::string list(int count, const std::function<std::string(int)>& value) {
  std::string text = "[";
  for (int i = 0; i < count; ++i) text += (i > 0 ? ", " : "") + value(i);
  return text + "]\n";
}

const std::string press =
    "[tissue]\nshape = { kind = \"half_space\" }\n[[step]]\nkind = \"indent\"\n";

// Ids name results of years: they change only where what is computed may have changed.
TEST_F(Plans, rows_and_ids_are_these) {
  const SweepPlan planned = plan(formulas);
  EXPECT_EQ(read(root_ / "out/s_sweep/plan.csv"),
            "number,id,tissue.young_modulus,tissue.poisson_ratio\n"
            "1,891409ee7ae69c12,10 kPa,0.3\n2,53ebe60ab25e8b54,10 kPa,0.45\n"
            "3,bb91731a63daca62,20 kPa,0.3\n4,ee21f6f519e01b73,20 kPa,0.45\n"
            "5,461b2b49fe589101,0.1 MPa,0.3\n6,54fddd56b0a3fae3,0.1 MPa,0.45\n");
  ASSERT_EQ(planned.count(), 6U);
  EXPECT_EQ(planned.family.name, "s");
  EXPECT_EQ(planned.family.title, "s");
  EXPECT_EQ(planned.hash, sha256(read(root_ / "out/s_sweep/plan.json")));
}

TEST_F(Plans, an_id_knows_the_case_and_not_its_number) {
  const SweepPlan six = plan(formulas);
  const auto one = [&](const std::string& sweep) {
    fs::remove_all(root_ / "out");
    return plan(formulas.substr(0, formulas.find("[sweep]")) + "[sweep]\n" + sweep).ids;
  };
  const auto last =
      one("\"tissue.young_modulus\" = [\"100 kPa\"]\n\"tissue.poisson_ratio\" = [0.45]\n");
  EXPECT_EQ(last, std::vector{six.ids.back()});
  const auto other =
      one("\"tissue.young_modulus\" = [\"100 kPa\"]\n\"tissue.poisson_ratio\" = [0.46]\n");
  EXPECT_NE(other, last);
}

// Rows of a sweep are compared, so that all cases take the model that one of them needs.
TEST_F(Plans, keep_the_model_that_all_cases_take) {
  const std::string text =
      "[tissue]\nviscosity = \"none\"\n[finger]\nmaterial = \"rigid\"\n[[step]]\nkind = "
      "\"indent\"\nto = "
      "\"1 mm\"\n[sweep]\n";
  const SweepPlan both = plan(text + "\"finger.x\" = [\"3 mm\", \"30 mm\"]\n");
  EXPECT_EQ(both.family.at_least, scenario::Solver::Model::solid);
  EXPECT_EQ(scenario::make_case(both.family, 1).at_least, scenario::Solver::Model::solid);
  fs::remove_all(root_ / "out");
  const SweepPlan middle = plan(text + "\"finger.x\" = [\"30 mm\", \"31 mm\"]\n");
  EXPECT_EQ(middle.family.at_least, scenario::Solver::Model::layer);
  EXPECT_NE(middle.ids.front(), both.ids.back()) << "of another model";
}

TEST_F(Plans, an_id_knows_the_content_of_files) {
  const std::string table = "[a]\ndensity = { value = \"1100 kg/m^3\", source = \"x\" }\n";
  const scenario::Family family = scenario::outline_text(formulas, "s.toml", {});
  scenario::Case one = scenario::make_case(family, 0);
  const std::uint64_t id = case_id(one, {{"leg.stl", "1"}});
  EXPECT_EQ(id, case_id(one, {})) << "a file that it does not read";
  one.files = {"leg.stl"};
  EXPECT_NE(case_id(one, {{"leg.stl", "1"}}), id);
  EXPECT_NE(case_id(one, {{"leg.stl", "1"}}), case_id(one, {{"leg.stl", "2"}}));
}

// The first points of a Sobol sequence have the same value in many dimensions, and a list of two
// words always has: rows of A and of A with a column of B are then one.
TEST_F(Plans, of_a_saltelli_design_may_have_cases_that_are_one) {
  const SweepPlan planned =
      plan(press +
           "[solver]\nmodel = \"hertz\"\n[sweep]\ndesign = \"saltelli\"\nsamples = 8\n"
           "\"tissue.material\" = [\"skin\", \"muscle\"]\n"
           "\"tissue.poisson_ratio\" = { from = 0.1, to = 0.4 }\n");
  ASSERT_EQ(planned.count(), 32U);
  const std::vector<HashedFile> files = scenario::hashed(planned.family.inputs);
  std::size_t twins = 0;
  for (std::size_t i = 0; i < planned.count(); ++i) {
    const std::uint64_t id = case_id(scenario::make_case(planned.family, i), files);
    if (planned.ids[i] == id) continue;
    EXPECT_EQ(planned.ids[i], twin_id(id, i + 1)) << i;
    ++twins;
  }
  EXPECT_GT(twins, 0U);
  const std::set<std::uint64_t> different(planned.ids.begin(), planned.ids.end());
  EXPECT_EQ(different.size(), planned.count());
}

TEST_F(Plans, samples_of_words_repeat_and_are_all_planned) {
  for (const char* design : {"lhs", "sobol"}) {
    const SweepPlan planned =
        plan(press + "[solver]\nmodel = \"hertz\"\n[sweep]\ndesign = \"" + design +
             "\"\nsamples = 6\n\"tissue.material\" = [\"skin\", \"muscle\"]\n");
    const std::set<std::uint64_t> different(planned.ids.begin(), planned.ids.end());
    EXPECT_EQ(different.size(), 6U) << design;
    fs::remove_all(root_ / "out");
  }
}

TEST_F(Plans, the_same_plan_again_is_there_already) {
  EXPECT_FALSE(plan_sweep(order(formulas)).there_already);
  const std::string before = read(root_ / "out/s_sweep/plan.json");
  EXPECT_TRUE(plan_sweep(order("# a remark\n" + formulas)).there_already);
  EXPECT_EQ(read(root_ / "out/s_sweep/plan.json"), before);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(root_ / "out"))
    names.push_back(entry.path().filename());
  EXPECT_EQ(names, std::vector<std::string>{"s_sweep"}) << "no leftovers";
}

TEST_F(Plans, another_plan_in_its_place_is_refused) {
  (void)plan_sweep(order(formulas));
  const std::string start = "out/s_sweep: is the plan of another sweep, with another ";
  const std::string rest = "; plans do not change: give another `--out`, or remove that folder";
  EXPECT_EQ(planning(formulas + "\"finger.radius\" = [\"5 mm\", \"6 mm\"]\n"),
            start + "number of cases (6, not 12), `scenario.toml`" + rest);
  SweepOrder curves = order(formulas);
  curves.curves = SweepOrder::Curves::kept;
  EXPECT_EQ(refusal([&] { (void)plan_sweep(curves); }), start + "`--curves`" + rest);
  SweepOrder newer = order(formulas);
  newer.program = "a later one";
  EXPECT_EQ(refusal([&] { (void)plan_sweep(newer); }), start + "version of the program" + rest);
}

TEST_F(Plans, a_folder_of_other_things_is_left_alone) {
  write(root_ / "out/s_sweep/letter.txt", "x");
  EXPECT_TRUE(planning(formulas).starts_with(
      "out/s_sweep: is there already and is not a plan of a sweep that palpate wrote"));
  EXPECT_EQ(read_text(root_ / "out/s_sweep/letter.txt"), "x");
}

TEST_F(Plans, many_cases_are_asked_for_twice) {
  const std::string many =
      press + "to = \"0.1 mm\"\n[sweep]\n\"tissue.poisson_ratio\" = " +
      list(100, [](int i) { return number_text(0.1 + i / 1000.0); }) + "\"finger.radius\" = " +
      list(101, [](int i) { return "\"" + number_text(5 + i / 100.0) + " mm\""; });
  const std::string said = planning(many);
  EXPECT_TRUE(said.starts_with("s.toml: `sweep` makes 10100 cases (about ")) << said;
  EXPECT_TRUE(said.ends_with(" s on one worker and 24 MB); give `--yes` to plan more than 10000"))
      << said;
  EXPECT_FALSE(fs::exists(root_ / "out"));
}

// Which no model's forecast covers: cases are run for it.
TEST_F(Plans, the_time_of_a_mesh_that_does_not_change_the_force_is_estimated) {
  const std::string text =
      "[contact]\ncoupling = \"one_way\"\n[solver]\nmodel = \"mass_spring\"\n[[step]]\nkind = "
      "\"indent\"\nto = \"0.1 mm\"\n[sweep]\n\"tissue.young_modulus\" = [\"10 kPa\", \"20 kPa\"]\n";
  const std::string said = plan_sweep(order(text)).forecast.value().text();
  EXPECT_TRUE(said.starts_with("about ")) << said;
  EXPECT_TRUE(said.ends_with(" s on one worker and 0.0048 MB")) << said;
}

// By hand: what has a set-up of its own, on a mesh and without one.
TEST_F(Plans, set_ups_are_counted) {
  const auto count = [&](const std::string& text, bool meshed) {
    return set_ups(scenario::outline(order(text).scenario, {}), meshed);
  };
  const std::string modulus = "\"tissue.young_modulus\" = [\"1 kPa\", \"2 kPa\", \"3 kPa\"]\n";
  const std::string ratio = "\"tissue.poisson_ratio\" = [0.3, 0.4]\n";
  const std::string radius = "\"finger.radius\" = [\"8 mm\", \"9 mm\", \"10 mm\", \"11 mm\"]\n";
  const std::string all = press + "[sweep]\n" + modulus + ratio + radius;
  EXPECT_EQ(count(press + "[sweep]\n" + modulus, true), 1.0) << "a modulus scales one set-up";
  EXPECT_EQ(count(all, true), 8.0);
  EXPECT_EQ(count(all, false), 2.0) << "a finger needs none without a mesh";
  const std::string lump =
      "[tissue]\nshape = { kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", \"30 mm\"] }\n"
      "[[region]]\nkind = \"sphere\"\n[[step]]\nkind = \"indent\"\n";
  EXPECT_EQ(count(lump + "[sweep]\n" + modulus + ratio, false), 6.0)
      << "of two tissues one modulus scales nothing";
  // Of more cases than are looked at: few set-ups are found, and many are reckoned.
  const std::string many = press + "[sweep]\ndesign = \"grid\"\n";
  const auto range = [](const char* key, const char* low, const char* high) {
    return std::string("\"") + key + "\" = { from = " + low + ", to = " + high +
           ", points = 100 }\n";
  };
  const std::string moduli = range("tissue.young_modulus", "\"1 kPa\"", "\"100 kPa\"");
  EXPECT_EQ(count(many + moduli + range("tissue.poisson_ratio", "0.1", "0.49"), true), 100.0);
  EXPECT_EQ(count(many + moduli + range("finger.radius", "\"8 mm\"", "\"12 mm\""), false), 1.0);
  EXPECT_EQ(count(many + range("finger.radius", "\"8 mm\"", "\"12 mm\"") +
                      range("tissue.poisson_ratio", "0.1", "0.49"),
                  true),
            10000.0);
}

TEST_F(Plans, a_scenario_without_a_sweep_is_refused) {
  for (const std::string& text : {press, press + "[sweep]\n"})
    EXPECT_EQ(planning(text),
              "s.toml: sweeps no key; name one in `[sweep]`, or run it by `palpate run`");
}

// Two values that are right by themselves and wrong together, far inside a large sweep.
TEST_F(Plans, the_first_case_that_cannot_be_is_named) {
  const std::string text =
      press + "to = \"9 mm\"\n[[step]]\nkind = \"retract\"\n[sweep]\n\"step.1.to\" = " +
      list(40,
           [](int i) {
             return i == 30 ? "\"1 mm\"" : "\"" + number_text(2 + i / 100.0) + " mm\"";
           }) +
      "\"step.2.to\" = " + list(40, [](int i) {
        return i == 23 ? "\"1.5 mm\"" : "\"" + number_text(i / 100.0) + " mm\"";
      });
  const std::string said = planning(text);
  EXPECT_TRUE(said.starts_with("s.toml:")) << said;
  EXPECT_NE(said.find("`retract` goes to 1.5 mm, which is not above the displacement of 1 mm"),
            std::string::npos)
      << said;
  EXPECT_TRUE(said.ends_with(
      "\ns.toml: case 1224 of 1600 (`step.1.to` = 1 mm, `step.2.to` = 1.5 mm) cannot be made; mend "
      "it, or leave it out of `sweep`"))
      << said;
  EXPECT_FALSE(fs::exists(root_ / "out/s_sweep"));
}

// Formulas know no rings, so that the first two cases are one.
TEST_F(Plans, two_cases_that_compute_the_same_are_refused) {
  EXPECT_EQ(
      planning("[tissue.mesh]\nkind = \"kuhn\"\ncells = [3, 4, 6]\n" +
               std::string("[[step]]\nkind = \"indent\"\n[sweep]\n") +
               "\"solver.model\" = [\"hertz\", \"mass_spring\"]\n\"solver.rings\" = [2, 3]\n"),
      "s.toml: cases 1 (`solver.model` = hertz, `solver.rings` = 2) and 2 (`solver.model` = "
      "hertz, `solver.rings` = 3) compute the very same; leave one out of `sweep`");
}

TEST_F(Plans, a_key_that_auto_leaves_unread_is_refused) {
  const std::string said = planning(
      "[[step]]\nkind = \"indent\"\nto = \"0.1 mm\"\n[sweep]\n\"solver.rings\" = [2, 3]\n");
  EXPECT_NE(said.find("s.toml:5:1: `solver.rings` changes nothing: in all of "), std::string::npos)
      << said;
}

TEST_F(Plans, files_come_along) {
  write(root_ / "tables/mine.toml", read(fs::path(PALPATE_SOURCE_DIR) / "materials/chen2007.toml"));
  const SweepPlan planned = plan(
      "[tissue]\nmaterial = \"tables/mine.toml#skin\"\nshape = { kind = \"half_space\" }\n"
      "[[step]]\nkind = \"indent\"\nto = \"0.1 mm\"\n[output]\ninterval = \"5 ms\"\n"
      "[sweep]\n\"finger.radius\" = [\"5 mm\", \"6 mm\"]\n");
  EXPECT_EQ(read(root_ / "out/s_sweep/inputs/mine.toml"), read(root_ / "tables/mine.toml"));
  // Elsewhere, without what it was made from.
  fs::remove_all(root_ / "tables");
  fs::remove(root_ / "s.toml");
  fs::rename(root_ / "out/s_sweep", root_ / "moved");
  const SweepPlan moved = read_plan((root_ / "moved").string(), "this one");
  EXPECT_EQ(moved.ids, planned.ids);
  EXPECT_EQ(run(moved).completed, 2U);
  EXPECT_EQ(merged(moved).find(root_.string()), std::string::npos);
}

TEST_F(Plans, settings_are_part_of_it) {
  SweepOrder asked = order(formulas);
  asked.settings = {"finger.radius=5 mm", "sweep.tissue.poisson_ratio=[0.2]"};
  const SweepPlan planned = read_plan(plan_sweep(asked).folder, "this one");
  EXPECT_EQ(planned.count(), 3U);
  EXPECT_EQ(scenario::make_case(planned.family, 0).scenario.finger.radius, 0.005);
}

// As by a machine whose numbers are read otherwise.
TEST_F(Plans, a_case_that_is_not_what_was_planned_is_not_run) {
  SweepPlan other = plan(formulas);
  other.ids[1] ^= 1U;
  EXPECT_EQ(refusal([&] { (void)run(other); }),
            "case 2 is not what was planned: this machine reads the scenario differently; plan "
            "anew on this one");
}

// A case that failed for want of memory, say, and completes when it is tried again.
TEST_F(Plans, a_case_that_completes_at_its_second_attempt_is_completed) {
  const SweepPlan six = plan(formulas);
  {
    record::Journal journal(six.folder + "/results", "1-of-1", six.hash);
    journal.add(journal_row({.id = six.ids[2], .outcome = SweepOutcome::failed, .reason = "why"}));
    journal.sync();
  }
  const SweepEnd end = run(six, {.which = SweepTask::Which::failed});
  EXPECT_EQ(end.completed, 1U);
  EXPECT_EQ(end.failed, 0U);
  const SweepResults results(six);
  EXPECT_EQ(results.at(2).head.outcome, SweepOutcome::completed);
  EXPECT_EQ(results.at(2).head.attempt, 2U);
}

TEST_F(Plans, take_over_completed_rows_without_their_past) {
  SweepOrder first = order(formulas);
  first.curves = SweepOrder::Curves::kept;
  const std::string folder = plan_sweep(first).folder;
  const SweepPlan old = read_plan(folder, "this one");
  {
    record::Journal journal(old.folder + "/results", "1-of-1", old.hash);
    journal.add(journal_row({.id = old.ids[0], .attempt = 3, .curve = {{"step"}, {{1.0}}}}));
    journal.add(journal_row({.id = old.ids[1], .outcome = SweepOutcome::failed, .reason = "why"}));
    journal.sync();
  }
  SweepOrder second = order(formulas);
  second.out = (root_ / "new").string();
  second.reuse = folder;
  const Planned planned = plan_sweep(second);
  EXPECT_EQ(planned.reused, 1U);
  const SweepPlan grown = read_plan(planned.folder, "this one");
  const SweepResults results(grown);
  EXPECT_FALSE(results.at(1).known()) << "what failed is run again";
  ASSERT_TRUE(results.at(0).known());
  EXPECT_EQ(results.at(0).head.attempt, 1U);
  EXPECT_TRUE(results.row(0).curve.columns.empty()) << "the new plan keeps none";
  // The other way round there are no curves to take.
  second = first;
  second.out = (root_ / "third").string();
  second.reuse = planned.folder;
  EXPECT_EQ(refusal([&] { (void)plan_sweep(second); }),
            "new/s_sweep: keeps no curves, and the new plan does; plan without `--curves`, or "
            "without `--reuse`");
  second.reuse = "nowhere";
  EXPECT_EQ(refusal([&] { (void)plan_sweep(second); }),
            "nowhere: is no plan of a sweep; `palpate sweep plan` makes one");
  EXPECT_FALSE(fs::exists(root_ / "third")) << "what was refused has planned nothing";
}

// Each task of a cluster may plan first. All of them reach the end of their plans at about the same
// time, because they begin together.
TEST_F(Plans, may_be_made_by_several_processes_at_once) {
  for (int round = 0; round < 5; ++round) {
    SweepOrder asked = order(formulas);
    asked.out += std::to_string(round);
    std::vector<pid_t> children;
    for (int i = 0; i < 6; ++i) {
      children.push_back(::fork());
      if (children.back() == 0)
        ::_exit(refusal([&] { (void)plan_sweep(asked); }) == "accepted" ? 0 : 1);
    }
    for (const pid_t child : children) {
      int status = 0;
      ::waitpid(child, &status, 0);
      EXPECT_EQ(status, 0) << round;
    }
    EXPECT_EQ(read_plan(asked.out + "/s_sweep", "this one").count(), 6U);
    EXPECT_EQ(entries_of(asked.out).size(), 1U) << "nothing is left beside the plan";
  }
}

TEST_F(Plans, what_has_changed_is_refused) {
  (void)plan_sweep(order(formulas));
  const fs::path folder = root_ / "out/s_sweep";
  const std::string rest = ": has changed since it was planned; put it back, or plan anew";
  for (const char* name : {"plan.csv", "inputs/scenario.toml"}) {
    const std::string before = read(folder / name);
    write(folder / name, before + "#\n");
    EXPECT_EQ(reading(), std::string("out/s_sweep/") + name + rest);
    write(folder / name, before.substr(0, before.size() - 1));
    EXPECT_EQ(reading(), std::string("out/s_sweep/") + name + rest);
    write(folder / name, before);
    EXPECT_EQ(reading(), "accepted");
  }
  const std::string plan = read(folder / "plan.json");
  const std::string damaged =
      "out/s_sweep/plan.json: is damaged, or made by another version; put it back, or plan anew";
  write(folder / "plan.json", plan.substr(5));
  EXPECT_EQ(reading(), damaged);
  const std::string cases = "\"cases\": 6";
  for (const char* number : {"1e52", "-1", "6.5", "\"6\"", "true"}) {
    std::string other = plan;
    write(folder / "plan.json",
          other.replace(plan.find(cases), cases.size(), std::string("\"cases\": ") + number));
    EXPECT_EQ(reading(), damaged) << number;
  }
}

TEST_F(Plans, another_version_is_refused) {
  (void)plan_sweep(order(formulas));
  EXPECT_EQ(reading("a later one"),
            "out/s_sweep/plan.json: was made by `this one`, and this is `a later one`; use that "
            "one, or plan anew");
}

TEST_F(Plans, other_folders_are_no_plans) {
  EXPECT_EQ(reading(), "out/s_sweep: is no plan of a sweep; `palpate sweep plan` makes one");
}

TEST(Shards, every_case_is_in_one) {
  for (const std::size_t of : {1U, 3U, 7U})
    for (std::size_t i = 0; i < 20; ++i) {
      std::size_t holders = 0;
      for (std::size_t number = 1; number <= of; ++number)
        holders += Shard{number, of}.holds(i) ? 1 : 0;
      EXPECT_EQ(holders, 1U);
    }
  EXPECT_EQ(parse_shard("3/16").number, 3U);
  EXPECT_EQ(parse_shard("3/16").text(), "3-of-16");
}

TEST(Shards, other_words_are_none) {
  for (const char* wrong :
       {"", "3", "0/4", "5/4", "1/0", "-1/4", "1/4x", " 1/4", "1/4/2", "a/b", "1.5/4",
        "99999999999999999999/4", "1/100000001", "1/18446744073709551616"}) {
    try {
      (void)parse_shard(wrong);
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()), "`--shard` wants a part and the number of parts, got `" +
                                               std::string(wrong) + "`; write `--shard 3/16`");
    }
  }
}

}  // namespace
}  // namespace palpate::sweep
