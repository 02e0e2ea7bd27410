// Draws the picture by parallel projection, painter's algorithm and flat shading.
#include "report/scene_picture.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <vector>

#include "base/text.h"
#include "base/units.h"

namespace palpate::report {
namespace {

using record::ScenePicture;

using Colour = std::array<double, 3>;  // red, green, blue, 0 to 255

constexpr double width = 800.0, height = 640.0;  // px, of the page
constexpr double margin = 60.0, head = 100.0, foot = 90.0;

// Colours by region: those of skin, muscle and bone, then others.
constexpr std::array<Colour, 6> palette{{{236, 188, 160},
                                         {190, 74, 66},
                                         {240, 232, 205},
                                         {96, 140, 190},
                                         {120, 165, 100},
                                         {150, 118, 185}}};

Colour colour(int region) { return palette[as_index(region) % palette.size()]; }

std::string hex(const Colour& colour, double brightness) {
  std::string text = "#";
  for (const double part : colour) {
    const int value = std::clamp(static_cast<int>(std::lround(brightness * part)), 0, 255);
    text += hex_text(static_cast<unsigned char>(value));
  }
  return text;
}

// Rounded to a tenth of a pixel.
std::string px(double value) { return number_text(std::round(10.0 * value) / 10.0 + 0.0); }

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
    if (letter == '&')
      safe += "&amp;";
    else if (letter == '<')
      safe += "&lt;";
    else if (letter == '>')
      safe += "&gt;";
    else  // XML permits no control characters
      safe += static_cast<unsigned char>(letter) < 0x20 ? ' ' : letter;
  }
  return safe;
}

struct Point {
  double x = 0.0, y = 0.0;  // px, y downwards
  [[nodiscard]] std::string text() const { return px(x) + " " + px(y); }
};

// Unit vectors of the page. `towards` points to the eye: 30 degrees above the horizon, and 30
// degrees from -y to +x.
const Vec3 right(0.5 * std::sqrt(3.0), 0.5, 0.0);
const Vec3 up(-0.25, 0.25 * std::sqrt(3.0), 0.5 * std::sqrt(3.0));
const Vec3 towards = right.cross(up);
const Vec3 light = Vec3(-0.35, -0.45, 0.82).normalized();  // from behind the eye's left

// The projection from space to the page.
struct View {
  double scale = 1.0;            // px/m
  double left = 0.0, top = 0.0;  // m, the page's upper left corner along `right` and `up`

  [[nodiscard]] Point operator()(const Vec3& place) const {
    return {scale * (place.dot(right) - left), scale * (top - place.dot(up))};
  }
};

View fitting(const ScenePicture& picture) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  double left = inf, bottom = inf, most_right = -inf, top = -inf;
  const auto take = [&](const Vec3& place, double around) {
    left = std::min(left, place.dot(right) - around);
    most_right = std::max(most_right, place.dot(right) + around);
    bottom = std::min(bottom, place.dot(up) - around);
    top = std::max(top, place.dot(up) + around);
  };
  for (const auto& face : picture.faces)
    for (const Vec3& corner : face.corners) take(corner, 0.0);
  for (const auto& sphere : picture.finger) take(sphere.centre, sphere.radius);
  Vec3 at = picture.touch;
  for (const Vec3& slide : picture.slides) take(at += slide, 0.0);
  View view;
  view.scale = std::min((width - 2.0 * margin) / (most_right - left),
                        (height - head - foot) / (top - bottom));
  view.left = 0.5 * (left + most_right - width / view.scale);
  view.top = 0.5 * (top + bottom + (height + head - foot) / view.scale);
  return view;
}

// Paints the faces towards the eye, the farthest first; successive faces of one colour form a path.
std::string painted(const std::vector<const ScenePicture::Face*>& faces, const View& view) {
  struct Seen {
    double nearness;
    const ScenePicture::Face* face;
    double brightness;
  };
  std::vector<Seen> seen;
  for (const ScenePicture::Face* face : faces) {
    const auto& [a, b, c] = face->corners;
    const Vec3 normal = (b - a).cross(c - a).normalized();
    if (normal.dot(towards) <= 0.0) continue;
    seen.push_back({(a + b + c).dot(towards), face, 0.74 + 0.3 * normal.dot(light)});
  }
  std::stable_sort(seen.begin(), seen.end(), [](const Seen& one, const Seen& other) {
    return one.nearness < other.nearness;
  });
  std::string text, before;
  for (const Seen& one : seen) {
    const Colour base = colour(one.face->region);
    const std::string fill = hex(base, one.brightness);
    if (fill != before) {
      if (!before.empty()) text += "\"/>\n";
      text +=
          "<path fill=\"" + fill + "\" stroke=\"" + hex(base, 0.88 * one.brightness) + "\" d=\"";
      before = fill;
    }
    const auto& [a, b, c] = one.face->corners;
    text += "M" + view(a).text() + "L" + view(b).text() + " " + view(c).text() + "z";
  }
  return before.empty() ? text : text + "\"/>\n";
}

// Paints opaque regions first, then the translucent ones, which contain others, innermost first.
std::string specimen(const ScenePicture& picture, const View& view) {
  using Faces = std::vector<const ScenePicture::Face*>;
  Faces solid;
  std::map<int, Faces, std::greater<>> glass;
  for (const ScenePicture::Face& face : picture.faces)
    if (face.within >= 0) glass[face.within];
  for (const ScenePicture::Face& face : picture.faces) {
    const auto found = glass.find(face.region);
    (found == glass.end() ? solid : found->second).push_back(&face);
  }
  std::string text = "<g stroke-width=\"0.6\" stroke-linejoin=\"round\">\n" + painted(solid, view);
  for (const auto& [region, faces] : glass)
    text += "<g opacity=\"0.45\">\n" + painted(faces, view) + "</g>\n";
  return text + "</g>\n";
}

std::string label(const Point& at, const std::string& attributes, const std::string& words) {
  return "<text x=\"" + px(at.x) + "\" y=\"" + px(at.y) + "\"" + attributes + ">" + escaped(words) +
         "</text>\n";
}

std::string mm_text(double metres) { return rounded_text(unit::mm.from_si(metres), 3) + " mm"; }

// An arrow from one point to another, with a head of `reach` px.
std::string arrow(const Point& from, const Point& to, double reach,
                  const std::string& attributes = "") {
  const double x = to.x - from.x, y = to.y - from.y;
  const double length = std::sqrt(x * x + y * y);
  if (length <= 0.0) return "";
  const Point ahead{x / length, y / length};
  const Point neck{to.x - reach * ahead.x, to.y - reach * ahead.y};
  const Point side{0.42 * reach * ahead.y, -0.42 * reach * ahead.x};
  return "<path d=\"M" + from.text() + "L" + neck.text() + "\" fill=\"none\"" + attributes +
         "/><path d=\"M" + to.text() + "L" + Point{neck.x + side.x, neck.y + side.y}.text() + " " +
         Point{neck.x - side.x, neck.y - side.y}.text() + "z\" stroke=\"none\"/>\n";
}

std::string slides(const ScenePicture& picture, const View& view) {
  std::string text;
  Vec3 at = picture.touch;
  for (const Vec3& slide : picture.slides) {
    const Vec3 next = at + slide;
    const Point end = view(next);
    text += arrow(view(at), end, 11.0, " stroke-dasharray=\"6 4\"") +
            label({end.x + 8.0, end.y + 5.0}, " stroke=\"none\"", mm_text(slide.norm()));
    at = next;
  }
  return text;
}

std::string finger(const ScenePicture& picture, const View& view) {
  std::vector<ScenePicture::Sphere> spheres = picture.finger;
  std::stable_sort(spheres.begin(), spheres.end(), [](const auto& one, const auto& other) {
    return one.centre.dot(towards) < other.centre.dot(towards);
  });
  std::string text;
  for (const auto& sphere : spheres) {
    const Point at = view(sphere.centre);
    text += "<circle cx=\"" + px(at.x) + "\" cy=\"" + px(at.y) + "\" r=\"" +
            px(view.scale * sphere.radius) + "\"/>\n";
  }
  return text;
}

// The arrow of the travel, above the finger, not to scale.
std::string travel(const ScenePicture& picture, const View& view) {
  double top = std::numeric_limits<double>::infinity(), x = 0.0;
  for (const auto& sphere : picture.finger) {
    const Point at = view(sphere.centre);
    top = std::min(top, at.y - view.scale * sphere.radius);
    x += at.x / static_cast<double>(picture.finger.size());
  }
  const double tip = top - 5.0, tail = tip - 38.0;
  return arrow({x, tail}, {x, tip}, 12.0) +
         label({x + 10.0, tail + 12.0}, " stroke=\"none\"", mm_text(picture.travel));
}

// Its length is 1, 2 or 5 times a power of ten: the longest that is at most 160 px.
std::string scale_bar(const View& view) {
  double length = 1e-6;  // m
  for (const double next : {2.0, 2.5, 2.0, 2.0, 2.5, 2.0, 2.0, 2.5, 2.0, 2.0, 2.5,
                            2.0, 2.0, 2.5, 2.0, 2.0, 2.5, 2.0, 2.0, 2.5, 2.0}) {
    if (length * next * view.scale > 160.0) break;
    length *= next;
  }
  const double left = margin, right_end = margin + view.scale * length, y = height - 36.0;
  const auto tick = [&](double x) { return "M" + px(x) + " " + px(y - 5.0) + "v10"; };
  return "<path d=\"" + tick(left) + tick(right_end) + "M" + px(left) + " " + px(y) + "H" +
         px(right_end) + "\" fill=\"none\"/>\n" +
         label({0.5 * (left + right_end), y - 10.0}, " stroke=\"none\" text-anchor=\"middle\"",
               mm_text(length));
}

std::string axes() {
  constexpr double length = 34.0;  // px, of an axis parallel to the page
  const Point origin{width - 100.0, height - 40.0};
  std::string text;
  constexpr std::array<const char*, 3> names{"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const double x = right[axis], y = -up[axis];
    text += arrow(origin, {origin.x + length * x, origin.y + length * y}, 7.0);
    text += label({origin.x + (length + 10.0) * x, origin.y + (length + 10.0) * y + 4.5},
                  " stroke=\"none\" text-anchor=\"middle\"", names[as_index(axis)]);
  }
  return text;
}

std::string legend(const ScenePicture& picture) {
  std::string text;
  double y = 70.0;
  for (std::size_t i = 0; i < picture.materials.size(); ++i, y += 20.0) {
    const std::string words = i == 0 ? picture.materials[i]
                                     : picture.materials[i] + " (region " + std::to_string(i) + ")";
    text += "<rect x=\"" + px(margin) + "\" y=\"" + px(y - 10.0) +
            "\" width=\"12\" height=\"12\" fill=\"" + hex(colour(static_cast<int>(i)), 1.0) +
            "\" stroke=\"#777\" stroke-width=\"0.6\"/>\n" +
            label({margin + 19.0, y}, " stroke=\"none\"", words);
  }
  return text;
}

constexpr const char* gradient =
    "<defs><radialGradient id=\"ball\" cx=\"0.36\" cy=\"0.3\" r=\"0.75\">"
    "<stop offset=\"0\" stop-color=\"#f4f7fb\"/><stop offset=\"0.45\" stop-color=\"#aebccd\"/>"
    "<stop offset=\"1\" stop-color=\"#5d6c80\"/></radialGradient></defs>\n";

}  // namespace

std::string region_colour(int region) { return hex(colour(region), 1.0); }

std::string scene_svg(const ScenePicture& picture, const std::string& title) {
  assert(!picture.faces.empty());
  const View view = fitting(picture);
  const std::string size = "width=\"" + px(width) + "\" height=\"" + px(height) + "\"";
  const std::string ink = "<g fill=\"#222\" stroke=\"#222\" stroke-width=\"1.6\">\n";
  std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + px(width) + " " +
                     px(height) + "\" " + size +
                     " font-family=\"sans-serif\" font-size=\"14\">\n<title>" + escaped(title) +
                     "</title>\n" + gradient + "<rect " + size + " fill=\"#fff\"/>\n" +
                     specimen(picture, view) + ink + slides(picture, view) + "</g>\n";
  if (!picture.finger.empty())
    text += "<g fill=\"url(#ball)\" stroke=\"#4a5666\" stroke-width=\"0.8\">\n" +
            finger(picture, view) + "</g>\n";
  text += ink;
  if (!picture.finger.empty()) text += travel(picture, view);
  text += scale_bar(view) + axes() + "</g>\n<g fill=\"#222\">\n" +
          label({margin, 40.0}, " font-size=\"18\"", title);
  if (picture.materials.size() > 1) text += legend(picture);
  return text + "</g>\n</svg>\n";
}

}  // namespace palpate::report
