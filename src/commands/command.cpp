// Turns a parser of CLI11 into plain values, writes man pages in roff's man macros and Markdown,
// and finds wrong words before CLI11 parses, so that the message can suggest the nearest word.
#include "commands/command.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/text.h"

namespace palpate::commands {

extern const std::string_view bash_completion_text, fish_completion_text, zsh_completion_text;

namespace {

// CLI11 writes a type with its checks, `TEXT:{constant,relative}` or `INT:INT in [1 - 8]`.
std::string value_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto open = type.find('{');
  if (open == std::string::npos) return type.substr(0, type.find(':'));
  const std::string words = type.substr(open + 1, type.find('}') - open - 1);
  return joined(split(words, ','), "|");
}

Argument argument(const CLI::Option& option) {
  Argument read;
  if (option.get_positional()) {
    read.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_lnames()) read.names.push_back("--" + name);
    for (const std::string& name : option.get_snames()) read.names.push_back("-" + name);
  }
  if (option.get_items_expected_max() > 0) read.value = value_of(option);
  read.meaning = option.get_description();
  read.fallback = option.get_default_str();
  read.required = option.get_required();
  read.repeated = option.get_items_expected_max() > 1;
  return read;
}

Command described(const CLI::App& app, bool top) {
  Command command{.name = app.get_name(), .meaning = app.get_description()};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty() || (!top && option == app.get_help_ptr())) continue;
    (option->get_positional() ? command.operands : command.options).push_back(argument(*option));
  }
  for (const CLI::App* inner : app.get_subcommands([](const CLI::App*) { return true; }))
    command.commands.push_back(described(*inner, false));
  command.ending = app.get_footer();
  return command;
}

}  // namespace

std::vector<std::string> Argument::words() const {
  return value.find('|') == std::string::npos ? std::vector<std::string>{} : split(value, '|');
}

const Command* Command::find(const std::string& command) const {
  const auto found = std::ranges::find(commands, command, &Command::name);
  return found == commands.end() ? nullptr : &*found;
}

Command describe(const CLI::App& app) { return described(app, true); }

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  });
  return text;
}

std::string synopsis(const Command& command, const std::string& before) {
  std::string line = before + command.name;
  for (const Argument& operand : command.operands) {
    std::string name = upper(operand.names[0]);
    if (operand.repeated) name += "...";
    line += operand.required ? " " + name : " [" + name + "]";
  }
  bool optional = false;
  for (const Argument& option : command.options) {
    optional = optional || !option.required;
    if (option.required) line += " " + option.names[0] + " " + option.value;
  }
  if (!command.commands.empty()) line += " VERB";
  return line + (optional ? " [OPTION]..." : "");
}

namespace {

class Candidates {
 public:
  Candidates(std::string part, std::span<const FlatKey> keys, std::span<const std::string> examples)
      : part_(std::move(part)), keys_(keys), examples_(examples) {}

  void add(const std::string& word, const std::string& meaning) {
    if (word.starts_with(part_)) text_ += before_ + word + "\t" + meaning + "\n";
  }

  void value(const Argument& argument) {
    for (const std::string& word : argument.words()) add(word, "");
    if (!argument.words().empty()) return;
    const std::string& kind = argument.value;
    if (kind == "KEY=VALUE") {
      assignment();
    } else if (kind == "KEY") {
      for (const FlatKey& key : keys_) add(key.path, key.meaning);
      text_ += ":files\n";
    } else if (kind == "SCENARIO") {
      for (const std::string& example : examples_) add(example, "an installed example");
      text_ += ":files\n";
    } else if (kind == "FOLDER") {
      text_ += ":folders\n";
    } else if (kind == "FILE" || kind == "TEXT") {
      text_ += ":files\n";
    }
  }

  // What stands before a value on the same word, as `--out=`.
  void behind(std::size_t length) {
    before_ += part_.substr(0, length);
    part_.erase(0, length);
  }

  [[nodiscard]] const std::string& part() const { return part_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void assignment() {
    const auto sign = part_.find('=');
    if (sign == std::string::npos) {
      for (const FlatKey& key : keys_) add(key.path + "=", key.meaning);
      return;
    }
    const std::string path = part_.substr(0, sign);
    behind(sign + 1);
    for (const FlatKey& key : keys_)
      if (key.path == path)
        for (const Word& word : key.words) add(word.word, word.meaning);
  }

  std::string part_;
  std::string before_;
  std::string text_;
  std::span<const FlatKey> keys_;
  std::span<const std::string> examples_;
};

}  // namespace

std::string complete(const Command& program, const std::vector<std::string>& words,
                     std::span<const FlatKey> keys, std::span<const std::string> examples) {
  Candidates found(words.empty() ? "" : words.back(), keys, examples);
  const Command* verb = &program;
  std::vector<const Argument*> options;
  const auto enter = [&](const Command& command) {
    verb = &command;
    for (const Argument& option : command.options) options.push_back(&option);
  };
  const auto option_named = [&](const std::string& name) -> const Argument* {
    for (const Argument* option : options)
      if (std::ranges::find(option->names, name) != option->names.end()) return option;
    return nullptr;
  };
  enter(program);
  std::size_t operands = 0;
  const Argument* waiting = nullptr;  // an option whose value comes next
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (waiting != nullptr) {
      waiting = nullptr;
    } else if (words[i].starts_with("-")) {
      const Argument* option = option_named(words[i]);
      if (option != nullptr && !option->value.empty()) waiting = option;
    } else if (const Command* inner = verb->find(words[i])) {
      enter(*inner);
    } else {
      ++operands;
    }
  }
  const std::string part = found.part();
  if (waiting != nullptr) {
    found.value(*waiting);
  } else if (part.starts_with("-")) {
    const auto sign = part.find('=');
    const Argument* option =
        sign == std::string::npos ? nullptr : option_named(part.substr(0, sign));
    if (option != nullptr) {
      found.behind(sign + 1);
      found.value(*option);
    } else {
      for (const Argument* one : options)
        for (const std::string& name : one->names) found.add(name, one->meaning);
    }
  } else if (!verb->commands.empty()) {
    for (const Command& inner : verb->commands) found.add(inner.name, inner.meaning);
  } else if (!verb->operands.empty()) {
    const std::size_t last = verb->operands.size() - 1;
    const Argument& operand = verb->operands[std::min(operands, last)];
    if (operands <= last || operand.repeated) found.value(operand);
  }
  return found.text();
}

std::string_view completion_script(std::string_view shell) {
  return shell == "bash"  ? bash_completion_text
         : shell == "zsh" ? zsh_completion_text
                          : fish_completion_text;
}

namespace {

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(verb->get_name());
  return names;
}

using Options = std::vector<const CLI::Option*>;

void add_options(const CLI::App& app, Options& options) {
  for (const CLI::Option* option : app.get_options())
    if (!option->get_positional()) options.push_back(option);
}

const CLI::Option* find_option(const Options& options, const std::string& name) {
  for (const CLI::Option* option : options)
    if (option->check_name(name)) return option;
  return nullptr;
}

std::vector<std::string> long_names(const Options& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options)
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (auto name = names.begin(); name != names.end(); ++name)  // every verb has its own --help
    names.erase(std::remove(name + 1, names.end(), *name), names.end());
  return names;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  // Dashes are alike in all options and are not counted.
  const std::string dashes(std::min(word.find_first_not_of('-'), word.size()), '-');
  std::vector<std::string> bare;
  for (const std::string& one : known)
    bare.push_back(one.starts_with(dashes) ? one.substr(dashes.size()) : one);
  const auto near = nearest(word.substr(dashes.size()), bare);
  return near ? "; did you mean `" + dashes + *near + "`?" : "; known: " + joined(known, ", ");
}

// The verbs with this option, as `palpate identify`.
std::vector<std::string> owners(const CLI::App& app, const std::string& name,
                                const std::string& command = "palpate") {
  std::vector<std::string> found;
  for (const std::string& word : verb_names(app)) {
    const CLI::App& verb = *app.get_subcommand(word);
    const std::string whole = command + " " + word;
    if (verb.get_option_no_throw(name) != nullptr) found.push_back("`" + whole + "`");
    for (std::string& inner : owners(verb, name, whole)) found.push_back(std::move(inner));
  }
  return found;
}

// `after` are the words behind it.
std::string unknown_option(const CLI::App& app, const CLI::App& verb, const std::string& name,
                           const Options& known, std::span<const std::string> after) {
  std::vector<std::string> inners = verb_names(verb);
  std::stable_partition(inners.begin(), inners.end(), [&](const std::string& inner) {
    return std::ranges::find(after, inner) != after.end();
  });
  for (const std::string& inner : inners)
    if (verb.get_subcommand(inner)->get_option_no_throw(name) != nullptr)
      return "option `" + name + "` stands before its verb; write it as `palpate " + inner +
             " ... " + name + "`";
  std::string command = verb.get_name();
  for (const CLI::App* outer = verb.get_parent(); outer != nullptr; outer = outer->get_parent())
    command = (outer == &app ? "palpate" : outer->get_name()) + " " + command;
  if (const std::vector<std::string> others = owners(app, name); !others.empty())
    return "`" + command + "` has no option `" + name + "`, which belongs to " +
           joined(others, ", ") + "; `" + command + " --help` lists its own";
  return "unknown option `" + name + "`" + did_you_mean(name, long_names(known));
}

// The library's text on an option or a word, in this program's words. Its options have names, but
// for hidden ones.
std::string reason(const std::string& what) {
  const auto cut = [&](std::string_view mark, std::string& before, std::string& after) {
    const std::size_t at = what.find(mark);
    if (at == std::string::npos) return false;
    before = what.substr(0, at);
    after = what.substr(at + mark.size());
    return true;
  };
  std::string name;
  std::string rest;
  if (const std::size_t range = what.rfind(" not in range ");
      range != std::string::npos && cut(": Value ", name, rest)) {
    std::vector<std::string> ends = split(what.substr(range + 14), ' ');  // A to B
    for (std::string& end : ends)
      if (const auto number = leading_number(end)) end = rounded_text(number->value, 10);
    return ticked(name) + " wants a number from " + joined(ends, " ") + ", got " +
           ticked(rest.substr(0, rest.rfind(" not in range ")));
  }
  if (cut("Could not convert: ", name, rest) && rest.find(" = ") != std::string::npos)
    return ticked(rest.substr(0, rest.find(" = "))) + " wants a plain number, got " +
           ticked(rest.substr(rest.find(" = ") + 3));
  if (cut(": At Most 1 required but received ", name, rest))
    return ticked(name) + " is given " + rest + " times; give it once";
  if (what.ends_with(" missing") && cut(": 1 required ", name, rest))
    return ticked(name) + " wants a value behind it";
  if (cut(" requires ", name, rest)) return ticked(name) + " is used only with " + ticked(rest);
  if (cut(" excludes ", name, rest)) return ticked(name) + " does not go with " + ticked(rest);
  if (const std::size_t colon = what.find(": ");
      what.ends_with("}") && colon != std::string::npos && cut(" not in {", name, rest)) {
    const std::string given = name.substr(colon + 2);
    const std::vector<std::string> known = split(rest.substr(0, rest.size() - 1), ',');
    // Of three letters one is too much for a slip.
    const auto near = given.size() > 3 ? nearest(given, known) : std::nullopt;
    return (colon == 0 ? "a hidden option" : ticked(name.substr(0, colon))) + " does not know " +
           ticked(given) +
           (near ? "; did you mean " + ticked(*near) + "?"
                 : "; it is one of " + joined(known, ", "));
  }
  if (cut(" not expected: ", name, rest))
    return (name.ends_with("were") ? "these words are too many: `" : "this word is too many: `") +
           rest + "`";
  return what;
}

}  // namespace

std::optional<std::string> wrong_word(const CLI::App& app,
                                      const std::vector<std::string>& arguments) {
  const CLI::App* verb = &app;
  Options options;
  add_options(app, options);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& word = arguments[i];
    if (word == "--") break;
    const bool is_long = word.starts_with("--");
    const std::string name = is_long ? word.substr(0, word.find('=')) : word;
    if (const CLI::Option* option = find_option(options, name); word.starts_with("-") && option) {
      // The next word is the value of the option, even if it begins with `-`.
      if (option->get_items_expected_min() > 0 && name == word) ++i;
    } else if (is_long) {
      return unknown_option(app, *verb, name, options, std::span(arguments).subspan(i));
    } else if (!word.starts_with("-") && !verb_names(*verb).empty()) {
      const std::vector<std::string> names = verb_names(*verb);
      if (std::ranges::find(names, word) == names.end())
        return "unknown verb `" + word + "`" + did_you_mean(word, names);
      verb = verb->get_subcommand(word);
      add_options(*verb, options);
    }
  }
  return std::nullopt;
}

std::string sentence(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* asked = &app;
  std::string command = "palpate";
  while (!asked->get_subcommands().empty()) {
    asked = asked->get_subcommands().front();
    command += " " + asked->get_name();
  }
  const std::string help = "; `" + command + " --help` shows how to write it";
  const std::string what = error.what();
  const std::string required = " is required";
  if (what == "A subcommand is required")
    return "`" + command + "` wants a verb: " + joined(verb_names(*asked), ", ") + help;
  if (what.ends_with(required))
    return "`" + command + "` lacks `" + what.substr(0, what.size() - required.size()) + "`" + help;
  if (what.find(" not in {") != std::string::npos) return reason(what);
  return "`" + command + "` cannot be read: " + reason(what) + help;
}

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
      } else if (!line.empty() && line[0] != '<') {  // a tag, which folds on a page
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
      std::ranges::replace(name, '|', '/');
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
