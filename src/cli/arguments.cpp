// The options of every verb, for parsing and help.
#include "cli/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <thread>
#include <tuple>

#include "cli/wrong_words.h"
#include "device/link_text.h"
#include "fit/model.h"
#include "report/machine.h"

namespace palpate::cli {
namespace {

void add_settings(CLI::App& verb, std::vector<std::string>& settings) {
  verb.add_option("--set", settings, "Set a key: KEY=VALUE")->allow_extra_args(false);
}

void add_out(CLI::App& verb, std::string& out) {
  verb.add_option("--out", out, "Folder of the results")->capture_default_str();
}

void add_jobs(CLI::App& verb, int& jobs) {
  verb.add_option("--jobs", jobs, "Workers; 0: one per core")->check(CLI::Range(0, 1024));
}

// Options on the layout of a measured file, for every verb that reads one.
void add_data(CLI::App& verb, DataOptions& data) {
  verb.add_option("--x", data.x, "Column of x: its name, or its number");
  verb.add_option("--y", data.y, "Column of y: its name, or its number");
  verb.add_option("--x-unit", data.x_unit, "Unit of x, if the file does not give it");
  verb.add_option("--y-unit", data.y_unit, "Unit of y, if the file does not give it");
  verb.add_option("--skip", data.skip, "Lines above the table")->check(CLI::Range(0, 1000000));
  verb.add_option("--separator", data.separator, "Separator of columns: , ; tab blank");
  verb.add_option("--decimal", data.decimal, "Decimal sign: . or ,");
  verb.add_option("--compression", data.compression,
                  "Sign of compression in the file: positive, negative, auto");
  verb.add_option("--segment", data.segment,
                  "Only approach or retract, or a value of the column `segment` or `step`; "
                  "NAME:2 is the second of that name");
  verb.add_option("--where", data.where, "Only rows with this value: COLUMN=VALUE")
      ->allow_extra_args(false);
  verb.add_option("--rows", data.rows, "Only these rows of the table, as 100..2000");
  verb.add_option("--table", data.table, "Which of several tables in the file, from 1")
      ->check(CLI::Range(1, 1000));
  verb.add_option("--case", data.case_name, "Only rows with this value in the column `case`");
}

// Below, one overload per verb.

void add_options(CLI::App& verb, Run& run) {
  verb.add_option("scenario", run.scenarios, "Scenario files")->required();
  add_out(verb, run.out);
  add_settings(verb, run.settings);
  add_jobs(verb, run.jobs);
  verb.add_flag("--force", run.force, "Replace finished results");
  RunDevice& device = run.device;
  CLI::Option* link = verb.add_option(
      "--device", device.link, "Run on " + device::link_forms() + "; without --arm only read");
  const auto beside = [&](CLI::Option* option) { option->needs(link); };
  beside(verb.add_flag("--arm", device.arm, "Allow motion and forces"));
  beside(verb.add_flag("--realtime", device.realtime, "Run with real-time priority"));
  beside(verb.add_flag("--traffic", device.traffic, "Keep the bytes sent and received"));
  beside(verb.add_flag("--expect", device.expect,
                       "Exit code 3 unless the measured force agrees with the model"));
  beside(verb.add_option("--surface", device.surface,
                         "Height of the surface in the device's z, as \"-2 mm\""));
  beside(verb.add_option("--max-force", device.most_force, "Largest force, as \"2 N\""));
  beside(verb.add_option("--seconds", device.seconds, "End after this time, s")
             ->check(CLI::Range(0.001, 1e6)));
  // Hidden, for tests: a virtual clock follows the emulator.
  beside(verb.add_option("--clock", device.clock)
             ->check(CLI::IsMember({"real", "virtual"}))
             ->group(""));
}

void add_options(CLI::App& verb, Explain& explain) {
  verb.add_option("subject", explain.subject, "Scenario file or key")->required();
  add_settings(verb, explain.settings);
}

void add_options(CLI::App& verb, Fit& fit) {
  std::string models;
  for (const fit::ModelInfo& model : fit::models()) models += std::string(model.name) + "|";
  for (const char* name : further_models) models += std::string(name) + "|";
  models.pop_back();
  verb.add_option("data", fit.data, "CSV or other tables in text")->required();
  verb.add_option("--out", fit.out, "Folder for the rows, the population and its figure");
  verb.add_flag("--force", fit.force, "Replace that folder");
  add_data(verb, fit.columns);
  verb.add_option("--model", fit.model, "Curve: " + models)->required();
  verb.add_option("--origin", fit.x_origin, "Subtracted from every x");
  verb.add_option("--radius", fit.radius, "hertz, layer: of the sphere or punch, as \"11 mm\"");
  verb.add_option("--tip", fit.tip,
                  "hertz: paraboloid (default), sphere, cone, pyramid3, pyramid4, punch");
  verb.add_option("--half-angle", fit.half_angle,
                  "hertz: between axis and face of a cone or pyramid, as \"20 deg\"");
  verb.add_option(
      "--baseline", fit.baseline,
      "hertz, layer: none, offset or tilt; default: what the rows before contact allow");
  verb.add_option("--from", fit.from,
                  "Least depth below contact, as \"0.1 mm\" or \"10 %\"; modulus: strain");
  verb.add_option("--to", fit.to, "Largest depth or strain, likewise");
  verb.add_option("--height", fit.height, "modulus, neo_hookean, ogden: of the specimen");
  verb.add_option("--diameter", fit.diameter, "the same: of a round specimen");
  verb.add_option("--area", fit.area, "the same: of the cross-section, as \"300 mm^2\"");
  verb.add_option("--platens", fit.platens, "the same: slippery (default) or bonded");
  verb.add_option("--loading", fit.loading, "the same: compression or tension");
  verb.add_option("--poisson", fit.poisson_ratio, "hertz, layer: Poisson's ratio")
      ->check(CLI::Range(0.0, 0.5));
  verb.add_option("--thickness", fit.thickness, "layer: of the tissue, as \"5 mm\"");
  verb.add_option("--base", fit.base, "layer: bonded (default) or frictionless");
  verb.add_option("--terms", fit.terms,
                  "prony: number of relaxation times; above 5 they are spaced in their logarithm")
      ->check(CLI::Range(1, 60));
  verb.add_option("--ramp", fit.ramp, "prony: duration of the loading ramp, in the unit of x")
      ->check(CLI::PositiveNumber);
  verb.add_option("--history", fit.history,
                  "prony: column of the strain or depth over time (creep: of the stress)");
  verb.add_option("--history-power", fit.history_power,
                  "prony: exponent of that column; default 1, and 1.5 of a depth under a force")
      ->check(CLI::Range(0.5, 3.0));
}

void add_options(CLI::App& verb, Data& data) {
  verb.add_option("data", data.data, "CSV or other table in text")->required();
  add_data(verb, data.columns);
}

void add_options(CLI::App& verb, Compare& compare) {
  verb.add_option("got", compare.got, "CSV file or result folder")->required();
  verb.add_option("want", compare.want, "CSV file or folder to compare with")->required();
  verb.add_option("--tolerances", compare.tolerances, "TOML file of tolerances by column");
}

void add_options(CLI::App& golden, Bless& bless) {
  golden.require_subcommand(1);
  golden.fallthrough();
  CLI::App* verb = golden.add_subcommand("bless", "Replace the expected results by today's");
  verb->add_option("name", bless.names, "Folders below golden/")->required();
  verb->add_option("--reason", bless.reason, "Why they may change")->required();
}

void add_options(CLI::App& verb, Mesh& mesh) {
  verb.add_option("subject", mesh.subject,
                  "Surface (.stl .obj .ply .off), mesh (.node .ele .msh) or scenario (.toml)")
      ->required();
  verb.add_option("--unit", mesh.unit, "Unit of coordinates, as mm; not for scenarios");
  CLI::Option* nodes = verb.add_option("--nodes", mesh.nodes, "For a surface: about so many nodes")
                           ->check(CLI::Range(4, 1000000));
  verb.add_option("--edge", mesh.edge, "For a surface: about this edge length, as \"3 mm\"")
      ->excludes(nodes);
  verb.add_option("--out", mesh.out, "File to write: .node, .ele (both, in metres) or .vtu")
      ->allow_extra_args(false);
  verb.add_option("--set", mesh.settings, "Set a scenario's key: KEY=VALUE")
      ->allow_extra_args(false);
  verb.add_flag("--force", mesh.force, "Replace files");
}

void add_options(CLI::App& verb, Reference& reference) {
  verb.add_option("scenario", reference.scenario, "Scenario file")->required();
  verb.add_option("--levels", reference.levels, "Number of meshes, each finer than the last")
      ->capture_default_str()
      ->check(CLI::Range(3, 8));
  add_settings(verb, reference.settings);
  verb.add_option("--out", reference.out, "Folder to write SCENARIO_reference.csv into");
  verb.add_flag("--force", reference.force, "Replace that file");
}

void add_options(CLI::App& verb, Bench& bench) {
  verb.add_option("scenario", bench.scenarios, "Scenario files; none: the paper's four models");
  add_settings(verb, bench.settings);
  verb.add_option("--frames", bench.frames, "Number of frames of 1 ms")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
}

void add_options(CLI::App& verb, Chart& chart) {
  verb.add_option("scenario", chart.scenario, "Scenario file")->required();
  add_settings(verb, chart.settings);
  add_out(verb, chart.out);
  verb.add_option("--repeats", chart.repeats, "Timings of every variant")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  verb.add_flag("--force", chart.force, "Start again, and replace a finished or partial chart");
}

void add_options(CLI::App& verb, Stability& stability) {
  verb.add_option("scenario", stability.scenario, "Scenario file")->required();
  add_settings(verb, stability.settings);
  add_out(verb, stability.out);
  verb.add_flag("--force", stability.force, "Replace a finished map");
}

void add_options(CLI::App& all, Sweep& sweep) {
  all.require_subcommand(1);
  all.fallthrough();
  const auto add = [&](const char* name, Sweep::Act act, const char* what) {
    CLI::App* verb = all.add_subcommand(name, what);
    verb->callback([&sweep, act] { sweep.act = act; });
    const bool plan = act == Sweep::Act::plan;
    verb->add_option(plan ? "scenario" : "folder", sweep.subject,
                     plan ? "Scenario file with a [sweep]" : "Folder of the plan")
        ->required();
    return verb;
  };
  CLI::App* verb = add("plan", Sweep::Act::plan, "Check all cases and write the plan");
  add_settings(*verb, sweep.settings);
  verb->add_option("--out", sweep.out, "The plan goes to OUT/SCENARIO_sweep")
      ->capture_default_str();
  verb->add_flag("--curves", sweep.curves, "Keep the curves of every case");
  verb->add_flag("--yes", sweep.yes, "Allow any number of cases");
  verb = add("run", Sweep::Act::run, "Run the cases that are not finished");
  verb->add_option("--shard", sweep.shard, "The I-th of N parts: I/N")->capture_default_str();
  add_jobs(*verb, sweep.jobs);
  verb->add_option("--lanes", sweep.lanes, "Cases in one loop: auto, none, all (same results)")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "none", "all"}));
  add("status", Sweep::Act::status, "How many cases are finished, failed and missing");
  add("retry", Sweep::Act::retry, "Run failed cases once more");
  verb = add("merge", Sweep::Act::merge, "All results as one table, with figures");
  verb->add_flag("--force", sweep.force, "Replace the merged results");
  verb->add_option("--show", sweep.show, "A column of results.csv to draw; may be repeated")
      ->allow_extra_args(false);
  verb = add("slurm", Sweep::Act::slurm, "Write a job file, and print the sbatch command");
  verb->add_option("--chunk", sweep.chunk, "Cases per task")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000000));
  verb->add_option("--time", sweep.time, "Time limit per task, as 01:00:00");
}

void add_options(CLI::App& verb, Identify& identify) {
  verb.add_option("data", identify.data, "CSV file of the measurement")->required();
  verb.add_option("scenario", identify.scenario, "Scenario of the test")->required();
  add_data(verb, identify.columns);
  verb.add_option("--noise", identify.noise, "Noise of the measurement: constant or relative")
      ->capture_default_str()
      ->check(CLI::IsMember({"constant", "relative"}));
  verb.add_option("--unknown", identify.unknowns, "Unknown with its range: KEY=LOW..HIGH")
      ->required()
      ->allow_extra_args(false);
  verb.add_option("--given", identify.givens, "Known with its deviation: KEY=\"VALUE +- SD\"")
      ->allow_extra_args(false);
  add_settings(verb, identify.settings);
  add_out(verb, identify.out);
  verb.add_flag("--force", identify.force, "Replace a finished result");
}

void add_options(CLI::App& verb, Export& export_to) {
  verb.add_option("result", export_to.result, "Result folder, or one of its CSV files")->required();
  verb.add_option("--to", export_to.format, "Format")->required();
  verb.add_option("--case", export_to.case_name, "Only this case");
  verb.add_option("--out", export_to.out, "Folder to write into")->capture_default_str();
  verb.add_flag("--force", export_to.force, "Replace files");
}

void add_options(CLI::App& all, Device& device) {
  all.require_subcommand(1);
  all.fallthrough();
  const auto add = [&](const char* name, Device::Act act, const char* what) {
    CLI::App* verb = all.add_subcommand(name, what);
    verb->callback([&device, act] { device.act = act; });
    verb->add_option("link", device.link, device::link_forms())->required();
    return verb;
  };
  add("probe", Device::Act::probe, "Identify the device; nothing moves, no force is sent");
  add("stop", Device::Act::stop, "Stop a stand, also one that another process moves");
  add("monitor", Device::Act::monitor, "Read samples, and report their rate and gaps")
      ->add_option("--seconds", device.seconds, "Duration, s")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 86400.0));
}

void add_options(CLI::App&, Manual&) {}

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
    app.set_version_flag("--version", "palpate " + report::this_build().version);
    app.add_flag("--quiet,-q", arguments.manner.quiet, "Only errors on stderr");
    app.add_flag("--json", arguments.manner.json, "JSON on stdout, one object per line");
    app.footer(
        "Exit codes: 0 good, 1 internal, 2 bad input, 3 comparison differs, 4 diverged, 5 mesh,\n"
        "6 device link, 7 sweep incomplete, 75 interrupted, resumable, 130 interrupted.\n"
        "Data go to stdout, messages to stderr.");
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
    std::string command;
    while (!asked->get_subcommands().empty()) {
      command += (command.empty() ? "" : " ") + asked->get_name();
      asked = asked->get_subcommands().front();
    }
    return Answer{asked->help(command)};
  } catch (const CLI::ParseError& error) {
    return UsageError{sentence(parser.app, error)};
  }
  parser.arguments.given = arguments;
  parser.arguments.verb = parser.chosen();
  return parser.arguments;
}

}  // namespace palpate::cli
