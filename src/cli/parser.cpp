// Parses the command line into the struct of its verb.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <thread>
#include <tuple>

#include "cli/arguments.h"
#include "cli/options.h"
#include "commands/complete.h"
#include "commands/wrong_words.h"
#include "report/machine.h"
#include "scenario/find.h"
#include "scenario/schema.h"

namespace palpate::cli {
namespace {

// The structs of all verbs, into which CLI11 writes the options.
template <class Variant>
struct CommandsOf;
template <class... Kinds>
struct CommandsOf<std::variant<Kinds...>> {
  std::tuple<Kinds...> each;
};

struct Parser {
  CLI::App app{"Batch mechanical testing of virtual soft tissue.", "palpate"};
  Arguments arguments;
  CommandsOf<Verb> commands;

  Parser() {
    app.require_subcommand(1);
    app.fallthrough();
    app.set_version_flag("--version,-V", "palpate " + report::this_build().version);
    app.add_flag("--quiet,-q", arguments.manner.quiet, "Only errors on stderr");
    app.add_flag("--no-color", arguments.manner.no_colour, "No colours, as with NO_COLOR set");
    app.add_flag("--json", arguments.manner.json, "JSON on stdout, one object per line");
    app.footer(
        "Exit codes: 0 good, 1 internal, 2 bad input, 3 comparison differs, 4 diverged, 5 mesh,\n"
        "6 device link, 7 sweep incomplete, 8 part run elsewhere, 75 interrupted, resumable, 130 "
        "interrupted.\n"
        "Data go to stdout, messages to stderr.");
    // For its place in lists: parse() reads `help VERB` as `VERB --help`.
    app.add_subcommand("help", "Print the help of a verb")
        ->add_option_function<std::vector<std::string>>(
            "verb", [](const std::vector<std::string>&) {}, "The verb; none: a list of all");
    for_each_command([&](auto& command) {
      add_options(*app.add_subcommand(command.word.word, command.word.meaning), command);
    });
  }

  template <class Use>
  void for_each_command(const Use& use) {
    std::apply([&](auto&... command) { (use(command), ...); }, commands.each);
  }

  Verb chosen() {
    std::optional<Verb> verb;
    for_each_command([&](auto& command) {
      if (app.got_subcommand(command.word.word)) verb = command;
    });
    return *verb;  // the parser requires one
  }
};

}  // namespace

int worker_count(int jobs) {
  return jobs > 0 ? jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

commands::Command described() { return commands::describe(Parser().app); }

std::variant<Arguments, UsageError, Answer> parse(const std::vector<std::string>& given) {
  std::vector<std::string> arguments = given;
  if (!given.empty() && given.front() == "help") {
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  } else if (!given.empty() && given.front() == "complete") {  // asked by the scripts of shells
    const std::vector<std::string> words(given.begin() + 1, given.end());
    return Answer{
        commands::complete(described(), words, scenario::settable_keys(), scenario::examples())};
  }
  Parser parser;
  if (const auto wrong = commands::wrong_word(parser.app, arguments)) return UsageError{*wrong};
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  try {
    parser.app.parse(reversed);
  } catch (const CLI::CallForVersion&) {
    return Answer{parser.app.version() + "\n"};
  } catch (const CLI::CallForHelp&) {
    const CLI::App* asked = &parser.app;
    std::string command;
    while (!asked->get_subcommands().empty()) {
      command += (command.empty() ? "" : " ") + asked->get_name();
      asked = asked->get_subcommands().front();
    }
    return Answer{asked->help(command)};
  } catch (const CLI::ParseError& error) {
    return UsageError{commands::sentence(parser.app, error)};
  }
  parser.arguments.given = arguments;
  parser.arguments.verb = parser.chosen();
  return parser.arguments;
}

}  // namespace palpate::cli
