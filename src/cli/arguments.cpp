// The one table of verbs and options: parsing and help come from it.
#include "cli/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/wrong_words.h"
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
  Mesh mesh;
  Reference reference;
  Bench bench;
  Chart chart;
  Stability stability;
  Sweep sweep;
  Identify identify;
  Export export_to;
  Device device;

  Parser() {
    app.require_subcommand(1);
    app.fallthrough();
    app.set_version_flag("--version", "palpate " + report::this_build().version);
    app.add_flag("--quiet,-q", arguments.manner.quiet, "Only errors on stderr");
    app.add_flag("--json", arguments.manner.json, "Events as JSON on stdout, one object a line");
    app.footer(
        "Exit codes: 0 good, 1 internal, 2 bad input, 3 comparison differs, 4 diverged, 5 mesh,\n"
        "6 device link, 7 sweep incomplete, 75 interrupted, resumable, 130 interrupted.\n"
        "Data goes to stdout, talk to stderr.");

    CLI::App* verb = app.add_subcommand("run", "Run scenarios and write their results");
    verb->add_option("scenario", run.scenarios, "Scenario files")->required();
    verb->add_option("--out", run.out, "Folder of the results")->capture_default_str();
    verb->add_option("--set", run.settings, "Set a key: KEY=VALUE")->allow_extra_args(false);
    verb->add_option("--jobs", run.jobs, "Workers; 0: one a core")->check(CLI::Range(0, 1024));
    verb->add_flag("--force", run.force, "Replace finished results");
    add_run_device(*verb);

    verb = app.add_subcommand("explain", "What a scenario would compute, or what a key means");
    verb->add_option("subject", explain.subject, "Scenario file or key")->required();
    verb->add_option("--set", explain.settings, "Set a key: KEY=VALUE")->allow_extra_args(false);

    verb = app.add_subcommand("fit", "Fit a curve to two columns of a table in text");
    verb->add_option("data", fit.data, "CSV or other table in text")->required();
    add_data(verb, fit.columns, Columns::required);
    verb->add_option("--model", fit.model, "Curve: " + model_names())->required();
    verb->add_option("--origin", fit.x_origin, "Subtracted from every x");
    verb->add_option("--radius", fit.radius, "hertz, layer: of the sphere, as \"11 mm\"");
    verb->add_option("--poisson", fit.poisson_ratio, "hertz, layer: Poisson's ratio")
        ->check(CLI::Range(0.0, 0.5));
    verb->add_option("--thickness", fit.thickness, "layer: of the tissue, as \"5 mm\"");
    verb->add_option("--base", fit.base, "layer: bonded (if not said) or frictionless");
    verb->add_option("--terms", fit.terms, "prony: how many relaxation times")
        ->check(CLI::Range(1, 5));

    verb = app.add_subcommand("compare", "Compare results with expected ones");
    verb->add_option("got", compare.got, "CSV file or result folder")->required();
    verb->add_option("want", compare.want, "CSV file or folder to compare with")->required();
    verb->add_option("--tolerances", compare.tolerances, "TOML file of tolerances by column");

    CLI::App* golden = app.add_subcommand("golden", "The golden results in golden/");
    golden->require_subcommand(1);
    golden->fallthrough();
    CLI::App* bless_verb =
        golden->add_subcommand("bless", "Make today's results the expected ones");
    bless_verb->add_option("name", bless.names, "Folders below golden/")->required();
    bless_verb->add_option("--reason", bless.reason, "Why they may change")->required();

    verb = app.add_subcommand("mesh", "Check and mesh a surface, a mesh or a scenario's specimen");
    verb->add_option("subject", mesh.subject,
                     "Surface (.stl .obj .ply .off), mesh (.node .ele .msh) or scenario (.toml)")
        ->required();
    verb->add_option("--unit", mesh.unit, "Of the file's coordinates, as mm; not for scenarios");
    CLI::Option* nodes = verb->add_option("--nodes", mesh.nodes, "About so many, of a surface")
                             ->check(CLI::Range(4, 1000000));
    verb->add_option("--edge", mesh.edge, "About such edges, as \"3 mm\", of a surface")
        ->excludes(nodes);
    verb->add_option("--out", mesh.out, "File to write: .node, .ele (both, in metres) or .vtu")
        ->allow_extra_args(false);
    verb->add_option("--set", mesh.settings, "Set a scenario's key: KEY=VALUE")
        ->allow_extra_args(false);
    verb->add_flag("--force", mesh.force, "Replace files");

    verb = app.add_subcommand(
        "reference", "Forces by the strongest model, refined and extrapolated, with their error");
    verb->add_option("scenario", reference.scenario, "Scenario file")->required();
    verb->add_option("--levels", reference.levels, "How many meshes, each finer than the last")
        ->capture_default_str()
        ->check(CLI::Range(3, 8));
    verb->add_option("--set", reference.settings, "Set a key: KEY=VALUE")->allow_extra_args(false);
    verb->add_option("--out", reference.out, "Folder to write SCENARIO_reference.csv into");
    verb->add_flag("--force", reference.force, "Replace that file");

    verb = app.add_subcommand("bench", "Time the frames of a press: the paper's Table 2");
    verb->add_option("scenario", bench.scenarios, "Scenario files; none: the paper's four models");
    verb->add_option("--frames", bench.frames, "How many, of 1 ms each")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000000));

    verb = app.add_subcommand("chart",
                              "Speed against accuracy: every model, step and mesh that serves");
    verb->add_option("scenario", chart.scenario, "Scenario file")->required();
    verb->add_option("--set", chart.settings, "Set a key: KEY=VALUE")->allow_extra_args(false);
    verb->add_option("--out", chart.out, "Folder of the results")->capture_default_str();
    verb->add_option("--repeats", chart.repeats, "Timings of every variant")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    verb->add_flag("--force", chart.force, "Begin afresh, over a finished chart or a part of one");

    verb = app.add_subcommand("stability", "Where methods fail: measured limits beside theory");
    verb->add_option("scenario", stability.scenario, "Scenario file")->required();
    verb->add_option("--set", stability.settings, "Set a key: KEY=VALUE")->allow_extra_args(false);
    verb->add_option("--out", stability.out, "Folder of the results")->capture_default_str();
    verb->add_flag("--force", stability.force, "Replace a finished map");

    add_sweep();

    verb = app.add_subcommand("identify", "The properties behind a measured curve");
    verb->add_option("data", identify.data, "CSV file of the measurement")->required();
    verb->add_option("scenario", identify.scenario, "Scenario of the test")->required();
    add_data(verb, identify.columns, Columns::optional);
    verb->add_option("--noise", identify.noise, "Of the measurement: constant or relative")
        ->capture_default_str()
        ->check(CLI::IsMember({"constant", "relative"}));
    verb->add_option("--unknown", identify.unknowns, "What is sought: KEY=LOW..HIGH")
        ->required()
        ->allow_extra_args(false);
    verb->add_option("--set", identify.settings, "Set a key: KEY=VALUE")->allow_extra_args(false);
    verb->add_option("--out", identify.out, "Folder of the results")->capture_default_str();
    verb->add_flag("--force", identify.force, "Replace a finished result");

    verb = app.add_subcommand("export", "Write results as other tools read them");
    verb->add_option("result", export_to.result, "Result folder, or one of its CSV files")
        ->required();
    verb->add_option("--to", export_to.format, "Format")->required();
    verb->add_option("--case", export_to.case_name, "Only this case");
    verb->add_option("--out", export_to.out, "Folder to write into")->capture_default_str();
    verb->add_flag("--force", export_to.force, "Replace files");

    add_device();

    app.add_subcommand("manual", "The reference of all scenario keys, in markdown");
  }

  enum class Columns { required, optional };

  // How a measured file is written, of every verb that reads one.
  static void add_data(CLI::App* verb, DataOptions& data, Columns columns) {
    const bool required = columns == Columns::required;
    verb->add_option("--x", data.x, "Column of x: its name, or its number")->required(required);
    verb->add_option("--y", data.y, "Column of y: its name, or its number")->required(required);
    verb->add_option("--x-unit", data.x_unit, "Unit of x, where the file does not say it");
    verb->add_option("--y-unit", data.y_unit, "Unit of y, where the file does not say it");
    verb->add_option("--skip", data.skip, "Lines above the table")->check(CLI::Range(0, 1000000));
    verb->add_option("--separator", data.separator, "Of columns: , ; tab blank");
    verb->add_option("--decimal", data.decimal, "Decimal sign: . or ,");
    verb->add_option("--compression", data.compression,
                     "How the load cell reads it: positive, negative, auto");
    verb->add_option("--segment", data.segment,
                     "Only approach or retract, or what the column `segment` or `step` holds");
    verb->add_option("--case", data.case_name, "Only rows whose column `case` says so");
  }

  void add_device() {
    CLI::App* all = app.add_subcommand("device", "Live devices: who is there, and how they do");
    all->require_subcommand(1);
    all->fallthrough();
    const auto add = [&](const char* name, Device::Act act, const char* what) {
      CLI::App* verb = all->add_subcommand(name, what);
      verb->callback([this, act] { device.act = act; });
      verb->add_option("link", device.link,
                       "mark10:PORT, inverse3:HOST:PORT[:EVENTS] or replay:FILE.csv")
          ->required();
      return verb;
    };
    add("probe", Device::Act::probe, "Who is there; nothing moves, no force is sent");
    CLI::App* verb = add("monitor", Device::Act::monitor, "Read samples, and how well they come");
    verb->add_option("--seconds", device.seconds, "How long")
        ->capture_default_str()
        ->check(CLI::Range(0.1, 86400.0));
  }

  void add_run_device(CLI::App& verb) {
    CLI::Option* link = verb.add_option("--device", run.device.link,
                                        "Against mark10:PORT, inverse3:HOST:PORT[:EVENTS] or "
                                        "replay:FILE.csv; without --arm it only "
                                        "looks");
    const auto beside = [&](CLI::Option* option) { option->needs(link); };
    beside(verb.add_flag("--arm", run.device.arm, "Let it move, let it send forces"));
    beside(verb.add_flag("--realtime", run.device.realtime, "Before all other programs"));
    beside(verb.add_flag("--traffic", run.device.traffic, "Keep what went over the line"));
    beside(verb.add_option("--surface", run.device.surface,
                           "Height of the surface in the device's z, as \"-2 mm\""));
    beside(verb.add_option("--max-force", run.device.most_force, "Ceiling, as \"2 N\""));
    beside(verb.add_option("--seconds", run.device.seconds, "End after so long")
               ->check(CLI::Range(0.001, 1e6)));
    // Of tests: time passes with the emulator's.
    beside(verb.add_option("--clock", run.device.clock)
               ->check(CLI::IsMember({"real", "virtual"}))
               ->group(""));
  }

  void add_sweep() {
    CLI::App* all = app.add_subcommand("sweep", "Many cases, on many workers and machines");
    all->require_subcommand(1);
    all->fallthrough();
    const auto add = [&](const char* name, Sweep::Act act, const char* what) {
      CLI::App* verb = all->add_subcommand(name, what);
      verb->callback([this, act] { sweep.act = act; });
      verb->add_option(act == Sweep::Act::plan ? "scenario" : "folder", sweep.subject,
                       act == Sweep::Act::plan ? "Scenario file with a [sweep]" : "The plan's")
          ->required();
      return verb;
    };
    CLI::App* verb = add("plan", Sweep::Act::plan, "Write down which cases there are");
    verb->add_option("--set", sweep.settings, "Set a key: KEY=VALUE")->allow_extra_args(false);
    verb->add_option("--out", sweep.out, "The plan goes to OUT/SCENARIO_sweep")
        ->capture_default_str();
    verb->add_flag("--curves", sweep.curves, "Keep every case's curves, too");
    verb->add_flag("--yes", sweep.yes, "However many cases there are");
    verb = add("run", Sweep::Act::run, "Run the cases that are not finished");
    verb->add_option("--shard", sweep.shard, "The I-th of N parts: I/N")->capture_default_str();
    verb->add_option("--jobs", sweep.jobs, "Workers; 0: one a core")->check(CLI::Range(0, 1024));
    verb->add_option("--lanes", sweep.lanes, "Cases that share a loop: auto, none, all; same bits")
        ->capture_default_str()
        ->check(CLI::IsMember({"auto", "none", "all"}));
    add("status", Sweep::Act::status, "How many cases are finished, failed and missing");
    add("retry", Sweep::Act::retry, "Run the cases that failed once more");
    verb = add("merge", Sweep::Act::merge, "All results as one table, with figures");
    verb->add_flag("--force", sweep.force, "Replace the merged results");
    verb->add_option("--show", sweep.show, "A column of results.csv to draw; may be repeated")
        ->allow_extra_args(false);
    verb = add("slurm", Sweep::Act::slurm, "Write a job file of an array, and print its line");
    verb->add_option("--chunk", sweep.chunk, "Cases a task")
        ->capture_default_str()
        ->check(CLI::Range(1, 100000000));
    verb->add_option("--time", sweep.time, "Limit of a task, as 01:00:00");
  }

  static std::string model_names() {
    std::string names;
    for (const fit::ModelInfo& model : fit::models())
      names += (names.empty() ? "" : "|") + std::string(model.name);
    for (const char* name : further_models) names += "|" + std::string(name);
    return names;
  }

  [[nodiscard]] Verb chosen() const {
    if (app.got_subcommand("run")) return run;
    if (app.got_subcommand("explain")) return explain;
    if (app.got_subcommand("fit")) return fit;
    if (app.got_subcommand("compare")) return compare;
    if (app.got_subcommand("golden")) return bless;
    if (app.got_subcommand("mesh")) return mesh;
    if (app.got_subcommand("reference")) return reference;
    if (app.got_subcommand("bench")) return bench;
    if (app.got_subcommand("chart")) return chart;
    if (app.got_subcommand("stability")) return stability;
    if (app.got_subcommand("sweep")) return sweep;
    if (app.got_subcommand("identify")) return identify;
    if (app.got_subcommand("export")) return export_to;
    if (app.got_subcommand("device")) return device;
    return Manual{};
  }
};

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
