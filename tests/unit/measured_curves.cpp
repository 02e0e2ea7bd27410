// Measured files as machines, spreadsheets and people leave them, and what is refused of them.
#include "measured/columns.h"
#include "measured/measured.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "record/csv.h"
#include "refusal.h"

namespace palpate::measured {
namespace {

using Numbers = std::vector<double>;

constexpr Dimension length{1, 0, 0};
constexpr Dimension force{1, 1, -2};

MeasuredCurve read(std::string_view text, const DataLayout& layout = {}) {
  return parse_measured(text, "data.csv", layout);
}

std::string refusal(std::string_view text, const DataLayout& layout = {}) {
  return test::refusal([&] { return read(text, layout); });
}

// 1.5 mm and 2 mm, 3 N and 4.25 N: the same curve in every dress.
void expect_curve(const MeasuredCurve& curve) {
  EXPECT_EQ(curve.x, (Numbers{1.5e-3, 2e-3}));
  EXPECT_EQ(curve.y, (Numbers{3.0, 4.25}));
  EXPECT_EQ(curve.x_axis.dimension, length);
  EXPECT_EQ(curve.y_axis.dimension, force);
}

TEST(Measured, SeparatorsAndDecimals) {
  const DataLayout layout{.x = "depth_mm", .y = "force_N"};
  expect_curve(read("depth_mm,force_N\n1.5,3\n2,4.25\n", layout));
  expect_curve(read("depth_mm;force_N\n1.5;3\n2;4.25\n", layout));
  expect_curve(read("depth_mm;force_N\n1,5;3\n2,0;4,25\n", layout));
  expect_curve(read("depth_mm\tforce_N\n1,5\t3\n2,0\t4,25\n", layout));
  expect_curve(read("depth_mm force_N\n  1.5   3\n  2.0   4.25\n", layout));
  expect_curve(read("depth_mm  force_N\n1,5  3,0\n2,0  4,25\n", layout));
  expect_curve(read("depth_mm, force_N\n1.5, 3.0\n2.0, 4.25\n", layout));
  expect_curve(read("\"depth_mm\",\"force_N\"\n\"1.5\",\"3\"\n\"2\",\"4.25\"\n", layout));
  expect_curve(read("\"depth_mm\",\"force_N\"\n\"1,5\",\"3,0\"\n\"2,0\",\"4,25\"\n", layout));
  expect_curve(read("depth_mm;force_N\n1,5;3\n2,0;4,25\n",
                    {.x = "1", .y = "2", .separator = ";", .decimal = ","}));
}

TEST(Measured, LineEndsAndEncodings) {
  const DataLayout layout{.x = "depth_mm", .y = "force_N"};
  expect_curve(
      read("\xEF\xBB\xBF"
           "depth_mm,force_N\r\n1.5,3\r\n2,4.25\r\n",
           layout));
  expect_curve(read("depth_mm,force_N\r1.5,3\r2,4.25", layout));
  expect_curve(read("depth_mm,force_N,\n1.5,3,\n2,4.25,\n", layout));
  expect_curve(read("\ndepth_mm,force_N\n\n1.5,3\n2,4.25\n\n \n", layout));
  const std::string ascii = "depth_mm\tforce_N\r\n1.5\t3\r\n2\t4.25\r\n";
  std::string little = "\xFF\xFE";
  std::string big = "\xFE\xFF";
  for (const char c : ascii) {
    little += c;
    little += '\0';
    big += '\0';
    big += c;
  }
  expect_curve(read(little, layout));
  expect_curve(read(big, layout));
  expect_curve(read(little.substr(2), layout));  // without a byte order mark
  expect_curve(read(big.substr(2), layout));
  EXPECT_EQ(refusal(std::string("a,b\n1,2\n3,\0\n", 12)),
            "data.csv:3:3: is no text: a NUL byte stands here; export the table as CSV in UTF-8");
  // The micro sign in ISO 8859-1, in UTF-8, and the Greek letter in UTF-8.
  for (const char* unit : {"\xB5"
                           "m",
                           "\xC2\xB5"
                           "m",
                           "\xCE\xBC"
                           "m",
                           "um", "micron"}) {
    const MeasuredCurve curve =
        read("Depth (" + std::string(unit) + "),Load (mN)\n1500,3000\n2000,4250\n",
             {.x = "Depth", .y = "load"});
    expect_curve(curve);
    EXPECT_EQ(curve.x_axis.unit, "um");
    EXPECT_EQ(curve.x_written, (Numbers{1500, 2000}));
  }
}

TEST(Measured, UnitsInNamesRowsAndOptions) {
  for (const char* heads : {"Displacement (mm),Load [N]", "Displacement_mm,Load_N",
                            "Weg in mm,Kraft in N", "Weg / mm,Kraft / N", "mm,N"})
    expect_curve(read(std::string(heads) + "\n1.5,3\n2,4.25\n"));
  expect_curve(read("Zeit,Weg,Kraft\n(s),(mm),(N)\n0,1.5,3\n1,2,4.25\n"));
  expect_curve(read("x,y\n1.5,3\n2,4.25\n", {.x_unit = "mm", .y_unit = "N"}));
  expect_curve(read("Weg_m,y\n1.5,3\n2,4.25\n", {.x_unit = "mm", .y_unit = "N"}));
  const MeasuredCurve scales =
      read("Time (sec),Strain (%)\n1,50\n2,25\n", {.x = "time", .y = "strain"});
  EXPECT_EQ(scales.y, (Numbers{0.5, 0.25}));
  EXPECT_EQ(scales.x_axis.unit, "s");
  EXPECT_TRUE(scales.y_axis.has_unit);
  EXPECT_FALSE(read("a,b\n1,2\n").x_axis.has_unit);
  // 1 lbf is 0.45359237 kg times 9.80665 m/s^2, and an inch 25.4 mm, both exactly.
  const MeasuredCurve imperial = read("Extension (in),Load (lbF)\n1,1\n2,2\n");
  EXPECT_DOUBLE_EQ(imperial.x[0], 0.0254);
  EXPECT_DOUBLE_EQ(imperial.y[0], 0.45359237 * 9.80665);
}

TEST(Measured, UnitsInOtherForms) {
  for (const char* heads :
       {"Depth {mm},Load {N}", "Depth <mm>,Load <N>", "Depth mm,Load N", "Depth: mm,Load: N",
        "Depth/mm,Load/N", "Depth (mm), Load (N)", "Depth, Load\n[mm], [N]"})
    expect_curve(read(std::string(heads) + "\n1.5,3\n2,4.25\n"));
  // A row of units with empty cells, with a hyphen and with a unit that is none of mechanics.
  const DataLayout layout{.x = "Depth", .y = "Load"};
  expect_curve(read("Depth,Load,Point,T,Note\nmm,N,-,degC,\n1.5,3,1,20,\n2,4.25,2,20,\n", layout));
  expect_curve(read("Point,T,Depth,Load\n,degC,mm,N\n1,20,1.5,3\n2,20,2,4.25\n", layout));
  const auto factor = [](const std::string& unit) {
    return read("x (mm),y (" + unit + ")\n1,1\n2,2\n").y[0];
  };
  EXPECT_DOUBLE_EQ(factor("pN"), 1e-12);
  EXPECT_DOUBLE_EQ(factor("psi"), 6894.757293168361);  // lbf / in^2
  EXPECT_DOUBLE_EQ(factor("mmHg"), 133.322387415);     // conventional
  EXPECT_DOUBLE_EQ(factor("lbf"), 4.4482216152605);
  EXPECT_DOUBLE_EQ(factor("Angstrom"), 1e-10);
  EXPECT_DOUBLE_EQ(factor("inch"), 0.0254);
  EXPECT_DOUBLE_EQ(read("x_nm,force_pN\n1,1\n2,2\n").y[0], 1e-12);
}

// The name and the unit of a column, in the ways in which makers join the two.
TEST(Measured, NamesAndUnitsAreParted) {
  for (const char* name : {"Depth (um)", "Depth [um]", "Depth {um}", "Depth <um>", "Depth_um",
                           "Depth / um", "Depth in um", "Depth, um", "Depth: um", "Depth um",
                           "Depth/um", "Depth (\u00b5m)", "Depth (\u03bcm)"}) {
    const NamedColumn column = named_column(name);
    EXPECT_EQ(column.bare, "Depth") << name;
    ASSERT_TRUE(column.unit.has_value()) << name;
    EXPECT_EQ(column.unit->text, "um") << name;
  }
  for (const char* name : {"1/s", "_mm", "Depth"}) {
    EXPECT_EQ(named_column(name).bare, name);
    EXPECT_FALSE(named_column(name).unit.has_value()) << name;
  }
  const Dimension rate{0, 0, -1};
  for (const char* unit : {"1/s", "s-1", "s^-1", "s\u207b\u00b9"}) {
    ASSERT_TRUE(written_unit(unit).has_value()) << unit;
    EXPECT_EQ(written_unit(unit)->factor.dimension, rate) << unit;
  }
  for (const char* unit : {"Pa.s", "Pa*s", "Pa\u00b7s", "Pa\u22c5s", "Pa s"}) {
    ASSERT_TRUE(written_unit(unit).has_value()) << unit;
    EXPECT_EQ(written_unit(unit)->factor.dimension, (Dimension{-1, 1, -1})) << unit;
  }
  EXPECT_DOUBLE_EQ(written_unit("mm\u00b2")->factor.to_si(1.0), 1e-6);
  EXPECT_EQ(written_unit("S")->factor.dimension, (Dimension{0, 0, 1}));
  EXPECT_EQ(unit_under("Shear rate", *written_unit("s")).factor.dimension, rate);
  // A mass under the name of a force is its weight.
  for (const char* name : {"Force", "Load", "Kraft", "Kracht", "Fuerza", "Firmness", "Hardness",
                           "F", "Fn", "Fz", "Peak load"})
    EXPECT_DOUBLE_EQ(unit_under(name, *written_unit("g")).factor.to_si(1.0), 9.80665e-3) << name;
  EXPECT_TRUE(is_mass(unit_under("Mass", *written_unit("g"))));
}

TEST(Measured, NumbersOfOtherPrograms) {
  // The minus of typesetters and the exponents of Fortran.
  expect_curve(read("depth_mm,force_N\n1.5,3.0\n2.0,4.25\n\u22121,NaN\n"));
  EXPECT_EQ(read("d_mm,F_N\n\u22121.5,2e\u22123\n2,4\n").x[0], -1.5e-3);
  EXPECT_EQ(read("d_mm,F_N\n\u22121.5,2e\u22123\n2,4\n").y[0], 2e-3);
  expect_curve(read("# depth_m force_N\n 0.15D-02 0.30d+01\n 0.20D-02 0.425D+01\n"));
  EXPECT_EQ(refusal("d_mm,F_N\n1,2D3\n2,4\n"),
            "data.csv:2:3: `F_N` holds `2D3`, which is no number; name a column of numbers");
  // Of two columns one holds no numbers.
  EXPECT_EQ(
      refusal("Time,Force (N)\n01:40.050,5\n01:40.150,4\n"),
      "data.csv:2:1: `Time` holds `01:40.050`, which is a time of day or minutes and seconds; "
      "write the column in seconds, or name a column of numbers");
}

TEST(Measured, PartsOfATable) {
  const std::string text =
      "Set,segment,d_mm,F_N\n1,load,1.5,3\n1,load,2,4.25\n1,unload,1,7\n1,load,9,9\n2,load,8,8\n";
  DataLayout layout{.x = "d_mm", .y = "F_N"};
  layout.rows = "1..2";
  expect_curve(read(text, layout));
  layout.rows = "";
  layout.segment = "load:1";
  expect_curve(read(text, layout));
  layout.segment = "load";
  EXPECT_EQ(refusal(text, layout),
            "data.csv:1: the column `segment` has 2 parts `load`, on lines 2 to 3, 5 to 6; choose "
            "one, as `--segment load:1`");
  layout.segment = "";
  layout.where = {"Set=1", "segment=unload"};
  EXPECT_EQ(read(text, layout).y, Numbers{7});
  layout.where = {"Set=3"};
  EXPECT_EQ(refusal(text, layout),
            "data.csv:1: the column `Set` contains no `3`; its values are 1, 2");
}

// Two columns of words divide nothing, nor does one that has the same part in every row.
TEST(Measured, OnlyOneColumnOfWordsDividesACurve) {
  EXPECT_EQ(read("a,b,d_mm,F_N\nload,approach,1,3\nload,retract,2,4\n").y, (Numbers{3, 4}));
  EXPECT_EQ(read("a,b,d_mm,F_N\nx,approach,1,3\nx,retract,2,4\n").y, Numbers{3});
  EXPECT_TRUE(read("b,d_mm,F_N\nextend,1,3\nextend,2,4\n").notes.empty());
}

TEST(Measured, AStretchBeginsNearOne) {
  EXPECT_TRUE(read("stretch,P_kPa\n1,0\n1.2,3\n").x_axis.stretch);
  EXPECT_FALSE(read("stretch,P_kPa\n0,0\n0.2,3\n").x_axis.stretch);
}

// 0.1 N/s on a press whose free ends last ten rows each; a row without a force is none of the line.
TEST(Measured, ADriftIsTheLineThroughTheFreeEnds) {
  std::string text = "t_s,d_mm,F_N\n";
  for (int i = 0; i < 60; ++i) {
    const int in = std::clamp(i < 30 ? i - 10 : 49 - i, 0, 19);
    text += std::to_string(i) + "," + std::to_string(in) + "," +
            (i == 15 ? "" : std::to_string(in * in + 0.1 * i)) + "\n";
  }
  DataLayout layout{.x = "d_mm", .y = "F_N"};
  layout.drift = "t_s";
  for (const char* segment : {"", "retract"}) {
    layout.segment = segment;
    const MeasuredCurve curve = read(text, layout);
    const double start = curve.y.back();
    for (std::size_t i = 0; i < curve.y.size(); ++i)
      EXPECT_NEAR(curve.y[i] - start, 1e6 * curve.x[i] * curve.x[i], 1e-9) << i;
  }
  layout.segment = "";
  layout.rows = "1..30";
  EXPECT_TRUE(
      refusal(text, layout).starts_with("data.csv: does not begin and end at the same place"));
}

TEST(Measured, ArchivesSayHowToUnpackThem) {
  EXPECT_EQ(refusal("\x1F\x8B\x08 etc."),
            "data.csv: is compressed by gzip; unpack it with `gunzip -k`");
  EXPECT_TRUE(refusal("PK\x03\x04 etc.").starts_with("data.csv: is a ZIP archive, as are .xlsx"));
}

TEST(Measured, TablesWithOtherColumnsAreLeftOutAloud) {
  const std::string text = "a,b\n1,2\n3,4\n\nd_mm,F_N\n1.5,3\n2,4.25\n3,5\n4,6\n5,7\nend\n";
  const DataLayout layout{.x = "d_mm", .y = "F_N"};
  EXPECT_EQ(read(text, layout).notes[1],
            "the table on lines 2 to 3 has other columns and is excluded; `--table 1` reads it");
  EXPECT_EQ(read(text, {.x = "a", .y = "b", .table = 1}).y, (Numbers{2, 4}));
}

TEST(Measured, BluehillBlocksAreSkipped) {
  const std::string text =
      "Specimen,liver 3\nRate : 0.5 mm/s\n\"Start of test\",\"10:00\"\n\n"
      "Time,Extension,Load\n(s),(mm),(N)\n"
      "\"0.0\",\"1.5\",\"3\"\n\"0.1\",\"2\",\"4.25\"\nEnd of test\n";
  const MeasuredCurve curve = read(text, {.x = "Extension", .y = "Load"});
  expect_curve(curve);
  EXPECT_EQ(curve.lines, (std::vector<int>{7, 8}));
  EXPECT_EQ(curve.notes, std::vector<std::string>{
                             "the lines from line 9 on contain no numbers and are excluded"});
  expect_curve(read(text, {.x = "Extension", .y = "Load", .skip = 4}));
}

TEST(Measured, HeaderInAComment) {
  expect_curve(read("# a press\n# depth_mm force_N\n1.5 3\n# seen\n2 4.25\n"));
  expect_curve(read("# Depth (mm)  Load (N)\n1.5  3\n2  4.25\n"));
}

TEST(Measured, NoHeaderAtAll) {
  const DataLayout layout{.x = "2", .y = "1", .x_unit = "mm", .y_unit = "N"};
  const MeasuredCurve curve = read("3,1.5,0\n4.25,2,1\n", layout);
  expect_curve(curve);
  EXPECT_EQ(curve.x_axis.column, "2");
  EXPECT_EQ(curve.lines, (std::vector<int>{1, 2}));
  EXPECT_EQ(refusal("3,1.5,0\n4,2,1\n", {.x = "load", .y = "1"}),
            "data.csv:1: the numbers begin here without names of columns above, so that there is "
            "no column `load`; give a column's number, as `--x 1`, or `--skip` the lines above the "
            "names");
  EXPECT_EQ(refusal("3,1.5,0\n4,2,1\n", {.x = "4", .y = "1"}),
            "data.csv: has 3 columns, and `--x 4` is not among them; columns count from 1");
}

TEST(Measured, WhatIsMissingIsLeftOutAndCounted) {
  const std::string text = "t,depth_mm,force_N\n,1.5,3\n1,NaN,7\n2,,8\n3,1,n/a\n4,2,4.25\n";
  const DataLayout layout{.x = "depth_mm", .y = "force_N"};
  const MeasuredCurve curve = read(text, layout);
  expect_curve(curve);
  EXPECT_EQ(curve.excluded, 3);
  EXPECT_EQ(curve.lines, (std::vector<int>{2, 6}));
  EXPECT_EQ(curve.notes,
            std::vector<std::string>{"3 rows are excluded: a number is missing or not finite"});
  DataLayout all = layout;
  all.blanks = DataLayout::Blanks::keep;
  const MeasuredCurve kept = read(text, all);
  ASSERT_EQ(kept.x.size(), 5U);
  EXPECT_TRUE(std::isnan(kept.x[1]));
  EXPECT_EQ(kept.excluded, 0);
}

TEST(Measured, WhatCanBeReadInTwoWaysIsRefused) {
  EXPECT_EQ(refusal("1,234\n2,345\n"),
            "data.csv:1:1: `1,234` could be two whole numbers or one with a decimal comma; give "
            "`--separator ,` for the first, and save the table with semicolons for the second");
  EXPECT_EQ(read("1,234\n2,345\n", {.separator = ","}).y, (Numbers{234, 345}));
  EXPECT_EQ(refusal("a;b\n1,234;5,678\n2,345;6,789\n"),
            "data.csv:2:1: `1,234` could be 1.234 or 1234, and no other number of the file decides "
            "this; give `--decimal ,`, or save the numbers with points and without marks between "
            "thousands");
  EXPECT_EQ(read("a;b\n1,234;5,678\n2,345;6,789\n", {.decimal = ","}).x, (Numbers{1.234, 2.345}));
  EXPECT_EQ(read("a;b\n0,234;5,678\n2,345;6,789\n").x, (Numbers{0.234, 2.345}));
  EXPECT_EQ(refusal("a,b\n0,5,1,25\n0,6,1,35\n"),
            "data.csv:2: this row has 4 fields, the header names 2; with decimal commas, separate "
            "the columns by semicolons or tabs");
  EXPECT_EQ(refusal("a,b\n1,2\n", {.separator = ",", .decimal = ","}),
            "data.csv:2: commas cannot both separate the columns and mark the decimals; save the "
            "table with semicolons or tabs");
}

TEST(Measured, RefusalsHavePlaces) {
  EXPECT_EQ(refusal(""), "data.csv:1: the file is empty; its first row names the columns");
  EXPECT_EQ(refusal("depth_mm,force_N\n"),
            "data.csv:1: the file contains no row of two numbers; give a table in text, and "
            "`--separator`, `--decimal` or `--skip` if its form is unusual");
  EXPECT_EQ(refusal("depth_mm,force_N\n1.5,3\n2, x7\n"),
            "data.csv:3:4: `force_N` holds `x7`, which is no number; name a column of numbers");
  EXPECT_EQ(refusal("depth_mm;force_N\n1.5;1.234,5\n2;7\n"),
            "data.csv:2:5: `force_N` holds `1.234,5`, whose marks between thousands are no part of "
            "a number; "
            "save the numbers without them, as `1234.5`");
  EXPECT_EQ(refusal("depth_mm,force_N\n1.5,3\n2,1e400\n"),
            "data.csv:3:3: `1e400` is too large or too small; write a number between 1e-300 and "
            "1e300 in size");
  EXPECT_EQ(refusal("depth_mm,force_N\n1.5,3\n2\n3,4\n"),
            "data.csv:3: this row has 1 field, the header names 2; give every row one field per "
            "column");
  EXPECT_EQ(refusal("depth_mm,force_N\n1.5,3\n2,3,4\n"),
            "data.csv:3: this row has 3 fields, the header names 2; give every row one field per "
            "column");
  EXPECT_EQ(refusal("depth_mm,force_N\n1.5,\"3\n2,4\n"),
            "data.csv:2:5: the quote opened here is not closed on its line; end the field with "
            "`\"`");
  EXPECT_EQ(refusal("a_mm,b_N,b_N\n1,2,3\n", {.x = "a_mm", .y = "b_N"}),
            "data.csv:1: the column name `b_N` occurs twice, as columns 2 and 3; give its number, "
            "as `--y 2`");
  EXPECT_EQ(read("a_mm,b_N,b_N\n1,2,3\n", {.x = "a_mm", .y = "3"}).y, Numbers{3});
  EXPECT_EQ(refusal("depth_mm,force_N\n1,2\n", {.x = "dept_mm", .y = "force_N"}),
            "data.csv:1: has no column `dept_mm`; did you mean `depth_mm`?");
  EXPECT_EQ(refusal("a_mm,b_mm,c_N\n1,2,3\n"),
            "data.csv:1: has 3 columns, and it is not clear which is x; set `--x` to one of a_mm, "
            "b_mm, c_N");
  EXPECT_EQ(refusal("a,b\n1,2\n", {.x_unit = "furlong"}),
            "palpate: `--x-unit furlong` is no unit; write it as `mm`, `uN`, `kPa` or `1`");
  EXPECT_EQ(refusal("a,b\n1,2\n", {.skip = 2}),
            "data.csv: has 2 lines, and `--skip 2` leaves none");
  EXPECT_EQ(refusal("a,b\n1,2\n", {.separator = "/"}),
            "palpate: `--separator /` is unknown; give `,`, `;`, `|`, `tab` or `blank`");
  EXPECT_EQ(
      read("No|Extension|Load\n |mm|N\n1|0.1|2\n2|0.2|3\n", {.x = "Extension", .y = "Load"}).y,
      (Numbers{2, 3}));
  EXPECT_EQ(refusal("Weg (um);Kraft (uN)\n1.500,000;-476,500\n1.505,000;-191,250\n"),
            "data.csv:2:1: `1.500,000` has marks between thousands, which are no part of a number; "
            "save the numbers without them, as `1234.5`");
  EXPECT_EQ(refusal("a,b\n,2\n1,\n"),
            "data.csv: no row is left with a number in `a` and in `b`; name columns that are "
            "filled");
  EXPECT_THROW(static_cast<void>(read_measured("/nowhere/data.csv", {})), InputError);
}

// Without a column of segments the approach ends at the largest change of load, which in a file of
// the retract alone is the pull-off.
TEST(Measured, ARetractAloneIsKeptWhole) {
  const char* adhesive = "x_mm,F_N\n3,9\n2,5\n1,2\n0,-3\n-1,0\n-2,0\n";
  const MeasuredCurve curve = read(adhesive, {.segment = "retract"});
  EXPECT_EQ(curve.y, (Numbers{9, 5, 2, -3, 0, 0}));
  EXPECT_EQ(curve.notes,
            (std::vector<std::string>{"`x_mm` goes one way only, and its load changes most at its "
                                      "first rows: all of them are taken as the retract"}));
  // A height that grows as the tip withdraws, under a load that reads negative in compression.
  EXPECT_EQ(read("x_mm,F_N\n-3,-9\n-2,-5\n-1,-2\n0,3\n1,0\n2,0\n", {.segment = "retract"}).y,
            (Numbers{-9, -5, -2, 3, 0, 0}));
  // Without adhesion the largest change is that of any free row, also of the last.
  EXPECT_EQ(
      read("x_mm,F_N\n3,9\n2,5\n1,2\n0,0\n-1,0.1\n-2,-0.1\n", {.segment = "retract"}).y.size(), 6U);
  // An approach whose specimen gave way, and a whole press, end at their largest load.
  EXPECT_EQ(read("x_mm,F_N\n0,0\n1,1\n2,4\n3,9\n4,5\n", {.segment = "retract"}).y, Numbers{5});
  EXPECT_EQ(read("x_mm,F_N\n0,0\n1,3\n2,4\n1,2\n0,0\n", {.segment = "retract"}).y, (Numbers{2, 0}));
  // Its rest is its end, so that its signs are told as well.
  const DataLayout automatic{.compression = "auto"};
  EXPECT_TRUE(read(adhesive, automatic).notes.empty());
  const MeasuredCurve height = read("x_mm,F_N\n-3,9\n-2,5\n-1,2\n0,-3\n1,0\n2,0\n", automatic);
  EXPECT_EQ(height.y, (Numbers{9, 5, 2, -3, 0, 0}));
  EXPECT_EQ(height.x.front(), 3e-3);
  // A stretch tells by itself, and has no sign.
  EXPECT_EQ(read("stretch,P_kPa\n1,0\n0.9,-3\n0.8,-7\n0.7,-14\n", automatic).x.back(), 0.7);
  // A load that saturates begins at rest, also where it gives way.
  EXPECT_EQ(read("x_mm,F_N\n0,0\n1,6\n2,8\n3,9\n4,7\n", {.segment = "retract"}).y, Numbers{7});
  EXPECT_TRUE(read("x_mm,F_N\n0,0\n1,6\n2,8\n3,9\n4,9.5\n", automatic).notes.empty());
  // It has no approach.
  EXPECT_EQ(
      test::refusal([&] { return read(adhesive, {.segment = "approach"}); }),
      "data.csv: goes one way only in `x_mm`, and its load changes most at its first rows: all "
      "of them are the way back; leave `--segment` out, or give `--segment retract`");
  // Over time every record goes one way.
  EXPECT_EQ(read("t_s,F_N\n0,0\n1,7\n2,9\n3,5\n", {.segment = "retract"}).y, Numbers{5});
}

TEST(Measured, CompressionThatReadsNegative) {
  const DataLayout automatic{.compression = "auto"};
  const std::string machine = "Extension (mm),Load (N)\n0,0.02\n-1,-1\n-2,-4\n-1,-0.9\n";
  MeasuredCurve curve = read(machine, automatic);
  EXPECT_EQ(curve.x, (Numbers{0, 1e-3, 2e-3, 1e-3}));
  EXPECT_EQ(curve.y, (Numbers{-0.02, 1, 4, 0.9}));
  EXPECT_EQ(curve.notes,
            (std::vector<std::string>{"`Load (N)` is negative in compression; sign changed",
                                      "`Extension (mm)` falls as the load grows; sign changed"}));
  EXPECT_EQ(read(machine, {.compression = "negative"}).y, curve.y);
  EXPECT_EQ(read(machine).y, (Numbers{0.02, -1, -4, -0.9}));  // as the file says
  // A cell with an offset: never below zero, and yet it falls in compression.
  curve = read("x_mm,F_N\n0,10\n1,9\n2,6\n", automatic);
  EXPECT_EQ(curve.y, (Numbers{-10, -9, -6}));
  EXPECT_TRUE(read("x_mm,F_N\n0,0\n1,-0.1\n2,4\n", automatic).notes.empty());  // it adheres
  // A way back ends at rest.
  curve = read("x_mm,F_N\n0,0\n1,4\n0.5,1\n0,0\n", {.compression = "auto", .segment = "retract"});
  EXPECT_EQ(curve.y, (Numbers{1, 0}));
  EXPECT_EQ(curve.x, (Numbers{0.5e-3, 0}));
  // Relaxation begins at its peak, so that the load's own sign tells.
  EXPECT_EQ(read("t_s,F_N\n0,-4\n1,-3\n", automatic).y, (Numbers{4, 3}));
  EXPECT_EQ(read("t_s,F_N\n0,4\n1,3\n", automatic).y, (Numbers{4, 3}));
  EXPECT_EQ(refusal("x_mm,F_N\n0,0\n1,-2\n2,3\n", automatic),
            "data.csv: `F_N` both rises and falls from its start, so that its sign in compression "
            "is not clear; give `--compression positive` or `--compression negative`");
  EXPECT_EQ(refusal("x_mm,F_N\n0,0\n1,2\n", {.compression = "down"}),
            "palpate: `--compression down` is unknown; give `positive`, `negative` or `auto`");
}

TEST(Measured, OurOwnTables) {
  const std::string text = record::csv_text({{"case", "step", "indentation_mm", "force_N"},
                                             {{std::string("a"), 1.0, 1.5, 3.0},
                                              {std::string("b"), 1.0, 9.0, 9.0},
                                              {std::string("a"), 1.0, 2.0, 4.25},
                                              {std::string("a"), 2.0, 2.5, 5.0}}});
  DataLayout layout{.x = "indentation_mm", .y = "force_N", .segment = "1", .case_name = "a"};
  expect_curve(read(text, layout));
  layout.case_name = "c";
  EXPECT_EQ(refusal(text, layout),
            "data.csv:1: the column `case` contains no `c`; its values are a, b");
}

// The same numbers in every dress that a spreadsheet or a machine may put on them.
TEST(Measured, EveryDressHoldsTheSameNumbers) {
  EXPECT_TRUE(rc::check("read(dressed(numbers)) == numbers", [] {
    const std::string separator =
        *rc::gen::elementOf(std::vector<std::string>{",", ";", "\t", " "});
    const bool comma = separator != "," && *rc::gen::arbitrary<bool>();
    const bool quoted = *rc::gen::arbitrary<bool>();
    const std::string end = *rc::gen::elementOf(std::vector<std::string>{"\n", "\r\n", "\r"});
    const int columns = *rc::gen::inRange(2, 5);
    const int rows = *rc::gen::inRange(1, 8);
    const std::string block = *rc::gen::elementOf(std::vector<std::string>{
        "", "Specimen: liver\n", "# a comment\n\n", "Date\t2020-01-01\nRate\t0.5\n", "\n\n"});
    std::string text = block;
    for (std::size_t at = text.find('\n'); at != std::string::npos;
         at = text.find('\n', at + end.size()))
      text.replace(at, 1, end);
    for (int k = 0; k < columns; ++k) text += (k > 0 ? separator : "") + "c" + std::to_string(k);
    text += end;
    std::vector<Numbers> values(static_cast<std::size_t>(columns));
    for (int i = 0; i < rows; ++i)
      for (int k = 0; k < columns; ++k) {
        const double value = *rc::gen::inRange(-100000, 100000) / 128.0;
        values[static_cast<std::size_t>(k)].push_back(value);
        std::string digits = number_text(value);
        if (comma && digits.find('.') != std::string::npos) digits[digits.find('.')] = ',';
        // What could be thousands is another test's.
        if (comma && digits.find(',') == std::string::npos) digits += ",0";
        if (quoted) digits = '"' + digits + '"';
        text += digits + (k + 1 < columns ? separator : end);
      }
    DataLayout layout{.x = "c0", .y = std::to_string(columns)};
    if (comma) layout.decimal = ",";
    const MeasuredCurve curve = parse_measured(text, "d", layout);
    RC_ASSERT(curve.x == values.front());
    RC_ASSERT(curve.y == values.back());
  }));
}

}  // namespace
}  // namespace palpate::measured
