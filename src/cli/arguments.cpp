// The options of every verb, and the parser that writes them into the struct of their verb.
#include "cli/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>
#include <thread>
#include <tuple>

#include "base/error.h"
#include "base/text.h"
#include "device/link.h"
#include "fit/regression.h"
#include "report/export.h"
#include "report/manifest.h"
#include "scenario/family.h"
#include "scenario/schema.h"

namespace palpate::cli {
namespace {

// The options that follow stand under this heading in the help.
void heading(CLI::App& verb, const char* words) { verb.option_defaults()->group(words); }

// An option whose value is one of these words.
CLI::Option* one_of(CLI::Option* option, const std::vector<std::string>& words) {
  return option->type_name(joined(words, "|"))->check(CLI::IsMember(words).description(""));
}

void add_scenario(CLI::App& verb, std::string& scenario, const char* what = "Scenario file") {
  verb.add_option("scenario", scenario, what)->required()->type_name("SCENARIO");
}

// An option that may be given several times.
CLI::Option* add_pairs(CLI::App& verb, const char* name, std::vector<std::string>& pairs,
                       const char* what) {
  return verb.add_option(name, pairs, what)->type_name("KEY=VALUE")->allow_extra_args(false);
}

void add_settings(CLI::App& verb, std::vector<std::string>& settings) {
  add_pairs(verb, "--set", settings, "Set a key");
}

// A verb within a verb, which sets the act.
template <class Verb>
CLI::App* add_act(CLI::App& all, Verb& verb, typename Verb::Act act, const char* name,
                  const char* what) {
  all.require_subcommand(1);
  all.fallthrough();
  CLI::App* inner = all.add_subcommand(name, what);
  inner->callback([&verb, act] { verb.act = act; });
  return inner;
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
  one_of(verb.add_option("--annotations", options.annotations,
                         "Also say differences to a forge: github"),
         {"github"});
}

// Options on the layout of a measured file, for every verb that reads one.
void add_data(CLI::App& verb, DataOptions& data) {
  heading(verb, "Of the measured file");
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
                  "Only approach or retract, or a value of the column `segment` or `step`; NAME:2 "
                  "is the second of that name");
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
  heading(verb, "With a device");
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
  beside(one_of(verb.add_option("--clock", device.clock), {"real", "virtual"})->group(""));
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
  std::vector<std::string> models;
  for (const fit::ModelInfo& model : fit::models()) models.emplace_back(model.name);
  models.insert(models.end(), further_models.begin(), further_models.end());
  verb.add_option("data", fit.data, "CSV or other tables in text; `-` is the standard input")
      ->required();
  verb.add_option("--out", fit.out, "Folder for the rows, the population and its figure")
      ->type_name("FOLDER");
  verb.add_flag("--force", fit.force, "Replace that folder");
  verb.add_flag("--csv", fit.csv, "CSV on a terminal too, where else a table stands");
  one_of(verb.add_option("--model", fit.model, "Curve")->required(), models);
  verb.add_option("--origin", fit.x_origin,
                  "Subtracted from every x; of times, default: where the step is");
  verb.add_option("--from", fit.from,
                  "Least depth below contact, as \"0.1 mm\" or \"10 %\"; modulus: strain");
  verb.add_option("--to", fit.to, "Largest depth or strain, likewise");
  heading(verb, "Of contact models (hertz, layer, jkr, dmt, adhesive, hertz_...)");
  verb.add_option("--radius", fit.radius, "Radius of the sphere or punch, as \"11 mm\"");
  verb.add_option("--poisson", fit.poisson_ratio,
                  "Poisson's ratio, also of a specimen between bonded platens")
      ->check(CLI::Range(0.0, 0.5));
  one_of(verb.add_option("--tip", fit.tip, "hertz: shape of the tip, default paraboloid"),
         {"paraboloid", "sphere", "cone", "pyramid3", "pyramid4", "punch"});
  verb.add_option("--half-angle", fit.half_angle,
                  "hertz: between axis and face of a cone or pyramid, as \"20 deg\"");
  one_of(verb.add_option("--baseline", fit.baseline,
                         "hertz, layer: default: what the rows before contact allow"),
         {"none", "offset", "tilt"});
  verb.add_option("--baseline-from", fit.baseline_from,
                  "hertz, layer: rows before contact count from this x on, as \"0.1 mm\"");
  verb.add_option("--baseline-to", fit.baseline_to, "hertz, layer: and up to this x");
  verb.add_option("--contact-point", fit.contact_point,
                  "hertz, layer: where it is known, as \"0.5 mm\"; default: fitted");
  verb.add_option("--thickness", fit.thickness, "layer: of the tissue, as \"5 mm\"");
  one_of(verb.add_option("--base", fit.base, "layer: default bonded"), {"bonded", "frictionless"});
  verb.add_option("--time", fit.time, "hertz_power_law, hertz_solid: column of the times");
  verb.add_option("--atoms", fit.atoms,
                  "adhesive: distance of the atoms at rest, default \"0.3 nm\"");
  heading(verb, "Of specimens between platens (modulus, neo_hookean, ogden, yeoh, ogden3)");
  verb.add_option("--height", fit.height, "Height of the specimen");
  verb.add_option("--diameter", fit.diameter, "Diameter of a round specimen");
  verb.add_option("--area", fit.area, "Cross-section of the specimen, as \"300 mm^2\"");
  one_of(verb.add_option("--platens", fit.platens, "How platens hold it, default slippery"),
         {"slippery", "bonded"});
  verb.add_option("--cycle", fit.cycle, "Which of several loadings of a specimen, from 1")
      ->check(CLI::Range(1, 100000));
  verb.add_flag("--toe", fit.toe, "Strain counts from where the line through the stress begins");
  one_of(verb.add_option("--loading", fit.loading, "Loading of the specimen, default by the signs"),
         {"compression", "tension"});
  heading(verb, "Of models over time (prony, prony_creep, spring_pot, ...)");
  verb.add_option("--ramp", fit.ramp, "Relaxation: duration of the loading ramp, in the unit of x")
      ->check(CLI::NonNegativeNumber);
  verb.add_option("--terms", fit.terms,
                  "prony: number of relaxation times; above 5 they are spaced in their logarithm")
      ->check(CLI::Range(1, 60));
  verb.add_flag("--liquid", fit.liquid, "prony: a liquid, which flows under load for ever");
  verb.add_option("--history", fit.history,
                  "prony: column of the strain or depth over time (creep: of the stress)");
  verb.add_option("--history-power", fit.history_power,
                  "prony: exponent of that column; default 1, and 1.5 of a depth under a force")
      ->check(CLI::Range(0.5, 3.0));
  add_data(verb, fit.columns);
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
  CLI::App* verb = add_act(all, golden, Golden::Act::add, "add",
                           "Run scenarios and store their results beside them as baseline");
  verb->add_option("scenario", golden.subjects, "Scenario files")->required();
  add_jobs(*verb, golden.jobs);
  verb->add_flag("--force", golden.force, "Replace the baseline");
  verb->add_option("--reason", golden.reason,
                   "Why it may change: stored with it, beside commit and compiler");
  verb = add_act(all, golden, Golden::Act::check, "check",
                 "Run scenarios and compare with their baselines");
  verb->add_option("subject", golden.subjects, "Scenarios or folders; none: this folder");
  add_jobs(*verb, golden.jobs);
  add_check_options(*verb, golden.options);
  verb = add_act(all, golden, Golden::Act::list, "list", "The scenarios that have a baseline");
  verb->add_option("subject", golden.subjects, "Scenarios or folders; none: this folder");
}

void add_options(CLI::App& verb, Convert& convert) {
  verb.add_option("subject", convert.subject,
                  "Surface (.stl .obj .ply .off .vtp), mesh (.msh .vtu .vtk .inp .mesh .node "
                  ".ele), scenario (.toml), or a result folder or CSV file")
      ->required();
  verb.add_option("--out", convert.out,
                  "File to write: .vtu, .node or .ele (both, in metres), of a surface .off or "
                  ".stl; of results the folder")
      ->allow_extra_args(false);
  verb.add_flag("--force", convert.force, "Replace files");
  heading(verb, "Of surfaces, meshes and scenarios");
  verb.add_option("--unit", convert.unit, "Unit of coordinates, as mm; not for scenarios");
  CLI::Option* nodes =
      verb.add_option("--nodes", convert.nodes, "For a surface: about so many nodes")
          ->check(CLI::Range(4, 1000000));
  verb.add_option("--edge", convert.edge, "For a surface: about this edge length, as \"3 mm\"")
      ->excludes(nodes);
  verb.add_option("--repair-up-to", convert.repair_up_to,
                  "For a surface: share of the area that holes may have, as 0.1 [0.02]")
      ->check(CLI::Range(0.0, 0.5));
  add_pairs(verb, "--set", convert.settings, "Set a scenario's key");
  heading(verb, "Of results");
  std::vector<std::string> formats;
  for (const report::ExportFormat& format : report::export_formats())
    formats.emplace_back(format.name);
  one_of(verb.add_option("--to", convert.format, "Format"), formats);
  verb.add_option("--case", convert.case_name, "Only this case");
}

void add_options(CLI::App& verb, Reference& reference) {
  add_scenario(verb, reference.scenario);
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
  add_scenario(verb, stability.scenario);
  add_settings(verb, stability.settings);
  add_out(verb, stability.out);
  verb.add_flag("--force", stability.force, "Replace a finished map");
}

void add_options(CLI::App& all, Sweep& sweep) {
  const auto add = [&](const char* name, Sweep::Act act, const char* what) {
    CLI::App* inner = add_act(all, sweep, act, name, what);
    inner->add_option("folder", sweep.subject, "Folder of the plan")
        ->required()
        ->type_name("FOLDER");
    return inner;
  };
  CLI::App* verb =
      add_act(all, sweep, Sweep::Act::plan, "plan", "Check all cases and write the plan");
  add_scenario(*verb, sweep.subject, "Scenario file with a [sweep]");
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
  add_scenario(verb, identify.scenario, "Scenario of the test");
  verb.add_option("--with", identify.with,
                  "A further measurement and its scenario, fitted together")
      ->type_name("DATA SCENARIO");
  verb.add_option("--origin", identify.x_origin,
                  "Subtracted from every x: where the loading history begins");
  one_of(verb.add_option("--noise", identify.noise, "Noise of the measurement"),
         {"constant", "relative"})
      ->capture_default_str();
  add_pairs(verb, "--unknown", identify.unknowns, "Unknown with its range, KEY=LOW..HIGH")
      ->required();
  add_pairs(verb, "--given", identify.givens, "Known with its deviation, KEY=\"VALUE +- SD\"");
  add_settings(verb, identify.settings);
  add_out(verb, identify.out);
  verb.add_flag("--force", identify.force, "Replace a finished result");
  add_data(verb, identify.columns);
}

void add_options(CLI::App& all, Device& device) {
  const auto add = [&](const char* name, Device::Act act, const char* what) {
    CLI::App* inner = add_act(all, device, act, name, what);
    inner->add_option("link", device.link, device::link_forms())->required();
    return inner;
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
  one_of(verb.add_option("kind", starter.kind, "What is computed")->required(), kinds);
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
  one_of(verb.add_option("page", manual.page, "Keys of scenarios, or verbs and options"),
         {"keys", "commands"})
      ->capture_default_str();
  verb.add_flag("--man", manual.man, "As a man page");
}

void add_options(CLI::App&, Schema&) {}

void add_options(CLI::App& verb, Completion& completion) {
  one_of(verb.add_option("shell", completion.shell, "The shell")->required(),
         {"bash", "zsh", "fish"});
}

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
  return *std::ranges::find(listed, verb, &Listed::verb);
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

// Without the examples, as of the program alone, the first press is one of `new`.
std::string welcome() {
  const std::vector<std::string> examples = scenario::examples();
  const bool installed = std::ranges::find(examples, "quickstart") != examples.end();
  const std::string made =
      "  palpate new press          a commented scenario of your own, press.toml\n";
  const std::string first = ", with a page of its results\n";
  return "palpate presses a virtual finger into virtual soft tissue, and says the force and its "
         "error.\n\n" +
         (installed ? "  palpate run quickstart     a first press" + first + made
                    : made + "  palpate run press.toml     presses" + first) +
         "  palpate --help             all verbs; `palpate help VERB` shows one\n";
}

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

double quantity_of(const std::string& option, const std::string& text, const Unit& unit,
                   const std::string& or_else) {
  try {
    return parse_quantity(text, unit);
  } catch (const std::invalid_argument& wrong) {
    refuse("`" + option + "` " + wrong.what() + or_else);
  }
}

double positive_of(const std::string& option, const std::string& text, const Unit& unit) {
  const double value = quantity_of(option, text, unit);
  if (value > 0.0) return value;
  const bool vowel = std::string_view("aeiou").find(unit.quantity[0]) != std::string_view::npos;
  refuse("`" + option + "` is `" + text + "`; give " + (vowel ? "an " : "a ") + unit.quantity +
         " above 0");
}

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
  if (given.empty()) return Answer{welcome()};
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
