// `palpate compare`: exit codes, and the words by which a difference is found.
#include <gtest/gtest.h>

#include "program.h"

namespace palpate::test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class CompareVerb : public testing::Test {
 protected:
  Ended compare(const std::string& got, const std::string& want,
                const std::string& tolerances = {}) {
    write_file(folder_ / "got.csv", got);
    write_file(folder_ / "want.csv", want);
    std::vector<std::string> arguments{"compare", "got.csv", "want.csv"};
    if (!tolerances.empty()) {
      write_file(folder_ / "tolerances.toml", tolerances);
      arguments.insert(arguments.end(), {"--tolerances", "tolerances.toml"});
    }
    return palpate(folder_.path(), arguments);
  }
  void expect(const Ended& ended, int code, const std::string& text) {
    EXPECT_EQ(ended.code, code);
    EXPECT_EQ(ended.out, text);
    EXPECT_EQ(ended.err, "");
  }

  TemporaryFolder folder_;
  const std::string base_ = "case,a_mm\nskin,1\nskin,2\nskin,4\n";
};

TEST_F(CompareVerb, equal) { expect(compare(base_, base_), 0, "equal: 2 columns\n"); }

TEST_F(CompareVerb, the_worst_row_is_named) {
  expect(compare("case,a_mm\nskin,1.5\nskin,2.5\nskin,8\n", base_), 3,
         "DIFFERS in 1 of 2 columns, in a_mm by 100 %\n"
         "a_mm: DIFFERS in 3 rows; worst row 3: case `skin`, got 8, want 4, relative difference 1, "
         "allowed 4e-09\n");
}

// Names of somebody else's file command neither a terminal nor a build server.
TEST_F(CompareVerb, names_from_files_are_only_words) {
  const Ended ended =
      compare("\"::error::x\",\"b\x1b[31m\"\n1,2\n", "\"::error::x\",\"b\x1b[31m\"\n3,4\n");
  EXPECT_EQ(ended.code, 3) << ended.err;
  EXPECT_NE(ended.out.find("\n\\x3a:error::x: DIFFERS"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("\nb\\x1b[31m: DIFFERS"), std::string::npos) << ended.out;
}

TEST_F(CompareVerb, a_report_for_a_build_server_goes_through_a_link) {
  write_file(folder_ / "there/junit.xml", "old");
  fs::create_symlink("there/junit.xml", folder_ / "junit.xml");
  write_file(folder_ / "got.csv", base_);
  const Ended ended =
      palpate(folder_.path(), {"compare", "got.csv", "got.csv", "--junit", "junit.xml"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(fs::is_symlink(folder_ / "junit.xml"));
  EXPECT_NE(read_file(folder_ / "there/junit.xml").find("<testsuite"), std::string::npos);
}

// The page tells the curve first, and draws what is wanted dashed over what was got.
TEST_F(CompareVerb, a_page_overlays_the_curves) {
  const std::string head = "case,travel_mm,force_N\n";
  write_file(folder_ / "got.csv", head + "skin,0,0\nskin,1,2\nskin,2,6\n");
  write_file(folder_ / "want.csv", head + "skin,0,0\nskin,1,2\nskin,2,5\n");
  const Ended ended =
      palpate(folder_.path(), {"compare", "got.csv", "want.csv", "--report", "page.html"});
  EXPECT_EQ(ended.code, 3) << ended.err;
  const std::string page = read_file(folder_ / "page.html");
  EXPECT_EQ(headline_of(folder_ / "page.html"), "20 % largest difference of force_N");
  const auto wanted = page.find(">want.csv</text>");
  ASSERT_NE(wanted, std::string::npos);
  EXPECT_LT(page.find(">got.csv</text>"), wanted);
  EXPECT_GT(page.find("stroke-dasharray"), wanted);
  EXPECT_NE(page.find("stroke-dasharray"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "page.html.partial"));
}

TEST_F(CompareVerb, a_page_overlays_curves_of_other_names) {
  const std::string head = "case,travel_mm,force_N\n";
  write_file(folder_ / "got.csv", head + "soft,0,0\nsoft,1,2\n");
  write_file(folder_ / "want.csv", head + "hard,0,0\nhard,1,5\n");
  EXPECT_EQ(
      palpate(folder_.path(), {"compare", "got.csv", "want.csv", "--report", "page.html"}).code, 3);
  const std::string page = read_file(folder_ / "page.html");
  EXPECT_NE(page.find("soft, got.csv</text>"), std::string::npos);
  EXPECT_NE(page.find("hard, want.csv</text>"), std::string::npos);
  EXPECT_EQ(page.find("soft, want.csv"), std::string::npos) << "an empty curve";
}

// Both sides are called by what their folders differ in, results come first, at most eight, and
// what no reader asks for is folded.
TEST_F(CompareVerb, a_page_begins_with_the_results) {
  const auto write = [&](const std::string& side, int by) {
    const std::string end = std::to_string(by) + "\n";
    std::string columns, values;
    for (int i = 1; i <= 9; ++i) {
      columns += ",peak_" + std::to_string(i) + "_N";
      values += ",1" + std::to_string(by);
    }
    write_file(folder_ / side / "out/press/findings.csv", "case,model,stated_error,factorisations" +
                                                              columns + "\nskin,layer,0.03,1" +
                                                              std::to_string(by) + values + "\n");
    write_file(folder_ / side / "out/press/force_indentation.csv",
               "case,time_s,travel_mm,force_N\nskin,0,0,0\nskin,1,1,2" + end);
  };
  write("a", 1);
  write("b", 2);
  const Ended ended = palpate(
      folder_.path(), {"compare", "a/out/press", "./b/out/press/", "--report", "page.html"});
  EXPECT_EQ(ended.code, 3) << ended.err;
  const std::string page = read_file(folder_ / "page.html");
  EXPECT_NE(page.find("<h1>press: a compared with b</h1>"), std::string::npos);
  EXPECT_NE(page.find("where it is 21 in a and 22 in b."), std::string::npos);
  EXPECT_NE(
      page.find("Force (N) against displacement (mm) in force_indentation.csv: the line is a, "
                "the dashed one b."),
      std::string::npos);
  EXPECT_NE(page.find("<p>Model in b: layer, with a stated error of about 3\u00a0%.</p>"),
            std::string::npos);
  EXPECT_NE(page.find("<p>The same in <code>findings.csv</code>: <code>case</code>, "),
            std::string::npos);
  const std::size_t from = page.find("id=\"what-differs\""),
                    to = page.find("id=\"all-columns-that-differ\"");
  ASSERT_LT(from, to);
  const std::string first = page.substr(from, to - from);
  EXPECT_LT(first.find(">force_N<"), first.find(">peak_1_N<"));
  EXPECT_EQ(has(first, ">peak_7_N<"), true);
  EXPECT_EQ(has(first, ">peak_8_N<"), false) << "the ninth";
  EXPECT_EQ(has(first, "factorisations"), false);
  EXPECT_EQ(has(page.substr(to), ">factorisations<"), true);
  EXPECT_EQ(has(page.substr(to), ">peak_9_N<"), true);
}

TEST_F(CompareVerb, within_a_tolerance) {
  const std::string tolerances = "[column.a_mm]\nrel = 0.01\nreason = \"a test\"\n";
  expect(compare("case,a_mm\nskin,1\nskin,2.01\nskin,4\n", base_, tolerances), 0,
         "equal: 2 columns\n");
  EXPECT_EQ(compare("case,a_mm\nskin,1\nskin,2.03\nskin,4\n", base_, tolerances).code, 3);
}

TEST_F(CompareVerb, columns_and_rows_too_few_and_too_many) {
  expect(compare("case\nskin\nskin\nskin\n", base_), 3,
         "DIFFERS in 1 of 2 columns, in a_mm\na_mm: DIFFERS, the column is missing\n");
  expect(compare("case,a_mm,b\nskin,1,0\nskin,2,0\nskin,4,0\n", base_), 3,
         "DIFFERS in 1 of 3 columns, in b\nb: DIFFERS, the column is not wanted\n");
  expect(compare("case,a_mm\nskin,1\n", base_), 3,
         "DIFFERS in 0 of 2 columns, in the number of rows\nrows: DIFFERS, got 1, want 3; "
         "compared: the first 1\n");
  expect(compare(base_ + "skin,5\n", base_), 3,
         "DIFFERS in 0 of 2 columns, in the number of rows\nrows: DIFFERS, got 4, want 3; "
         "compared: the first 3\n");
}

// What is compared of curves of different length stands beside the difference.
TEST_F(CompareVerb, says_over_which_rows_the_difference_is) {
  const std::string head = "case,travel_mm,force_N\n", start = head + "skin,0,1\n";
  write_file(folder_ / "got.csv", start + "skin,1,2\n");
  write_file(folder_ / "want.csv", start + "skin,1,4\nskin,2,5\n");
  const Ended ended =
      palpate(folder_.path(), {"compare", "got.csv", "want.csv", "--report", "page.html"});
  EXPECT_TRUE(ended.out.starts_with(
      "DIFFERS in 1 of 3 columns, in force_N by 50 % over the first 2 of 3 rows\n"))
      << ended.out;
  EXPECT_EQ(headline_of(folder_ / "page.html"),
            "50 % largest difference of force_N over the first 2 of 3 rows");
}

// The place of the worst row has six digits; the JSON has all of them.
TEST_F(CompareVerb, tells_a_place_in_six_digits) {
  const std::string place = "time_s,force_N\n0.2990033222591362,";
  const Ended ended = compare(place + "1\n", place + "2\n");
  EXPECT_NE(ended.out.find("row 1: time_s 0.299003, got 1, want 2,"), std::string::npos)
      << ended.out;
}

TEST_F(CompareVerb, what_is_no_number) {
  expect(compare("a\nnan\ninf\n", "a\nnan\ninf\n"), 0, "equal: 1 column\n");
  const std::string wide = "[default]\nrel = 1e9\nabs = 1e9\n";
  expect(compare("a\nnan\n", "a\n1\n", wide), 3,
         "DIFFERS in 1 of 1 column, in a\n"
         "a: DIFFERS in 1 row; worst row 1: got nan, want 1, allowed 2e+09\n");
  EXPECT_EQ(compare("a\n1\n", "a\nnan\n", wide).code, 3);
  EXPECT_EQ(compare("a\ninf\n", "a\n-inf\n", wide).code, 3);
  EXPECT_EQ(compare("a,b\n,1\n", "a,b\n1,1\n", wide).code, 3) << "nothing is not a number";
  EXPECT_EQ(compare("case\nskin\n", "case\nbone\n", wide).code, 3);
}

TEST_F(CompareVerb, folders) {
  write_file(folder_ / "a/x.csv", base_);
  write_file(folder_ / "a/run.json", "{}");
  write_file(folder_ / "b/x.csv", base_);
  expect(palpate(folder_.path(), {"compare", "a", "b"}), 0, "equal: 2 columns\n");
  write_file(folder_ / "b/y.csv", base_);
  Ended ended = palpate(folder_.path(), {"compare", "a", "b"});
  EXPECT_EQ(ended.code, 3);
  EXPECT_NE(ended.out.find("y.csv, file: DIFFERS, the file is missing\n"), std::string::npos);
  ended = palpate(folder_.path(), {"compare", "b", "a"});
  EXPECT_EQ(ended.code, 3);
  EXPECT_NE(ended.out.find("y.csv, file: DIFFERS, the file is not wanted\n"), std::string::npos);
}

TEST_F(CompareVerb, for_pipelines) {
  const std::string curve = "case,time_s,a_mm\nskin,0,1\nskin,0.5,2\n";
  const std::string other = "case,time_s,a_mm\nskin,0,1\nskin,0.5,3\n";
  write_file(folder_ / "a/x.csv", other);
  write_file(folder_ / "b/x.csv", curve);
  write_file(folder_ / "b/y.csv", curve);
  const Ended quiet = palpate(folder_.path(), {"compare", "a", "b", "--quiet", "--junit", "j.xml",
                                               "--annotations", "github"});
  EXPECT_EQ(quiet.code, 3);
  EXPECT_EQ(quiet.out,
            "x.csv, a_mm: DIFFERS in 1 row; worst row 2: case `skin`, time_s 0.5, got 3, want 2, "
            "relative difference 0.5, allowed 2e-09\n"
            "y.csv, file: DIFFERS, the file is missing\n");
  EXPECT_EQ(quiet.err,
            "::error file=b/x.csv,line=3,title=palpate%3A a::x.csv, a_mm: DIFFERS in 1 row; worst "
            "row 2: case `skin`, time_s 0.5, got 3, want 2, relative difference 0.5, allowed "
            "2e-09 (2 differences in all)\n")
      << "one a result";
  const std::string junit = read_file(folder_ / "j.xml");
  EXPECT_NE(junit.find("<testsuites name=\"palpate\" tests=\"4\" failures=\"2\" errors=\"0\" "
                       "skipped=\"0\">"),
            std::string::npos)
      << junit;
  const Ended json = palpate(folder_.path(), {"compare", "a", "b", "--json"});
  EXPECT_EQ(json.code, 3);
  EXPECT_NE(json.out.find("{\"file\":\"x.csv\",\"column\":\"a_mm\",\"state\":\"differs\","
                          "\"rows_differing\":1,\"row\":2,\"case\":\"skin\",\"x_name\":\"time_s\","
                          "\"x\":0.5,\"got\":3,\"want\":2,\"relative\":0.5,\"allowed\":2e-09}\n"),
            std::string::npos)
      << json.out;
  EXPECT_EQ(palpate(folder_.path(), {"compare", "a", "a", "--quiet"}).out, "");
}

TEST_F(CompareVerb, tolerances_of_unknown_columns_are_mistakes) {
  const Ended ended =
      compare(base_, base_, "[column.b_mm]\nrel = 1\n[tube]\nx = \"time\"\nwidth = 1\n");
  EXPECT_EQ(ended.code, 2);
  EXPECT_EQ(ended.err,
            "tolerances.toml:1:9: `b_mm` is no column of these files; did you mean `a_mm`?\n"
            "tolerances.toml:4:5: `time` is no column of these files; take it out, or name one of "
            "a_mm, case\n");
}

TEST_F(CompareVerb, what_cannot_be_compared) {
  write_file(folder_ / "a/x.csv", base_);
  fs::create_directory(folder_ / "empty");
  const auto complaint = [&](const std::string& got, const std::string& want) {
    const Ended ended = palpate(folder_.path(), {"compare", got, want});
    EXPECT_EQ(ended.code, 2);
    EXPECT_EQ(ended.out, "");
    return ended.err;
  };
  EXPECT_EQ(complaint("nothing", "a"),
            "nothing: is not there; give a CSV file or a result folder\n");
  EXPECT_EQ(complaint("a", "nothing"),
            "nothing: is not there; give a CSV file or a result folder\n");
  EXPECT_EQ(complaint("a", "a/x.csv"),
            "a: and a/x.csv are a file and a folder; give two files or two folders\n");
  EXPECT_EQ(complaint("a", "empty"),
            "empty: holds no CSV file to compare with; give a folder of results\n");
  const Ended ended = compare(base_, base_, "[column.a_mm]\nrel = -1\n");
  EXPECT_EQ(ended.code, 2);
  EXPECT_EQ(ended.err.rfind("tolerances.toml:2:7: ", 0), 0U) << ended.err;
}

// A verdict that nobody can read is no verdict.
TEST_F(CompareVerb, stdout_that_takes_nothing) {
  write_file(folder_ / "a.csv", base_);
  const Ended ended = run_program({.arguments = {"compare", "a.csv", "a.csv"},
                                   .folder = folder_.path(),
                                   .before = [] { ::dup2(::open("/dev/full", O_WRONLY), 1); }});
  EXPECT_EQ(ended.code, 1);
  EXPECT_EQ(ended.err, "palpate: stdout cannot be written\n");
}

}  // namespace
}  // namespace palpate::test
