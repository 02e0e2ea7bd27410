// Puts a page together.
#include "page/page.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "base/text.h"
#include "page/style.h"

#ifndef PALPATE_VERSION
#define PALPATE_VERSION "unknown"
#endif

namespace palpate::page {
namespace {

namespace fs = std::filesystem;

// `How it was made` as `how-it-was-made`.
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

Markup line() { return Markup::ready("\n"); }

// `href="#gpPt0"` as `href="#PREFIX-gpPt0"`, and so for every way in which SVG names an element.
std::string with_prefix(const std::string& svg, const std::string& prefix) {
  static constexpr std::array<std::string_view, 6> words{"id=\"",   "id='",  "href=\"#",
                                                         "href='#", "url(#", "url('#"};
  std::string made;
  made.reserve(svg.size() + svg.size() / 8);
  for (std::size_t at = 0; at < svg.size();) {
    const auto* const word = std::find_if(words.begin(), words.end(), [&](std::string_view each) {
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

Page::Page(std::string title, std::string kind)
    : title_(std::move(title)), kind_(std::move(kind)) {}

void Page::answer(const std::vector<std::string>& sentences) { answer_ += paragraphs(sentences); }

void Page::headline(const std::string& value, const std::string& error) {
  answer_ += element("p", text(value + " ") + element("span", error), {{"class", "big"}});
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

void Page::script(const std::string& code) { script_ += code; }

std::string Page::html() const {
  const Markup head =
      element("meta", Markup(), {{"charset", "utf-8"}}) +
      element("meta", Markup(),
              {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}}) +
      element("title", title_ + " – palpate " + kind_) + element("style", Markup::ready(style()));
  Markup top = element("p", "palpate: " + kind_, {{"class", "kind"}}) + element("h1", title_);
  if (!answer_.empty())
    top += element("div", answer_,
                   {{"class", "answer"}, {"role", "region"}, {"aria-label", "The answer"}});
  Markup body = element("a", "To the results", {{"class", "skip"}, {"href", "#results"}}) + line() +
                element("header", top) + line() +
                element("nav", element("ul", contents_), {{"aria-label", "Contents"}}) + line() +
                element("main", body_, {{"id", "results"}}) + line() +
                element("footer", "Made by palpate " PALPATE_VERSION
                                  ". Everything on this page is in the "
                                  "files beside it.");
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

Markup figures(const std::vector<ShownFigure>& shown, const WholeFolder& folder) {
  Markup all;
  for (const ShownFigure& figure : shown) {
    const std::string picture = figure.name + ".svg";
    Markup caption = text(figure.caption + " Data: ");
    for (const std::string& file : figure.data)
      caption += (&file == figure.data.data() ? Markup() : text(", ")) + link(file, file);
    if (!fs::exists(folder.file(picture))) {
      all += element("p", text("The figure " + picture + " could not be drawn here. ") + caption);
      continue;
    }
    const Markup svg = inline_svg(read_text(folder.file(picture)), figure.name, figure.caption);
    all += element("figure", element("div", svg, {{"class", "sheet plot"}}) +
                                 element("figcaption",
                                         caption + text("; picture: ") + link(picture, picture)));
  }
  return all;
}

Markup all_figures(const WholeFolder& folder,
                   const std::function<std::string(const std::string&)>& words) {
  std::vector<ShownFigure> shown;
  std::vector<std::string> tables;
  for (const HashedFile& file : folder.files()) {
    if (file.path.ends_with(".csv")) tables.push_back(file.path);
    if (!file.path.ends_with(".gp")) continue;
    const std::string name = file.path.substr(0, file.path.size() - 3);
    const std::string script = read_text(folder.file(file.path));
    ShownFigure figure{.name = name, .caption = words(name)};
    for (const std::string& table : tables)
      if (script.find("'" + table + "'") != std::string::npos) figure.data.push_back(table);
    if (!figure.caption.empty()) shown.push_back(figure);
  }
  return figures(shown, folder);
}

Markup making(const Making& made, const std::vector<HashedFile>& inputs,
              const WholeFolder& folder) {
  Markup all = element(
      "p", text("This repeats the result in this folder, with the same bytes on "
                "every x86-64 processor, by the same build of palpate " PALPATE_VERSION ":"));
  all += element("pre", element("code", made.command), {{"tabindex", "0"}});
  if (!made.remark.empty()) all += paragraphs({made.remark});
  record::Table hashes{{"file", "SHA-256"}, {}};
  for (const HashedFile& file : inputs) hashes.rows.push_back({file.path, file.sha256});
  if (!hashes.rows.empty()) all += table("What went in", hashes);
  hashes.rows.clear();
  for (const HashedFile& file : folder.files()) hashes.rows.push_back({file.path, file.sha256});
  constexpr std::size_t most = 100;
  if (hashes.rows.size() > most) hashes.rows.resize(most);
  return all + table("What came out", hashes);
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
                  .answer = between(html, "aria-label=\"The answer\">", "</p>")};
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
    if (++count <= most) items += element("li", link(file.path, file.path));
  page.section("Files", element("ul", items), Page::Shown::folded);
  folder.write(file_name, page.html());
}

}  // namespace palpate::page
