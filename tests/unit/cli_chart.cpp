// `palpate chart` on scenarios that cost nothing: its files, its refusals, how it goes on.
#include <gtest/gtest.h>

#include "browser.h"
#include "program.h"
#include "record/csv.h"
#include "record/journal.h"
#include "svg_text.h"

namespace palpate::test {
namespace {

using Words = std::vector<std::string>;

// Strains of a few nodes.
const std::string creep =
    "title = \"Small creep\"\n"
    "[tissue]\nmesh = { kind = \"mirrored\", cells = [2, 2, 2] }\n"
    "viscosity = \"kelvin_voigt\"\nretardation_time = \"10 ms\"\n"
    "[[step]]\nkind = \"creep\"\nstress = \"1 kPa\"\nload_time = \"16 ms\"\n"
    "recovery_time = \"8 ms\"\n[output]\ninterval = \"4 ms\"\n";
// Nothing but formulas.
const std::string half_space =
    "[tissue]\nshape = { kind = \"half_space\" }\n[[step]]\nkind = \"indent\"\nto = \"0.1 mm\"\n";

class ChartVerb : public testing::Test {
 protected:
  Ended chart(const std::string& scenario, const Words& more = {}) const {
    write_file(folder_ / "small.toml", scenario);
    return palpate(folder_.path(), {"chart", "small.toml", "--repeats", "1"}, more);
  }
  [[nodiscard]] record::Table table() const {
    return record::read_csv((folder_ / "out/small_chart/chart.csv").string());
  }
  TemporaryFolder folder_;
};

std::vector<record::Cell> column(const record::Table& table, const char* name) {
  std::vector<record::Cell> cells;
  for (const auto& row : table.rows)
    cells.push_back(row[static_cast<std::size_t>(table.find(name))]);
  return cells;
}

TEST_F(ChartVerb, AUniformTestIsCharted) {
  const Ended ended = chart(creep);
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(names_in(folder_ / "out"), std::set<std::string>{"small_chart"});
  const std::set<std::string> names = names_in(folder_ / "out/small_chart");
  for (const char* name : {"chart.csv", "chart.md", "chart.gp", "chart.svg"})
    EXPECT_TRUE(names.contains(name)) << name;
  EXPECT_FALSE(names.contains("journal.csv"));
  EXPECT_EQ(read_file(folder_ / "out/small_chart/chart.md"), ended.out);
  EXPECT_NE(ended.out.find("Within the tolerance of 5 %, the cheapest is `"), std::string::npos);
  EXPECT_NE(read_file(folder_ / "out/small_chart/chart.svg").find("taken by auto"),
            std::string::npos);
  EXPECT_EQ(SvgPicture(read_file(folder_ / "out/small_chart/chart.svg")).faults(),
            std::vector<std::string>{});
  EXPECT_NE(headline_of(folder_ / "out/small_chart/report.html").find("the cheapest within"),
            std::string::npos);
  // Which of two models of springs is the cheaper one is a matter of times.
  const std::string said = "the cheapest is `";
  const std::size_t from = ended.out.find(said) + said.size();
  const std::string cheapest = ended.out.substr(from, ended.out.find('`', from) - from);
  EXPECT_NE(headline_of(folder_ / "out/small_chart/report.html").find(cheapest), std::string::npos)
      << cheapest;
  const std::string page = read_file(folder_ / "out/small_chart/report.html");
  EXPECT_NE(page.find("<td data-column=\"auto\">yes</td>"), std::string::npos);
  EXPECT_EQ(faults_of_pages(folder_ / "out/small_chart", {"report.html"}, Scheme::dark),
            std::vector<std::string>{});
  const record::Table all = table();
  const auto status = column(all, "status");
  const auto variant = column(all, "configuration");
  const auto error = column(all, "greatest_error");
  auto note = column(all, "note");
  for (record::Cell& cell : note)
    if (!std::holds_alternative<std::string>(cell)) cell = "";
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    const std::string name = std::get<std::string>(variant[i]);
    // Formulas have no specimen; 4 ms is above the limit of the explicit methods.
    const bool refused =
        name == "hertz" || name == "layer" ||
        std::get<std::string>(note[i]).find("above the stability limit") != std::string::npos;
    EXPECT_EQ(status[i] == record::Cell("cannot"), refused) << name;
    if (refused) continue;
    ASSERT_TRUE(std::holds_alternative<double>(error[i])) << name;
    // Of the closed form: backward differences of 4 ms at a retardation time of 10 ms err most.
    EXPECT_LT(std::get<double>(error[i]), 0.2) << name;
  }
}

TEST_F(ChartVerb, ErrorsAreTheSameTwice) {
  ASSERT_EQ(chart(creep).code, 0);
  const record::Table first = table();
  ASSERT_EQ(chart(creep, {"--force"}).code, 0);
  const record::Table second = table();
  for (const char* name : {"variant", "status", "greatest_error", "end_error", "rms_error",
                           "shown_error", "greatest_time_error", "reference_error", "note"})
    EXPECT_EQ(column(first, name), column(second, name)) << name;
}

TEST_F(ChartVerb, AHalfSpaceIsForHertzAlone) {
  const Ended ended = chart(half_space, {"--json"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("\"configuration\":\"auto\""), std::string::npos);
  const auto status = column(table(), "status");
  EXPECT_EQ(std::count(status.begin(), status.end(), record::Cell("measured")), 1);
}

TEST_F(ChartVerb, AFinishedChartIsNotOverwritten) {
  ASSERT_EQ(chart(half_space).code, 0);
  const Ended again = chart(half_space, {"--set", "finger.radius=8 mm"});
  EXPECT_EQ(again.code, 2);
  EXPECT_EQ(again.err,
            "out/small_chart: holds a finished chart of other inputs or settings; give `--force` "
            "to replace it, or another `--out`\n");
  EXPECT_EQ(chart(half_space).code, 0) << "the same call";
}

TEST_F(ChartVerb, InterruptedItGoesOn) {
  write_file(folder_ / "small.toml", creep);
  const std::string folder = (folder_ / "out/small_chart.partial").string();
  const auto journal = [&] {
    const std::vector<std::string> files = record::journal_files(folder);
    return files.empty() ? "" : read_file(files.front());
  };
  const auto lines = [&] {
    const std::string text = journal();
    return std::count(text.begin(), text.end(), '\n');
  };
  // So many repeats that it does not end by itself.
  Running running(
      {.arguments = {"chart", "small.toml", "--repeats", "1000"}, .folder = folder_.path()});
  ASSERT_TRUE(running.until([&] { return lines() >= 4; }));
  running.send(SIGINT);
  const Ended ended = running.wait();
  EXPECT_EQ(ended.code, 75);
  EXPECT_EQ(ended.err,
            "palpate: interrupted; out/small_chart.partial keeps the measurements, and the same "
            "call continues from there\n");
  EXPECT_FALSE(fs::exists(folder_ / "out/small_chart"));
  const std::string kept = journal();

  // Other settings are another chart.
  const Ended other = chart(creep, {"--set", "tissue.young_modulus=5 kPa"});
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("holds the beginning of a chart of another scenario"),
            std::string::npos);
  EXPECT_EQ(journal(), kept);

  const Ended rest = chart(creep);
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_NE(rest.err.find("continues with the measurements in out/small_chart.partial"),
            std::string::npos);
  // The first measurement is the one that was kept: its total time is in the table.
  // A line is a seal, a tab, and a table of one row whose line feeds are written as `\n`.
  const std::size_t column_name = kept.find("whole_s");
  ASSERT_NE(column_name, std::string::npos);
  const std::size_t start = kept.rfind('\t', column_name) + 1;
  std::string first = kept.substr(start, kept.find('\n', start) - start);
  for (std::size_t at; (at = first.find("\\n")) != std::string::npos;) first.replace(at, 2, "\n");
  const record::Table before = record::parse_csv(first, "journal");
  const auto seconds = [&](const char* name) {
    return std::get<double>(before.rows.at(0).at(static_cast<std::size_t>(before.find(name))));
  };
  const double total = seconds("build_s") + seconds("whole_s");
  EXPECT_NEAR(std::get<double>(column(table(), "total_min_s").front()), total,
              1e-3 * total);  // written with four digits; more timings may only be shorter
}

TEST_F(ChartVerb, Refusals) {
  EXPECT_EQ(chart("[[step]]\nkind = \"indent\"\nto = \"1 N\"\n").err,
            "small.toml:3:6: a step to a force ends elsewhere in every configuration, and `palpate "
            "chart` compares forces at equal displacements; give a displacement\n");
  EXPECT_EQ(chart(half_space, {"--repeats", "0"}).code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

}  // namespace
}  // namespace palpate::test
