// A program's command line as plain values: the source of its man page, its reference in Markdown,
// what a shell offers at the tab key, and the messages on wrong words.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/key_tree.h"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace palpate::commands {

// An option, or an operand, which stands without a name of an option before it.
struct Argument {
  std::vector<std::string> names = {};  // `--quiet`, `-q`; of an operand its name alone
  std::string value = {};  // what is given: FILE, KEY=VALUE, or words with `|`; empty: a flag
  std::string meaning = {};
  std::string fallback = {};  // the default; empty if there is none
  bool required = false;
  bool repeated = false;  // may be given several times

  // The words of `value`; empty if it is not a list of words.
  [[nodiscard]] std::vector<std::string> words() const;
};

struct Command {
  std::string name = {};
  std::string meaning = {};
  std::vector<Argument> options = {};
  std::vector<Argument> operands = {};
  std::vector<Command> commands = {};
  std::string ending = {};  // what its help says at the end

  // The command of that name; null if there is none.
  [[nodiscard]] const Command* find(const std::string& command) const;
};

// Reads what a parser knows. Hidden options are omitted, and so is `--help` below the top.
[[nodiscard]] Command describe(const CLI::App& app);

// With the letters a to z in upper case, as operands are written.
[[nodiscard]] std::string upper(std::string text);

// The first line of a command's help: `palpate fit DATA... --model MODEL [OPTION]...`.
[[nodiscard]] std::string synopsis(const Command& command, const std::string& before);

// What may stand for the last of `words`, the words behind the program's name. Each line is a word
// and, behind a tab, its meaning. The lines `:files` and `:folders` ask the shell for its own
// names. `keys` are those of KEY=VALUE, `examples` the names that a SCENARIO may have besides
// files.
[[nodiscard]] std::string complete(const Command& program, const std::vector<std::string>& words,
                                   std::span<const FlatKey> keys,
                                   std::span<const std::string> examples);

// The script that makes a shell (bash, zsh, fish) ask the program for completions.
[[nodiscard]] std::string_view completion_script(std::string_view shell);

// The message on the first word that is neither a verb nor an option of `app`, if there is one.
[[nodiscard]] std::optional<std::string> wrong_word(const CLI::App& app,
                                                    const std::vector<std::string>& arguments);

// The message for an error of CLI11.
[[nodiscard]] std::string sentence(const CLI::App& app, const CLI::ParseError& error);

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
