// Draws the picture by parallel projection, painter's algorithm and flat shading.
#include "report/scene_picture.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "base/text.h"
#include "base/units.h"
#include "base/written.h"
#include "page/page.h"
#include "plot/gnuplot_text.h"

namespace palpate::report {
namespace {

using record::ScenePicture;

using Colour = std::array<double, 3>;  // red, green, blue, 0 to 255

constexpr double width = 800.0, height = 640.0;  // px, of the page
constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};
constexpr double margin = 60.0, foot = 40.0;               // px
constexpr double first_entry = 70.0, entry_height = 24.0;  // px, of the legend below the title

// Above the body there is room for the title and the legend.
double head_of(const ScenePicture& picture) {
  const std::size_t entries = (picture.materials.size() > 1 ? picture.materials.size() : 0) +
                              (picture.base.empty() ? 0 : 1);
  return std::max(100.0, first_entry + entry_height * static_cast<double>(entries));
}

constexpr Colour held_colour{90, 90, 90}, cavity_colour{205, 205, 205};

// The colour of a tissue's curves in figures, mixed with white; a further region of the same tissue
// has less of it.
std::vector<Colour> region_colours(const ScenePicture& picture) {
  std::vector<Colour> colours;
  const std::vector<std::size_t> places = plot::tissue_colours(picture.materials);
  for (std::size_t i = 0; i < places.size(); ++i) {
    Colour& colour = colours.emplace_back(cavity_colour);
    if (picture.materials[i] == ScenePicture::cavity) continue;
    const auto here = places.begin() + static_cast<std::ptrdiff_t>(i);
    const auto same = std::count(places.begin(), here, places[i]);
    const auto line = static_cast<unsigned>(
        std::stoul(plot::line_colours[places[i] % plot::line_colours.size()], nullptr, 16));
    const double white = 0.5 / static_cast<double>(1 + same);
    for (std::size_t k = 0; k < 3; ++k)
      colour[k] = white * 255.0 + (1.0 - white) * (line >> (16 - 8 * k) & 0xffU);
  }
  return colours;
}

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

struct Point {
  double x = 0.0, y = 0.0;  // px, y downwards
  [[nodiscard]] std::string text() const { return px(x) + " " + px(y); }
};

const Vec3 light = Vec3(-0.35, -0.45, 0.82).normalized();  // of a page seen from the front

// The projection from space to the page.
struct View {
  Vec3 right, up, towards;       // unit vectors of the page; `towards` points to the eye
  double scale = 1.0;            // px/m
  double left = 0.0, top = 0.0;  // m, the page's upper left corner along `right` and `up`

  [[nodiscard]] Point operator()(const Vec3& place) const {
    return {scale * (place.dot(right) - left), scale * (top - place.dot(up))};
  }
};

View directions(const SceneAngles& angles) {
  const double around = angles.around * std::numbers::pi / 180.0;
  const double tilt = angles.tilt * std::numbers::pi / 180.0;
  View view;
  view.right = {std::cos(around), std::sin(around), 0.0};
  view.up = {-std::sin(tilt) * std::sin(around), std::sin(tilt) * std::cos(around), std::cos(tilt)};
  view.towards = view.right.cross(view.up);
  return view;
}

View fitting(const ScenePicture& picture, const SceneFrame& frame) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  double left = inf, bottom = inf, most_right = -inf, top = -inf;
  View view = directions(scene_angles(picture));
  const auto take = [&](const Vec3& place, double around) {
    left = std::min(left, place.dot(view.right) - around);
    most_right = std::max(most_right, place.dot(view.right) + around);
    bottom = std::min(bottom, place.dot(view.up) - around);
    top = std::max(top, place.dot(view.up) + around);
  };
  for (const auto& [from, to] : frame.lines) take(from, 0.0), take(to, 0.0);
  for (const auto& sphere : picture.finger) take(sphere.centre, sphere.radius);
  for (const SceneLabel& label : frame.labels) take(label.at, 0.0);
  Vec3 at = picture.touch;
  for (const Vec3& slide : picture.slides) take(at += slide, 0.0);
  const double head = head_of(picture);
  view.scale = std::min((width - 2.0 * margin) / (most_right - left),
                        (height - head - foot) / (top - bottom));
  view.left = 0.5 * (left + most_right - width / view.scale);
  view.top = 0.5 * (top + bottom + (height + head - foot) / view.scale);
  return view;
}

// Paints the faces towards the eye, the farthest first; successive faces of one colour form a path.
std::string painted(const std::vector<const ScenePicture::Face*>& faces,
                    const std::vector<Colour>& colours, const View& view) {
  struct Seen {
    double nearness;
    const ScenePicture::Face* face;
    double brightness;
  };
  std::vector<Seen> seen;
  for (const ScenePicture::Face* face : faces) {
    const auto& [a, b, c] = face->corners;
    const Vec3 normal = (b - a).cross(c - a).normalized();
    if (normal.dot(view.towards) <= 0.0) continue;
    seen.push_back({(a + b + c).dot(view.towards), face, 0.74 + 0.3 * normal.dot(light)});
  }
  std::ranges::stable_sort(seen, {}, &Seen::nearness);
  std::string text, before;
  for (const Seen& one : seen) {
    const Colour base = one.face->held ? held_colour : colours.at(as_index(one.face->region));
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
  const std::vector<Colour> colours = region_colours(picture);
  Faces solid;
  std::map<int, Faces, std::greater<>> glass;
  for (const ScenePicture::Face& face : picture.faces)
    if (face.within >= 0) glass[face.within];
  for (const ScenePicture::Face& face : picture.faces) {
    const auto found = glass.find(face.region);
    (found == glass.end() ? solid : found->second).push_back(&face);
  }
  std::string text =
      "<g stroke-width=\"0.6\" stroke-linejoin=\"round\">\n" + painted(solid, colours, view);
  for (const auto& [region, faces] : glass)
    text += "<g opacity=\"0.45\">\n" + painted(faces, colours, view) + "</g>\n";
  return text + "</g>\n";
}

std::string label(const Point& at, const std::string& attributes, const std::string& words) {
  return "<text x=\"" + px(at.x) + "\" y=\"" + px(at.y) + "\"" + attributes + ">" + escaped(words) +
         "</text>\n";
}

// Of letters that may stand before a body.
constexpr const char* halo =
    " class=\"halo\" stroke=\"#fff\" stroke-width=\"3\" paint-order=\"stroke\"";

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
  std::vector<std::string> lengths;  // where the last slide ends
  for (const Vec3& slide : picture.slides) {
    text += arrow(view(at), view(at + slide), 11.0, " stroke-dasharray=\"6 4\"");
    at += slide;
    lengths.push_back(mm_text(slide.norm()));
  }
  if (lengths.empty()) return text;
  const Point end = view(at);
  return text + label({end.x + 8.0, end.y + 5.0}, halo, joined(lengths, ", "));
}

std::string finger(const ScenePicture& picture, const View& view) {
  std::vector<ScenePicture::Sphere> spheres = picture.finger;
  std::ranges::stable_sort(spheres, [&](const auto& one, const auto& other) {
    return one.centre.dot(view.towards) < other.centre.dot(view.towards);
  });
  std::string text;
  for (const auto& sphere : spheres) {
    const Point at = view(sphere.centre);
    text += "<circle cx=\"" + px(at.x) + "\" cy=\"" + px(at.y) + "\" r=\"" +
            px(view.scale * sphere.radius) + "\"/>\n";
  }
  return text;
}

// Where the arrows of a load between plates stand: on the top, also on a round one.
std::array<Vec3, 5> loaded_places(const ScenePicture& picture) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  double top = -inf;
  for (const auto& face : picture.faces)
    for (const Vec3& corner : face.corners) top = std::max(top, corner.z());
  Vec3 low = Vec3::Constant(inf), high = -low;
  for (const auto& face : picture.faces)
    for (const Vec3& corner : face.corners)
      if (corner.z() > top - 1e-6) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
  const Vec3 middle = 0.5 * (low + high), half = 0.25 * (high - low);
  return {middle, middle + half, middle - half, middle + Vec3(half.x(), -half.y(), 0.0),
          middle + Vec3(-half.x(), half.y(), 0.0)};
}

// The load between plates: arrows, not to scale, with its words above them.
std::string load(const ScenePicture& picture, const View& view) {
  std::string text;
  Point label_at = view(loaded_places(picture).front());
  for (const auto& face : picture.faces)  // above the body
    for (const Vec3& corner : face.corners)
      label_at.y = std::min(label_at.y, view(corner).y - 12.0);
  for (const Vec3& place : loaded_places(picture)) {
    const Point tip = view(place);
    text += arrow({tip.x, tip.y - 40.0}, {tip.x, tip.y - 2.0}, 10.0);
    label_at.y = std::min(label_at.y, tip.y - 48.0);
  }
  return text + label(label_at, std::string(halo) + " text-anchor=\"middle\"", picture.load);
}

// The arrow of the displacement, before the finger, not to scale.
std::string press(const ScenePicture& picture, const View& view) {
  Point ahead{picture.towards.dot(view.right), -picture.towards.dot(view.up)};
  const double length = std::hypot(ahead.x, ahead.y);
  ahead = length > 0.05 ? Point{ahead.x / length, ahead.y / length} : Point{0.0, 1.0};
  Point middle;
  for (const auto& sphere : picture.finger) {
    const Point at = view(sphere.centre);
    middle.x += at.x / static_cast<double>(picture.finger.size());
    middle.y += at.y / static_cast<double>(picture.finger.size());
  }
  double before = 0.0;  // px, from the middle to where the spheres begin
  for (const auto& sphere : picture.finger) {
    const Point at = view(sphere.centre);
    before = std::max(before, view.scale * sphere.radius + (middle.x - at.x) * ahead.x +
                                  (middle.y - at.y) * ahead.y);
  }
  const auto back = [&](double by) {
    return Point{middle.x - by * ahead.x, middle.y - by * ahead.y};
  };
  const Point tail = back(before + 43.0);
  return arrow(tail, back(before + 5.0), 12.0) +
         label({tail.x + 10.0, tail.y + (ahead.y < 0.0 ? 0.0 : 12.0)}, halo,
               mm_text(picture.travel));
}

std::string lines(const std::vector<std::array<Vec3, 2>>& edges, const View& view,
                  const std::string& attributes) {
  std::string path;
  for (const auto& [from, to] : edges) path += "M" + view(from).text() + "L" + view(to).text();
  return path.empty() ? path : "<path d=\"" + path + "\" fill=\"none\"" + attributes + "/>\n";
}

// Where centred texts stand, so that no further one is put over them.
class Places {
 public:
  explicit Places(double letters) : letters_(letters) {}  // px, their height
  // Whether a text has room; it takes it then.
  bool take(const Point& at, const std::string& text) {
    constexpr double wide = 0.3;  // half of a digit's width with its part of a blank, in heights
    const double half = wide * letters_ * (static_cast<double>(text.size()) + 0.5);
    for (const auto& [other, other_half] : taken_)
      if (std::abs(at.x - other.x) < half + other_half && std::abs(at.y - other.y) < letters_)
        return false;
    taken_.emplace_back(at, half);
    return true;
  }

 private:
  double letters_;
  std::vector<std::pair<Point, double>> taken_;
};

// The edges of the box, behind the body, with the numbers along its axes. A narrow page, whose
// letters are larger, hides the units and the numbers for which it has no room.
std::string box(const SceneFrame& frame, const View& view) {
  constexpr double letters = 12.0, narrow = 1.8 * letters;  // px; 1.8: the style of the page
  Places wide_places(letters), narrow_places(narrow);
  std::vector<SceneLabel> all = frame.labels;
  const auto is_name = [](const SceneLabel& one) { return one.text.ends_with(" (mm)"); };
  std::stable_partition(all.begin(), all.end(), is_name);  // which have the first choice
  const std::string hidden = " class=\"more\"";
  std::string labels;
  for (const SceneLabel& one : all) {
    const Point at = view(one.at);
    if (!wide_places.take(at, one.text)) continue;
    const std::string short_text = one.text.substr(0, one.text.find(' '));
    const bool fits = narrow_places.take(at, short_text);
    std::string text = label({at.x, at.y + 4.0}, fits ? "" : hidden, short_text);
    if (is_name(one)) text.insert(text.rfind("</text>"), "<tspan" + hidden + "> (mm)</tspan>");
    labels += text;
  }
  return lines(frame.lines, view, " stroke=\"#8b949e\" stroke-width=\"0.8\"") +
         "<g class=\"ink\" font-size=\"12\" fill=\"#444\" text-anchor=\"middle\">\n" + labels +
         "</g>\n";
}

std::string legend(const ScenePicture& picture) {
  std::string text;
  double y = first_entry;
  const auto entry = [&](const Colour& fill, const std::string& words) {
    text += "<rect x=\"" + px(margin) + "\" y=\"" + px(y - 10.0) +
            "\" width=\"12\" height=\"12\" fill=\"" + hex(fill, 1.0) +
            "\" stroke=\"#777\" stroke-width=\"0.6\"/>\n" +
            label({margin + 19.0, y}, " stroke=\"none\"", words);
    y += entry_height;
  };
  const std::vector<Colour> colours = region_colours(picture);
  for (std::size_t i = 0; picture.materials.size() > 1 && i < picture.materials.size(); ++i)
    entry(colours[i], i == 0 || picture.materials[i] == ScenePicture::cavity
                          ? picture.materials[i]
                          : picture.materials[i] + " (region " + std::to_string(i) + ")");
  if (!picture.base.empty()) entry(held_colour, picture.base);
  return text;
}

constexpr const char* gradient =
    "<defs><radialGradient id=\"ball\" cx=\"0.36\" cy=\"0.3\" r=\"0.75\"><stop offset=\"0\" "
    "stop-color=\"#f4f7fb\"/><stop offset=\"0.45\" stop-color=\"#aebccd\"/><stop offset=\"1\" "
    "stop-color=\"#5d6c80\"/></radialGradient></defs>\n";

}  // namespace

std::vector<std::string> scene_colours(const ScenePicture& picture) {
  std::vector<std::string> colours;
  for (const Colour& colour : region_colours(picture)) colours.push_back(hex(colour, 1.0));
  colours.push_back(hex(held_colour, 1.0));
  return colours;
}

SceneAngles scene_angles(const ScenePicture& picture) {
  SceneAngles best{30.0, picture.towards.z() > 0.7 ? -30.0 : 30.0};
  double most = -2.0;
  for (const double around : {30.0, -60.0, 120.0, -150.0}) {
    const double facing = -picture.towards.dot(directions({around, 0.0}).towards);
    if (facing < most + 0.2) continue;
    most = facing;
    best.around = around;
  }
  return best;
}

SceneFrame scene_frame(const ScenePicture& picture) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Vec3 low = Vec3::Constant(inf), high = Vec3::Constant(-inf);
  for (const auto& face : picture.faces)
    for (const Vec3& corner : face.corners) {
      const Vec3 own = picture.axes.transpose() * corner;
      low = low.cwiseMin(own);
      high = high.cwiseMax(own);
    }
  const double size = (high - low).norm();
  const View view = directions(scene_angles(picture));
  SceneFrame frame;
  for (int axis = 0; axis < 3; ++axis) {
    const int second = (axis + 1) % 3, third = (axis + 2) % 3;
    // Of the two edges at the rim of the picture the lower one, or the left one of upright axes.
    double least = inf;
    Vec3 start = low, outwards = Vec3::Zero();
    for (const double far : {-1.0, 1.0})
      for (const double above : {-1.0, 1.0}) {
        Vec3 corner = low, out = Vec3::Zero();
        out[second] = far;
        out[third] = above;
        if (far > 0.0) corner[second] = high[second];
        if (above > 0.0) corner[third] = high[third];
        Vec3 end = corner;
        end[axis] = high[axis];
        frame.lines.push_back({picture.axes * corner, picture.axes * end});
        const auto seen = [&](int side) {
          return out[side] * picture.axes.col(side).dot(view.towards) > 0.0;
        };
        const bool upright = std::abs(picture.axes.col(axis).z()) > 0.7;
        const double rank = (picture.axes * corner).dot(upright ? view.right : view.up);
        if (seen(second) == seen(third) || rank >= least) continue;
        least = rank;
        start = corner;
        outwards = out.normalized();
      }
    // Three to seven numbers, 1, 2 or 5 times a power of ten apart.
    const double span = unit::mm.from_si(high[axis] - low[axis]);
    if (!(span > 0.0)) continue;
    double step = std::pow(10.0, std::floor(std::log10(span / 3.0)));
    step *= span / (5.0 * step) >= 3.0 ? 5.0 : span / (2.0 * step) >= 3.0 ? 2.0 : 1.0;
    // Fewer where the axis is seen from its end.
    const Vec3 direction = picture.axes.col(axis);
    const double seen_length = std::hypot(direction.dot(view.right), direction.dot(view.up));
    constexpr double apart = 0.04;  // of the size
    if (const double shortest = apart * unit::mm.from_si(size) / seen_length; step < shortest) {
      step = std::pow(10.0, std::floor(std::log10(shortest)));
      step *= shortest <= 2.0 * step ? 2.0 : shortest <= 5.0 * step ? 5.0 : 10.0;
    }
    const auto at = [&](double along, double away) -> Vec3 {
      Vec3 place = start + away * size * outwards;
      place[axis] = along;
      return picture.axes * place;
    };
    for (double i = std::ceil(unit::mm.from_si(low[axis]) / step - 1e-6);
         i * step <= unit::mm.from_si(high[axis]) + 1e-6 * step; ++i) {
      const double along = unit::mm.to_si(i * step);
      frame.lines.push_back({at(along, 0.0), at(along, 0.015)});
      frame.labels.push_back({at(along, 0.045), rounded_text(i * step + 0.0, 6)});
    }
    frame.labels.push_back({at(0.5 * (low[axis] + high[axis]), 0.11),
                            std::string(axis_names[as_index(axis)]) + " (mm)"});
  }
  return frame;
}

std::vector<std::array<Vec3, 2>> base_border(const ScenePicture& picture) {
  using Key = std::array<double, 3>;
  std::map<std::pair<Key, Key>, int> uses;
  for (const auto& face : picture.faces)
    for (std::size_t i = 0; face.held && i < 3; ++i) {
      const Vec3& a = face.corners[i];
      const Vec3& b = face.corners[(i + 1) % 3];
      ++uses[std::minmax(Key{a.x(), a.y(), a.z()}, Key{b.x(), b.y(), b.z()})];
    }
  std::vector<std::array<Vec3, 2>> border;
  for (const auto& [edge, count] : uses)
    if (count == 1)
      border.push_back({Vec3(edge.first[0], edge.first[1], edge.first[2]),
                        Vec3(edge.second[0], edge.second[1], edge.second[2])});
  return border;
}

std::string scene_svg(const ScenePicture& picture, const std::string& title) {
  assert(!picture.faces.empty());
  const SceneFrame frame = scene_frame(picture);
  const View view = fitting(picture, frame);
  const std::vector<std::array<Vec3, 2>> border = base_border(picture);
  const std::string held = " class=\"border\" stroke=\"" + hex(held_colour, 0.8) + "\"";
  const std::string size = "width=\"" + px(width) + "\" height=\"" + px(height) + "\"";
  // What stands before the body is dark on every page.
  const std::string before = "<g fill=\"#222\" stroke=\"#222\" stroke-width=\"1.6\">\n";
  std::string text =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + px(width) + " " + px(height) +
      "\" " + size + " font-family=\"sans-serif\" font-size=\"14\">\n<title>" + escaped(title) +
      "</title>\n" + gradient + "<rect class=\"back\" " + size + " fill=\"#fff\"/>\n" +
      box(frame, view) + lines(border, view, held + " stroke-width=\"2.4\"") +
      specimen(picture, view) + lines(border, view, held + " stroke-dasharray=\"4 4\"") + before +
      slides(picture, view) + "</g>\n";
  if (!picture.finger.empty())
    text += "<g fill=\"url(#ball)\" stroke=\"#4a5666\" stroke-width=\"0.8\">\n" +
            finger(picture, view) +
            "</g>\n<g class=\"ink\" fill=\"#222\" stroke=\"#222\" stroke-width=\"1.6\">\n" +
            press(picture, view) + "</g>\n";
  if (!picture.load.empty()) text += before + load(picture, view) + "</g>\n";
  text +=
      "<g class=\"ink names\" fill=\"#222\">\n" + label({margin, 40.0}, " font-size=\"18\"", title);
  return text + legend(picture) + "</g>\n</svg>\n";
}

namespace {

using page::element;
using page::Markup;

// Millimetres, rounded to a hundredth.
std::string mm(double metres) {
  return number_text(std::round(100.0 * unit::mm.from_si(metres)) / 100.0 + 0.0);
}

std::string places(const Vec3& place) {
  return mm(place.x()) + "," + mm(place.y()) + "," + mm(place.z());
}

// What the script draws: triangles with their region, spheres, and the colours of the regions.
std::string data(const record::ScenePicture& picture) {
  std::string faces, spheres, colours;
  for (const auto& face : picture.faces) {
    for (const Vec3& corner : face.corners) faces += places(corner) + ",";
    const std::size_t colour = face.held ? picture.materials.size() : as_index(face.region);
    faces += std::to_string(colour) + "," + (face.within >= 0 ? "1" : "0") + ",";
  }
  const SceneFrame frame = scene_frame(picture);
  const auto add = [](std::string& list, const std::vector<std::array<Vec3, 2>>& edges) {
    for (const auto& [from, to] : edges) list += places(from) + "," + places(to) + ",";
  };
  std::string lines, border, labels;
  add(lines, frame.lines);
  add(border, base_border(picture));
  const auto add_arrow = [&](const Vec3& tip, double length) {
    const Vec3 tail = tip - length * picture.towards;
    const Vec3 neck = 0.75 * tip + 0.25 * tail;
    const Vec3 side = 0.13 * length * picture.towards.unitOrthogonal();
    add(border, {{tail, tip}, {tip, neck + side}, {tip, neck - side}});
  };
  if (!picture.finger.empty()) {
    const auto& [centre, radius] = picture.finger.front();
    add_arrow(centre - 1.1 * radius * picture.towards, 1.5 * radius);
  }
  if (!picture.load.empty()) {
    const auto& [middle, corner, other, third, fourth] = loaded_places(picture);
    for (const Vec3& place : {middle, corner, other, third, fourth})
      add_arrow(place, 1.5 * (corner - middle).norm());
  }
  for (const SceneLabel& one : frame.labels)
    labels += "[" + places(one.at) + ",\"" + one.text + "\"],";
  for (const auto& sphere : picture.finger)
    spheres += places(sphere.centre) + "," + mm(sphere.radius) + ",";
  for (const std::string& one : scene_colours(picture)) colours += "\"" + one + "\",";
  std::string text;
  const auto name = [&](const char* word, std::string& list) {
    if (!list.empty()) list.pop_back();
    text += (text.empty() ? "{\"" : ",\"") + std::string(word) + "\":[" + list + "]";
  };
  name("faces", faces);
  name("spheres", spheres);
  name("lines", lines);
  name("border", border);
  name("labels", labels);
  name("colours", colours);
  return text + "}";
}

Markup slider(const std::string& id, const std::string& label, const std::string& low,
              const std::string& high, const std::string& value) {
  return element("label", page::text(label) + element("input", Markup(),
                                                      {{"type", "range"},
                                                       {"id", id},
                                                       {"min", low},
                                                       {"max", high},
                                                       {"step", "5"},
                                                       {"value", value}}));
}

}  // namespace

Markup scene_view(const record::ScenePicture& picture, const std::string& title) {
  std::vector<std::string> materials;
  for (const std::string& material : picture.materials)
    if (std::ranges::find(materials, material) == materials.end()) materials.push_back(material);
  std::string words = "Specimen of " + joined(materials, ", ");
  words += picture.finger.empty()
               ? " between two plates; the arrows are the load, " + picture.load + "."
               : " and finger at first contact; the arrow is the largest displacement, " +
                     mm(picture.travel) + " mm.";
  Markup inner = element("div", page::inline_svg(scene_svg(picture, title), "scene", words),
                         {{"id", "scene-still"}});
  const SceneAngles angles = scene_angles(picture);
  inner += element("canvas", Markup(),
                   {{"id", "scene-canvas"},
                    {"width", "800"},
                    {"height", "640"},
                    {"role", "img"},
                    {"aria-label", words},
                    {"hidden", "hidden"}}) +
           element("div",
                   slider("scene-around", "Turn", "-180", "180", number_text(angles.around)) +
                       slider("scene-tilt", "Tilt", "-90", "90", number_text(angles.tilt)),
                   {{"class", "turn"}, {"id", "scene-turn"}, {"hidden", "hidden"}}) +
           element("script", Markup::ready(data(picture)),
                   {{"type", "application/json"}, {"id", "scene-data"}});
  return element("figure", inner + element("figcaption", words));
}

// Parallel projection, painter's algorithm and flat shading, as in the still picture.
std::string scene_script() {
  return R"js(
(() => {
  const at = id => document.getElementById(id);
  if (!at("scene-data")) return;
  const scene = JSON.parse(at("scene-data").textContent), pen = at("scene-canvas").getContext("2d");
  const points = [];
  for (let i = 0; i < scene.faces.length; i += 11)
    for (let k = 0; k < 9; k += 3) points.push(scene.faces.slice(i + k, i + k + 3));
  const ends = [0, 1, 2].map(k => [Math.min(...points.map(p => p[k])),
                                   Math.max(...points.map(p => p[k]))]);
  for (let i = 0; i < scene.spheres.length; i += 4)
    ends[2][1] = Math.max(ends[2][1], scene.spheres[i + 2] + scene.spheres[i + 3]);
  const middle = ends.map(e => (e[0] + e[1]) / 2);
  const scale = 560 / Math.hypot(...ends.map(e => e[1] - e[0]));
  const now = word => getComputedStyle(document.documentElement).getPropertyValue(word);
  const shade = (colour, light) => "#" + [1, 3, 5].map(i => Math.min(255, Math.max(0, Math.round(
    light * parseInt(colour.slice(i, i + 2), 16)))).toString(16).padStart(2, "0")).join("");
  const draw = () => {
    const a = at("scene-around").value * Math.PI / 180, t = at("scene-tilt").value * Math.PI / 180;
    const right = [Math.cos(a), Math.sin(a), 0];
    const up = [-Math.sin(t) * Math.sin(a), Math.sin(t) * Math.cos(a), Math.cos(t)];
    const eye = [right[1] * up[2] - right[2] * up[1], right[2] * up[0] - right[0] * up[2],
                 right[0] * up[1] - right[1] * up[0]];
    const dot = (p, q) => p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    const flat = p => { const d = p.map((x, k) => x - middle[k]);
      return [400 + scale * dot(d, right), 320 - scale * dot(d, up), dot(d, eye)]; };
    const shapes = [];
    for (let i = 0; i < scene.faces.length; i += 11) {
      const [p, q, r] = [0, 3, 6].map(k => scene.faces.slice(i + k, i + k + 3));
      const u = q.map((x, k) => x - p[k]), v = r.map((x, k) => x - p[k]);
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const size = Math.hypot(...n) || 1;
      if (dot(n, eye) <= 0) continue;
      const corners = [p, q, r].map(flat), inside = scene.faces[i + 10];
      const light = .74 + .3 * dot(n, [-.35, -.45, .82]) / size;
      shapes.push({ depth: (corners[0][2] + corners[1][2] + corners[2][2]) / 3 - (inside ? 1e6 : 0),
        colour: shade(scene.colours[scene.faces[i + 9]] || "#888888", light), corners,
        alpha: scene.colours.length > 2 && !inside ? .5 : 1 });
    }
    for (let i = 0; i < scene.spheres.length; i += 4) {
      const c = flat(scene.spheres.slice(i, i + 3));
      shapes.push({ depth: c[2], centre: c, radius: scale * scene.spheres[i + 3], alpha: 1 });
    }
    shapes.sort((p, q) => p.depth - q.depth);
    pen.clearRect(0, 0, 800, 640);
    const edges = (list, colour, width) => {
      pen.globalAlpha = 1; pen.strokeStyle = colour; pen.lineWidth = width; pen.beginPath();
      for (let i = 0; i < list.length; i += 6) {
        pen.moveTo(...flat(list.slice(i, i + 3))); pen.lineTo(...flat(list.slice(i + 3, i + 6))); }
      pen.stroke(); pen.lineWidth = 1;
    };
    edges(scene.lines, "#8b949e", 1);
    for (const s of shapes) {
      pen.globalAlpha = s.alpha; pen.beginPath();
      if (s.centre) { pen.arc(s.centre[0], s.centre[1], s.radius, 0, 7); pen.fillStyle = "#aebccd";
        pen.strokeStyle = "#4a5666"; }
      else { s.corners.forEach(c => pen.lineTo(c[0], c[1])); pen.closePath();
        pen.fillStyle = pen.strokeStyle = s.colour; }
      pen.fill(); pen.stroke();
    }
    edges(scene.border, now("--soft"), 1.5);
    pen.fillStyle = now("--ink"); pen.textAlign = "center"; pen.font = "12px sans-serif";
    pen.strokeStyle = now("--back"); pen.lineWidth = 3; pen.lineJoin = "round";
    const taken = [];  // names first; a number for which there is no room is not drawn
    for (const [x, y, z, words] of [...scene.labels].sort((p, q) => q[3].length - p[3].length)) {
      const at = flat([x, y, z]), half = pen.measureText(words).width / 2 + 2;
      if (taken.some(t => Math.abs(t[0] - at[0]) < t[2] + half && Math.abs(t[1] - at[1]) < 12))
        continue;
      taken.push([at[0], at[1], half]);
      pen.strokeText(words, at[0], at[1] + 4); pen.fillText(words, at[0], at[1] + 4); }
    pen.lineWidth = 1;
  };
  at("scene-turn").hidden = false;
  for (const id of ["scene-around", "scene-tilt"]) at(id).addEventListener("input", () => {
    at("scene-still").hidden = true; at("scene-canvas").hidden = false; draw(); });
})();
)js";
}

}  // namespace palpate::report
