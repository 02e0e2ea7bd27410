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
  return names;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const auto near = nearest(word, known);
  return near ? "; did you mean `" + *near + "`?" : "; known: " + joined(known, ", ");
}

// `after` are the words behind it.
std::string unknown_option(const CLI::App& verb, const std::string& name, const Options& known,
                           std::span<const std::string> after) {
  std::vector<std::string> inners = verb_names(verb);
  std::stable_partition(inners.begin(), inners.end(), [&](const std::string& inner) {
    return std::find(after.begin(), after.end(), inner) != after.end();
  });
  for (const std::string& inner : inners)
    if (verb.get_subcommand(inner)->get_option_no_throw(name) != nullptr)
      return "option `" + name + "` stands before its verb; write it as `palpate " + inner +
             " ... " + name + "`";
  return "unknown option `" + name + "`" + did_you_mean(name, long_names(known));
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
      return unknown_option(*verb, name, options, std::span(arguments).subspan(i));
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
  return "`" + command + "` cannot be read: " + what + help;
}

}  // namespace palpate::commands
