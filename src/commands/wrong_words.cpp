// Finds wrong words before CLI11 parses, so that the message can suggest the nearest word.
#include "commands/wrong_words.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <span>

#include "base/text.h"

namespace palpate::commands {
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
    return std::find(after.begin(), after.end(), inner) != after.end();
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
      if (std::find(names.begin(), names.end(), word) == names.end())
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

}  // namespace palpate::commands
