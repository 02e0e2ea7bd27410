// What a finished run leaves: its files, their columns, the paper's forces, the identities.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "cases.h"
#include "program.h"
#include "record/csv.h"

namespace palpate::test {
namespace {

using Strings = std::vector<std::string>;

const std::string press_and_hold =
    "[tissue]\nmesh = { kind = \"mirrored\", cells = [4, 4, 3] }\n"
    "[solver]\nmodel = \"mass_spring\"\nintegrator = \"quasi_static\"\n"
    "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = \"10 mm/s\"\n"
    "[[step]]\nkind = \"hold\"\ntime = \"50 ms\"\n"
    "[output]\ninterval = \"10 ms\"\n";

double number(const record::Table& table, std::size_t row, const std::string& column) {
  const int found = table.find(column);
  if (found < 0 || row >= table.rows.size()) {
    ADD_FAILURE() << "no `" << column << "` in row " << row;
    return 0.0;
  }
  return std::get<double>(table.rows[row][static_cast<std::size_t>(found)]);
}

// The row of a case at a travel.
std::size_t row_at(const record::Table& table, const std::string& name, double travel) {
  const auto column = static_cast<std::size_t>(table.find("travel_mm"));
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (std::get<std::string>(table.rows[i][0]) == name &&
        std::abs(std::get<double>(table.rows[i][column]) - travel) <
            1e-9)  // mm; rows stand 0.01 apart
      return i;
  ADD_FAILURE() << "no row of " << name << " at " << travel << " mm";
  return 0;
}

class OfAPress : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    write_file(*folder_ / "press.toml", press_and_hold);
    ended_ = palpate(folder_->path(), {"run", "press.toml", "--set", "contact.friction=0.4"});
  }
  static void TearDownTestSuite() { delete folder_; }
  static fs::path result() { return *folder_ / "out/press"; }

  inline static TemporaryFolder* folder_ = nullptr;
  inline static Ended ended_;
};

// A layer that folds under the default finger, which is elastic.
TEST(ARunThatEndsEarly, keeps_its_curve_and_shows_no_force_where_there_is_none) {
  const TemporaryFolder folder;
  write_file(folder / "thin.toml",
             "[tissue]\nmaterial = \"muscle\"\nyoung_modulus = \"10 kPa\"\npoisson_ratio = 0.45\n"
             "shape = { kind = \"cuboid\", size = [\"40 mm\", \"40 mm\", \"5 mm\"] }\n"
             "[finger]\nradius = \"10 mm\"\n[solver]\nmodel = \"solid\"\n"
             "[[step]]\nkind = \"indent\"\nto = \"4 mm\"\nrate = \"5 mm/s\"\n"
             "[output]\ninterval = \"10 ms\"\nfigures = false\n");
  const auto head = [&](const char* run) { return headline_of(folder / run / "thin/report.html"); };
  const Ended kept = palpate(folder.path(), {"run", "thin.toml", "--out", "kept"});
  EXPECT_EQ(kept.code, 4);
  const record::Table rows = record::read_csv(folder / "kept/thin/force_indentation.csv");
  const std::size_t last = rows.rows.size() - 1;
  EXPECT_GT(number(rows, last, "travel_mm"), 3.5);  // 3.6 mm; nine tenths of the way
  EXPECT_LT(number(rows, last, "travel_mm"), 3.7);
  EXPECT_GT(number(rows, last, "force_N"), number(rows, last / 2, "force_N"));
  EXPECT_NE(head("kept").find(" N up to a displacement of 3."), std::string::npos) << head("kept");
  const Ended none = palpate(
      folder.path(), {"run", "thin.toml", "--out", "none", "--set", "output.interval=\"1 s\""});
  EXPECT_EQ(none.code, 4);
  EXPECT_NE(head("none").find("No result"), std::string::npos) << head("none");
  EXPECT_EQ(head("none").find("0 N"), std::string::npos) << head("none");
  EXPECT_EQ(record::read_csv(folder / "none/thin/findings.csv").find("peak_force_N"), -1);
}

// Where the motion itself went wrong, no force is shown as a result.
TEST(ARunThatDiverges, says_so_first_on_page_and_terminal) {
  const TemporaryFolder folder;
  const Ended ended =
      palpate(folder.path(), {"run", project_file("scenarios/failures/01_step_above_limit.toml")});
  EXPECT_EQ(ended.code, 4);
  EXPECT_TRUE(says(ended, "mm, where the run diverged; no error is stated.")) << ended.err;
  EXPECT_TRUE(ended.err.ends_with(": 1 of 1 case, 1 ended early\n")) << ended.err;
  const std::string page = read_file(folder / "out/01_step_above_limit/report.html");
  EXPECT_NE(
      page.find("<p class=\"big failure\">Diverged at 0.0574\u00a0s: <span>energy grew without "
                "input</span></p>"),
      std::string::npos);
  EXPECT_EQ(page.find("<p class=\"big\">"), std::string::npos);
}

// What the first screen of a page says.
std::string head_of(const fs::path& page) {
  const std::string html = read_page(page);
  return html.substr(0, html.find("</header>"));
}

TEST(OfACreepTest, the_page_begins_with_stress_times_and_viscous_law) {
  const TemporaryFolder folder;
  write_file(folder / "creep.toml",
             "[tissue]\nmaterial = \"muscle\"\nviscosity = \"kelvin_voigt\"\n"
             "retardation_time = \"0.5 s\"\n[[step]]\nkind = \"creep\"\nstress = \"0.5 kPa\"\n"
             "load_time = \"3 s\"\nrecovery_time = \"2 s\"\n[output]\nfigures = false\n");
  ASSERT_EQ(palpate(folder.path(), {"run", "creep.toml"}).code, 0);
  const std::string one = head_of(folder / "out/creep/report.html");
  for (const char* line : {"; creep under 0.5 kPa for 3 s, then recovery for 2 s;",
                           "<p>Viscosity: Kelvin-Voigt, retardation time 0.5 s.</p>"})
    EXPECT_NE(one.find(line), std::string::npos) << line << " is not in " << one;
  ASSERT_EQ(palpate(folder.path(), {"run", "creep.toml", "--force", "--set",
                                    "sweep.tissue.retardation_time=[\"1 s\", \"2 s\"]"})
                .code,
            0);
  const std::string two = head_of(folder / "out/creep/report.html");
  EXPECT_NE(
      two.find("<p>Tissue: muscle, E 6 kPa, nu 0.4; block of 60 x 60 x 30 mm; creep under 0.5 "
               "kPa for 3 s, then recovery for 2 s.</p>"),
      std::string::npos)
      << "both cases have these" << two;
  EXPECT_EQ(two.find("<table"), std::string::npos) << "the first screen is for the curves";
  const std::string page = read_page(folder / "out/creep/report.html");
  for (const char* part :
       {">Kelvin-Voigt, retardation time 1 s</td>", ">Kelvin-Voigt, retardation time 2 s</td>"})
    EXPECT_LT(page.find("id=\"every-case\""), page.find(part)) << part;
}

// What is not computed is an empty cell, and no line of the page.
TEST(OfACurvedBody, what_is_not_known_is_not_zero) {
  const TemporaryFolder folder;
  write_file(folder / "round.toml",
             "[tissue]\nshape = { kind = \"ellipsoid\", size = [\"60 mm\", \"50 mm\", \"40 "
             "mm\"] }\n[solver]\nmodel = \"hertz\"\n[contact]\ncoupling = \"one_way\"\n"
             "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n[output]\nfigures = false\n");
  const Ended ended = palpate(folder.path(), {"run", "round.toml"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const record::Table table = record::read_csv((folder / "out/round/findings.csv").string());
  for (const char* name : {"thickness_effect", "side_effect", "deep_effect"}) {
    const int column = table.find(name);
    ASSERT_GE(column, 0) << name;
    EXPECT_EQ(table.rows.front()[static_cast<std::size_t>(column)], record::Cell()) << name;
  }
  EXPECT_EQ(number(table, 0, "edge_effect"), 0.0) << "known: no edge is near";
  EXPECT_LT(number(table, 0, "body_effect"), 0.0) << "known from a coarse mesh";
  const std::string page = read_file(folder / "out/round/report.html");
  EXPECT_NE(page.find("bound of what a near edge changes"), std::string::npos);
  for (const char* line : {"more force by the finite thickness", "change by free sides",
                           "change by large depth", "force that friction allows"})
    EXPECT_EQ(page.find(line), std::string::npos) << line;
}

// A coarse mesh was pressed for a block of one tissue, not for one with layers and `solid`.
TEST(OfALayeredBlock, sides_that_were_not_computed_are_an_empty_cell) {
  const TemporaryFolder folder;
  write_file(folder / "block.toml",
             "[tissue]\nshape = { kind = \"cuboid\", size = [\"30 mm\", \"30 mm\", \"15 mm\"] }\n"
             "[finger]\nmaterial = \"rigid\"\n[solver]\nmodel = \"solid\"\n"
             "[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n[output]\nfigures = false\n"
             "interval = \"1 s\"\n");
  const auto findings = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command{"run", "block.toml", "--force"};
    command.insert(command.end(), more.begin(), more.end());
    const Ended ended = palpate(folder.path(), command);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return record::read_csv((folder / "out/block/findings.csv").string());
  };
  const record::Table plain = findings({});
  EXPECT_NE(number(plain, 0, "side_effect"), 0.0);
  const record::Table layered =
      findings({"--set",
                "region=[{kind=\"sphere\",centre=[\"15 mm\",\"15 mm\",\"8 mm\"],radius="
                "\"3 mm\",material=\"skin\"}]"});
  for (const char* name : {"side_effect", "body_effect"}) {
    const int column = layered.find(name);
    ASSERT_GE(column, 0) << name;
    EXPECT_EQ(layered.rows.front()[static_cast<std::size_t>(column)], record::Cell()) << name;
  }
}

TEST_F(OfAPress, has_all_its_files) {
  ASSERT_EQ(ended_.code, 0) << ended_.err;
  EXPECT_EQ(names_in(result()),
            (std::set<std::string>{"contents.sha256", "figure_force_indentation.gp",
                                   "figure_force_indentation.svg", "figure_force_time.gp",
                                   "figure_force_time.svg", "findings.csv", "fits.csv",
                                   "force_indentation.csv", "pressure_001.exr", "pressure_002.exr",
                                   "report.html", "run.json", "scenario.toml"}));
  EXPECT_EQ(names_in(*folder_ / "out"), std::set<std::string>{"press"}) << "nothing is left beside";
}

TEST_F(OfAPress, has_a_page_that_begins_with_the_force) {
  const std::string headline = headline_of(result() / "report.html");
  EXPECT_NE(headline.find(" N "), std::string::npos) << headline;
  EXPECT_TRUE(headline.ends_with(" %, not counting viscosity")) << headline;
  const std::string page = read_page(result() / "report.html");
  EXPECT_NE(page.find("pressed 2 mm by a sphere of radius 11 mm at x 30, y 30, z 30 mm, then "
                      "held for 0.05 s; underside fixed (bonded base)."),
            std::string::npos);
  EXPECT_NE(ended_.err.find("\nIt took "), std::string::npos) << ended_.err;
}

// What was done to what, and in what the cases differ.
TEST(RunResults, the_first_lines_say_slides_regions_platens_and_swept_keys) {
  const TemporaryFolder folder;
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  const auto page = [&](const std::string& text, const std::string& more) {
    write_file(folder / "one.toml",
               text + "[output]\nfigures = false\ninterval = \"1 s\"\n" + more);
    const Ended ended = palpate(folder.path(), {"run", "one.toml", "--force"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    return read_page(folder / "out/one/report.html");
  };
  const std::string slide =
      "[tissue]\nmesh = { kind = \"tetgen\", nodes = 200 }\n[[region]]\nkind = \"sphere\"\n"
      "centre = [\"30 mm\", \"30 mm\", \"15 mm\"]\nradius = \"8 mm\"\nmaterial = \"muscle\"\n"
      "[finger]\nx = \"25 mm\"\n[solver]\nmodel = \"mass_spring\"\n[[step]]\nkind = \"indent\"\n"
      "to = \"1 mm\"\n[[step]]\nkind = \"slide\"\nby = \"6 mm\"\n";
  const std::string alone = page(slide, "");
  EXPECT_TRUE(has(alone,
                  "nu 0.33; block of 60 x 60 x 30 mm; region 1: muscle, E 6 kPa; pressed 1 mm by "
                  "a sphere"))
      << alone;
  EXPECT_TRUE(has(alone, " mm, then slid by 6 mm; underside fixed"));
  const std::string swept =
      page(slide, "[sweep]\n\"region.1.young_modulus\" = [\"6 kPa\", \"60 kPa\"]\n");
  EXPECT_TRUE(has(swept, "<p>Cases differ in region 1 Young&#39;s modulus: 6 kPa, 60 kPa.</p>"))
      << swept;
  EXPECT_FALSE(has(swept, "region 1: muscle, E 6 kPa")) << "it is not that of all cases";
  EXPECT_TRUE(has(swept, ", then slid by 6 mm.</p>"));
  const std::string squeezed = page(
      "[tissue]\nbase = \"bonded\"\nmesh = { kind = \"mirrored\", cells = [2, 2, 2] }\n[solver]\n"
      "model = \"coupled_springs\"\n[[step]]\nkind = \"compress\"\nplaten = \"bonded\"\n",
      "");
  EXPECT_TRUE(has(squeezed, "; upper platen bonded; underside fixed (bonded base).")) << squeezed;
}

TEST(RunResults, the_first_lines_name_the_other_neglected_effects_with_their_size) {
  const TemporaryFolder folder;
  write_file(folder / "thin.toml",
             "[solver]\nmodel = \"hertz\"\n[output]\nfigures = false\n[[step]]\nkind = "
             "\"indent\"\nto = \"2 mm\"\nrate = \"5 mm/s\"\n");
  ASSERT_EQ(palpate(folder.path(), {"run", "thin.toml"}).code, 0);
  const std::string page = read_page(folder / "out/thin/report.html");
  const std::size_t also = page.find(" (also the size of the body, 15 %");
  EXPECT_NE(also, std::string::npos) << page;
  EXPECT_LT(also, page.find("Derived quantities"));
}

// As a person would: in its folder, line by line.
TEST_F(OfAPress, is_repeated_by_the_commands_of_its_page) {
  const std::string commands = "cp scenario.toml press.toml\npalpate run press.toml";
  EXPECT_NE(read_file(result() / "report.html").find(commands), std::string::npos);
  const TemporaryFolder folder;
  fs::copy_file(result() / "scenario.toml", folder / "press.toml");
  ASSERT_EQ(palpate(folder.path(), {"run", "press.toml"}).code, 0);
  for (const char* table : {"force_indentation.csv", "findings.csv", "fits.csv", "scenario.toml"})
    EXPECT_EQ(read_file(folder / "out/press" / table), read_file(result() / table)) << table;
}

TEST_F(OfAPress, has_the_promised_columns) {  // DESIGN.md section 6
  EXPECT_EQ(
      record::read_csv(result() / "force_indentation.csv").columns,
      (Strings{"case", "step", "time_s", "travel_mm", "indentation_mm", "force_N",
               "contact_force_N", "friction_N", "ambient_N", "contact_radius_mm",
               "peak_pressure_kPa", "tissue_radius_mm", "contacts", "slide_mm", "tangential_N"}));
  EXPECT_EQ(
      record::read_csv(result() / "fits.csv").columns,
      (Strings{"case", "curve", "model", "parameter", "unit", "estimate", "std_error", "ci95_low",
               "ci95_high", "r2", "rmse", "n", "range_low", "range_high", "termination"}));
  EXPECT_EQ(record::read_csv(result() / "findings.csv").columns.front(), "case");
}

TEST_F(OfAPress, has_a_manifest_that_fits) {
  const auto manifest = nlohmann::json::parse(read_file(result() / "run.json"));
  EXPECT_EQ(manifest["complete"], true);
  EXPECT_FALSE(manifest["outputs"].empty());
  std::set<std::string> named{"run.json", "contents.sha256"};
  for (const auto& output : manifest["outputs"]) {
    named.insert(output["path"]);
    EXPECT_EQ(output["sha256"], sha256(read_file(result() / std::string(output["path"]))))
        << output["path"];
  }
  EXPECT_EQ(named, names_in(result()));
}

TEST_F(OfAPress, has_identities_that_hold) {
  const record::Table findings = record::read_csv(result() / "findings.csv");
  const double map = number(findings, 0, "pressure_map_imbalance");
  EXPECT_GT(map, 0.0) << "a sum over pixels is never exact";
  EXPECT_LT(map, 0.005);  // pixels cut by the contact's edge; the promise of the map
  EXPECT_LT(number(findings, 0, "friction_imbalance"), 0.005);  // the same sum times mu
  const record::Table rows = record::read_csv(result() / "force_indentation.csv");
  ASSERT_GT(rows.rows.size(), 20U);
  for (std::size_t i = 0; i < rows.rows.size(); ++i) {
    const double contact = number(rows, i, "contact_force_N");
    EXPECT_NEAR(number(rows, i, "friction_N"), 0.4 * contact, 1e-14);  // rounding
    EXPECT_NEAR(number(rows, i, "force_N"), contact, 1e-14);           // no ambient force
  }
}

TEST(RunResults, a_uniform_test_has_a_strain_curve) {
  const TemporaryFolder folder;
  write_file(folder / "creep.toml",
             "[tissue]\nmesh = { kind = \"mirrored\", cells = [2, 2, 2] }\n"
             "[solver]\nintegrator = \"modal\"\n[[step]]\nkind = \"creep\"\n"
             "[output]\ninterval = \"50 ms\"\n");
  const Ended ended = palpate(folder.path(), {"run", "creep.toml"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(names_in(folder / "out/creep"),
            (std::set<std::string>{"contents.sha256", "figure_strain_time.gp",
                                   "figure_strain_time.svg", "findings.csv", "fits.csv",
                                   "report.html", "run.json", "scenario.toml", "strain_time.csv"}));
  EXPECT_EQ(record::read_csv(folder / "out/creep/strain_time.csv").columns,
            (Strings{"case", "step", "time_s", "stress_kPa", "strain"}));
}

// PHYSICS.md section 2: the table's printed digits, and the closed forms of tests/cases where they
// are there.
TEST(RunResults, figure6_gives_the_forces_of_the_closed_form) {
  struct Printed {
    const char* name;
    double scale;                 // of the printed row
    std::array<double, 4> force;  // N
    std::array<double, 4> digit;  // N, one unit of the last printed digit
  };
  const std::array<Printed, 5> printed{{
      {"skin", 1.0, {0.1234, 0.3489, 0.9869, 1.813}, {1e-4, 1e-4, 1e-4, 1e-3}},
      {"muscle", 1.0, {0.0111, 0.0315, 0.0891, 0.1637}, {1e-4, 1e-4, 1e-4, 1e-4}},
      {"ligament", 1.0, {0.0639, 0.1808, 0.5114, 0.9394}, {1e-4, 1e-4, 1e-4, 1e-4}},
      {"bone", 0.1, {0.427, 1.209, 3.418, 6.280}, {1e-3, 1e-3, 1e-3, 1e-3}},
      {"upper_leg", 1.0, {0.00137, 0.00389, 0.0110, 0.0202}, {1e-5, 1e-5, 1e-4, 1e-4}},
  }};
  const std::array<double, 4> depths{0.5, 1.0, 2.0, 3.0};  // mm
  const TemporaryFolder folder;
  const Ended ended =
      palpate(folder.path(), {"run", project_file("scenarios/figure6_force_indentation.toml"),
                              "--set", "output.figures=false"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const record::Table rows =
      record::read_csv(folder / "out/figure6_force_indentation/force_indentation.csv");
  const auto force = [&](const char* name, double depth) {
    return number(rows, row_at(rows, name, depth), "force_N");
  };
  for (const Printed& row : printed)
    for (std::size_t i = 0; i < depths.size(); ++i) {
      // 1e-4 of the force, and half a unit of the last digit that is printed
      const double near = 1e-4 * row.force[i] + 0.5 * row.digit[i];
      EXPECT_NEAR(row.scale * force(row.name, depths[i]), row.force[i], near)
          << row.name << " at " << depths[i] << " mm";
    }
  expect_case("hertz-02", force("skin", 0.5));
  expect_case("hertz-07", force("skin", 2.0));
  expect_case("hertz-11", force("muscle", 0.5));
  expect_case("hertz-12", force("muscle", 1.0));
  expect_case("hertz-20", force("bone", 0.5));
  expect_case("hertz-21", force("bone", 1.0));
  expect_case("hertz-29", force("ligament", 0.5));
  expect_case("hertz-30", force("ligament", 1.0));
  const auto leg = row_at(rows, "upper_leg", 1.0);
  expect_case("hertz-40", 1e-3 * number(rows, leg, "contact_radius_mm"));
  expect_case("hertz-41", 1e3 * number(rows, leg, "peak_pressure_kPa"));
  // F grows as h^(3/2): the rows that the table prints with two digits only
  for (const Printed& row : printed)
    EXPECT_NEAR(force(row.name, 3.0) / force(row.name, 0.5), 6.0 * std::sqrt(6.0),
                1e-8)  // rounding of the travel
        << row.name;
}

TEST(RunResults, findings_lead_with_the_swept_keys) {
  const TemporaryFolder folder;
  write_file(folder / "sweep.toml",
             "[solver]\nmodel = \"hertz\"\n[[step]]\nkind = \"indent\"\n"
             "[output]\ninterval = \"100 ms\"\nfigures = false\n"
             "[sweep]\n\"tissue.material\" = [\"skin\", \"bone\"]\n"
             "\"finger.radius\" = [\"8 mm\", \"11 mm\"]\n");
  const Ended ended = palpate(folder.path(), {"run", "sweep.toml"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const record::Table findings = record::read_csv(folder / "out/sweep/findings.csv");
  EXPECT_EQ(Strings(findings.columns.begin(), findings.columns.begin() + 3),
            (Strings{"case", "tissue.material", "finger.radius_mm"}));
  ASSERT_EQ(findings.rows.size(), 4U);
  EXPECT_EQ(findings.rows[1][0], record::Cell("skin_11 mm"));
  EXPECT_EQ(findings.rows[2][1], record::Cell("bone"));
  EXPECT_EQ(findings.rows[2][2], record::Cell(8.0));
}

TEST(RunResults, pdf_on_request) {
  const TemporaryFolder folder;
  write_file(folder / "press.toml", press_and_hold);
  const Ended ended = palpate(folder.path(), {"run", "press.toml", "--set", "output.pdf=true"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(read_file(folder / "out/press/figure_force_indentation.pdf").substr(0, 5), "%PDF-");
  EXPECT_TRUE(fs::exists(folder / "out/press/figure_force_indentation.svg"));
}

TEST(RunResults, without_gnuplot_the_script_stays) {
  const TemporaryFolder folder;
  write_file(folder / "press.toml", press_and_hold);
  fs::create_directory(folder / "empty");
  const Ended ended = run_program({.arguments = {"run", "press.toml"},
                                   .folder = folder.path(),
                                   .set = {{"PATH", (folder / "empty").string()}}});
  EXPECT_EQ(ended.code, 0);
  EXPECT_NE(ended.err.find("warning: figure_force_indentation.svg was not drawn"),
            std::string::npos)
      << ended.err;
  EXPECT_NE(ended.err.find("`gnuplot` is not installed"), std::string::npos) << ended.err;
  EXPECT_TRUE(fs::exists(folder / "out/press/figure_force_indentation.gp"));
  EXPECT_FALSE(fs::exists(folder / "out/press/figure_force_indentation.svg"));
  EXPECT_TRUE(fs::exists(folder / "out/press/run.json"));
}

TEST(RunResults, inputs_lie_beside_the_echo) {
  const TemporaryFolder folder;
  const Ended ended = palpate(
      folder.path(), {"run", project_file("golden/user_table/scenario.toml"), "--out", "a"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(read_file(folder / "a/scenario/mine.toml"),
            read_file(project_file("golden/user_table/mine.toml")));
  EXPECT_NE(read_file(folder / "a/scenario/scenario.toml").find("\"mine.toml#gel\""),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::test
