// The scene's picture: what it shows, what hides what, its size, its text.
#include "report/scene_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>

#include "plot/gnuplot_text.h"

namespace palpate::report {
namespace {

using record::ScenePicture;

// A flat of 2 x 2 cm at height z, looking up.
void add_flat(ScenePicture& picture, double z, int region, int within) {
  const Vec3 a(0, 0, z), b(0.02, 0, z), c(0.02, 0.02, z), d(0, 0.02, z);
  picture.faces.push_back({{a, b, c}, region, within});
  picture.faces.push_back({{a, c, d}, region, within});
}

ScenePicture flat() {
  ScenePicture picture;
  add_flat(picture, 0.0, 0, -1);
  picture.materials = {"skin"};
  picture.finger = {{Vec3(0.01, 0.01, 0.005), 0.005}};
  picture.travel = 0.003;
  picture.touch = {0.01, 0.01, 0.0};
  return picture;
}

std::size_t occurrences(const std::string& text, const std::string& piece) {
  std::size_t number = 0;
  for (std::size_t at = text.find(piece); at != std::string::npos; at = text.find(piece, at + 1))
    ++number;
  return number;
}

TEST(ScenePicture, shows_finger_travel_and_scale) {
  const std::string svg = scene_svg(flat(), "A press");
  EXPECT_EQ(svg.substr(0, 5), "<svg ");
  EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
  EXPECT_EQ(occurrences(svg, "A press"), 2U);  // as title and in the picture
  EXPECT_EQ(occurrences(svg, "<circle"), 1U);
  EXPECT_EQ(occurrences(svg, ">3 mm<"), 1U);
  EXPECT_EQ(svg, scene_svg(flat(), "A press"));
}

// The finger is as large as the numbers along the axes say: 10 mm across, as from 0 to 10 of x.
TEST(ScenePicture, axes_and_finger_have_one_scale) {
  const std::string svg = scene_svg(flat(), "");
  const auto number_after = [&](const std::string& word, std::size_t from) {
    return std::stod(svg.substr(svg.find(word, from) + word.size()));
  };
  const double radius = number_after(" r=\"", svg.find("<circle"));
  const auto place = [&](const std::string& text) {  // of the first number, on the axis of x
    const std::size_t at = svg.rfind("<text", svg.find(">" + text + "<"));
    return std::pair{number_after(" x=\"", at), number_after(" y=\"", at)};
  };
  const auto [x0, y0] = place("0");
  const auto [x1, y1] = place("10");
  const double turned = std::cos(M_PI / 6.0), raised = std::sin(M_PI / 6.0) * std::sin(M_PI / 6.0);
  EXPECT_NEAR(std::hypot(x1 - x0, y1 - y0), 2.0 * radius * std::hypot(turned, raised),
              0.3);  // digits of 0.1 px
}

TEST(ScenePicture, draws_what_looks_up_and_merges_one_colour) {
  ScenePicture picture = flat();
  const auto paths = [&] { return occurrences(scene_svg(picture, ""), "<path fill=\"#"); };
  EXPECT_EQ(paths(), 1U);
  std::swap(picture.faces[1].corners[0], picture.faces[1].corners[1]);  // looks down
  EXPECT_EQ(occurrences(scene_svg(picture, ""), "z\"/>"), 1U);
  picture = flat();
  picture.materials = {"skin", "muscle"};
  picture.faces[1].region = 1;
  EXPECT_EQ(paths(), 2U);
}

// In every scene a tissue has the colour of its curves, half of it white.
TEST(ScenePicture, a_tissue_has_one_colour_wherever_it_is) {
  ScenePicture picture;
  const auto colours = [&](const std::vector<std::string>& materials) {
    picture.materials = materials;
    return scene_colours(picture);
  };
  EXPECT_STREQ(plot::line_colours[0], "0072B2");
  const std::string skin = "#80b9d9";  // (0, 114, 178) and white
  EXPECT_EQ(colours({"skin", "muscle"})[0], skin);
  EXPECT_EQ(colours({"muscle", "skin"})[1], skin);
  EXPECT_EQ(colours({"muscle", "skin"})[0], colours({"skin", "muscle"})[1]);
  // Regions of one tissue differ, also from other tissues; so do tissues of own tables.
  const auto many = colours({"skin", "skin", "a", "b", "a", ScenePicture::cavity});
  EXPECT_EQ(std::set<std::string>(many.begin(), many.end()).size(), 7U);  // with the held surface
}

TEST(ScenePicture, paints_the_nearest_last) {
  const auto first_fill = [](const ScenePicture& picture) {
    const std::string svg = scene_svg(picture, "");
    return svg.substr(svg.find("<path fill="), 19);
  };
  ScenePicture low = flat();  // of region 1
  low.materials = {"skin", "muscle"};
  for (auto& face : low.faces) face.region = 1;
  ScenePicture above = low;
  add_flat(above, 0.004, 0, -1);
  ScenePicture below = low;
  add_flat(below, -0.004, 0, -1);
  EXPECT_EQ(first_fill(above), first_fill(low));
  EXPECT_EQ(first_fill(below), first_fill(flat()));
}

TEST(ScenePicture, shows_a_region_through_the_one_around_it) {
  ScenePicture picture = flat();
  EXPECT_EQ(occurrences(scene_svg(picture, ""), "opacity=\"0.45\""), 0U);
  EXPECT_EQ(occurrences(scene_svg(picture, ""), "region 1"), 0U);
  add_flat(picture, -0.005, 1, 0);
  picture.materials = {"skin", "<lump>"};
  const std::string svg = scene_svg(picture, "");
  EXPECT_EQ(occurrences(svg, "opacity=\"0.45\""), 1U);
  EXPECT_EQ(occurrences(svg, "&lt;lump&gt; (region 1)"), 1U);
  EXPECT_LT(svg.find("<path fill="), svg.find("opacity=")) << "first the lump, then the glass";
}

TEST(ScenePicture, shows_what_is_held_with_its_border) {
  ScenePicture picture = flat();
  EXPECT_EQ(occurrences(scene_svg(picture, ""), "bonded"), 0U);
  picture.faces[0].held = true;
  picture.base = "bonded base";
  EXPECT_EQ(base_border(picture).size(), 3U);
  const std::string svg = scene_svg(picture, "");
  EXPECT_EQ(occurrences(svg, ">bonded base<"), 1U);
  EXPECT_EQ(occurrences(svg, "<path fill=\"#"), 2U) << "held and free skin have two colours";
  EXPECT_EQ(occurrences(svg, "stroke-dasharray=\"4 4\""), 1U) << "the border through the body";
  picture.faces[1].held = true;
  EXPECT_EQ(base_border(picture).size(), 4U) << "not the diagonal";
}

TEST(ScenePicture, has_numbers_along_the_axes_of_the_scenario) {
  ScenePicture picture = flat();  // x and y 0 to 20 mm
  const auto text_at = [&](const std::string& text) {
    for (const SceneLabel& one : scene_frame(picture).labels)
      if (one.text == text) return Vec3(1e3 * one.at);
    return Vec3(Vec3::Constant(NAN));
  };
  // At the lower edges, outside of the box.
  EXPECT_NEAR(text_at("x (mm)").x(), 10.0, 1e-9);
  EXPECT_LT(text_at("x (mm)").y(), 0.0);
  EXPECT_NEAR(text_at("y (mm)").y(), 10.0, 1e-9);
  EXPECT_GT(text_at("y (mm)").x(), 20.0);
  EXPECT_TRUE(std::isnan(text_at("z (mm)").x())) << "a flat has no height";
  // A body that stands on its side: the file's y is up.
  picture.axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  EXPECT_NEAR(text_at("z (mm)").y(), 10.0, 1e-9);
  EXPECT_GT(text_at("z (mm)").x(), 20.0);
}

// However an axis lies to the eye, its numbers do not run into each other: two neighbours are 1/25
// of the body's size apart on the page, and of an axis that is seen from its end there are fewer.
TEST(ScenePicture, numbers_of_an_axis_keep_apart) {
  std::size_t fewest = 100;
  for (int turn = 0; turn < 36; ++turn) {
    ScenePicture picture = flat();
    add_flat(picture, 0.01, 0, -1);
    picture.axes = (Eigen::AngleAxisd(10.0 * turn * M_PI / 180.0, Vec3(1, 2, 3).normalized()) *
                    Eigen::AngleAxisd(0.3 * turn, Vec3::UnitX()))
                       .toRotationMatrix();
    const SceneAngles angles = scene_angles(picture);
    const double around = angles.around * M_PI / 180.0, tilt = angles.tilt * M_PI / 180.0;
    const Vec3 right(std::cos(around), std::sin(around), 0.0);
    const Vec3 up(-std::sin(tilt) * std::sin(around), std::sin(tilt) * std::cos(around),
                  std::cos(tilt));
    Vec3 low = Vec3::Constant(1.0), high = Vec3::Constant(-1.0);
    for (const auto& face : picture.faces)
      for (const Vec3& corner : face.corners) {
        const Vec3 own = picture.axes.transpose() * corner;
        low = low.cwiseMin(own);
        high = high.cwiseMax(own);
      }
    const double size = (high - low).norm();
    std::vector<Vec3> numbers;  // of one axis, before its name
    for (const SceneLabel& one : scene_frame(picture).labels) {
      if (one.text.find("mm") == std::string::npos) {
        numbers.push_back(one.at);
        continue;
      }
      for (std::size_t i = 1; i < numbers.size(); ++i) {
        const Vec3 way = numbers[i] - numbers[i - 1];
        EXPECT_GT(std::hypot(way.dot(right), way.dot(up)), 0.04 * size * (1.0 - 1e-9)) << turn;
      }
      fewest = std::min(fewest, numbers.size());
      numbers.clear();
    }
  }
  EXPECT_LT(fewest, 3U) << "no axis of these was seen from its end";
}

// The centred texts along the axes with their places, and whether a narrow page hides them.
struct Shown {
  double x, y;
  std::string text;
  bool hidden;
};
std::vector<Shown> along_axes(const std::string& svg) {
  std::vector<Shown> all;
  const std::size_t from = svg.find("text-anchor=\"middle\">"), end = svg.find("</g>", from);
  for (std::size_t at = svg.find("<text", from); at < end; at = svg.find("<text", at + 1)) {
    const std::string one = svg.substr(at, svg.find("</text>", at) - at);
    const auto number_after = [&](const std::string& word) {
      return std::stod(one.substr(one.find(word) + word.size()));
    };
    std::string words = one.substr(one.find('>') + 1);
    words.erase(std::min(words.find('<'), words.size()));
    all.push_back({number_after(" x=\""), number_after(" y=\""), words,
                   one.find("class=\"more\"") < one.find('>')});
  }
  return all;
}

// Wherever an axis lies, no text along it stands over another: not with letters of 12 px, and of
// those that a narrow page shows, with letters 1.8 times as large.
TEST(ScenePicture, texts_along_the_axes_keep_apart) {
  for (int turn = 0; turn < 36; ++turn) {
    ScenePicture picture = flat();
    add_flat(picture, 0.01, 0, -1);
    for (auto& face : picture.faces)  // about the middle, so that numbers have signs
      for (Vec3& corner : face.corners) corner -= Vec3(0.01, 0.01, 0.005);
    picture.axes = Eigen::AngleAxisd(10.0 * turn * M_PI / 180.0, Vec3(1, 2, 3).normalized())
                       .toRotationMatrix();
    const std::vector<Shown> all = along_axes(scene_svg(picture, ""));
    EXPECT_GE(all.size(), 6U) << turn;
    for (const bool narrow : {false, true})
      for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
          if (narrow && (all[i].hidden || all[k].hidden)) continue;
          const double letters = narrow ? 1.8 * 12.0 : 12.0;
          // A digit of the usual fonts is 0.56 to 0.64 of their size wide.
          const auto half = [&](const Shown& one) {
            return 0.5 * 0.56 * letters * static_cast<double>(one.text.size());
          };
          EXPECT_FALSE(std::abs(all[i].x - all[k].x) < half(all[i]) + half(all[k]) &&
                       std::abs(all[i].y - all[k].y) < 0.9 * letters)
              << turn << ": " << all[i].text << " over " << all[k].text
              << (narrow ? ", narrow" : "");
        }
  }
  // x, y and their ends are there on a narrow page; the units are not.
  const std::string svg = scene_svg(flat(), "");
  std::string narrow;
  for (const Shown& one : along_axes(svg)) narrow += one.hidden ? "" : one.text + " ";
  for (const char* shown : {"x ", "y ", "0 ", "10 ", "20 "})
    EXPECT_NE(narrow.find(shown), std::string::npos) << shown << "is not in " << narrow;
  EXPECT_EQ(occurrences(svg, "<tspan class=\"more\"> (mm)<"), 2U);
}

// The number beside the arrow stays readable where it stands before the body.
TEST(ScenePicture, the_depth_has_a_white_border) {
  const std::string svg = scene_svg(flat(), "");
  const std::size_t end = svg.find(">3 mm<"), begin = svg.rfind("<text", end);
  ASSERT_NE(end, std::string::npos);
  const std::string label = svg.substr(begin, end - begin);
  for (const char* part : {"stroke=\"#fff\"", "stroke-width=\"3\"", "paint-order=\"stroke\""})
    EXPECT_NE(label.find(part), std::string::npos) << part << " is missing in " << label;
}

TEST(ScenePicture, is_seen_from_where_the_finger_comes) {
  ScenePicture picture = flat();
  EXPECT_EQ(scene_angles(picture).around, 30.0);
  EXPECT_EQ(scene_angles(picture).tilt, 30.0);
  for (const double angle : {-150.0, -60.0, 30.0, 120.0}) {
    const double turn = angle * M_PI / 180.0;
    picture.towards = {-std::sin(turn), std::cos(turn), 0.0};
    EXPECT_EQ(scene_angles(picture).around, angle);
  }
  picture.towards = Vec3::UnitZ();
  EXPECT_EQ(scene_angles(picture).tilt, -30.0) << "from below";
}

TEST(ScenePicture, follows_slides_one_after_the_other) {
  ScenePicture picture = flat();
  EXPECT_EQ(occurrences(scene_svg(picture, ""), "stroke-dasharray"), 0U);
  picture.slides = {{0.01, 0.0, 0.0}, {0.0, 0.02, 0.0}};
  const std::string svg = scene_svg(picture, "");
  EXPECT_EQ(occurrences(svg, "stroke-dasharray"), 2U);
  EXPECT_EQ(occurrences(svg, ">10 mm, 20 mm<"), 1U) << "both where the last one ends";
}

// Between plates there is no finger: five arrows stand on the top, with what they are.
TEST(ScenePicture, shows_the_load_between_plates) {
  ScenePicture picture = flat();
  picture.finger.clear();
  const std::string without = scene_svg(picture, "");
  picture.load = "1 kPa";
  const std::string svg = scene_svg(picture, "");
  EXPECT_EQ(occurrences(svg, ">1 kPa<"), 1U);
  EXPECT_EQ(occurrences(svg, "z\" stroke=\"none\""),
            occurrences(without, "z\" stroke=\"none\"") + 5U);
  EXPECT_NE(scene_view(picture, "").html().find("the arrows are the load, 1 kPa."),
            std::string::npos);
  // Its words stand above the body: above the highest corner of its faces.
  const std::size_t end = svg.find(">1 kPa<"), begin = svg.rfind("<text", end);
  const double words = std::stod(svg.substr(svg.find(" y=\"", begin) + 4));
  const std::size_t faces = svg.find("<path fill=\"#");
  const std::string path = svg.substr(svg.find(" d=\"", faces), svg.find("/>", faces) - faces);
  const std::regex pair("([-0-9.]+) ([-0-9.]+)");
  double top = INFINITY;
  for (std::sregex_iterator at(path.begin(), path.end(), pair), none; at != none; ++at)
    top = std::min(top, std::stod((*at)[2]));
  EXPECT_LT(words, top);
}

// The page gives ground and ink, which it finds by these classes.
TEST(ScenePicture, takes_the_colours_of_a_page) {
  const std::string svg = scene_svg(flat(), "");
  EXPECT_EQ(occurrences(svg, "<rect class=\"back\""), 1U);
  EXPECT_EQ(occurrences(svg, "class=\"halo\""), 1U);
  EXPECT_EQ(occurrences(svg, "<g class=\"ink\""), 2U) << "numbers, arrow with axes";
  EXPECT_EQ(occurrences(svg, "<g class=\"ink names\""), 1U) << "title and legend";
  EXPECT_EQ(occurrences(svg, "<g fill=\"#222\""), 1U) << "slides stand before the body";
  EXPECT_EQ(scene_view(flat(), "").html().find("class=\"white\""), std::string::npos);
}

TEST(ScenePicture, text_is_safe_in_xml) {
  const std::string svg = scene_svg(flat(), "a < b & c\n\x01");
  EXPECT_EQ(occurrences(svg, "a &lt; b &amp; c\n <"), 2U);
  EXPECT_EQ(svg.find('\x01'), std::string::npos);
}

TEST(ScenePicture, of_5000_triangles_stays_below_2_MB) {
  ScenePicture picture;
  picture.materials = {"skin"};
  const auto height = [](int i, int j) {
    return Vec3(1e-3 * i, 1e-3 * j, 2e-3 * std::sin(0.3 * i) * std::cos(0.4 * j));
  };
  for (int i = 0; i < 50; ++i)
    for (int j = 0; j < 50; ++j) {
      picture.faces.push_back({{height(i, j), height(i + 1, j), height(i + 1, j + 1)}, 0, -1});
      picture.faces.push_back({{height(i, j), height(i + 1, j + 1), height(i, j + 1)}, 0, -1});
    }
  const std::string svg = scene_svg(picture, "bumps");
  EXPECT_GT(occurrences(svg, "z"), 4000U);
  EXPECT_LT(svg.size(), 2'000'000U);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(TissueColours, AreOneForATissueWhereverItOccurs) {
  const std::vector<std::size_t> wanted{5, 1, 6, 5, 0};
  EXPECT_EQ(plot::tissue_colours({"liver", "muscle", "tumour", "liver", "skin"}), wanted);
}

}  // namespace
}  // namespace palpate::report
