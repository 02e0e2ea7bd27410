// The formats of instruments and of other tools, as their own readers define them.
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/text.h"
#include "measured/measured.h"
#include "refusal.h"

namespace palpate::measured {
namespace {

using Numbers = std::vector<double>;

std::string format_refusal(std::string_view text, const DataLayout& layout = {}) {
  return test::refusal([&] { return parse_measured(text, "curve", layout); });
}

// As afmformats writes: CR LF, a JSON block in comments, the last comment names the columns.
const std::string tab =
    "# afmformats 0.18.0\r\n#\r\n# BEGIN METADATA\r\n# {\r\n#   \"enum\": 0,\r\n"
    "#   \"imaging mode\": \"force-distance\"\r\n# }\r\n# END METADATA\r\n#\r\n"
    "# force\theight (measured)\tindex\tsegment\ttime\ttip position\r\n"
    "0\t2e-06\t0\tFalse\t0\t1e-06\r\n"
    "2.5e-09\t1e-06\t1\tFalse\t0.5\t5e-07\r\n"
    "1e-09\t2e-06\t2\tTrue\t1\t7.5e-07\r\n";

TEST(MeasuredFormats, AfmTab) {
  MeasuredCurve curve = parse_measured(tab, "curve.tab", {.segment = "approach"});
  EXPECT_EQ(curve.x, (Numbers{-1e-6, -5e-7}));  // downwards positive
  EXPECT_EQ(curve.y, (Numbers{0, 2.5e-9}));
  EXPECT_EQ(curve.x_axis.column, "tip position");
  EXPECT_EQ(curve.x_axis.unit, "m");
  EXPECT_EQ(curve.notes,
            std::vector<std::string>{"`tip position` falls as the tip goes in; taken as a depth"});
  curve = parse_measured(tab, "curve.tab", {.x = "time", .y = "force", .segment = "retract"});
  EXPECT_EQ(curve.x, Numbers{1});
  EXPECT_EQ(curve.x_axis.unit, "s");
  EXPECT_EQ(parse_measured(tab, "curve.tab", {.x = "height (measured)"}).x,
            (Numbers{-2e-6, -1e-6}));  // the approach
  EXPECT_EQ(format_refusal(tab, {.segment = "pause"}),
            "curve:10: the column `segment` contains no `pause`; its values are False, True");
}

// Segments as numbers, as afmformats writes those it has as small integers.
TEST(MeasuredFormats, AfmTabSegmentsAsNumbers) {
  const std::string text =
      "# BEGIN METADATA\n# {}\n# END METADATA\n# force\tsegment\ttip position\n"
      "1\t0\t0\n2\t1\t-1\n3\t2\t-2\n";
  EXPECT_EQ(parse_measured(text, "t.tab", {.segment = "approach"}).y, Numbers{1});
  EXPECT_EQ(parse_measured(text, "t.tab", {.segment = "retract"}).y, Numbers{2});
  EXPECT_EQ(parse_measured(text, "t.tab", {.segment = "2"}).x, Numbers{2});
}

TEST(MeasuredFormats, Chiaro) {
  const std::string text =
      "Date\t2020-01-31\tTime\t12:00:00\tStatus\tok\r\nDevice:\tChiaro\r\n"
      "Tip radius (um)\t24.5\r\nk (N/m)\t0.48\r\n\r\nMax load (\xB5N)\t1.5\r\n"
      "Profile:\r\nD[Z1] (nm)\t10000\tt[1] (s)\t2\r\n\r\n"
      "Time (s)\tLoad (uN)\tIndentation (nm)\tCantilever (nm)\tPiezo (nm)\tAuxiliary\r\n"
      "0.000\t0.000\t0.000\t0.0\t0.0\t0\r\n0.001\t0.250\t500.000\t1.0\t500.0\t0\r\n"
      "0.002\t0.125\t250.000\t1.0\t250.0\t0\r\n";
  MeasuredCurve curve = parse_measured(text, "I_001.txt", {.segment = "approach"});
  EXPECT_EQ(curve.x, (Numbers{0, 500e-9}));
  EXPECT_EQ(curve.y, (Numbers{0, 0.25e-6}));
  EXPECT_EQ(curve.notes,
            std::vector<std::string>{"the approach ends at the largest load, on line 12"});
  curve = parse_measured(text, "I_001.txt", {.segment = "retract"});
  EXPECT_EQ(curve.lines, std::vector<int>{13});
}

TEST(MeasuredFormats, ApproachOfACellWithAnOffset) {
  const std::string text = "x_mm,F_N\n0,10\n1,9\n2,6\n1,8.5\n";
  EXPECT_EQ(parse_measured(text, "c.csv", {.segment = "approach"}).y, (Numbers{10, 9, 6}));
}

TEST(MeasuredFormats, CellScale) {
  const std::string text =
      "SetName,Cycle,Time_S,Size_mm,Displacement_mm,Force_mN\n"
      "1-Compress,1-Load,0,5,0,0\n1-Compress,1-Load,0.2,4.5,0.5,3.5\n";
  const MeasuredCurve curve = parse_measured(text, "c.csv", {.x = "Displacement", .y = "force"});
  EXPECT_EQ(curve.x, (Numbers{0, 5e-4}));
  EXPECT_EQ(curve.y, (Numbers{0, 3.5e-3}));
  EXPECT_EQ(parse_measured(text, "c.csv", {.x = "Time_S", .y = "force"}).x_axis.unit, "s");
}

TEST(MeasuredFormats, Rheos) {
  const MeasuredCurve curve =
      parse_measured("1.5,0.125,0.0\nNaN,0.125,0.1\n1.25,0.125,0.2\n", "relax.csv",
                     {.x = "3", .y = "1", .x_unit = "s", .y_unit = "kPa"});
  EXPECT_EQ(curve.x, (Numbers{0, 0.2}));
  EXPECT_EQ(curve.y, (Numbers{1500, 1250}));
  EXPECT_EQ(curve.excluded, 1);
}

// A table of results above the curve, names and units in two rows, all fields quoted.
TEST(MeasuredFormats, Bluehill) {
  const std::string text =
      "\"Specimen label\",\"phantom 3\"\n\n\"Results Table 1\"\n"
      "\"\",\"Maximum load\",\"Modulus\"\n\"\",\"(N)\",\"(MPa)\"\n\"1\",\"12.5\",\"0.02\"\n\n"
      "\"Time\",\"Compressive extension\",\"Compressive load\",\"Temperature\"\n"
      "\"(s)\",\"(mm)\",\"(N)\",\"(degC)\"\n"
      "\"0.0\",\"0.0\",\"0.0\",\"21\"\n\"0.1\",\"0.5\",\"3.5\",\"21\"\n\"0.2\",\"1.0\",\"9.0\","
      "\"21\"\n";
  const MeasuredCurve curve = parse_measured(text, "c.csv", {});
  EXPECT_EQ(curve.x, (Numbers{0, 5e-4, 1e-3}));
  EXPECT_EQ(curve.y, (Numbers{0, 3.5, 9}));
  EXPECT_EQ(curve.x_axis.column, "Compressive extension");
}

// Two intervals with the same columns, in UTF-16 and with empty first fields.
TEST(MeasuredFormats, AntonPaar) {
  const std::string head =
      "Interval data:\tPoint No.\tTime\tShear Strain\tShear Stress\tTorque\r\n"
      "\t\t[s]\t[%]\t[Pa]\t[mN*m]\r\n";
  const std::string text =
      "Project:\tgel\r\nResult:\tGel 1\r\n\r\nInterval and data points:\t1\t3\r\n" + head +
      "\t1\t0.5\t1\t200\t0.1\r\n\t2\t1\t1\t150\t0.1\r\n\t3\t2\t1\t100\t0.1\r\n\r\n" +
      "Interval and data points:\t2\t2\r\n" + head +
      "\t1\t3\t2\t300\t0.1\r\n\t2\t4\t2\t250\t0.1\r\n";
  std::string wide = "\xFF\xFE";
  for (const char c : text) {
    wide += c;
    wide += '\0';
  }
  const DataLayout layout{.x = "Time", .y = "Shear Stress", .segment = "1"};
  EXPECT_EQ(parse_measured(wide, "c.csv", layout).y, (Numbers{200, 150, 100}));
  const DataLayout second{.x = "Time", .y = "Shear Strain", .segment = "2"};
  const MeasuredCurve curve = parse_measured(wide, "c.csv", second);
  EXPECT_EQ(curve.x, (Numbers{3, 4}));
  EXPECT_EQ(curve.y, (Numbers{0.02, 0.02}));
  EXPECT_EQ(format_refusal(wide, {.x = "Time", .y = "Shear Stress"}),
            "curve: contains 2 tables with the same columns; choose one, as `--segment 1`, or take "
            "the rows of all by `--segment all`");
}

// Comments with names and units above each segment; the tip is above the base by force / k.
TEST(MeasuredFormats, JpkText) {
  const std::string head = "# columns: height vDeflection seriesTime\n# units: m N s\n";
  const std::string text = "# springConstant: 0.05\n# segment: extend\n" + head +
                           "3e-06 0 0\n2e-06 1e-09 0.1\n\n# segment: retract\n" + head +
                           "3e-06 0 0.2\n";
  MeasuredCurve curve = parse_measured(text, "c.txt", {.segment = "approach"});
  EXPECT_EQ(curve.x_axis.column, "tip position");
  EXPECT_EQ(curve.x, (Numbers{-3e-6, -(2e-6 + 1e-9 / 0.05)}));
  EXPECT_EQ(curve.y, (Numbers{0, 1e-9}));
  curve = parse_measured(text, "c.txt", {.x = "height", .y = "vDeflection", .segment = "retract"});
  EXPECT_EQ(curve.x, Numbers{-3e-6});
}

TEST(MeasuredFormats, FebioLogData) {
  const std::string one =
      "*Step  = 0\n*Time  = 0\n*Data  = z;Fz\n1,0,0\n"
      "*Step  = 1\n*Time  = 0.5\n*Data  = z;Fz\n1,-0.25,3\n";
  const MeasuredCurve curve = parse_measured(
      one, "log.txt", {.x = "z", .y = "Fz", .x_unit = "mm", .y_unit = "N", .compression = "auto"});
  EXPECT_EQ(curve.x, (Numbers{0, 0.25e-3}));  // z falls as the force grows
  EXPECT_EQ(curve.y, (Numbers{0, 3}));
  EXPECT_EQ(curve.lines, (std::vector<int>{4, 8}));
  EXPECT_EQ(parse_measured(one, "log.txt", {.x = "time", .y = "Fz"}).x, (Numbers{0, 0.5}));
  const std::string two = "*Step  = 1\n*Time  = 1\n*Data  = z;Fz\n1 7 8\n2 9 10\n";
  EXPECT_EQ(parse_measured(two, "log.txt", {.x = "z", .y = "Fz", .case_name = "2"}).y, Numbers{10});
  EXPECT_EQ(format_refusal(two, {.x = "z", .y = "Fz"}),
            "curve:3: contains several items per time; choose one by `--case`, as `--case 1`");
  EXPECT_EQ(
      format_refusal("*Step  = 1\n*Time  = 1\n*Data  = z;Fz\n1,7\n"),
      "curve:4: this row has 2 values with its item, `*Data` names 2 and the item; give every "
      "row one value per name");
}

// A text export of TA TRIOS: sections in brackets, names, and a row of units below them.
TEST(MeasuredFormats, TriosSteps) {
  const std::string text =
      "Filename\tgel.tri\nInstrument name\tDHR-2\n\n[step]\nStress Relaxation - 1\n"
      "Time\tStress\tStrain\tTemperature\tModulus G(t)\ns\tMPa\t%\t\u00b0C\tMPa\n"
      "0.1\t0.002\t5\t25.01\t0.04\n0.2\t0.0015\t5\t25.02\t0.03\n"
      "0.4\t0.0012\t5\t25.0\t0.024\n";
  const MeasuredCurve curve =
      parse_measured(text, "gel.txt", {.curve = DataLayout::Curve::relaxation});
  EXPECT_EQ(curve.x, (Numbers{0.1, 0.2, 0.4}));
  EXPECT_EQ(curve.y_axis.column, "Stress");  // of two pressures
  EXPECT_NEAR(curve.y[0], 2000.0, 1e-9);     // rounding
  EXPECT_EQ(curve.x_axis.unit, "s");
}

// The export of TRIOS for laboratory systems (LIMS), version 0: every row begins with its kind, and
// has readings that are words; each step is a table.
TEST(MeasuredFormats, TriosLimsSteps) {
  const auto step = [](const std::string& name, double begin, double stress) {
    std::string text =
        "[Step]\nStep name\t" + name +
        "\nNumber of points\t12\n"
        "Variables\tRun time\tTemperature\tStress\tStrain\tStep time\tTime\tStatus bits\t"
        "Torque transducer\tDate and time\n"
        "Units\ts\t\u00b0C\tPa\t%\ts\ts\t\t\t\n";
    for (int i = 1; i <= 12; ++i)
      text += "Data point\t" + number_text(begin + i) + "\t37.01\t" + number_text(stress / i) +
              "\t5\t" + number_text(i) + "\t" + number_text(i) +
              "\t0xB6453\tFRT\t6/26/2023 1:43:31 PM\n";
    return text;
  };
  const std::string head =
      "[Version]\nTA Instruments LIMS export format version\t0\n[Header]\n"
      "Instrument serial number\t4010-0862\n[Sample]\nName\tgel\n[Geometry: Standard]\n"
      "Diameter\t25.0 mm\nGap\t1.000 mm\n[Procedure: Steps]\n"
      "Step 1\tStep (Transient)-Stress Relaxation : Temperature 37 \u00b0C Soak Time 180.0 s\n"
      "[Parameters: File Parameters]\nTrios version\t5.1.1.46572\n";
  const std::string first = step("Stress relaxation (37.0 \u00b0C)", 552.0, 200.0);
  const std::string second = step("Stress relaxation (25.0 \u00b0C)", 752.0, 400.0);
  const DataLayout relaxes{.curve = DataLayout::Curve::relaxation};
  const MeasuredCurve curve = parse_measured(head + first, "gel.txt", relaxes);
  EXPECT_EQ(curve.x_axis.column, "Step time");
  EXPECT_EQ(curve.y_axis.column, "Stress");
  ASSERT_EQ(curve.x.size(), 12U);
  EXPECT_EQ(curve.x[11], 12.0);
  EXPECT_EQ(curve.y[1], 100.0);
  DataLayout chosen = relaxes;
  chosen.segment = "2";
  EXPECT_EQ(parse_measured(head + first + second, "gel.txt", chosen).y[1], 200.0);
  EXPECT_NE(format_refusal(head + first + second, relaxes).find("--segment 1"), std::string::npos);
}

// A row of units with more cells than the names above it: the columns are those of the units.
TEST(MeasuredFormats, ARowOfUnitsMayBeWiderThanThatOfNames) {
  const MeasuredCurve curve = parse_measured("Time\tForce\ns\tN\tmm\n1\t2\t3\n2\t3\t4\n3\t4\t5\n",
                                             "t.txt", {.x = "1", .y = "3"});
  EXPECT_EQ(curve.x_axis.unit, "s");
  EXPECT_EQ(curve.y_axis.unit, "mm");
  EXPECT_EQ(curve.y.size(), 3U);
}

// LabVIEW's .lvm: units in the heading of each table, a column of comments that are not there.
TEST(MeasuredFormats, LabViewMeasurement) {
  const std::string first =
      "LabVIEW Measurement\t\r\nWriter_Version\t2\r\nSeparator\tTab\r\nX_Columns\tOne\r\n"
      "Date\t2023/05/04\r\nTime\t10:11:12.5\r\n***End_of_Header***\t\r\n\t\r\n";
  const std::string heading =
      "Channels\t2\t\t\r\nSamples\t3\t3\t\r\nY_Unit_Label\tmm\tmN\t\r\n"
      "X_Dimension\tTime\tTime\t\r\nX0\t0.0E+0\t0.0E+0\t\r\nDelta_X\t0.1\t0.1\t\r\n"
      "***End_of_Header***\t\t\t\r\nX_Value\tTravel\tForce\tComment\r\n";
  const std::string rows = "0.0\t0.1\t1\r\n0.1\t0.2\t2\r\n0.2\t0.3\t4\r\n";
  MeasuredCurve curve = parse_measured(first + heading + rows, "a.lvm", {});
  EXPECT_EQ(curve.x_axis.column, "Travel");
  EXPECT_EQ(curve.y, (Numbers{1e-3, 2e-3, 4e-3}));
  EXPECT_NEAR(curve.x[2], 3e-4, 1e-18);
  curve = parse_measured(first + heading + rows, "a.lvm", {.x = "X_Value", .y = "Force"});
  EXPECT_EQ(curve.x_axis.unit, "s");
  // Each table of several has its heading.
  curve = parse_measured(first + heading + rows + "\r\n" + heading + rows, "a.lvm",
                         {.x = "Travel", .y = "Force", .segment = "2"});
  EXPECT_EQ(curve.y, (Numbers{1e-3, 2e-3, 4e-3}));
  EXPECT_EQ(curve.x_axis.unit, "mm");
}

// A text export of Anton Paar's Bioindenter: lines about the test, `Measured values`, and a table
// of time, penetration depth, normal force, that of the reference sensor, and the segment.
TEST(MeasuredFormats, BioindenterDepthAndForce) {
  const std::string head =
      "Anton Paar Indentation\r\nSample:\tcartilage 3\r\nDate:\t12/03/2024 10:11:12\r\n"
      "Indenter radius:\t500.00 [\u00b5m]\r\nApproach speed:\t20.00 [\u00b5m/min]\r\n\r\n"
      "Measured values\r\n";
  const std::string rows =
      "0.000\t0.0000\t-0.002\t0.001\t1\r\n0.100\t0.2000\t0.400\t0.001\t1\r\n"
      "0.200\t0.4000\t1.200\t0.001\t1\r\n0.300\t0.1000\t0.300\t0.001\t3\r\n";
  std::string comma = rows;
  std::replace(comma.begin(), comma.end(), '.', ',');
  const std::string names = "Time [s]\tPd [\u00b5m]\tFn [mN]\tFnref [mN]\tSegment\r\n";
  const std::string above = "Time\tPd\tFn\tFnref\tSegment\r\n[s]\t[\u00b5m]\t[mN]\t[mN]\t[-]\r\n";
  for (const std::string& text : {head + names + rows, head + names + comma, head + above + rows}) {
    const MeasuredCurve curve = parse_measured(text, "cartilage.TXT", {.segment = "1"});
    EXPECT_EQ(curve.x_axis.column.substr(0, 2) + " " + curve.y_axis.column.substr(0, 2), "Pd Fn");
    ASSERT_EQ(curve.x.size(), 3U);
    EXPECT_NEAR(curve.x[2], 4e-7, 1e-18);  // rounding
    EXPECT_NEAR(curve.y[2], 1.2e-3, 1e-15);
  }
  // Without units in its names the file does not say what its numbers are.
  EXPECT_EQ(format_refusal(head + "time\tdispl\tload\tref_load\tsegm\r\n" + rows),
            "curve:8: has 5 columns, and it is not clear which is x; set `--x` to one of time, "
            "displ, load, ref_load, segm");
}

// A column without a number is none of the two, and neither is one of words.
TEST(MeasuredFormats, AnEmptyFirstColumnIsNoCurve) {
  const std::string rows = "\t1\t5\n\t2\t4\n\t3\t3.5\n\t4\t3\n";
  for (const char* head : {"Interval data:\tTime\tShear Stress\n\t[s]\t[Pa]\n", "\tt\ty\n", ""}) {
    const MeasuredCurve curve = parse_measured(head + rows, "r.csv", {});
    EXPECT_EQ(curve.x, (Numbers{1, 2, 3, 4})) << head;
    EXPECT_EQ(curve.y, (Numbers{5, 4, 3.5, 3})) << head;
  }
}

// depth = travel - force / k; a deflection in the column of y is force / k itself.
TEST(MeasuredFormats, TheBendingIsTakenOff) {
  const std::string force = "travel (um),force (nN)\n0,0\n1,10\n2,30\n";
  MeasuredCurve curve = parse_measured(force, "c.csv", {.spring_constant = "0.1 N/m"});
  EXPECT_NEAR(curve.x[1], 0.9e-6, 1e-18);
  EXPECT_NEAR(curve.x[2], 1.7e-6, 1e-18);
  EXPECT_NEAR(parse_measured(force, "c.csv", {.compliance = "10 um/uN"}).x[2], 1.7e-6, 1e-18);
  const std::string bent = "travel (um),deflection (nm)\n0,0\n1,100\n2,300\n";
  curve = parse_measured(bent, "c.csv", {.spring_constant = "0.1 N/m"});
  EXPECT_NEAR(curve.x[2], 1.7e-6, 1e-18);
  EXPECT_NEAR(curve.y[2], 30e-9, 1e-20);
  EXPECT_EQ(format_refusal(force, {.spring_constant = "0.1 N"}),
            "palpate: `--spring-constant 0.1 N` is no stiffness; write it as `0.1 N/m`");
}

TEST(MeasuredFormats, ADriftIsTakenOff) {
  std::string text = "time (s),travel (mm),force (N)\n";
  const auto travel = [](int i) { return i <= 50 ? 0.1 * i : 0.1 * (100 - i); };
  for (int i = 0; i <= 100; ++i)
    text += std::to_string(i) + "," + std::to_string(travel(i)) + "," +
            std::to_string(std::max(travel(i) - 2.0, 0.0) + 0.01 * i) + "\n";
  const MeasuredCurve curve =
      parse_measured(text, "c.csv", {.x = "travel", .y = "force", .drift = "time"});
  for (int i = 0; i <= 100; ++i)  // the mean time of the first 6 rows is 2.5 s
    EXPECT_NEAR(curve.y[static_cast<std::size_t>(i)], std::max(travel(i) - 2.0, 0.0) + 0.01 * 2.5,
                1e-6);
  const std::string half = text.substr(0, text.find("\n70,") + 1);
  EXPECT_NE(format_refusal(half, {.x = "travel", .y = "force", .drift = "time"})
                .find("does not begin and end at the same place"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::measured
