// Escapes texts and puts tags around them.
#include "page/html.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "base/text.h"
#include "base/units.h"
#include "base/written.h"
#include "plot/gnuplot_text.h"

namespace palpate::page {

Markup Markup::ready(std::string html) {
  Markup made;
  made.html_ = std::move(html);
  return made;
}

Markup operator+(Markup first, const Markup& second) { return first += second; }

Markup text(std::string_view words) { return Markup::ready(escaped(words)); }

Markup element(std::string_view tag, const Markup& inner, const Attributes& attributes) {
  constexpr std::array<std::string_view, 3> without_end{"img", "input", "meta"};
  std::string html = "<" + std::string(tag);
  for (const auto& [name, value] : attributes)
    html += " " + std::string(name) + "=\"" + escaped(value) + "\"";
  html += ">";
  if (std::ranges::find(without_end, tag) == without_end.end())
    html += inner.html() + "</" + std::string(tag) + ">";
  return Markup::ready(html);
}

Markup element(std::string_view tag, std::string_view words, const Attributes& attributes) {
  constexpr std::array<std::string_view, 3> copied{"code", "pre", "title"};  // letter by letter
  const bool prose = std::ranges::find(copied, tag) == copied.end();
  return element(tag, text(prose ? kept_together(words) : std::string(words)), attributes);
}

std::string kept_together(std::string_view words) {
  constexpr const char* no_break = "\u00a0";  // a space at which no line ends
  std::string kept;
  for (std::size_t at = 0; at < words.size(); ++at) {
    const auto is_unit = [&] {
      std::string_view next = words.substr(at + 1);
      next = next.substr(0, next.find_first_of(" ,;:)"));
      if (next.ends_with('.')) next.remove_suffix(1);
      const std::string_view first = next.substr(0, next.find_first_of("/^_"));  // of `N/mm^n`
      return next == "%" || next == "µs" || unit_factor(next) || unit_factor(first);
    };
    const bool after_number =
        !kept.empty() && std::isdigit(static_cast<unsigned char>(kept.back())) != 0;
    if (words[at] == ' ' && (kept.ends_with("±") || (after_number && is_unit())))
      kept += no_break;
    else
      kept += words[at];
  }
  return kept;
}

Markup link(const std::string& target, std::string_view words) {
  return element("a", words, {{"href", target}});
}

Markup sentence(std::string_view words) {
  Markup all;
  bool code = false;
  for (const std::string& part : split(words, '`')) {
    all += code ? element("code", part) : text(kept_together(part));
    code = !code;
  }
  return all;
}

Markup paragraphs(const std::vector<std::string>& sentences) {
  Markup all;
  for (const std::string& one : sentences)
    if (!one.empty())
      all += element("p", sentence(capitalized(one) + (one.ends_with('.') ? "" : ".")));
  return all;
}

namespace {

// `column` names the value where the table's head has no place.
Markup cell(const record::Cell& value, bool heading, const std::string& column) {
  Attributes attributes;
  if (heading)
    attributes.emplace_back("scope", "row");
  else
    attributes.emplace_back("data-column", column);
  if (const auto* number = std::get_if<double>(&value)) {
    if (!heading) attributes.emplace_back("class", "number");
    const std::string shown = std::isfinite(*number) ? plot::tick_text(*number, 4) : "–";
    return element(heading ? "th" : "td", shown, attributes);
  }
  const auto* word = std::get_if<std::string>(&value);
  if (word == nullptr) attributes.emplace_back("class", "none");
  constexpr std::size_t sentence = 50;  // letters; a column of such texts is not made narrow
  if (word != nullptr && word->size() > sentence)  // one word of that length may be broken
    attributes.emplace_back("class", word->find(' ') == std::string::npos ? "long" : "words");
  return element(heading ? "th" : "td", word == nullptr ? std::string("–") : *word, attributes);
}

// Whether a row says something in this column.
bool has_values(const record::Table& content, std::size_t column) {
  return std::ranges::any_of(content.rows, [&](const auto& row) {
    if (const auto* number = std::get_if<double>(&row[column])) return std::isfinite(*number);
    const auto* word = std::get_if<std::string>(&row[column]);
    return word != nullptr && !word->empty();
  });
}

// Whether a column has a number and no word, so that its head stands to the right as well.
bool stands_right(const record::Table& content, std::size_t column) {
  bool number = false;
  for (const auto& row : content.rows) {
    if (std::holds_alternative<std::string>(row[column])) return false;
    number = number || std::holds_alternative<double>(row[column]);
  }
  return number;
}

}  // namespace

Markup table(const std::string& caption, const record::Table& content) {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < content.columns.size(); ++i)
    if (i == 0 || has_values(content, i)) columns.push_back(i);
  Markup head, body;
  for (const std::size_t i : columns) {
    Attributes attributes{{"scope", "col"}};
    if (i > 0 && stands_right(content, i)) attributes.emplace_back("class", "number");
    head += element("th", content.columns[i], attributes);
  }
  for (const auto& row : content.rows) {
    Markup cells;
    for (const std::size_t i : columns) cells += cell(row[i], i == 0, content.columns[i]);
    body += element("tr", cells) + Markup::ready("\n");
  }
  constexpr std::size_t many = 8;  // columns; more do not fit on paper side by side
  return element(
      "div",
      element("table", element("caption", caption) + element("thead", element("tr", head)) +
                           element("tbody", body)),
      {{"class", columns.size() > many ? "wide many" : "wide"},
       {"tabindex", "0"},
       {"role", "region"},
       {"aria-label", caption}});
}

record::Table columns_of(const record::Table& content, const std::vector<std::string>& names) {
  record::Table chosen{{}, std::vector<std::vector<record::Cell>>(content.rows.size())};
  for (const std::string& name : names) {
    const int at = content.find(name);
    if (at < 0) continue;
    chosen.columns.push_back(name);
    for (std::size_t i = 0; i < content.rows.size(); ++i)
      chosen.rows[i].push_back(content.rows[i][static_cast<std::size_t>(at)]);
  }
  return chosen;
}

Markup table_of_file(const std::string& caption, const record::Table& content,
                     const std::string& file, std::size_t most) {
  record::Table shown = content;
  if (shown.rows.size() > most) shown.rows.resize(most);
  const std::string what = shown.rows.size() < content.rows.size()
                               ? "The first " + std::to_string(most) + " of " +
                                     std::to_string(content.rows.size()) +
                                     " rows; all of them are in "
                               : "All columns and digits are in ";
  return table(caption, shown) + element("p", text(what) + link(file, file) + text("."));
}

}  // namespace palpate::page
