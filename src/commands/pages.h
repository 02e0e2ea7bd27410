// Reference pages made from the table of a program's arguments, as man pages and as Markdown.
#pragma once

#include <string>
#include <string_view>

#include "commands/command.h"

namespace palpate::commands {

// The head of a man page: its name, its section and what it is, in a few words.
struct Title {
  std::string name;  // "palpate-scenario"
  int section = 1;
  std::string meaning;  // "keys of a scenario file"
  std::string version;  // "palpate 0.1.0"
};

// A man page of a program: all verbs with their options. `further` is Markdown that follows.
[[nodiscard]] std::string man_page(const Title& title, const Command& program,
                                   std::string_view further);

// A man page of a text in the Markdown that this program writes: headings, paragraphs, fenced
// blocks, and tables whose first column is a term and whose other columns, named by the table's
// head, explain it.
[[nodiscard]] std::string man_page(const Title& title, std::string_view markdown);

// The same reference of a program as Markdown, for the site.
[[nodiscard]] std::string markdown_page(const Command& program, std::string_view further);

}  // namespace palpate::commands
