// The scene's picture on a page, to turn.
#include <cmath>
#include <string>
#include <vector>

#include "base/text.h"
#include "base/units.h"
#include "page/html.h"
#include "page/page.h"
#include "report/scene_picture.h"

namespace palpate::report {
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
  if (!picture.finger.empty()) {  // the arrow of the press
    const auto& [centre, radius] = picture.finger.front();
    const Vec3 tip = centre - 1.1 * radius * picture.towards;
    const Vec3 tail = tip - 1.5 * radius * picture.towards;
    const Vec3 neck = 0.75 * tip + 0.25 * tail;
    const Vec3 side = 0.2 * radius * picture.towards.unitOrthogonal();
    add(border, {{tail, tip}, {tip, neck + side}, {tip, neck - side}});
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
  std::string words = "Specimen";
  for (const std::string& material : picture.materials)
    words += (&material == picture.materials.data() ? " of " : ", ") + material;
  words += picture.finger.empty()
               ? std::string(" before anything moves.")
               : " and finger at its first touch; the arrow is the deepest travel, " +
                     mm(picture.travel) + " mm.";
  Markup inner = element("div", page::inline_svg(scene_svg(picture, title), "scene", words),
                         {{"class", "sheet white"}, {"id", "scene-still"}});
  const SceneAngles angles = scene_angles(picture);
  inner += element("canvas", Markup(),
                   {{"id", "scene-canvas"},
                    {"class", "white"},
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
    edges(scene.lines, "#9aa3ad", 1);
    for (const s of shapes) {
      pen.globalAlpha = s.alpha; pen.beginPath();
      if (s.centre) { pen.arc(s.centre[0], s.centre[1], s.radius, 0, 7); pen.fillStyle = "#aebccd";
        pen.strokeStyle = "#4a5666"; }
      else { s.corners.forEach(c => pen.lineTo(c[0], c[1])); pen.closePath();
        pen.fillStyle = pen.strokeStyle = s.colour; }
      pen.fill(); pen.stroke();
    }
    edges(scene.border, "#4a586e", 1.5);
    pen.fillStyle = "#444"; pen.textAlign = "center"; pen.font = "12px sans-serif";
    for (const [x, y, z, words] of scene.labels) {
      const at = flat([x, y, z]); pen.fillText(words, at[0], at[1] + 4); }
  };
  at("scene-turn").hidden = false;
  for (const id of ["scene-around", "scene-tilt"]) at(id).addEventListener("input", () => {
    at("scene-still").hidden = true; at("scene-canvas").hidden = false; draw(); });
})();
)js";
}

}  // namespace palpate::report
