// A live run judges itself: what is wrong with a session is found, named, and an exit code.
#include <gtest/gtest.h>

#include "browser.h"
#include "live_session.h"

namespace palpate {
namespace {

using test::has;
using test::Played;
using test::ScratchFile;
using test::Session;

const std::vector<std::string> expecting{"--arm", "--expect"};

TEST(LiveVerdict, TheScenariosOwnTissueAgrees) {
  const Played live(Session{.options = expecting});
  EXPECT_EQ(live.ended.code, 0) << live.ended.err;
  EXPECT_TRUE(has(live.ended.err, "device_stand: measured and model agree: ")) << live.ended.err;
  EXPECT_EQ(live.findings.word(0, "measured_verdict"), "agrees");
  EXPECT_LT(live.findings.number(0, "measured_difference"), 0.05);
  // The display shows steps of 2 mN.
  EXPECT_NEAR(live.findings.number(0, "measured_offset_N"), 0.0, 2e-3);
  EXPECT_NEAR(live.findings.number(0, "measured_contact_mm"),
              live.findings.number(0, "model_contact_mm"), 0.02);
}

// What is wrong with a session: a fault from its beginning on, another tissue, another surface.
struct Wrong {
  const char* name;
  std::string fault;
  std::string tissue;
  std::string surface;
  std::string cause;
  std::string clause;
};

class WrongSession : public testing::TestWithParam<Wrong> {};

TEST_P(WrongSession, IsNamedAndDiffers) {
  const Wrong& wrong = GetParam();
  const ScratchFile file("[[fault]]\nat = \"0 s\"\n" + wrong.fault);
  Session session{.options = expecting, .surface = wrong.surface};
  if (!wrong.fault.empty()) session.emulator = {"--fault", file.path()};
  if (!wrong.tissue.empty()) session.emulator = {"--tissue", wrong.tissue};
  const Played live(session);
  EXPECT_EQ(live.ended.code, 3) << live.ended.err;
  EXPECT_EQ(live.findings.word(0, "measured_verdict"), "differs");
  EXPECT_EQ(live.findings.word(0, "measured_causes"), wrong.cause);
  EXPECT_TRUE(has(live.ended.err, "measured and model differ: ")) << live.ended.err;
  EXPECT_TRUE(has(live.ended.err, wrong.clause)) << live.ended.err;
  session.options = {"--arm"};
  EXPECT_EQ(Played(session).ended.code, 0) << "only --expect makes it an exit code";
}

INSTANTIATE_TEST_SUITE_P(
    Stand, WrongSession,
    testing::Values(Wrong{"NoSpecimen", "", "none", "", "no_specimen", "no specimen: "},
                    Wrong{"Sign", "kind = \"sign_flip\"\n", "", "", "wrong_sign", "wrong sign: "},
                    Wrong{"Tare", "kind = \"spike\"\nvalue = \"0.1 N\"\n", "", "", "wrong_tare",
                          "wrong tare: the gauge shows 0.1 N"},
                    Wrong{"Surface", "", "", "-1.6 mm", "wrong_surface",
                          "wrong surface: the specimen begins 0.39 mm lower"}),
    [](const auto& wrong) { return std::string(wrong.param.name); });

// A gauge of 10 N scatters by a thousandth of its range, and nobody has tared it: readings that
// touch nothing are not taken for contact.
TEST(LiveVerdict, TheSurfaceIsFoundInNoise) {
  for (const char* seed : {"1", "2", "3"}) {
    const test::TemporaryFolder folder;
    test::LiveEmulator emulator(
        {"mark10", "--clock", "virtual", "--seed", seed, "--tissue",
         test::project_file("scenarios/emulator/stand_tissue.toml"), "--stand",
         folder.file("stand.toml", "[gauge]\nfilter = 0\nnoise = \"3 mN\"\n"), "--fault",
         folder.file("tare.toml",
                     "[[fault]]\nkind = \"spike\"\nat = \"0 s\"\nvalue = \"60 mN\"\n")});
    const test::Ended ended =
        test::palpate(folder.path(), {"run", test::project_file("scenarios/device_stand.toml"),
                                      "--device", "mark10:" + emulator.port(), "--arm", "--clock",
                                      "virtual", "--set", "output.figures=false"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    // The run withdraws to the surface that it found.
    EXPECT_NEAR(emulator.end().at("summary").at("position_m").get<double>(), -2e-3, 0.05e-3);
  }
}

// A surface that noise leaves open by a good part of the press is none.
TEST(LiveVerdict, ASurfaceThatNoiseHidesIsNotTaken) {
  const test::TemporaryFolder folder;
  test::LiveEmulator emulator(
      {"mark10", "--clock", "virtual", "--log", folder / "log.csv", "--tissue",
       test::project_file("scenarios/emulator/stand_tissue.toml"), "--stand",
       folder.file("stand.toml", "[gauge]\nfilter = 0\nnoise = \"60 mN\"\n")});
  const test::Ended ended =
      test::palpate(folder.path(), {"run", test::project_file("scenarios/device_stand.toml"),
                                    "--device", "mark10:" + emulator.port(), "--arm", "--clock",
                                    "virtual", "--set", "output.figures=false"});
  EXPECT_EQ(ended.code, 6);
  EXPECT_TRUE(has(ended.err, "by which the surface is known to")) << ended.err;
  emulator.end();
  // It goes slower, for more readings, but not slower than 0.1 mm/s.
  const std::string log = test::read_file(folder / "log.csv");
  EXPECT_TRUE(has(log, "e0006.0"));
  EXPECT_FALSE(has(log, "e0030.0"));
}

TEST(LiveVerdict, AnArmMeasuresNoForce) {
  const Played live(Session{.link = "inverse3", .scenario = "device_arm", .options = expecting});
  EXPECT_EQ(live.ended.code, 2);
  EXPECT_TRUE(has(live.ended.err, "wants a device that measures force")) << live.ended.err;
  EXPECT_EQ(live.summary.at("greatest_force_N"), 0.0);
}

// The recording of a session is judged by what the session measured, not by its model.
TEST(LiveVerdict, OfARecordingIsThatOfItsGauge) {
  const ScratchFile file("[[fault]]\nat = \"0 s\"\nkind = \"sign_flip\"\n");
  const Played live(Session{.emulator = {"--fault", file.path()}});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  const test::Ended again =
      test::palpate(live.folder(), {"run", test::project_file("scenarios/device_stand.toml"),
                                    "--out", "again", "--set", "output.figures=false", "--expect",
                                    "--device", "replay:out/device_stand/force_indentation.csv"});
  EXPECT_EQ(again.code, 3) << again.err;
  EXPECT_TRUE(has(again.err, "wrong sign: ")) << again.err;
}

// The figure shows measured points beside the model's curve, and the page says whether they agree.
TEST(LiveVerdict, MeasuredPointsAreInTheFigure) {
  const Played live(Session{.options = {"--arm", "--set", "output.figures=true"}});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  const std::string script =
      test::read_file(live.result("device_stand") / "figure_force_indentation.gp");
  EXPECT_TRUE(has(script, "column('measured_force_N')) with points")) << script;
  EXPECT_TRUE(has(script, "title 'measured'"));
  const test::fs::path result = live.result("device_stand");
  const std::string page = test::read_file(result / "report.html");
  EXPECT_TRUE(has(page, " (model)</span></p><p>Measured and model agree: ")) << "the verdict first";
  EXPECT_TRUE(has(page, " allowed).</p>")) << page;
  EXPECT_TRUE(has(page, "id=\"beside-the-device\">Beside the device</h2>"));
  EXPECT_EQ(test::faults_of_pages(result, {"report.html"}, test::Scheme::light),
            std::vector<std::string>{});
}

// Readings that are older than their replies: the programme as it was planned tells nothing of the
// tissue; as the stand carried it out, it is found.
TEST(LiveVerdict, ALateStandIsIdentifiedByTheProgrammeThatItCarriedOut) {
  const Played live(Session{.emulator = {"--latency", "4 ms", "--jitter", "4 ms", "--seed", "5"}});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  const auto identified = [&](const std::string& scenario, std::vector<std::string> more) {
    std::vector<std::string> call{"identify",
                                  "out/device_stand/force_indentation.csv",
                                  scenario,
                                  "--x",
                                  "time_s",
                                  "--y",
                                  "measured_force_N",
                                  "--set",
                                  "output.figures=false",
                                  "--unknown",
                                  "tissue.young_modulus=2 kPa..60 kPa",
                                  "--unknown",
                                  "tissue.relaxation_time=0.05 s..5 s",
                                  "--unknown",
                                  "tissue.instantaneous_ratio=1.1..6"};
    call.insert(call.end(), more.begin(), more.end());
    return test::palpate(live.folder(), call);
  };
  // Of scenarios/emulator/stand_tissue.toml.
  const std::map<std::string, double> truth{{"tissue.young_modulus", 12.0},
                                            {"tissue.relaxation_time", 0.5},
                                            {"tissue.instantaneous_ratio", 2.5}};
  // As planned, the lateness is in the residuals, which are no noise: wide intervals, and a
  // warning.
  const test::Ended planned = identified(test::project_file("scenarios/device_stand.toml"), {});
  ASSERT_EQ(planned.code, 0) << planned.err;
  EXPECT_TRUE(has(planned.err, "an effective sample size below 10")) << planned.err;
  const test::Rows wide(
      record::read_csv((live.folder() / "out/device_stand_identified/identified.csv").string()));
  ASSERT_EQ(wide.size(), truth.size());
  for (std::size_t i = 0; i < wide.size(); ++i) {
    const double own = truth.at(wide.word(i, "unknown"));
    EXPECT_LT(wide.number(i, "ci95_low"), own) << wide.word(i, "unknown");
    EXPECT_GT(wide.number(i, "ci95_high"), own) << wide.word(i, "unknown");
  }
  const test::Ended ended =
      identified("out/device_stand/as_moved.toml", {"--unknown", "step.1.time=0.1 ms..100 ms"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const test::Rows moved(
      record::read_csv((live.folder() / "out/as_moved_identified/identified.csv").string()));
  const auto off = [&](const char* unknown) {
    for (std::size_t i = 0; i < moved.size(); ++i)
      if (moved.word(i, "unknown") == unknown)
        return moved.number(i, "estimate") / truth.at(unknown) - 1.0;
    ADD_FAILURE() << "no " << unknown;
    return 0.0;
  };
  // Three standard deviations of the sessions of
  // tests/bench/live_identify.py.
  EXPECT_NEAR(off("tissue.young_modulus"), 0.0, 0.03);
  EXPECT_NEAR(off("tissue.relaxation_time"), 0.0, 0.08);
  EXPECT_NEAR(off("tissue.instantaneous_ratio"), 0.0, 0.02);
}

}  // namespace
}  // namespace palpate
