// The options of every verb, for parsing and help.
#include "cli/options.h"

#include <CLI/CLI.hpp>

#include "device/link.h"
#include "fit/regression.h"
#include "report/export.h"
#include "scenario/schema.h"

namespace palpate::cli {
namespace {

void add_settings(CLI::App& verb, std::vector<std::string>& settings) {
  verb.add_option("--set", settings, "Set a key")->type_name("KEY=VALUE")->allow_extra_args(false);
}

void add_out(CLI::App& verb, std::string& out) {
  verb.add_option("--out", out, "Folder of the results")
      ->type_name("FOLDER")
      ->capture_default_str();
}

void add_jobs(CLI::App& verb, int& jobs) {
  verb.add_option("--jobs", jobs, "Workers; 0: one per core")->check(CLI::Range(0, 1024));
}

void add_check_options(CLI::App& verb, CheckOptions& options) {
  verb.add_option("--junit", options.junit, "Also write JUnit XML into this file");
  verb.add_option("--annotations", options.annotations, "Also say differences to a forge: github")
      ->check(CLI::IsMember({"github"}));
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
  verb.add_option("--compression", data.compression, "Sign of compression in the file")
      ->type_name("positive|negative|auto");
  verb.add_option("--segment", data.segment,
                  "Only approach or retract, or a value of the column `segment` or `step`; "
                  "NAME:2 is the second of that name");
  verb.add_option("--where", data.where, "Only rows with this value: COLUMN=VALUE")
      ->allow_extra_args(false);
  verb.add_option("--rows", data.rows, "Only these rows of the table, as 100..2000");
  verb.add_option("--table", data.table, "Which of several tables in the file, from 1")
      ->check(CLI::Range(1, 1000));
  CLI::Option* spring = verb.add_option("--spring-constant", data.spring_constant,
                                        "x minus force over it is the depth, as \"0.1 N/m\"");
  verb.add_option("--compliance", data.compliance,
                  "x minus force times it is the depth, as \"0.2 um/N\"")
      ->excludes(spring);
  verb.add_option("--drift", data.drift,
                  "Column of times: a drift of y between both ends of the record is taken off");
  verb.add_option("--case", data.case_name, "Only rows with this value in the column `case`");
}

// The words that an option may have, for its help and for shells; its verb checks them.
template <class Words>
std::string any_of(const Words& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : "|") + std::string(word);
  return text;
}

}  // namespace

// Below, one overload per verb.

void add_options(CLI::App& verb, Run& run) {
  verb.add_option("scenario", run.scenarios, "Scenario files; `-` is the standard input")
      ->required()
      ->type_name("SCENARIO");
  add_out(verb, run.out);
  add_settings(verb, run.settings);
  add_jobs(verb, run.jobs);
  verb.add_flag("--force", run.force, "Replace finished results");
  CLI::Option* dry =
      verb.add_flag("--dry-run", run.dry, "Say what would be computed; write nothing");
  RunDevice& device = run.device;
  CLI::Option* link = verb.add_option(
      "--device", device.link, "Run on " + device::link_forms() + "; without --arm only read");
  link->excludes(dry);
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
  verb.add_option("subject", explain.subject, "Scenario file or key")->required()->type_name("KEY");
  add_settings(verb, explain.settings);
  verb.add_option("--picture", explain.picture,
                  "Draw the body, its base and the finger into a .svg, or an .html to turn")
      ->type_name("FILE");
  verb.add_option("--case", explain.case_name, "The case of a sweep to explain; none: the first")
      ->type_name("NAME");
}

void add_options(CLI::App& verb, Fit& fit) {
  std::vector<std::string> models(further_models.begin(), further_models.end());
  for (const fit::ModelInfo& model : fit::models()) models.emplace_back(model.name);
  verb.add_option("data", fit.data, "CSV or other tables in text; `-` is the standard input")
      ->required();
  verb.add_option("--out", fit.out, "Folder for the rows, the population and its figure")
      ->type_name("FOLDER");
  verb.add_flag("--force", fit.force, "Replace that folder");
  add_data(verb, fit.columns);
  verb.add_flag("--csv", fit.csv, "CSV on a terminal too, where else a table stands");
  verb.add_option("--model", fit.model, "Curve")->required()->type_name(any_of(models));
  verb.add_option("--origin", fit.x_origin,
                  "Subtracted from every x; of times, default: where the step is");
  verb.add_option("--radius", fit.radius, "contact models: of the sphere or punch, as \"11 mm\"");
  verb.add_option("--tip", fit.tip, "hertz: default paraboloid")
      ->type_name("paraboloid|sphere|cone|pyramid3|pyramid4|punch");
  verb.add_option("--half-angle", fit.half_angle,
                  "hertz: between axis and face of a cone or pyramid, as \"20 deg\"");
  verb.add_option("--baseline", fit.baseline,
                  "hertz, layer: default: what the rows before contact allow")
      ->type_name("none|offset|tilt");
  verb.add_option("--baseline-from", fit.baseline_from,
                  "the same: rows before contact count from this x on, as \"0.1 mm\"");
  verb.add_option("--baseline-to", fit.baseline_to, "the same: and up to this x");
  verb.add_option("--contact-point", fit.contact_point,
                  "the same: where it is known, as \"0.5 mm\"; default: fitted");
  verb.add_option("--time", fit.time, "hertz_power_law, hertz_solid: column of the times");
  verb.add_option("--atoms", fit.atoms,
                  "adhesive: distance of the atoms at rest, default \"0.3 nm\"");
  verb.add_option("--from", fit.from,
                  "Least depth below contact, as \"0.1 mm\" or \"10 %\"; modulus: strain");
  verb.add_option("--to", fit.to, "Largest depth or strain, likewise");
  verb.add_option("--height", fit.height, "modulus, neo_hookean, ogden: of the specimen");
  verb.add_option("--diameter", fit.diameter, "the same: of a round specimen");
  verb.add_option("--area", fit.area, "the same: of the cross-section, as \"300 mm^2\"");
  verb.add_option("--platens", fit.platens, "the same: default slippery")
      ->type_name("slippery|bonded");
  verb.add_option("--cycle", fit.cycle, "the same: which of several loadings, from 1")
      ->check(CLI::Range(1, 100000));
  verb.add_flag("--toe", fit.toe, "the same: count from where the line through the stress begins");
  verb.add_option("--loading", fit.loading, "the same: default by the signs")
      ->type_name("compression|tension");
  verb.add_option("--poisson", fit.poisson_ratio, "contact models: Poisson's ratio")
      ->check(CLI::Range(0.0, 0.5));
  verb.add_option("--thickness", fit.thickness, "layer: of the tissue, as \"5 mm\"");
  verb.add_option("--base", fit.base, "layer: default bonded")->type_name("bonded|frictionless");
  verb.add_option("--terms", fit.terms,
                  "prony: number of relaxation times; above 5 they are spaced in their logarithm")
      ->check(CLI::Range(1, 60));
  verb.add_flag("--liquid", fit.liquid, "prony: a liquid, which flows under load for ever");
  verb.add_option("--ramp", fit.ramp, "relaxation: duration of the loading ramp, in the unit of x")
      ->check(CLI::NonNegativeNumber);
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
  verb.add_option("--report", compare.report, "Write the comparison as a page to this file");
  add_check_options(verb, compare.options);
}

void add_options(CLI::App& all, Golden& golden) {
  all.require_subcommand(1);
  all.fallthrough();
  const auto add = [&](const char* name, Golden::Act act, const char* what) {
    CLI::App* verb = all.add_subcommand(name, what);
    verb->callback([&golden, act] { golden.act = act; });
    return verb;
  };
  CLI::App* verb =
      add("add", Golden::Act::add, "Run scenarios and store their results beside them as baseline");
  verb->add_option("scenario", golden.subjects, "Scenario files")->required();
  add_jobs(*verb, golden.jobs);
  verb->add_flag("--force", golden.force, "Replace the baseline");
  verb->add_option("--reason", golden.reason,
                   "Why it may change: stored with it, beside commit and compiler");
  verb = add("check", Golden::Act::check, "Run scenarios and compare with their baselines");
  verb->add_option("subject", golden.subjects, "Scenarios or folders; none: this folder");
  add_jobs(*verb, golden.jobs);
  add_check_options(*verb, golden.options);
  verb = add("list", Golden::Act::list, "The scenarios that have a baseline");
  verb->add_option("subject", golden.subjects, "Scenarios or folders; none: this folder");
}

void add_options(CLI::App& verb, Convert& convert) {
  constexpr const char* of_bodies = "Of surfaces, meshes and scenarios";
  constexpr const char* of_results = "Of results";
  verb.add_option(
          "subject", convert.subject,
          "Surface (.stl .obj .ply .off .vtp), mesh (.msh .vtu .vtk .inp .mesh .node .ele), "
          "scenario (.toml), or a result folder or CSV file")
      ->required();
  verb.add_option(
          "--out", convert.out,
          "File to write: .vtu, .node or .ele (both, in metres), of a surface .off or .stl; "
          "of results the folder")
      ->allow_extra_args(false);
  verb.add_flag("--force", convert.force, "Replace files");
  verb.add_option("--unit", convert.unit, "Unit of coordinates, as mm; not for scenarios")
      ->group(of_bodies);
  CLI::Option* nodes =
      verb.add_option("--nodes", convert.nodes, "For a surface: about so many nodes")
          ->check(CLI::Range(4, 1000000))
          ->group(of_bodies);
  verb.add_option("--edge", convert.edge, "For a surface: about this edge length, as \"3 mm\"")
      ->excludes(nodes)
      ->group(of_bodies);
  verb.add_option("--repair-up-to", convert.repair_up_to,
                  "For a surface: share of the area that holes may have, as 0.1 [0.02]")
      ->check(CLI::Range(0.0, 0.5))
      ->group(of_bodies);
  verb.add_option("--set", convert.settings, "Set a scenario's key")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->group(of_bodies);
  std::vector<std::string> formats;
  for (const report::ExportFormat& format : report::export_formats())
    formats.emplace_back(format.name);
  verb.add_option("--to", convert.format, "Format")->type_name(any_of(formats))->group(of_results);
  verb.add_option("--case", convert.case_name, "Only this case")->group(of_results);
}

void add_options(CLI::App& verb, Reference& reference) {
  verb.add_option("scenario", reference.scenario, "Scenario file")
      ->required()
      ->type_name("SCENARIO");
  add_settings(verb, reference.settings);
  verb.add_option("--out", reference.out, "Folder to write SCENARIO_reference.csv into");
  verb.add_flag("--force", reference.force, "Replace that file");
}

void add_options(CLI::App& verb, Chart& chart) {
  verb.add_option("scenario", chart.scenario,
                  "Scenario file; with --frames also none: the paper's four models")
      ->type_name("SCENARIO");
  add_settings(verb, chart.settings);
  add_out(verb, chart.out);
  verb.add_option("--repeats", chart.repeats, "Timings of every configuration")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  verb.add_flag("--force", chart.force, "Start again, and replace a finished or partial chart");
  CLI::Option* frames =
      verb.add_option("--frames", chart.frames,
                      "Only time so many frames of 1 ms of a press: the paper's Table 2")
          ->check(CLI::Range(1, 1000000));
  verb.add_option("--report", chart.report, "Write the times of frames as a page to this file")
      ->needs(frames);
}

void add_options(CLI::App& verb, Stability& stability) {
  verb.add_option("scenario", stability.scenario, "Scenario file")
      ->required()
      ->type_name("SCENARIO");
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
        ->required()
        ->type_name(plan ? "SCENARIO" : "FOLDER");
    return verb;
  };
  CLI::App* verb = add("plan", Sweep::Act::plan, "Check all cases and write the plan");
  add_settings(*verb, sweep.settings);
  verb->add_option("--out", sweep.out, "The plan goes to OUT/SCENARIO_sweep")
      ->type_name("FOLDER")
      ->capture_default_str();
  verb->add_flag("--curves", sweep.curves, "Keep the curves of every case");
  verb->add_flag("--yes", sweep.yes, "Allow any number of cases");
  verb->add_option("--reuse", sweep.reuse, "Take over rows of equal cases from another plan")
      ->type_name("FOLDER");
  const auto add_accepting = [&] {
    verb->add_flag("--accept-failed", sweep.accept_failed,
                   "Exit code 0 where every case has a row, failed ones included");
  };
  const auto add_part = [&] {
    verb->add_option("--shard", sweep.shard, "The I-th of N parts: I/N")->capture_default_str();
    add_jobs(*verb, sweep.jobs);
    add_accepting();
    verb->add_option("--done", sweep.done, "Write this file once every case of the part has a row")
        ->type_name("FILE");
  };
  verb = add("run", Sweep::Act::run, "Run the cases that are not finished");
  add_part();
  add("status", Sweep::Act::status, "How many cases are finished, failed and missing");
  verb = add("retry", Sweep::Act::retry, "Run failed cases once more");
  add_part();
  verb = add("merge", Sweep::Act::merge, "All results as one table, with figures");
  verb->add_flag("--force", sweep.force, "Replace the merged results");
  add_accepting();
  verb->add_option("--show", sweep.show, "A column of results.csv to draw; may be repeated")
      ->allow_extra_args(false);
  verb = add("parts", Sweep::Act::parts, "Print the commands that run the unfinished parts");
  verb->add_option("--of", sweep.of, "Number of parts")
      ->required()
      ->check(CLI::Range(1, 100000000));
  add_accepting();
  verb->add_option("--program", sweep.program, "The program as a shell takes it");
  verb = add("slurm", Sweep::Act::slurm, "Write a job file, and print the sbatch command");
  verb->add_option("--chunk", sweep.chunk, "Cases per task")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000000));
  verb->add_option("--time", sweep.time, "Time limit per task, as 01:00:00");
  add_accepting();
  verb->add_option("--program", sweep.program, "The program as a shell takes it");
  verb->add_option("--prologue", sweep.prologue, "File of lines that a task runs first")
      ->type_name("FILE");
}

void add_options(CLI::App& verb, Identify& identify) {
  verb.add_option("data", identify.data, "CSV file of the measurement")->required();
  verb.add_option("scenario", identify.scenario, "Scenario of the test")
      ->required()
      ->type_name("SCENARIO");
  verb.add_option("--with", identify.with,
                  "A further measurement and its scenario, fitted together")
      ->type_name("DATA SCENARIO");
  add_data(verb, identify.columns);
  verb.add_option("--origin", identify.x_origin,
                  "Subtracted from every x: where the loading history begins");
  verb.add_option("--noise", identify.noise, "Noise of the measurement")
      ->capture_default_str()
      ->check(CLI::IsMember({"constant", "relative"}));
  verb.add_option("--unknown", identify.unknowns, "Unknown with its range, KEY=LOW..HIGH")
      ->required()
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  verb.add_option("--given", identify.givens, "Known with its deviation, KEY=\"VALUE +- SD\"")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  add_settings(verb, identify.settings);
  add_out(verb, identify.out);
  verb.add_flag("--force", identify.force, "Replace a finished result");
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

void add_options(CLI::App& verb, New& starter) {
  std::vector<std::string> kinds;
  for (const scenario::Starter& one : scenario::starters()) kinds.emplace_back(one.word.word);
  verb.add_option("kind", starter.kind, "What is computed")
      ->required()
      ->type_name("")
      ->check(CLI::IsMember(kinds));
  verb.add_option("file", starter.file,
                  "File to write, default KIND.toml; `-` is the standard output");
  verb.add_flag("--force", starter.force, "Replace the file");
}

void add_options(CLI::App& verb, Open& open) {
  verb.add_option("result", open.result, "Result folder, or a folder of such folders")
      ->required()
      ->type_name("FOLDER");
}

void add_options(CLI::App& verb, Manual& manual) {
  verb.add_option("page", manual.page, "Keys of scenarios, or verbs and options")
      ->capture_default_str()
      ->check(CLI::IsMember({"keys", "commands"}));
  verb.add_flag("--man", manual.man, "As a man page");
}

void add_options(CLI::App&, Schema&) {}

void add_options(CLI::App& verb, Completion& completion) {
  verb.add_option("shell", completion.shell, "The shell")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
}

}  // namespace palpate::cli
