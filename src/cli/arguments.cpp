// CLI11 parses; wrong words are found first, so that a suggestion can be made.
#include "cli/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/text.h"
#include "fit/model.h"
#include "report/machine.h"

namespace palpate::cli {
namespace {

struct Parser {
  CLI::App app{"Batch mechanical testing of virtual soft tissue.", "palpate"};
  Arguments arguments;
  Run run;
  Explain explain;
  Fit fit;
  Compare compare;
  Bless bless;
  CLI::App* bless_verb = nullptr;

  Parser() {
    app.require_subcommand(1);
    app.fallthrough();
    app.set_version_flag("--version", "palpate " + report::this_build().version);
    app.add_flag("--quiet,-q", arguments.manner.quiet, "Only errors on stderr");
    app.add_flag("--json", arguments.manner.json, "Events as JSON on stdout, one object a line");
    app.footer(
        "Exit codes: 0 good, 1 internal, 2 bad input, 3 comparison differs, 4 diverged, 5 mesh,\n"
        "130 interrupted. Data goes to stdout, talk to stderr.");

    CLI::App* verb = app.add_subcommand("run", "Run scenarios and write their results");
    verb->add_option("scenario", run.scenarios, "Scenario files")->required();
    verb->add_option("--out", run.out, "Folder of the results")->capture_default_str();
    verb->add_option("--set", run.settings, "Set a key: KEY=VALUE")->allow_extra_args(false);
    verb->add_option("--jobs", run.jobs, "Workers; 0: one a core")->check(CLI::NonNegativeNumber);
    verb->add_flag("--force", run.force, "Replace finished results");

    verb = app.add_subcommand("explain", "What a scenario would compute, or what a key means");
    verb->add_option("subject", explain.subject, "Scenario file or key")->required();
    verb->add_option("--set", explain.settings, "Set a key: KEY=VALUE")->allow_extra_args(false);

    verb = app.add_subcommand("fit", "Fit a curve to two columns of a CSV file");
    verb->add_option("data", fit.data, "CSV file")->required();
    verb->add_option("--x", fit.x, "Column of x")->required();
    verb->add_option("--y", fit.y, "Column of y")->required();
    verb->add_option("--model", fit.model, "Curve: " + model_names())->required();
    verb->add_option("--case", fit.case_name, "Only rows whose column `case` says so");
    verb->add_option("--origin", fit.x_origin, "Subtracted from every x");

    verb = app.add_subcommand("compare", "Compare results with expected ones");
    verb->add_option("got", compare.got, "CSV file or result folder")->required();
    verb->add_option("want", compare.want, "CSV file or folder to compare with")->required();
    verb->add_option("--tolerances", compare.tolerances, "TOML file of tolerances by column");

    CLI::App* golden = app.add_subcommand("golden", "The golden results in golden/");
    golden->require_subcommand(1);
    golden->fallthrough();
    bless_verb = golden->add_subcommand("bless", "Make today's results the expected ones");
    bless_verb->add_option("name", bless.names, "Folders below golden/")->required();
    bless_verb->add_option("--reason", bless.reason, "Why they may change")->required();

    app.add_subcommand("manual", "The reference of all scenario keys, in markdown");
  }

  static std::string model_names() {
    std::string names;
    for (const fit::ModelInfo& model : fit::models())
      names += (names.empty() ? "" : "|") + std::string(model.name);
    return names;
  }

  [[nodiscard]] Verb chosen() const {
    if (app.got_subcommand("run")) return run;
    if (app.got_subcommand("explain")) return explain;
    if (app.got_subcommand("fit")) return fit;
    if (app.got_subcommand("compare")) return compare;
    if (app.got_subcommand("golden")) return bless;
    return Manual{};
  }
};

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(verb->get_name());
  return names;
}

void add_options(const CLI::App& app, std::vector<std::string>& names) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const auto near = nearest(word, known);
  return near ? "; did you mean `" + *near + "`?" : "; known: " + joined(known, ", ");
}

// The first word that no verb or option of ours is.
std::optional<std::string> wrong_word(const CLI::App& app,
                                      const std::vector<std::string>& arguments) {
  const CLI::App* verb = &app;
  std::vector<std::string> options;
  add_options(app, options);
  for (const std::string& word : arguments) {
    if (word == "--") break;
    if (word.starts_with("--") && word.size() > 2) {
      const std::string name = word.substr(0, word.find('='));
      if (std::find(options.begin(), options.end(), name) == options.end())
        return "unknown option `" + name + "`" + did_you_mean(name, options);
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

}  // namespace

std::variant<Arguments, UsageError, Answer> parse(const std::vector<std::string>& arguments) {
  Parser parser;
  if (const auto wrong = wrong_word(parser.app, arguments)) return UsageError{*wrong};
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  try {
    parser.app.parse(reversed);
  } catch (const CLI::CallForVersion&) {
    return Answer{parser.app.version() + "\n"};
  } catch (const CLI::CallForHelp&) {
    const CLI::App* asked = &parser.app;
    while (!asked->get_subcommands().empty()) asked = asked->get_subcommands().front();
    return Answer{asked->help()};
  } catch (const CLI::ParseError& error) {
    return UsageError{std::string(error.what()) + "; `palpate --help` lists what is known"};
  }
  parser.arguments.given = arguments;
  parser.arguments.verb = parser.chosen();
  return parser.arguments;
}

}  // namespace palpate::cli
