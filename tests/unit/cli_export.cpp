// `palpate convert` of results: every file read back by us, and by the rules of the tools it is
// for.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <sstream>

#include "measured/measured.h"
#include "program.h"
#include "record/csv.h"

namespace palpate::test {
namespace {

using Numbers = std::vector<double>;

// Lines as Python's text mode gives them: any line end is one line feed, kept.
std::vector<std::string> python_lines(const std::string& bytes) {
  std::vector<std::string> lines{""};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] == '\r' && i + 1 < bytes.size() && bytes[i + 1] == '\n') continue;
    lines.back() += bytes[i] == '\r' ? '\n' : bytes[i];
    if (lines.back().ends_with('\n')) lines.emplace_back();
  }
  if (lines.back().empty()) lines.pop_back();
  return lines;
}

std::string strip(const std::string& text, const std::string& what) {
  const auto first = text.find_first_not_of(what);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(what) - first + 1);
}

const std::string white = " \t\r\n";

std::vector<std::string> python_split(const std::string& text, char separator) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

// What afmformats' fmt_tab.py would load: its rules, written anew.
struct AfmTab {
  bool detected = false;
  std::string json;
  std::map<std::string, Numbers> data;
  std::vector<bool> segment;
};
AfmTab load_tab(const std::string& bytes) {
  AfmTab loaded;
  const std::vector<std::string> lines = python_lines(bytes);
  bool begin = false;
  bool end = false;
  for (const std::string& raw : lines) {
    const std::string line = strip(raw, white);
    if (line.starts_with("# BEGIN METADATA"))
      begin = true;
    else if (line.starts_with("# END METADATA") && begin)
      end = true;
    else if (line.empty() || line.starts_with("#"))
      continue;
    else {
      loaded.detected = begin && end && line.find('\t') != std::string::npos;
      break;
    }
  }
  bool in_json = false;
  for (const std::string& line : lines) {
    if (line.starts_with("# BEGIN METADATA"))
      in_json = true;
    else if (line.starts_with("# END METADATA"))
      break;
    else if (in_json)
      loaded.json += strip(strip(line, "#"), white) + "\n";
  }
  std::string header;
  for (const std::string& line : lines) {
    if (strip(line, white).empty()) continue;
    if (!line.starts_with("#")) break;
    header = line;
  }
  const std::vector<std::string> columns = python_split(strip(strip(header, "#"), white), '\t');
  for (const std::string& line : lines) {
    if (strip(line, white).empty() || line.starts_with("#")) continue;
    const std::vector<std::string> items = python_split(strip(line, white), '\t');
    EXPECT_EQ(items.size(), columns.size()) << line;
    for (std::size_t i = 0; i < items.size() && i < columns.size(); ++i) {
      if (columns[i] == "segment")
        loaded.segment.push_back(items[i] == "True");
      else
        loaded.data[columns[i]].push_back(std::stod(items[i]));
    }
  }
  return loaded;
}

// What afmformats' fmt_chiaro_txt.py would load: pairs above the columns, then numbers.
struct Chiaro {
  bool device = false;
  std::map<std::string, std::string> notes;
  std::vector<std::string> columns;
  std::vector<Numbers> rows;
};
Chiaro load_chiaro(const std::string& bytes) {
  Chiaro loaded;
  for (const std::string& line : python_lines(bytes)) {
    if (line.find("Device:\tChiaro") != std::string::npos) loaded.device = true;
    const std::vector<std::string> cells = python_split(strip(line, "\n"), '\t');
    if (line.find("Time (s)\tLoad") != std::string::npos) {
      loaded.columns = cells;
    } else if (!loaded.columns.empty()) {
      EXPECT_EQ(cells.size(), loaded.columns.size());
      loaded.rows.emplace_back();
      for (const std::string& cell : cells) loaded.rows.back().push_back(std::stod(cell));
    } else if (cells.size() % 2 == 0) {
      for (std::size_t i = 0; i < cells.size(); i += 2)
        loaded.notes[cells[i]] = strip(cells[i + 1], white);
    }
  }
  return loaded;
}

class ExportVerb : public testing::Test {
 protected:
  void SetUp() override {
    // Numbers with all their digits; a retraction after the largest force.
    record::Table press{{"case", "step", "time_s", "travel_mm", "indentation_mm", "force_N"}, {}};
    for (const char* name : {"soft", "8 kPa/v=2"})
      for (int i = 0; i <= 40; ++i) {
        const double depth = (i <= 25 ? i : 50 - i) / 15.0 + (name[0] == '8' ? 1e-3 : 0.0);
        press.rows.push_back({std::string(name), i <= 25 ? 1.0 : 2.0, 0.007 * i, depth + 0.01,
                              depth, 0.37 * depth * std::sqrt(depth)});
      }
    write_file(result() / "force_indentation.csv", record::csv_text(press));
    fs::copy_file(project_file("scenarios/quickstart.toml"), result() / "scenario.toml");
    record::Table creep{{"case", "step", "time_s", "stress_kPa", "strain"}, {}};
    for (int i = 0; i <= 20; ++i)
      creep.rows.push_back(
          {std::string("relax"), 1.0, 0.1 * i, 5.0 + 3.0 * std::exp(-0.1 * i), 0.1 / 3.0});
    write_file(folder_ / "uniform" / "strain_time.csv", record::csv_text(creep));
    write_file(folder_ / "own.csv", "time_s,Load_mN\n0,1\n1,2.5\n");
  }

  [[nodiscard]] fs::path result() const { return folder_ / "press"; }

  Ended run(const std::string& result, const std::string& format,
            const std::vector<std::string>& more = {}) {
    return palpate(folder_.path(), {"convert", result, "--to", format, "--out", "out"}, more);
  }

  // A column of one case as the result has it, in SI.
  [[nodiscard]] Numbers expected(const std::string& x, const std::string& name) const {
    return measured::read_measured((result() / "force_indentation.csv").string(),
                                   {.x = x, .y = "force_N", .case_name = name})
        .x;
  }
  measured::MeasuredCurve back(const std::string& file, measured::DataLayout layout) {
    return measured::read_measured((folder_ / "out" / file).string(), layout);
  }

  TemporaryFolder folder_;
};

TEST_F(ExportVerb, afm_tab_by_the_rules_of_afmformats) {
  const Ended ended = run("press", "afm-tab");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(names_in(folder_ / "out"), (std::set<std::string>{"8_kPa_v=2.tab", "soft.tab"}));
  const AfmTab tab = load_tab(read_file(folder_ / "out" / "soft.tab"));
  EXPECT_TRUE(tab.detected);
  EXPECT_NE(tab.json.find("\"imaging mode\": \"force-distance\""), std::string::npos) << tab.json;
  EXPECT_NE(tab.json.find("\"point count\": 41"), std::string::npos) << tab.json;
  Numbers depth = expected("indentation_mm", "soft");
  ASSERT_EQ(depth.size(), 41U);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    EXPECT_EQ(tab.data.at("tip position")[i], 0.0 - depth[i]);  // falls as the tip goes in
    EXPECT_EQ(tab.segment[i], i > 25) << i;
  }
  EXPECT_EQ(tab.data.at("time"), expected("time_s", "soft"));
  const measured::MeasuredCurve curve = back("soft.tab", {});
  // Without a choice the approach is read.
  const Numbers& force = tab.data.at("force");
  EXPECT_EQ(curve.x, Numbers(depth.begin(), depth.begin() + 26));
  EXPECT_EQ(curve.y, Numbers(force.begin(), force.begin() + 26));
  EXPECT_EQ(back("soft.tab", {.segment = "approach"}).x.size(), 26U);
  EXPECT_EQ(back("soft.tab", {.segment = "retract"}).x.size(), 15U);
}

TEST_F(ExportVerb, chiaro_by_the_rules_of_afmformats) {
  ASSERT_EQ(run("press", "chiaro", {"--case", "soft"}).code, 0);
  const Chiaro loaded = load_chiaro(read_file(folder_ / "out" / "soft.txt"));
  EXPECT_TRUE(loaded.device);
  for (const char* key : {"Max load (\xB5N)", "k (N/m)", "Piezo position (nm) (Measured)",
                          "Piezo speed  (\xB5m/s)", "Device:", "Software version", "Date", "Time"})
    EXPECT_EQ(loaded.notes.count(key), 1U) << key;
  EXPECT_NEAR(std::stod(loaded.notes.at("Piezo speed  (\xB5m/s)")), 1e3 / 15.0 / 0.007,
              1e-9);  // rounding
  ASSERT_EQ(loaded.columns.size(), 5U);
  ASSERT_EQ(loaded.rows.size(), 41U);
  const measured::MeasuredCurve curve = back("soft.txt", {});
  const Numbers depth = expected("indentation_mm", "soft");
  const Numbers force =
      measured::read_measured((result() / "force_indentation.csv").string(),
                              {.x = "time_s", .y = "force_N", .case_name = "soft"})
          .y;
  ASSERT_EQ(curve.x.size(), depth.size());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    // nm and uN have no digits for some doubles of m and N, and then for their neighbours.
    const auto apart = [](double a, double b) {
      return std::abs(std::bit_cast<std::int64_t>(a) - std::bit_cast<std::int64_t>(b));
    };
    EXPECT_LE(apart(curve.x[i], depth[i]), 1);
    EXPECT_LE(apart(curve.y[i], force[i]), 1);
    EXPECT_DOUBLE_EQ(loaded.rows[i][1] * 1e-6, force[i]);  // as fmt_chiaro_txt turns it
    EXPECT_DOUBLE_EQ(loaded.rows[i][2] * 1e-9, depth[i]);
  }
  EXPECT_EQ(curve.y_axis.unit, "uN");
}

TEST_F(ExportVerb, the_finger_s_radius_comes_from_the_scenario) {
  fs::copy_file(project_file("scenarios/quickstart.toml"), folder_ / "uniform" / "scenario.toml");
  ASSERT_EQ(run("press", "chiaro").code, 0);  // one case in the scenario: of all curves
  EXPECT_EQ(load_chiaro(read_file(folder_ / "out" / "soft.txt")).notes.at("Tip radius (um)"),
            "11000");
}

TEST_F(ExportVerb, rheos_has_no_header) {
  ASSERT_EQ(run("uniform", "rheos").code, 0);
  const std::string text = read_file(folder_ / "out" / "relax.csv");
  EXPECT_TRUE(text.starts_with("8000,0.03333333333333333,0\n")) << text;
  const measured::DataLayout first{.x = "time_s", .y = "stress_kPa"};
  const measured::MeasuredCurve was =
      measured::read_measured((folder_ / "uniform" / "strain_time.csv").string(), first);
  const measured::MeasuredCurve now =
      back("relax.csv", {.x = "3", .y = "1", .x_unit = "s", .y_unit = "Pa"});
  EXPECT_EQ(now.x, was.x);
  EXPECT_EQ(now.y, was.y);
}

TEST_F(ExportVerb, febio_log_and_csv_si_come_back_bit_by_bit) {
  for (const char* format : {"febio-log", "csv-si"}) {
    ASSERT_EQ(run("press", format, {"--force"}).code, 0);
    const std::string file = std::string(format) == "csv-si" ? "soft.csv" : "soft.txt";
    const measured::MeasuredCurve now = back(file, {.x = "indentation_m", .y = "force_N"});
    EXPECT_EQ(now.x, expected("indentation_mm", "soft")) << format;
    EXPECT_EQ(back(file, {.x = "time", .y = "travel"}).x, expected("time_s", "soft")) << format;
  }
  const std::string log = read_file(folder_ / "out" / "soft.txt");
  EXPECT_TRUE(
      log.starts_with("*Step  = 0\n*Time  = 0\n*Data  = travel_m;indentation_m;force_N\n1,"))
      << log.substr(0, 200);
  ASSERT_EQ(run("own.csv", "csv-si").code, 0);
  EXPECT_EQ(read_file(folder_ / "out" / "own.csv"), "time_s,Load_N\n0,0.001\n1,0.0025\n");
}

TEST_F(ExportVerb, refusals_leave_nothing_behind) {
  const auto refusal = [&](const std::string& result, const std::string& format,
                           const std::vector<std::string>& more = {}) {
    const Ended ended = run(result, format, more);
    EXPECT_EQ(ended.code, 2) << ended.err;
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    return ended.err;
  };
  EXPECT_EQ(refusal("press", "afmtab"),
            "palpate: `--to` does not know `afmtab`; did you mean `afm-tab`?\n");
  EXPECT_EQ(refusal("press", "zzzzzzzzzz"),
            "palpate: `--to` does not know `zzzzzzzzzz`; it is one of afm-tab, rheos, chiaro, "
            "febio-log, csv-si\n");
  EXPECT_EQ(refusal("uniform", "afm-tab"),
            "uniform/strain_time.csv: `afm-tab` needs indentation and force, and the curve `relax` "
            "has no `indentation`, only step, time, stress, strain; choose another format, such as "
            "`--to csv-si`\n");
  EXPECT_EQ(refusal("press", "rheos"),
            "press/force_indentation.csv: `rheos` needs stress, strain and time, and the curve "
            "`soft` has no `stress`, only step, time, travel, indentation, force; choose another "
            "format, such as `--to csv-si`\n");
  EXPECT_EQ(refusal("press", "csv-si", {"--case", "sofd"}),
            "press/force_indentation.csv: has no case `sofd`; did you mean `soft`?\n");
  EXPECT_EQ(refusal("nowhere", "csv-si"),
            "nowhere: cannot be read: No such file or directory; check the path\n");
  fs::create_directories(folder_ / "empty");
  EXPECT_EQ(refusal("empty", "csv-si"),
            "empty: holds neither force_indentation.csv nor strain_time.csv; give the folder of a "
            "result, or a CSV file\n");
}

TEST_F(ExportVerb, nothing_is_replaced_unasked) {
  ASSERT_EQ(run("press", "afm-tab").code, 0);
  EXPECT_EQ(run("press", "afm-tab").code, 0) << "the same content";
  write_file(folder_ / "out/soft.tab", "mine");
  const Ended again = run("press", "afm-tab");
  EXPECT_EQ(again.code, 2);
  EXPECT_EQ(again.err,
            "out/soft.tab: is there already and says something else; give `--force` to replace it, "
            "or another `--out`\n");
  EXPECT_EQ(run("press", "afm-tab", {"--force"}).code, 0);
  // The source itself stays, whatever is asked for.
  const Ended self = palpate(folder_.path(), {"convert", "own.csv", "--to", "csv-si", "--force"});
  EXPECT_EQ(self.code, 2);
  EXPECT_EQ(read_file(folder_ / "own.csv"), "time_s,Load_mN\n0,1\n1,2.5\n");
  write_file(folder_ / "twice.csv", "case,time_s\na b,1\na/b,2\n");
  EXPECT_EQ(run("twice.csv", "csv-si").code, 2);
}

}  // namespace
}  // namespace palpate::test
