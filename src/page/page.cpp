// Puts a page together.
#include "page/page.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "base/text.h"
#include "base/written.h"

#ifndef PALPATE_VERSION
#define PALPATE_VERSION "unknown"
#endif

namespace palpate::page {

const char* style() {
  return R"css(
:root { color-scheme: light dark; --back: #ffffff; --ink: #1b1f24; --soft: #57606a;
  --line: #d0d7de; --card: #f6f8fa; --link: #0b5cad; --fail: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --back: #171717; --ink: #e6e8eb; --soft: #a2abb5;
  --line: #3a424b; --card: #1e2329; --link: #7cb7ff; --fail: #ff8f85; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1rem 1.2rem 3rem; max-width: 62rem; background: var(--back);
  color: var(--ink); font: 1rem/1.55 system-ui, sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: .2rem 0 .6rem; }
h2 { font-size: 1.25rem; margin: 2.2rem 0 .6rem; padding-top: .6rem;
  border-top: 1px solid var(--line); }
h3 { font-size: 1.05rem; margin: 1.4rem 0 .3rem; }
a { color: var(--link); } a:focus-visible, summary:focus-visible, .wide:focus-visible,
input:focus-visible { outline: 3px solid var(--link); outline-offset: 2px; }
.skip { position: absolute; left: -999rem; } .skip:focus { position: static; }
.kind { color: var(--soft); margin: 0; }
.big { font-size: clamp(1.4rem, 5.5vw, 2rem); font-weight: 600; line-height: 1.2; }
.big span { font-size: .65em; font-weight: 400; } .failure { color: var(--fail); }
.result { background: var(--card); border-left: .35rem solid var(--link); padding: .6rem 1rem;
  font-size: 1.08rem; } .result p { margin: .35rem 0; }
main section:first-child h2 { margin-top: .8rem; } .beside > * { margin: 0; }
@media screen and (min-width: 75rem) { body:has(.beside), body:has(.cards) { max-width: 84rem; }
  header:has(.beside) { display: grid; grid-template: auto 1fr / minmax(0, 1fr) minmax(0, 40rem);
    column-gap: 2rem; } .said, nav { grid-column: 1; } .beside { grid-area: 1 / 2 / 3 / 3; }
  .beside svg { max-height: calc(100vh - 7rem); } .figures { display: grid; gap: 0 2rem;
    grid-template-columns: 1fr 1fr; } main p, main li, main pre { max-width: 60rem; } }
nav ul { list-style: none; padding: 0; margin: .7rem 0; display: flex; flex-wrap: wrap; gap: .2rem 1.2rem; }
figure { margin: 1rem 0 1.6rem; break-inside: avoid; }
figcaption, caption { color: var(--soft); text-align: left; padding: .3rem 0; font-size: .95rem; }
figure svg { display: block; width: 100%; max-width: 40rem; height: auto; }
@media screen and (max-width: 37rem) { .plot svg text { font-size: 1.15em; }
  #scene-still text { font-size: 1.8em; } #scene-still .names text { font-size: 1.5em; } #scene-still .more { display: none; } .wide td { overflow-wrap: anywhere; } }
#scene-still .back { fill: none; } #scene-still .ink { fill: var(--ink); }
#scene-still .ink[stroke] { stroke: var(--ink); } #scene-still .border { stroke: var(--soft); }
#scene-still .halo { fill: var(--ink); stroke: var(--back); }
@media (prefers-color-scheme: dark) { .plot svg { filter: invert(.91) hue-rotate(180deg); }
  .map svg g[shape-rendering="crispEdges"] { filter: invert(1) hue-rotate(180deg); } }
.maps { display: flex; flex-wrap: wrap; gap: 1.2rem; } .maps figure { margin: 0; width: 17rem; }
.maps img { width: 100%; display: block; height: auto; image-rendering: pixelated; border: 1px solid var(--line); }
.bar { display: flex; justify-content: space-between; font-size: .9rem; }
.maps .scale { height: .9rem; image-rendering: auto; }
.wide { overflow-x: auto; margin: .6rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; overflow-wrap: normal; }
th, td { border-bottom: 1px solid var(--line); padding: .25rem .8rem .25rem 0; text-align: left;
  vertical-align: top; } th { font-weight: 600; } .number { text-align: right; }
.words { min-width: 24rem; } .long { overflow-wrap: anywhere; }
code, pre { font: .92em/1.45 ui-monospace, monospace; } pre { background: var(--card);
  padding: .8rem; white-space: pre-wrap; } code { background: var(--card); }
summary { cursor: pointer; padding: .4rem 0; } summary h2 { display: inline; border: 0; padding: 0; }
section + section > details:first-child { border-top: 1px solid var(--line); }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(20rem, 100%), 1fr)); gap: 1.2rem; }
.cards section, .cards p { margin: 0; } .cards h3 { margin: .3rem 0; }
.cards figure { margin: 0; max-height: 34rem; overflow: hidden; }
.whole .words { min-width: 0; white-space: normal; } .whole table { width: 100%; }
@media screen and (max-width: 37rem) { .wide thead { display: none; }
  .wide table, .wide tr, .wide th, .wide .words { display: block; } .wide td { display: inline-block; margin-right: 1rem; white-space: normal; }
  .wide tr { border-bottom: 1px solid var(--line); padding: .3rem 0; }
  .wide th, .wide td { border: 0; padding: .1rem 0; text-align: left; } .wide .words { min-width: 0; }
  td[data-column]::before { content: attr(data-column) ": "; color: var(--soft); } .wide td:empty { display: none; }
  body { display: flex; flex-direction: column; } main { order: 1; min-width: 0; } nav { order: 2; } footer { order: 3; }
  header { display: contents; } }
.many thead { display: none; } .many table, .many tr, .many th { display: block; }
.many td { display: inline-block; margin-right: 1rem; white-space: normal; }
.many th, .many td { border: 0; padding: .1rem 0; text-align: left; }
.many tr { border-bottom: 1px solid var(--line); padding: .3rem 0; } .many .words { min-width: 0; }
.many .none { display: none; }
.many td[data-column]::before { content: attr(data-column) ": "; color: var(--soft); }
footer { color: var(--soft); margin-top: 2rem; font-size: .9rem; }
.turn { display: flex; flex-wrap: wrap; gap: 1rem; margin-top: .5rem; align-items: center; }
.turn label { display: flex; gap: .5rem; align-items: center; } canvas { max-width: 100%; }
@media print { nav, .skip, .turn { display: none; } body { max-width: none; padding: 0; }
  .wide { overflow: visible; } .wide table { font-size: .78rem; break-inside: avoid; } figure svg { max-height: 22cm; } .beside svg { max-height: 13cm; }
  h2, h3, caption, thead { break-after: avoid; } tr, .cards section { break-inside: avoid; } footer { margin-top: .3rem; }
  tbody tr:first-child { break-before: avoid; } summary { list-style: none; break-after: avoid; }
  details::details-content { content-visibility: visible; height: auto; }
  .words { min-width: 0; } }
)css";
}

namespace {

namespace fs = std::filesystem;

Markup line() { return Markup::ready("\n"); }

// `href="#gpPt0"` as `href="#PREFIX-gpPt0"`, and so for every way in which SVG names an element.
std::string with_prefix(const std::string& svg, const std::string& prefix) {
  static constexpr std::array<std::string_view, 6> words{"id=\"",   "id='",  "href=\"#",
                                                         "href='#", "url(#", "url('#"};
  std::string made;
  made.reserve(svg.size() + svg.size() / 8);
  for (std::size_t at = 0; at < svg.size();) {
    const auto* const word = std::ranges::find_if(words, [&](std::string_view each) {
      return svg[at] == each[0] && svg.compare(at, each.size(), each) == 0;
    });
    if (word == words.end()) {
      made += svg[at++];
      continue;
    }
    made += *word;
    made += prefix + "-";
    at += word->size();
  }
  return made;
}

}  // namespace

std::string id_of(const std::string& heading) {
  std::string id;
  for (const char letter : heading) {
    if (std::isalnum(static_cast<unsigned char>(letter)) != 0)
      id += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    else if (!id.empty() && id.back() != '-')
      id += '-';
  }
  return id;
}

Page::Page(std::string title, std::string kind)
    : title_(std::move(title)), kind_(std::move(kind)) {}

void Page::answer(const std::vector<std::string>& sentences) { answer_ += paragraphs(sentences); }

void Page::headline(const std::string& value, const std::string& error, Tone tone) {
  const char* between = error.starts_with("±") ? "\u00a0" : tone == Tone::failure ? ": " : " ";
  Markup words = text(kept_together(value) + (error.empty() ? "" : between));
  if (!error.empty()) words += element("span", error);
  answer_ += element("p", words, {{"class", tone == Tone::failure ? "big failure" : "big"}});
}

void Page::section(const std::string& heading, const Markup& body, Shown shown) {
  if (body.empty()) return;
  const std::string id = id_of(heading);
  contents_ += element("li", link("#" + id, heading));
  const Markup head = element("h2", heading, {{"id", id}});
  body_ +=
      element("section",
              shown == Shown::open ? head + line() + body
                                   : element("details", element("summary", head) + line() + body),
              {{"aria-labelledby", id}}) +
      line();
}

void Page::beside(const Markup& picture) {
  beside_ = element("div", picture, {{"class", "beside"}});
}

namespace {

// Whether a figure would be too small to read where it is seen whole, as one of many panels.
bool is_tall(const Markup& figure) {
  constexpr double most = 1.6;  // heights a width: of letters of 12 px 9 are left in 900 px
  const std::string word = "viewBox=\"";
  const std::size_t at = figure.html().find(word);
  if (at == std::string::npos) return false;
  std::istringstream box(figure.html().substr(at + word.size(), 60));
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
  box >> x >> y >> width >> height;
  return height > most * width;
}

}  // namespace

void Page::figures(const std::vector<Markup>& all) {
  if (all.empty()) return;
  const bool below = is_tall(all.front());
  if (!below) beside(all.front());
  Markup more;
  for (std::size_t i = below ? 0 : 1; i < all.size(); ++i) more += all[i];
  if (!more.empty())
    section(below ? "Figures" : "More figures", element("div", more, {{"class", "figures"}}));
}

void Page::script(const std::string& code) { script_ += code; }

std::string Page::html(Files files) const {
  const Markup head =
      element("meta", Markup(), {{"charset", "utf-8"}}) +
      element("meta", Markup(),
              {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}}) +
      element("title", title_ + " – palpate " + kind_) + element("style", Markup::ready(style()));
  Markup top = element("p", "palpate: " + kind_, {{"class", "kind"}}) + element("h1", title_);
  if (!answer_.empty())
    top += element("div", answer_,
                   {{"class", "result"}, {"role", "region"}, {"aria-label", "The result"}});
  top = element("div", top, {{"class", "said"}}) + line() + beside_ +
        element("nav", element("ul", contents_), {{"aria-label", "Contents"}});
  Markup body =
      element("a", "To the results", {{"class", "skip"}, {"href", "#results"}}) + line() +
      element("header", top) + line() + element("main", body_, {{"id", "results"}}) + line() +
      element("footer",
              std::string("Made by palpate " PALPATE_VERSION ".") +
                  (files == Files::beside ? " Everything on this page is in the files beside it."
                                          : ""));
  if (!script_.empty()) body += element("script", Markup::ready(script_));
  return "<!DOCTYPE html>\n" +
         element("html", element("head", head) + line() + element("body", body), {{"lang", "en"}})
             .html() +
         "\n";
}

Markup inline_svg(const std::string& svg, const std::string& prefix,
                  const std::string& description) {
  const std::size_t start = svg.find("<svg");
  if (start == std::string::npos) return {};
  const std::size_t end = svg.find('>', start);
  std::string head = svg.substr(start, end - start);
  // The page gives the size; the proportions come from the viewBox.
  for (const char* name : {" width=\"", " height=\"", " width='", " height='"}) {
    const std::size_t at = head.find(name);
    if (at == std::string::npos) continue;
    const char quote = name[std::string_view(name).size() - 1];
    head.erase(at, head.find(quote, at + std::string_view(name).size()) + 1 - at);
  }
  return Markup::ready(with_prefix(
      head + " role=\"img\" aria-label=\"" + escaped(description) + "\"" + svg.substr(end),
      prefix));
}

std::string class_of(const std::string& picture) {
  const fs::path script = fs::path(picture).replace_extension(".gp");
  const bool map =
      fs::exists(script) && read_text(script.string()).find("boxxyerror") != std::string::npos;
  return map ? "plot map" : "plot";
}

std::vector<Markup> all_figures(const WholeFolder& folder,
                                const std::function<std::string(const std::string&)>& words) {
  std::vector<Markup> all;
  std::vector<std::string> tables;
  for (const HashedFile& file : folder.files()) {
    if (file.path.ends_with(".csv")) tables.push_back(file.path);
    if (!file.path.ends_with(".gp")) continue;
    const std::string name = file.path.substr(0, file.path.size() - 3);
    const std::string description = words(name), picture = name + ".svg";
    if (description.empty()) continue;
    const std::string script = read_text(folder.file(file.path));
    Markup data;
    for (const std::string& table : tables)
      if (script.find("'" + table + "'") != std::string::npos)
        data += text(data.empty() ? " Data: " : ", ") + link(table, table);
    if (!fs::exists(folder.file(picture))) {
      all.push_back(element(
          "p", text("The figure " + picture + " could not be drawn here. " + description) + data));
      continue;
    }
    const Markup svg = inline_svg(read_text(folder.file(picture)), name, description);
    all.push_back(element(
        "figure", element("div", svg, {{"class", class_of(folder.file(picture))}}) +
                      element("figcaption", text(kept_together(description)) + data +
                                                text("; picture: ") + link(picture, picture))));
  }
  return all;
}

Markup making(const Making& made, const std::vector<HashedFile>& inputs) {
  Markup all = element(
      "p", text("This repeats the result in this folder, its tables with the same bytes on every "
                "x86-64 processor, by the same build of palpate " PALPATE_VERSION ":"));
  all += element("pre", element("code", made.command), {{"tabindex", "0"}});
  if (!made.note.empty()) all += paragraphs({made.note});
  record::Table hashes{{"file", "SHA-256"}, {}};
  for (const HashedFile& file : inputs) hashes.rows.push_back({file.path, file.sha256});
  return hashes.rows.empty() ? all : all + table("What went in", hashes);
}

Markup folded(const std::string& summary, const std::string& content) {
  return element("details", element("summary", summary) +
                                element("pre", element("code", content), {{"tabindex", "0"}}));
}

namespace {

// What stands between two words of a page, without tags and with the letters that were escaped.
std::string between(const std::string& html, std::string_view from, std::string_view to) {
  const std::size_t start = html.find(from);
  if (start == std::string::npos) return {};
  const std::size_t end = html.find(to, start + from.size());
  if (end == std::string::npos) return {};
  std::string plain;
  bool tag = false;
  for (std::size_t at = start + from.size(); at < end; ++at) {
    const char letter = html[at];
    if (html.compare(at, 4, "</p>") == 0) plain += ' ';
    if (letter == '<' || letter == '>')
      tag = letter == '<';
    else if (!tag)
      plain += letter;
  }
  constexpr std::array<std::pair<std::string_view, char>, 5> letters{
      {{"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&#39;", '\''}, {"&amp;", '&'}}};
  for (const auto& [word, letter] : letters)
    for (std::size_t at = plain.find(word); at != std::string::npos; at = plain.find(word, at + 1))
      plain.replace(at, word.size(), 1, letter);
  return trimmed(plain);
}

}  // namespace

Summary summary_of(const std::string& html) {
  Summary summary{.title = between(html, "<title>", "</title>"),
                  .answer = between(html, "aria-label=\"The result\">", "</p>")};
  const std::string picture = "picture: <a href=\"", paper = "id=\"beside-the-paper\"";
  for (std::size_t at = html.find(picture); at != std::string::npos;
       at = html.find(picture, at + 1)) {
    const std::size_t from = at + picture.size();
    summary.pictures.push_back(html.substr(from, html.find('"', from) - from));
  }
  if (const std::size_t at = html.find(paper); at != std::string::npos) {
    const std::size_t from = html.find("</h2>", at) + 5;
    summary.paper = html.substr(from, html.find("</section>", from) - from);
  }
  return summary;
}

void write(Page page, WholeFolder& folder) {
  constexpr std::size_t most = 200;
  Markup items;
  std::size_t count = 0;
  for (const HashedFile& file : folder.files())
    if (++count <= most)
      items += element("li", link(file.path, file.path) + text(" ") + element("code", file.sha256));
  page.section("Files", element("ul", items), Page::Shown::folded);
  folder.write(file_name, page.html(Page::Files::beside));
}

}  // namespace palpate::page
