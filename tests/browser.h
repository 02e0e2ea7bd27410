// Pages opened in a real browser, Debian's chromium: what its console says, what a reader could not
// read or reach, and how a page looks.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "program.h"

namespace palpate::test {

enum class Scheme { light, dark };

// One start of the browser, without a network, with an empty profile.
inline Ended browse(const fs::path& page, Scheme scheme, const std::vector<std::string>& more) {
  const TemporaryFolder profile;
  std::vector<std::string> arguments{"--headless",
                                     "--no-sandbox",
                                     "--disable-gpu",
                                     "--disable-quic",
                                     "--no-first-run",
                                     "--disable-background-networking",
                                     "--disable-component-update",
                                     "--disable-sync",
                                     "--host-resolver-rules=MAP * ~NOTFOUND",
                                     "--allow-file-access-from-files",
                                     "--enable-logging=stderr",
                                     "--hide-scrollbars",
                                     "--virtual-time-budget=20000",
                                     "--user-data-dir=" + profile.path().string()};
  arguments.push_back(std::string("--blink-settings=preferredColorScheme=") +
                      (scheme == Scheme::dark ? "0" : "1"));
  arguments.insert(arguments.end(), more.begin(), more.end());
  arguments.push_back("file://" + page.string());
  return run_program({.arguments = arguments, .program = "chromium"});
}

// A page that opens others in frames of 360, 390 and 1400 px, and as on paper, and lists their
// faults.
inline std::string inspection(const std::vector<std::string>& pages) {
  std::string list;
  for (const std::string& page : pages) list += "\"" + page + "\",";
  return "<!DOCTYPE html><html lang=en><body><pre id=found></pre><script>const pages = [" + list +
         R"js(];
const found = [], say = (page, what) => found.push(page + ": " + what);
const light = c => { const [r, g, b] = c.map(x => { x /= 255;
  return x <= .04045 ? x / 12.92 : ((x + .055) / 1.055) ** 2.4; });
  return .2126 * r + .7152 * g + .0722 * b; };
const parts = text => text.match(/[0-9.]+/g).map(Number);
function ground(element, view) {
  for (let e = element; e; e = e.parentElement) {
    const c = parts(view.getComputedStyle(e).backgroundColor);
    if (c.length === 3 || c[3] > 0) return c.slice(0, 3);
  }
  return matchMedia("(prefers-color-scheme: dark)").matches ? [23, 23, 23] : [255, 255, 255];
}
const ratio = (a, b) => (Math.max(a, b) + .05) / (Math.min(a, b) + .05);
// A colour of a figure as the page shows it: filter: invert(.91) hue-rotate(180deg) in the dark.
function shown(colour) {
  const c = parts(colour).slice(0, 3);
  if (!matchMedia("(prefers-color-scheme: dark)").matches) return c;
  const i = c.map(x => 255 * .91 - .82 * x);
  return [[-.574, 1.43, .144], [.426, .43, .144], [.426, 1.43, -.856]].map(row =>
    Math.min(255, Math.max(0, row.reduce((sum, m, k) => sum + m * i[k], 0))));
}
// Lines below 3 to 1 and letters below 4.5 to 1; the grid is no line.
function figures(page, view, all) {
  const white = light(shown("rgb(255,255,255)")), poor = new Set();
  for (const e of all(".plot svg path, .plot svg line, .plot svg polyline, .plot svg use, .plot svg text")) {
    const style = view.getComputedStyle(e), letters = e.tagName === "text";
    const colour = letters ? style.fill : style.stroke !== "none" ? style.stroke : style.fill;
    if (colour === "none" || colour === "rgb(220, 220, 220)" || colour.startsWith("url") ||
        colour === "rgb(255, 255, 255)" || e.closest("defs")) continue;
    const seen = ratio(light(shown(colour)), white);
    if (seen < (letters ? 4.5 : 3)) poor.add((letters ? "letters" : "lines") + " of " + colour + " with " + seen.toFixed(2));
  }
  poor.forEach(what => say(page, "has " + what + " to 1 in a figure"));
}
// Texts of a figure that stand over each other; gnuplot draws some twice at one place.
function crowded(page, width, all) {
  for (const s of all(".plot svg, #scene-still svg")) {
    const texts = [...s.querySelectorAll("text")].filter(t => t.checkVisibility() && t.textContent.trim())
      .map(t => ({ words: t.textContent.trim(), box: t.getBoundingClientRect() }));
    texts.forEach((one, i) => texts.slice(0, i).forEach(other => {
      const a = one.box, b = other.box;
      const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const along = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      const twice = one.words === other.words && Math.abs(a.left - b.left) < 1 && Math.abs(a.top - b.top) < 1;
      if (across > 1 && along > .4 * Math.min(a.height, b.height) && !twice)
        say(page, "has " + one.words + " over " + other.words + " in a figure at " + width + " px");
    }));
  }
}
// The page with the rules of paper, in the width between the margins of A4 at 96 dpi.
const paper = 718;
function print(page, frame) {
  const d = frame.contentDocument, all = q => [...d.querySelectorAll(q)];
  all("details").forEach(e => e.open = true);
  all("style").forEach(s => s.textContent = s.textContent.replaceAll("@media print", "@media all"));
  crowded(page, "paper's " + paper, all);
  const names = new Set();
  for (const e of all("main *, header *"))
    if (e.checkVisibility() && !e.closest("svg") && e.getBoundingClientRect().right > paper + 1)
      names.add((e.closest("table")?.caption ?? e).textContent.slice(0, 30));
  names.forEach(name => say(page, "is cut on paper: " + name));
}
function look(page, width, frame) {
  const d = frame.contentDocument, view = frame.contentWindow, all = q => [...d.querySelectorAll(q)];
  for (const t of all(".wide"))
    if (!t.closest("details:not([open])") && t.scrollWidth > t.clientWidth + 1) say(page, "has a table that is cut at " + width + " px");
  all("details").forEach(e => e.open = true);
  figures(page, view, all);
  crowded(page, width, all);
  if (width === 1400) for (const e of all(".beside, .result"))
    if (e.getBoundingClientRect().bottom > 900) say(page, "has its " + e.className + " beyond the first screen");
  const wide = d.documentElement.scrollWidth;
  if (wide > width) say(page, "is " + wide + " px wide in a window of " + width);
  const ids = all("[id]").map(e => e.id);
  ids.filter((id, i) => ids.indexOf(id) < i).forEach(id => say(page, "has the id " + id + " twice"));
  for (const a of all("a[href]")) {
    const to = a.getAttribute("href");
    if (to.startsWith("#")) { if (!d.getElementById(to.slice(1))) say(page, "links to no place " + to); }
    else found.push("LINK " + page + " " + to);
  }
  for (const e of all("[src],link[href]")) {
    const from = e.getAttribute("src") || e.getAttribute("href");
    if (!from.startsWith("data:")) say(page, "loads " + from);
  }
  all("use").forEach(u => { const to = u.getAttribute("xlink:href") || u.getAttribute("href");
    if (!d.getElementById(to.slice(1))) say(page, "draws no element " + to); });
  for (const i of all("img")) {
    if (!i.hasAttribute("alt")) say(page, "has a picture without words");
    if (!i.naturalWidth) say(page, "has a picture that cannot be decoded");
  }
  for (const s of all(".plot svg, #scene-still svg")) {
    const box = s.getBoundingClientRect();
    if (!box.width || s.closest("details")) continue;
    if (box.right > width) say(page, "has a figure that is cut at " + width + " px");
    for (const t of view.getComputedStyle(s).overflow === "visible" ? [] : s.querySelectorAll("text")) {
      const b = t.getBoundingClientRect();
      if (b.width && t.checkVisibility() && (b.left < box.left - 1 || b.right > box.right + 1))
        say(page, "has " + t.textContent.trim() + " beyond the edge of a figure at " + width + " px");
    }
    const sizes = [...s.querySelectorAll("text")].map(t => parseFloat(view.getComputedStyle(t).fontSize) *
      (t.getScreenCTM() ? Math.hypot(t.getScreenCTM().a, t.getScreenCTM().b) : 0)).filter(x => x > 0);
    if (s.closest(".plot") && sizes.length && Math.min(...sizes) < 7)
      say(page, "has letters of " + Math.min(...sizes).toFixed(1) + " px in a figure at " + width + " px");
  }
  all("svg").forEach(s => { if (!s.getAttribute("aria-label")) say(page, "has a figure without words"); });
  all("table").forEach(t => { if (!t.caption || !t.querySelector("th[scope]"))
    say(page, "has a table without caption or headings"); });
  all("input").forEach(i => { if (!i.labels.length) say(page, "has an input without a label"); });
  if (all("h1").length !== 1 || all("main").length !== 1 || !d.documentElement.lang)
    say(page, "has not one h1, one main and a language");
  const walk = d.createTreeWalker(d.body, NodeFilter.SHOW_TEXT);
  for (let node; (node = walk.nextNode());) {
    const e = node.parentElement;
    if (!node.data.trim() || e.closest("svg,script,style") || !e.offsetParent) continue;
    const parted = node.data.match(/[0-9] (%|mm|N|kPa|s|ms|Pa|1\/m)(?![A-Za-z0-9])/);
    if (parted && !e.closest("pre,code")) say(page, "may part a number from its unit in " + parted[0]);
    const seen = ratio(light(parts(view.getComputedStyle(e).color)), light(ground(e, view)));
    if (seen < 4.5) say(page, "has a contrast of " + seen.toFixed(2) + " in " + node.data.slice(0, 30));
  }
  return all("h2").length;
}
(async () => {
  for (const page of pages) for (const width of [360, 390, 1400, paper]) {
    const frame = document.createElement("iframe");
    frame.style.width = width + "px"; frame.style.height = "900px"; frame.style.border = "0";
    document.body.append(frame);
    await new Promise(go => { frame.onload = go; frame.src = page; });
    if (width === paper) print(page, frame);
    found.push("SEEN " + page + " " + width + " " + (width === paper ? 0 : look(page, width, frame)));
    frame.remove();
  }
  document.getElementById("found").textContent = "BEGIN\n" + found.join("\n") + "\nEND";
})();
</script></body></html>)js";
}

// What is wrong with these pages, given relative to `folder`; empty if nothing is.
inline std::vector<std::string> faults_of_pages(const fs::path& folder,
                                                const std::vector<std::string>& pages,
                                                Scheme scheme) {
  const fs::path page = folder / "inspection.html";
  write_file(page, inspection(pages));
  const Ended ended = browse(page, scheme, {"--dump-dom"});
  std::vector<std::string> faults;
  std::istringstream errors(ended.err);
  for (std::string line; std::getline(errors, line);)
    if (line.find(":CONSOLE") != std::string::npos) faults.push_back(line);
  const std::size_t begin = ended.out.find("BEGIN\n"), end = ended.out.find("\nEND");
  if (begin == std::string::npos || end == std::string::npos)
    return {"chromium ended with " + std::to_string(ended.code) + " and said " +
            ended.err.substr(0, 2000)};
  std::istringstream lines(ended.out.substr(begin + 6, end - begin - 6));
  std::size_t seen = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind, of, to;
    words >> kind >> of >> to;
    if (kind == "SEEN")
      ++seen;
    else if (kind != "LINK")
      faults.push_back(line);
    else if (!fs::exists((folder / of).parent_path() / to))
      faults.push_back(of + " links to " + to + ", which is not there");
  }
  if (seen != 4 * pages.size()) faults.push_back("not every page was opened at each width");
  return faults;
}

// How light a page is, 0 to 255, in 12 columns and 16 rows of a window of 900 x 1200 px.
inline std::vector<double> lightness(const fs::path& page, Scheme scheme) {
  const TemporaryFolder folder;
  const fs::path shot = folder / "shot.png";
  const Ended taken =
      browse(page, scheme, {"--window-size=900,1200", "--screenshot=" + shot.string()});
  EXPECT_TRUE(fs::exists(shot)) << taken.err.substr(0, 2000);
  write_file(folder / "read.html", R"js(<!DOCTYPE html><html><body><pre id=found></pre><script>
const image = new Image();
image.onload = () => {
  const canvas = document.createElement("canvas"), pen = canvas.getContext("2d"), all = [];
  canvas.width = image.width; canvas.height = image.height; pen.drawImage(image, 0, 0);
  const w = Math.floor(image.width / 12), h = Math.floor(image.height / 16);
  for (let r = 0; r < 16; ++r) for (let c = 0; c < 12; ++c) {
    const d = pen.getImageData(c * w, r * h, w, h).data; let sum = 0;
    for (let i = 0; i < d.length; i += 4) sum += .2126 * d[i] + .7152 * d[i + 1] + .0722 * d[i + 2];
    all.push((4 * sum / d.length).toFixed(0));
  }
  document.getElementById("found").textContent = "BEGIN " + all.join(" ") + " END";
};
image.src = "shot.png";
</script></body></html>)js");
  const Ended read = browse(folder / "read.html", Scheme::light, {"--dump-dom"});
  std::vector<double> all;
  const std::size_t begin = read.out.find("BEGIN ");
  if (begin == std::string::npos) return all;
  std::istringstream numbers(read.out.substr(begin + 6));
  for (double number = 0.0; numbers >> number;) all.push_back(number);
  return all;
}

}  // namespace palpate::test
