// A program's command line as plain values: the source of its man page, reference and completion.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
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

}  // namespace palpate::commands
