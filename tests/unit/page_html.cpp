// Pages: escaping, links, inline pictures, contrast.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

#include "base/text.h"
#include "page/page.h"
#include "plot/gnuplot.h"
#include "plot/gnuplot_text.h"
#include "temporary_folder.h"

namespace palpate::page {
namespace {

TEST(Html, NothingGetsInUnescaped) {
  const std::string evil = "<script>\"it's\" & \x1b</script>";
  const std::string safe = "&lt;script&gt;&quot;it&#39;s&quot; &amp;  &lt;/script&gt;";
  EXPECT_EQ(text(evil).html(), safe);
  EXPECT_EQ(element("p", evil, {{"title", evil}}).html(),
            "<p title=\"" + safe + "\">" + safe + "</p>");
  EXPECT_EQ(link(evil, "x").html(), "<a href=\"" + safe + "\">x</a>");
  EXPECT_EQ(paragraphs({"set `a<b` now"}).html(), "<p>Set <code>a&lt;b</code> now.</p>");
  Page page(evil, "run");
  page.answer({evil});
  page.section("One", table(evil, {{evil}, {{record::Cell(evil)}}}));
  EXPECT_EQ(page.html().find("<script>"), std::string::npos);
}

TEST(Html, TablesHaveHeadingsAndFourDigits) {
  const std::string html =
      table("Forces", {{"case", "force"}, {{record::Cell("a"), 1.23456789}, {"b", {}}}}).html();
  for (const char* part :
       {"<caption>Forces</caption>", "<th scope=\"col\" class=\"number\">force</th>",
        "<th scope=\"col\">case</th>", "<th scope=\"row\">a</th>",
        "<td data-column=\"force\" class=\"number\">1.235</td>",
        "<td data-column=\"force\" class=\"none\">–</td>"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_EQ(table("n", {{"a", "b"}, {{"x", INFINITY}}}).html().find("inf"), std::string::npos);
  const std::string known =
      table("n", {{"a", "empty", "b"}, {{"x", {}, {}}, {"y", "", 2.0}, {"z", NAN, {}}}}).html();
  EXPECT_EQ(known.find("empty"), std::string::npos) << "a column without values";
  EXPECT_NE(known.find("<td data-column=\"b\" class=\"none\">–</td>"), std::string::npos);
  const record::Table long_one{{"n"}, {{1.0}, {2.0}, {3.0}}};
  const std::string cut = table_of_file("n", long_one, "n.csv", 2).html();
  EXPECT_NE(cut.find("The first 2 of 3 rows"), std::string::npos);
  EXPECT_EQ(cut.find(">3<"), std::string::npos);
}

// Keys, models and parameters are not words of a sentence.
TEST(Html, NamesKeepTheirCaseAtTheStartOfASentence) {
  EXPECT_EQ(paragraphs({"tissue.young_modulus 60 kPa"}).html(),
            "<p>tissue.young_modulus 60\u00a0kPa.</p>");
  EXPECT_EQ(paragraphs({"coupled_springs is taken"}).html(), "<p>coupled_springs is taken.</p>");
  EXPECT_EQ(paragraphs({"a, logarithmic fit"}).html(), "<p>a, logarithmic fit.</p>");
  EXPECT_EQ(paragraphs({"a press is deep."}).html(), "<p>A press is deep.</p>");
  EXPECT_EQ(paragraphs({"done."}).html(), "<p>Done.</p>");
}

// A hash may be broken anywhere, a sentence between its words.
TEST(Html, OneLongWordDoesNotWidenItsTable) {
  const auto cell = [](const std::string& content) {
    return table("t", {{"a", "b"}, {{record::Cell("x"), record::Cell(content)}}}).html();
  };
  EXPECT_NE(cell(std::string(64, 'f')).find("class=\"long\""), std::string::npos);
  EXPECT_NE(cell(std::string(40, 'f') + " " + std::string(20, 'f')).find("class=\"words\""),
            std::string::npos);
  EXPECT_NE(std::string(style()).find(".long { overflow-wrap: anywhere; }"), std::string::npos);
}

// No line ends between a number and its unit, and none between a value and its `±`.
TEST(Page, TheHeadlineKeepsItsNumbersTogether) {
  const auto headline = [](const std::string& value, const std::string& error,
                           Page::Tone tone = Page::Tone::result) {
    Page page("t", "run");
    page.headline(value, error, tone);
    const std::string html = page.html(), begin = "\">", start = "<p class=\"big";
    const std::size_t from = html.find(begin, html.find(start)) + begin.size();
    return html.substr(from, html.find("</p>", from) - from);
  };
  EXPECT_EQ(headline("Peak force 1.17 N", "± 2.5 %, not counting viscosity"),
            "Peak force 1.17\u00a0N\u00a0<span>±\u00a02.5\u00a0%, not counting viscosity</span>");
  EXPECT_EQ(headline("3 %", "largest"), "3\u00a0% <span>largest</span>");
  EXPECT_EQ(headline("Diverged", "energy grew", Page::Tone::failure),
            "Diverged: <span>energy grew</span>");
  EXPECT_EQ(headline("No result", "", Page::Tone::failure), "No result");
}

// No line ends between a number and its unit; what may be copied stays letter by letter.
TEST(Page, ANumberKeepsItsUnitOnItsLine) {
  EXPECT_EQ(kept_together("radius 7 mm, 3.5 kPa; 40 % of 2 N (5 s)."),
            "radius 7\u00a0mm, 3.5\u00a0kPa; 40\u00a0% of 2\u00a0N (5\u00a0s).");
  EXPECT_EQ(kept_together("-95 1/m, 3 N/mm^n"), "-95\u00a01/m, 3\u00a0N/mm^n");
  EXPECT_EQ(kept_together("3 of 4 cases at 2 places"), "3 of 4 cases at 2 places");
  EXPECT_EQ(paragraphs({"set `to = 7 mm` for 7 mm"}).html(),
            "<p>Set <code>to = 7 mm</code> for 7\u00a0mm.</p>");
  EXPECT_EQ(element("pre", "7 mm").html(), "<pre>7 mm</pre>");
  EXPECT_EQ(element("figcaption", "7 mm").html(), "<figcaption>7\u00a0mm</figcaption>");
  const std::string made = table("at 7 mm", {{"a", "b"}, {{"3 kPa", "5 %"}}}).html();
  for (const char* part : {">at 7\u00a0mm<", ">3\u00a0kPa<", ">5\u00a0%<"})
    EXPECT_NE(made.find(part), std::string::npos) << part;
}

// The first figure stands in the head of the page, before the contents; the others are a section.
TEST(Page, TheFirstFigureStandsBesideTheAnswer) {
  const auto made = [](const std::vector<Markup>& figures) {
    Page page("t", "run");
    page.answer({"It is 3."});
    page.figures(figures);
    return page.html();
  };
  const std::string one = made({text("first")}), two = made({text("first"), text("second")});
  const std::string beside = "<div class=\"beside\">first</div>";
  EXPECT_LT(one.find("It is 3."), one.find(beside));
  EXPECT_LT(one.find(beside), one.find("<nav"));
  EXPECT_EQ(one.find("More figures"), std::string::npos);
  EXPECT_NE(two.find("<div class=\"figures\">second</div>"), std::string::npos);
  EXPECT_NE(two.find("<a href=\"#more-figures\">"), std::string::npos);
  EXPECT_EQ(made({}).find("class=\"beside\""), std::string::npos);
  const auto picture = [&](const char* height) {
    return made({Markup::ready(std::string("<svg viewBox=\"0 0 640 ") + height + "\"></svg>")});
  };
  EXPECT_NE(picture("1000").find("class=\"beside\""), std::string::npos);
  EXPECT_EQ(picture("1100").find("class=\"beside\""), std::string::npos) << "too small to read";
  EXPECT_NE(picture("1100").find("<h2 id=\"figures\">"), std::string::npos);
}

// A comparison's page stands alone; that of a run stands beside its tables.
TEST(Page, ItsFootNamesFilesWhereThereAreSome) {
  const std::string foot = "Everything on this page is in the files beside it.";
  EXPECT_EQ(Page("t", "comparison").html().find(foot), std::string::npos);
  EXPECT_NE(Page("t", "run").html(Page::Files::beside).find(foot), std::string::npos);
  const test::TemporaryFolder place;
  WholeFolder folder((place / "out").string(), "result", Replace::incomplete);
  folder.open();
  write(Page("t", "run"), folder);
  EXPECT_NE(read_text(folder.file(file_name)).find(foot), std::string::npos);
}

// The dark inverts lines, texts and grounds, but no areas whose colours stand for numbers.
TEST(Page, ColoursOfNumbersAreNotInverted) {
  const test::TemporaryFolder folder;
  const std::string picture = (folder.path() / "a.svg").string();
  EXPECT_EQ(class_of(picture), "plot");
  test::write_file(folder.path() / "a.gp", "plot 'a.csv' with boxxyerror linecolor palette\n");
  EXPECT_EQ(class_of(picture), "plot map");
  const std::string css = style();
  EXPECT_NE(css.find(".map svg g[shape-rendering=\"crispEdges\"] { filter: invert(1)"),
            std::string::npos);
  EXPECT_NE(css.find(".plot svg { filter: invert("), std::string::npos);
}

// On paper nothing can be opened. More than eight columns do not stand side by side, there and on
// the widest screen.
TEST(Page, PrintsWhatIsFoldedAndWideTablesRowByRow) {
  const std::string css = style(), print = css.substr(css.find("@media print"));
  EXPECT_NE(print.find("details::details-content { content-visibility: visible;"),
            std::string::npos);
  EXPECT_EQ(print.find("details:not([open])"), std::string::npos);
  EXPECT_NE(css.find("\n.many td { display: inline-block;"), std::string::npos);
  EXPECT_NE(css.find(".many .none { display: none; }"), std::string::npos)
      << "row by row a missing value needs no place";
  EXPECT_NE(print.find(".words { min-width: 0; }"), std::string::npos);
  record::Table wide{{}, {{}}};
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(table("t", wide).html().find("many"), std::string::npos) << i;
    wide.columns.push_back(std::to_string(i));
    wide.rows[0].emplace_back(1.0);
  }
  EXPECT_NE(table("t", wide).html().find("class=\"wide many\""), std::string::npos);
}

TEST(Page, IsTheSameTwiceAndKnowsItsAnswer) {
  const auto made = [] {
    Page page("A & B", "run");
    page.answer({"It is 3 < 4 N (`h`).", "So."});
    page.section("Figures", text("x"), Page::Shown::folded);
    page.section("Empty", Markup());
    return page.html();
  };
  EXPECT_EQ(made(), made());
  EXPECT_NE(made().find("<a href=\"#figures\">Figures</a>"), std::string::npos);
  EXPECT_EQ(made().find("Empty"), std::string::npos);
  EXPECT_EQ(summary_of(made()).title, "A & B – palpate run");
  EXPECT_EQ(summary_of(made()).answer, "It is 3 < 4\u00a0N (h).");
  EXPECT_EQ(summary_of(made()).paper, "");
  EXPECT_EQ(summary_of("<p>another page</p>").title, "");
}

TEST(Page, PicturesKeepTheirNamesApart) {
  const std::string svg =
      "<?xml version=\"1.0\"?>\n<svg \n width=\"820\" height=\"500\"\n viewBox=\"0 0 820 500\">"
      "<g id=\"a\"/><path id='b'/><use xlink:href='#b'/><rect fill=\"url(#a)\"/></svg>";
  EXPECT_EQ(inline_svg(svg, "f", "Force < 1").html(),
            "<svg \n\n viewBox=\"0 0 820 500\" role=\"img\" aria-label=\"Force &lt; 1\"><g "
            "id=\"f-a\"/><path id='f-b'/><use xlink:href='#f-b'/><rect fill=\"url(#f-a)\"/></svg>");
  EXPECT_TRUE(inline_svg("no picture", "f", "x").empty());
}

TEST(Page, MissingPicturesAreSaid) {
  const test::TemporaryFolder place;
  WholeFolder folder((place / "out").string(), "result", Replace::incomplete);
  folder.open();
  folder.write("data.csv", "x\n");
  folder.write("plot.gp", "plot 'data.csv'\n");
  const auto all = all_figures(folder, [](const std::string&) { return "Force."; });
  ASSERT_EQ(all.size(), 1U);
  const Markup& shown = all.front();
  EXPECT_NE(shown.html().find("plot.svg could not be drawn here"), std::string::npos);
  EXPECT_NE(shown.html().find("<a href=\"data.csv\">"), std::string::npos);
}

// A 2 x 1 picture: transparent, then the last colour. pngfix of libpng-tools 1.6.39 finds no fault
// in these bytes.
TEST(Png, IsAPicture) {
  const std::vector<unsigned char> shades{0, 255};
  const std::string address = png_address(2, 1, shades);
  EXPECT_TRUE(address.starts_with("data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAMAAAD"))
      << address.substr(0, 80);
  // The end of the length, the stored block 00 00 ff with its checksums, and the chunk IEND.
  EXPECT_TRUE(address.ends_with("AA/wECAQC3AS73AAAAAElFTkSuQmCC"))
      << address.substr(address.size() - 40);
}

double luminance(const std::string& colour) {
  double sum = 0.0;
  const double weights[] = {0.2126, 0.7152, 0.0722};
  for (std::size_t k = 0; k < 3; ++k) {
    const double part = std::stoi(colour.substr(2 * k, 2), nullptr, 16) / 255.0;
    sum += weights[k] * (part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4));
  }
  return sum;
}

// WCAG 2.1, 1.4.3: a ratio of at least 4.5, in both schemes, of every text on both grounds.
TEST(Style, HasEnoughContrast) {
  const std::string css = style();
  const std::regex colour("--([a-z]+): #([0-9a-f]{6})");
  std::vector<std::map<std::string, std::string>> schemes;
  for (std::sregex_iterator at(css.begin(), css.end(), colour), end; at != end; ++at) {
    if ((*at)[1] == "back") schemes.emplace_back();
    schemes.back()[(*at)[1]] = (*at)[2];
  }
  ASSERT_EQ(schemes.size(), 2U);
  for (auto& scheme : schemes)
    for (const char* ink : {"ink", "soft", "link"})
      for (const char* ground : {"back", "card"}) {
        const double a = luminance(scheme.at(ink)), b = luminance(scheme.at(ground));
        EXPECT_GE((std::max(a, b) + 0.05) / (std::min(a, b) + 0.05), 4.5) << ink << ground;
      }
}

// As CSS does it to a figure in the dark: `invert(a)`, then `hue-rotate(180deg)` (Filter Effects
// Module 1), in sRGB.
std::string as_in_the_dark(const std::string& colour, double inverted) {
  constexpr double turn[3][3] = {
      {-0.574, 1.430, 0.144}, {0.426, 0.430, 0.144}, {0.426, 1.430, -0.856}};
  std::array<double, 3> parts{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double part = std::stoi(colour.substr(2 * k, 2), nullptr, 16) / 255.0;
    parts[k] = inverted + part * (1.0 - 2.0 * inverted);
  }
  std::string text;
  for (const auto& row : turn) {
    const double sum = row[0] * parts[0] + row[1] * parts[1] + row[2] * parts[2];
    text += hex_text(static_cast<unsigned char>(std::lround(255.0 * std::clamp(sum, 0.0, 1.0))));
  }
  return text;
}

// WCAG 2.1, 1.4.11: 3 for the lines of figures and 4.5 for their text, on white and in the dark.
TEST(Style, FiguresHaveEnoughContrast) {
  const std::string css = style();
  std::smatch filter;
  ASSERT_TRUE(
      std::regex_search(css, filter, std::regex("invert\\(([.0-9]+)\\) hue-rotate\\(180deg\\)")));
  const double inverted = std::stod(filter[1]);
  const auto least = [&](const std::string& colour) {
    const auto contrast = [](const std::string& one, const std::string& ground) {
      const double a = luminance(one), b = luminance(ground);
      return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
    };
    return std::min(contrast(colour, "ffffff"),
                    contrast(as_in_the_dark(colour, inverted), as_in_the_dark("ffffff", inverted)));
  };
  for (const char* colour : plot::line_colours) EXPECT_GE(least(colour), 3.0) << colour;
  for (int i = 0; i <= 20; ++i)
    EXPECT_GE(least(plot::palette_colour(plot::brightest_line * i / 20.0)), 3.0) << i;
  const std::string script = plot::gnuplot_script({.name = "f", .series = {{.csv_file = "f.csv"}}});
  const std::regex shown("(textcolor|linecolor) rgb '#([0-9a-f]{6})'");
  std::size_t texts = 0;
  for (std::sregex_iterator at(script.begin(), script.end(), shown), end; at != end; ++at) {
    if ((*at)[2] == "dcdcdc") continue;  // the grid, which carries nothing by itself
    const bool text = (*at)[1] == "textcolor";
    texts += text ? 1 : 0;
    EXPECT_GE(least((*at)[2]), text ? 4.5 : 3.0) << at->str();
  }
  EXPECT_GT(texts, 0U);
  EXPECT_LT(least("e69f00"), 3.0) << "an orange that is too pale is found";
}

}  // namespace
}  // namespace palpate::page
