// Parses the command line into the struct of its verb.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <thread>
#include <tuple>

#include "cli/arguments.h"
#include "cli/options.h"
#include "commands/complete.h"
#include "commands/wrong_words.h"
#include "report/manifest.h"
#include "scenario/family.h"
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

struct Listed {
  std::string_view verb, group, example;
};
constexpr const char* scenarios = "Scenarios";
constexpr const char* agreement = "Agreement";
constexpr const char* measured = "Measured curves";
constexpr const char* judging = "Judging the model";
constexpr const char* files = "Files";
constexpr const char* installers = "For installers";
// The group of each verb in the help, and one call.
constexpr std::array<Listed, 18> listed{
    {{"new", scenarios, "palpate new press"},
     {"explain", scenarios, "palpate explain contact.viscosity"},
     {"run", scenarios, "palpate run quickstart --set \"step.1.to=3 mm\""},
     {"sweep", "Many cases", "palpate sweep plan sweep.toml"},
     {"compare", agreement, "palpate compare out/press other/press"},
     {"golden", agreement, "palpate golden check"},
     {"data", measured, "palpate data measured.txt --x-unit um"},
     {"fit", measured, "palpate fit measured.csv --model hertz --radius \"11 mm\" --poisson 0.45"},
     {"identify", measured,
      "palpate identify measured.csv press.toml --unknown \"tissue.young_modulus=1..500 kPa\""},
     {"device", measured, "palpate device probe mark10:/dev/ttyUSB0"},
     {"chart", judging, "palpate chart press.toml"},
     {"stability", judging, "palpate stability press.toml"},
     {"reference", judging, "palpate reference press.toml --out truth"},
     {"convert", files, "palpate convert leg.stl --unit mm --edge \"3 mm\" --out leg.vtu"},
     {"open", files, "palpate open out/press"},
     {"manual", installers, "palpate manual keys --man"},
     {"schema", installers, "palpate schema > palpate.schema.json"},
     {"completion", installers, "palpate completion bash"}}};

// Of the verbs within verbs.
constexpr std::array<std::pair<std::string_view, std::string_view>, 13> inner_examples{
    {{"sweep plan", "sweep.toml"},
     {"sweep run", "out/sweep_sweep --jobs 4"},
     {"sweep status", "out/sweep_sweep"},
     {"sweep retry", "out/sweep_sweep"},
     {"sweep merge", "out/sweep_sweep"},
     {"sweep parts", "out/sweep_sweep --of 8 | parallel"},
     {"sweep slurm", "out/sweep_sweep --chunk 20 --time 01:00:00"},
     {"golden add", "press.toml"},
     {"golden check", "scenarios --junit golden.xml"},
     {"golden list", "scenarios"},
     {"device probe", "mark10:/dev/ttyUSB0"},
     {"device monitor", "mark10:/dev/ttyUSB0 --seconds 5"},
     {"device stop", "mark10:/dev/ttyUSB0"}}};

void add_inner_examples(CLI::App& verb) {
  for (CLI::App* inner : verb.get_subcommands([](const CLI::App*) { return true; }))
    for (const auto& [words, rest] : inner_examples)
      if (words == verb.get_name() + " " + inner->get_name())
        inner->footer("Example: palpate " + std::string(words) + " " + std::string(rest));
}

const Listed& listing(std::string_view verb) {
  return *std::find_if(listed.begin(), listed.end(),
                       [&](const Listed& one) { return one.verb == verb; });
}

// What a word that was a verb is called now.
std::optional<std::string> renamed(const std::vector<std::string>& given) {
  const std::string two = given.front() + (given.size() > 1 ? " " + given[1] : "");
  for (const auto& [old, now] : {std::pair{"mesh", "convert"},
                                 {"export", "convert"},
                                 {"report", "open"},
                                 {"bench", "chart --frames 1000"},
                                 {"golden bless", "golden add --force --reason TEXT"}})
    if (given.front() == old || two == old)
      return "`palpate " + std::string(old) + "` is `palpate " + now + "` now";
  return std::nullopt;
}

constexpr const char* welcome =
    "palpate presses a virtual finger into virtual soft tissue, and says the force and its error.\n"
    "\n"
    "  palpate run quickstart     a first press, with a page of its results\n"
    "  palpate new press          a commented scenario of your own, press.toml\n"
    "  palpate --help             all verbs; `palpate help VERB` shows one\n";

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
    app.add_flag("--csv", arguments.manner.csv, "CSV on a terminal too, where else tables stand");
    app.footer(
        "Exit codes: 0 good, 1 internal, 2 bad input, 3 comparison differs, 4 diverged, 5 mesh,\n"
        "6 device link, 7 sweep incomplete, 8 part run elsewhere, 75 interrupted, resumable, 130 "
        "interrupted.\n"
        "Data go to stdout, messages to stderr.");
    // For its place in lists: parse() reads `help VERB` as `VERB --help`.
    app.add_subcommand("help", "Print the help of a verb")
        ->group("Help")
        ->add_option_function<std::vector<std::string>>(
            "verb", [](const std::vector<std::string>&) {}, "The verb; none: a list of all");
    for_each_command([&](auto& command) {
      CLI::App& verb = *app.add_subcommand(command.word.word, command.word.meaning);
      add_options(verb, command);
      verb.group(std::string(listing(command.word.word).group));
      verb.footer("Example: " + std::string(listing(command.word.word).example));
      add_inner_examples(verb);
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
  if (given.empty()) return Answer{welcome};
  if (const auto now = renamed(arguments)) return UsageError{*now};
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
