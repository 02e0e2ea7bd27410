// Writes man pages in roff's man macros, and Markdown.
#include "commands/pages.h"

#include <algorithm>
#include <vector>

#include "base/text.h"

namespace palpate::commands {
namespace {

// Text for roff: no character is special, and `-` is the one of options.
std::string plain(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else
      safe += c;
  }
  return safe;
}

// A line of text: one that begins like a command of roff is none.
std::string line_of(const std::string& roff) {
  return (roff.starts_with('.') || roff.starts_with('\'') ? "\\&" : "") + roff + "\n";
}

// Inline Markdown: `code` becomes bold, a link its words, a line break a blank.
std::string inline_roff(std::string text) {
  for (std::size_t at = text.find("<br>"); at != std::string::npos; at = text.find("<br>"))
    text.replace(at, 4, "; ");
  for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](")) {
    const std::size_t open = text.rfind('[', at);
    const std::size_t close = text.find(')', at);
    if (open == std::string::npos || close == std::string::npos) break;
    text = text.substr(0, open) + text.substr(open + 1, at - open - 1) + text.substr(close + 1);
  }
  std::string roff;
  const std::vector<std::string> parts = split(text, '`');
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty()) continue;
    const std::string safe = plain(parts[i]);
    roff += i % 2 == 1 ? "\\fB" + safe + "\\fR" : safe;
  }
  return roff;
}

std::string head(const Title& title) {
  return ".TH \"" + plain(title.name) + "\" " + std::to_string(title.section) + " \"\" \"" +
         plain(title.version) + "\"\n.SH NAME\n" + plain(title.name) + " \\- " +
         plain(title.meaning) + "\n";
}

std::string term_of(const Argument& argument) {
  return joined(argument.names, ", ") + (argument.value.empty() ? "" : " " + argument.value);
}

std::string meaning_of(const Argument& argument) {
  std::string text = argument.meaning;
  if (!argument.fallback.empty()) text += "; default `" + argument.fallback + "`";
  if (argument.required) text += "; required";
  return text.empty() ? text : text + ".";
}

// Every command with its full name, the inner ones behind the outer one.
template <class Use>
void for_each_command(const Command& command, const std::string& before, const Use& use) {
  for (const Command& inner : command.commands) {
    use(inner, before);
    for_each_command(inner, before + inner.name + " ", use);
  }
}

class Roff {
 public:
  explicit Roff(const Title& title) : text_(head(title)) {}

  void add(std::string_view markdown) {
    for (const std::string& line : split(markdown, '\n')) add_line(line);
    end_table();
  }
  void section(const std::string& name) { text_ += ".SH " + plain(upper(name)) + "\n"; }
  void subsection(const std::string& name) { text_ += ".SS " + plain(name) + "\n"; }
  void paragraph(const std::string& markdown) { text_ += ".PP\n" + line_of(inline_roff(markdown)); }
  void term(const std::string& name, const std::string& meaning) {
    text_ += ".TP\n\\fB" + plain(name) + "\\fR\n" + line_of(inline_roff(meaning));
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void add_line(const std::string& line) {
    if (line.starts_with("```")) {
      text_ += fenced_ ? ".EE\n" : ".PP\n.EX\n";
      fenced_ = !fenced_;
    } else if (fenced_) {
      text_ += line_of(plain(line));
    } else if (line.starts_with("|")) {
      add_row(line);
    } else {
      end_table();
      const auto level = line.find_first_not_of('#');
      if (level != std::string::npos && level > 0 && line[level] == ' ') {
        std::string name = line.substr(level + 1);
        std::erase(name, '`');
        level <= 2 ? section(name) : subsection(name);
      } else if (!line.empty()) {
        paragraph(line);
      }
    }
  }

  // The first row names the columns; the second one is a rule.
  void add_row(const std::string& line) {
    std::vector<std::string> cells = split(line.substr(1, line.rfind('|') - 1), '|');
    for (std::string& cell : cells) cell = trimmed(cell);
    if (++rows_ == 1) columns_ = cells;
    if (rows_ < 3) return;
    std::string meaning;
    for (std::size_t i = 1; i < cells.size(); ++i) {
      if (cells[i].empty()) continue;
      const bool last = i + 1 == cells.size();
      meaning += last ? cells[i] : columns_[i] + ": " + cells[i] + ". ";
    }
    std::string name = cells[0];
    std::erase(name, '`');
    term(name, meaning);
  }
  void end_table() { rows_ = 0; }

  std::string text_;
  std::vector<std::string> columns_;
  int rows_ = 0;
  bool fenced_ = false;
};

}  // namespace

std::string man_page(const Title& title, const Command& program, std::string_view further) {
  Roff page(title);
  page.section("synopsis");
  page.paragraph("`" + synopsis(program, "") + "`");
  page.section("description");
  page.paragraph(program.meaning);
  page.section("options of all verbs");
  for (const Argument& option : program.options) page.term(term_of(option), meaning_of(option));
  page.section("verbs");
  for_each_command(program, program.name + " ",
                   [&](const Command& verb, const std::string& before) {
                     page.subsection(synopsis(verb, before));
                     page.paragraph(verb.meaning + ".");
                     for (const Argument& operand : verb.operands)
                       page.term(upper(operand.names[0]), meaning_of(operand));
                     for (const Argument& option : verb.options)
                       page.term(term_of(option), meaning_of(option));
                   });
  page.add(further);
  return page.text();
}

std::string man_page(const Title& title, std::string_view markdown) {
  Roff page(title);
  page.add(markdown);
  return page.text();
}

std::string markdown_page(const Command& program, std::string_view further) {
  const auto rows = [](const std::vector<Argument>& arguments, bool operands) {
    std::string text;
    for (const Argument& argument : arguments) {
      std::string name = operands ? upper(argument.names[0]) : term_of(argument);
      // A `|` would end the cell.
      std::replace(name.begin(), name.end(), '|', '/');
      text += "| `" + name + "` | " + meaning_of(argument) + " |\n";
    }
    return text;
  };
  const std::string table = "\n| argument | meaning |\n| --- | --- |\n";
  std::string text = "# The command line of " + program.name + "\n\n" + program.meaning +
                     "\n\n## Options of all verbs\n" + table + rows(program.options, false);
  for_each_command(program, program.name + " ",
                   [&](const Command& verb, const std::string& before) {
                     text += "\n## " + before + verb.name + "\n\n```\n" + synopsis(verb, before) +
                             "\n```\n\n" + verb.meaning + ".\n";
                     if (verb.operands.empty() && verb.options.empty()) return;
                     text += table + rows(verb.operands, true) + rows(verb.options, false);
                   });
  return text + "\n" + std::string(further);
}

}  // namespace palpate::commands
