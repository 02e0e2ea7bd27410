// One self-contained page: the answer, then sections. It opens from the disk, prints, and can be
// read in light and dark, on a phone, by keyboard and by a screen reader; it loads nothing.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "base/whole_folder.h"
#include "page/html.h"

namespace palpate::page {

// CSS: system fonts, light and dark colours with contrasts of at least 4.5 (WCAG AA), narrow
// screens, and paper.
[[nodiscard]] const char* style();

inline constexpr const char* file_name = "report.html";

class Page {
 public:
  // `kind` says what the page is about: `run`, `sweep`, ...
  Page(std::string title, std::string kind);

  // At the head of the page: one large line, such as a force and its error, then anything else. A
  // failure has the colour of a warning.
  enum class Tone { result, failure };
  void headline(const std::string& value, const std::string& error, Tone tone = Tone::result);
  void answer(const Markup& more) { answer_ += more; }
  void answer(const std::vector<std::string>& sentences);
  // A picture that is seen whole with the answer: beside it on a wide screen, else below it.
  void beside(const Markup& picture);
  // The first figure beside the answer, the others in a section.
  void figures(const std::vector<Markup>& all);
  // A section with an entry in the contents. An empty body makes no section. A folded one shows its
  // heading until it is opened, and is open in print.
  enum class Shown { open, folded };
  void section(const std::string& heading, const Markup& body, Shown shown = Shown::open);
  // A script of our own, which the page runs when it has been read.
  void script(const std::string& code);

  // The whole page, always the same for the same content. Its foot says so where all that it shows
  // is in files beside it.
  enum class Files { none, beside };
  [[nodiscard]] std::string html(Files files = Files::none) const;

 private:
  std::string title_, kind_;
  Markup answer_, beside_, contents_, body_;
  std::string script_;
};

// The class of a figure: `plot`, which the dark inverts, and `map` where its script, beside it,
// gives areas colours that stand for numbers, which stay.
[[nodiscard]] std::string class_of(const std::string& picture);

// All figures of a folder whose scripts are listed in it, in that order, inline, with the tables
// that they read. `words` gives the caption of the figure NAME, which a screen reader says as well;
// an empty caption leaves the figure out. Of a picture that was not drawn its data are named.
[[nodiscard]] std::vector<Markup> all_figures(
    const WholeFolder& folder, const std::function<std::string(const std::string&)>& words);

// `How it was made` as `how-it-was-made`.
[[nodiscard]] std::string id_of(const std::string& heading);

// A picture as part of the page: without prolog and size, with ids that begin with `prefix`, and
// named for screen readers.
[[nodiscard]] Markup inline_svg(const std::string& svg, const std::string& prefix,
                                const std::string& description);

// How the result was made and how to repeat it: program, command, and the SHA-256 of what went in.
struct Making {
  std::string command = {};  // that repeats the result, run in its folder
  std::string note = {};     // a sentence; may be empty
};
[[nodiscard]] Markup making(const Making& made, const std::vector<HashedFile>& inputs = {});

// A long text, folded up.
[[nodiscard]] Markup folded(const std::string& summary, const std::string& content);

// What a row beside a paper's text says.
inline constexpr std::array verdicts{"agrees", "differs", "the text does not say"};

// Parts of a page that write() made, as plain text; empty where there is none.
struct Summary {
  std::string title = {};
  std::string answer = {};                 // its first line
  std::vector<std::string> pictures = {};  // the files of its figures
  std::string paper = {};  // the section `Beside the paper`, without its heading, as HTML
};
[[nodiscard]] Summary summary_of(const std::string& html);

// Adds the files of a folder with their SHA-256, the last section, and writes report.html.
void write(Page page, WholeFolder& folder);

}  // namespace palpate::page
