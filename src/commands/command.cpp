// Turns a parser of CLI11 into plain values.
#include "commands/command.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/text.h"

namespace palpate::commands {
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
  const auto found = std::find_if(commands.begin(), commands.end(),
                                  [&](const Command& one) { return one.name == command; });
  return found == commands.end() ? nullptr : &*found;
}

Command describe(const CLI::App& app) { return described(app, true); }

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
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

}  // namespace palpate::commands
