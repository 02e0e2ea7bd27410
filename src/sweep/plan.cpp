// Makes a plan from copies of its inputs in a temporary folder, which is then renamed. Times cases
// as a sweep runs them, and counts how often what they share has to be made.
#include "sweep/plan.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "base/document.h"
#include "base/stop_scope.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "base/whole_folder.h"
#include "record/csv.h"
#include "record/table.h"
#include "run/choose.h"
#include "run/family.h"
#include "run/refined_mesh.h"
#include "scenario/programme.h"
#include "scene/estimates.h"
#include "scene/scene.h"
#include "scene/specimen_shape.h"
#include "scene/surface_displacement_store.h"
#include "sweep/journal.h"
#include "sweep/row.h"

namespace palpate::sweep {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// A case as a row of plan.csv.
struct PlannedCase {
  std::uint64_t id = 0;
  std::vector<std::string> words;
};

// The text of the scenario with its settings applied and with the names of the copied files.
std::string portable(const scenario::Family& family) {
  Node document = family.document;
  scenario::use_copies(document, "");
  return "# A sweep's scenario, its settings applied, its files beside it.\n" +
         toml_document(document) + family.design.toml();
}

// `tissue.young_modulus` = 20 kPa, ...
std::string words_of(const scenario::Family& family, std::size_t index) {
  std::vector<std::string> words;
  for (const scenario::Setting& setting : family.design.settings(index))
    words.push_back("`" + setting.key + "` = " + setting.word);
  return joined(words, ", ");
}

[[noreturn]] void refuse_case(const scenario::Family& family, std::size_t index,
                              std::vector<Problem> problems) {
  problems.push_back({{family.document.place.file, 0, 0},
                      "case " + std::to_string(index + 1) + " of " +
                          std::to_string(family.design.count()) + " (" + words_of(family, index) +
                          ") cannot be made; mend it, or leave it out of `sweep`"});
  throw InputError(problems);
}

// Makes cases from the copies; an invalid one again from the original, whose lines messages name.
class Maker {
 public:
  Maker(const scenario::Family& original, const scenario::Family& copy)
      : original_(original), copy_(copy), files_(scenario::hashed(copy.inputs)) {}

  [[nodiscard]] PlannedCase operator()(std::size_t index) const {
    PlannedCase planned;
    try {
      const scenario::Case one = scenario::make_case(copy_, index);
      planned.id = case_id(one, files_);
      for (const auto& [key, word] : one.swept) planned.words.push_back(word);
    } catch (const InputError& error) {
      try {
        (void)scenario::make_case(original_, index);
      } catch (const InputError& same) {
        refuse_case(original_, index, same.problems());
      }
      refuse_case(copy_, index, error.problems());
    }
    return planned;
  }

 private:
  const scenario::Family& original_;
  const scenario::Family& copy_;
  std::vector<HashedFile> files_;
};

void refuse_twins(const scenario::Family& family, const std::vector<std::uint64_t>& ids) {
  std::vector<std::uint32_t> order(ids.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return ids[a] != ids[b] ? ids[a] < ids[b] : a < b;
  });
  for (std::size_t i = 0; i + 1 < order.size(); ++i)
    if (ids[order[i]] == ids[order[i + 1]])
      throw InputError({family.document.place.file, 0, 0},
                       "cases " + std::to_string(order[i] + 1) + " (" + words_of(family, order[i]) +
                           ") and " + std::to_string(order[i + 1] + 1) + " (" +
                           words_of(family, order[i + 1]) +
                           ") compute the very same; leave one out of `sweep`");
}

void write_cases(const std::string& path, const scenario::Family& original,
                 const scenario::Family& copy, int workers) {
  constexpr std::size_t block = 4096;
  const std::size_t count = copy.design.count();
  const Maker make(original, copy);
  std::vector<std::uint64_t> ids;
  ids.reserve(count);
  using Kind = scenario::Design::Kind;
  const Kind kind = copy.design.kind();
  const bool sampled = kind == Kind::lhs || kind == Kind::sobol || kind == Kind::saltelli;
  std::unordered_set<std::uint64_t> seen;
  std::vector<std::string> columns{"number", "id"};
  columns.insert(columns.end(), copy.design.keys().begin(), copy.design.keys().end());
  record::CsvFile file(path, std::move(columns));
  for (std::size_t first = 0; first < count; first += block) {
    std::vector<PlannedCase> planned(std::min(block, count - first));
    run::share_out(planned.size(), workers, [&](std::size_t i) { planned[i] = make(first + i); });
    for (std::size_t i = 0; i < planned.size(); ++i) {
      if (sampled && !seen.insert(planned[i].id).second)
        planned[i].id = twin_id(planned[i].id, first + i + 1);
      std::vector<record::Cell> row{static_cast<double>(first + i + 1), id_text(planned[i].id)};
      for (std::string& word : planned[i].words) {
        std::ranges::replace(word, '\n', ' ');  // one line per case
        row.push_back(record::swept_cell(word));
      }
      file.add(std::move(row));
      ids.push_back(planned[i].id);
    }
  }
  file.finish();
  refuse_twins(original, ids);
}

void refuse_many(const scenario::Family& family, const std::optional<SweepForecast>& forecast) {
  throw InputError({family.document.place.file, 0, 0},
                   "`sweep` makes " + std::to_string(family.design.count()) + " cases" +
                       (forecast ? " (" + forecast->text() + ")" : "") +
                       "; give `--yes` to plan more than " + std::to_string(sweep_ceiling));
}

// Takes one model for all cases, and refuses a swept key that none of the models which `auto`
// chooses reads.
void take_model(scenario::Family& family, int workers) {
  std::map<std::string, std::size_t> unread;
  scene::SpecimenShapes shapes;
  std::map<std::size_t, scene::Choice> choices;
  try {
    auto [model, made] = run::one_model(family, shapes, workers);
    family.at_least = model;
    choices = std::move(made);
  } catch (const InputError&) {  // write_cases() reports invalid cases
  }
  const std::size_t tries = choices.size();
  for (const auto& [i, choice] : choices)
    for (const std::string& key : scenario::unread_keys(family, i, choice.chosen.solver.model))
      ++unread[key];
  if (choices.empty()) return;
  for (const scenario::Setting& setting : family.design.settings(0))
    if (const auto found = unread.find(setting.key);
        found != unread.end() && found->second == tries)
      throw InputError(setting.place,
                       "`" + setting.key + "` changes nothing: in all of " + std::to_string(tries) +
                           " cases tried, `model = \"auto\"` chooses a model that does not use it; "
                           "take it out of `[sweep]` or give `solver.model`");
}

// Adds the completed rows of `from` whose cases `to` has without a row. Returns how many.
std::size_t take_over(const SweepPlan& from, const SweepPlan& to) {
  const FolderLock lock(to.folder, "reuse");
  const SweepResults old(from);
  const SweepResults known(to);
  std::unordered_map<std::uint64_t, std::size_t> by_id;
  for (std::size_t i = 0; i < from.count(); ++i)
    if (old.at(i).known() && old.at(i).head.outcome == SweepOutcome::completed)
      by_id.emplace(from.ids[i], i);
  std::unique_ptr<record::Journal> journal;
  std::size_t taken = 0;
  for (std::size_t i = 0; i < to.count(); ++i) {
    const auto found = by_id.find(to.ids[i]);
    if (found == by_id.end() || known.at(i).known()) continue;
    if (!journal)
      journal = std::make_unique<record::Journal>(to.folder + "/results", "reuse", to.hash);
    SweepRow row = old.row(found->second);
    row.attempt = 1;
    row.name = scenario::make_case(to.family, i).name;
    if (!to.curves) row.curve = {};
    journal->add(journal_row(row));
    ++taken;
  }
  if (journal) journal->sync();
  return taken;
}

}  // namespace

Planned plan_sweep(const SweepOrder& order) {
  scenario::Family original = scenario::outline(order.scenario, order.settings);
  if (original.design.empty())
    throw InputError({order.scenario, 0, 0},
                     "sweeps no key; name one in `[sweep]`, or run it by `palpate run`");
  // A plan that cannot be used is told before the new one is made.
  std::optional<SweepPlan> old;
  if (!order.reuse.empty()) old = read_plan(order.reuse, order.program);
  if (old && order.curves == SweepOrder::Curves::kept && !old->curves)
    throw InputError(
        {old->folder, 0, 0},
        "keeps no curves, and the new plan does; plan without `--curves`, or without `--reuse`");
  take_model(original, order.workers);
  Planned planned{.folder = (fs::path(order.out) / (original.name + "_sweep")).string(),
                  .cases = original.design.count(),
                  .notes = original.notes,
                  .forecast = forecast(original, order.curves == SweepOrder::Curves::kept)};
  if (planned.cases > sweep_ceiling && order.ceiling == SweepOrder::Ceiling::holds)
    refuse_many(original, planned.forecast);
  WholeFolder folder(planned.folder, "plan of a sweep", Replace::incomplete);
  // Tasks of a cluster may plan at once, so that the plan may appear at any moment.
  const std::string place = (fs::path(planned.folder) / "plan.json").string();
  bool there = fs::exists(place);
  try {
    if (!there) folder.refuse_what_is_there();
  } catch (const InputError&) {
    there = fs::exists(place);
    if (!there) throw;
  }
  folder.open();
  const std::string scenario = "inputs/scenario.toml";  // no other input has this name
  folder.write(scenario, portable(original));
  for (std::size_t i = 1; i < original.inputs.size(); ++i)
    folder.write("inputs/" + original.inputs[i].name, original.inputs[i].content);
  scenario::Family copy = scenario::outline(folder.file(scenario), {});
  copy.at_least = original.at_least;
  write_cases(folder.file("plan.csv"), original, copy, order.workers);
  folder.add({"plan.csv"});
  const PlanFile file{.program = order.program,
                      .name = original.name,
                      .settings = order.settings,
                      .curves = order.curves == SweepOrder::Curves::kept,
                      .cases = planned.cases,
                      .model = copy.at_least,
                      .csv_hash = folder.files().back().sha256,
                      .inputs = scenario::hashed(copy.inputs)};
  const std::string text = plan_text(file);
  folder.write("plan.json", text);
  if (there) {
    const std::string known = read_text(place);
    if (known != text)
      throw InputError({planned.folder, 0, 0},
                       "is the plan of another sweep, with another " +
                           differences(read_plan_file(known, planned.folder), file) +
                           "; plans do not change: give another `--out`, or remove that folder");
    planned.there_already = true;
  } else {
    for (const std::string& sentence : folder.put(WholeFolder::State::complete)) {
      if (!holds(place, text)) throw SystemError(sentence);
      fs::remove_all(folder.partial());
      planned.there_already = true;
    }
  }
  if (old) planned.reused = take_over(*old, read_plan(planned.folder, order.program));
  return planned;
}

SweepPlan read_plan(const std::string& folder, const std::string& program) {
  const std::string path = (fs::path(folder) / "plan.json").string();
  if (!fs::exists(path))
    throw InputError({folder, 0, 0}, "is no plan of a sweep; `palpate sweep plan` makes one");
  const std::string text = read_text(path);
  const PlanFile file = read_plan_file(text, path);
  if (file.program != program)
    throw InputError({path, 0, 0}, "was made by `" + file.program + "`, and this is `" + program +
                                       "`; use that one, or plan anew");
  const auto changed = [&](const std::string& name) {
    return InputError({(fs::path(folder) / name).string(), 0, 0},
                      "has changed since it was planned; put it back, or plan anew");
  };
  for (const auto& [name, hash] : file.inputs)
    if (sha256(read_text((fs::path(folder) / "inputs" / name).string())) != hash)
      throw changed("inputs/" + name);
  SweepPlan plan{.folder = folder,
                 .hash = sha256(text),
                 .program = program,
                 .curves = file.curves,
                 .family = {},
                 .ids = {}};
  Sha256 hash;
  bool header = true;
  for_each_line((fs::path(folder) / "plan.csv").string(), [&](const FileLine& line) {
    hash.add(line.text);
    if (line.whole) hash.add("\n");
    std::size_t at = line.text.find(',') + 1;
    if (line.text.substr(at, 1) == "\"") ++at;  // ids of decimal digits only are quoted
    if (!header) plan.ids.push_back(id_of(line.text.substr(at, 16)).value_or(0));
    header = false;
  });
  if (hash.digits() != file.csv_hash || plan.ids.size() != file.cases) throw changed("plan.csv");
  plan.family = scenario::outline_planned((fs::path(folder) / "inputs/scenario.toml").string());
  plan.family.name = file.name;
  plan.family.at_least = file.model;
  if (plan.family.base.title.empty()) plan.family.title = file.name;
  return plan;
}

std::string plan_text(const PlanFile& file) {
  Json json;
  json["palpate_sweep"] = 1;  // version of the file format
  json["program"] = file.program;
  json["scenario"] = file.name;
  json["settings"] = file.settings;
  json["curves"] = file.curves;
  json["cases"] = file.cases;
  if (file.model) json["model"] = scenario::traits(*file.model).word;  // of `auto`, for all cases
  json["plan_csv_sha256"] = file.csv_hash;
  json["inputs"] = Json::array();
  for (const auto& [name, hash] : file.inputs)
    json["inputs"].push_back({{"name", name}, {"sha256", hash}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

PlanFile read_plan_file(const std::string& text, const std::string& path) {
  PlanFile file;
  try {
    const Json json = Json::parse(text);
    if (json.at("palpate_sweep") != 1) throw std::runtime_error("another form");
    file.program = json.at("program");
    file.name = json.at("scenario");
    file.settings = json.at("settings").get<std::vector<std::string>>();
    file.curves = json.at("curves");
    const Json& cases = json.at("cases");
    if (!cases.is_number_unsigned()) throw std::runtime_error("no number of cases");
    file.cases = cases;
    if (json.contains("model")) {
      const auto named = [&](const scenario::ModelTraits& traits) {
        return json["model"] == traits.word;
      };
      const auto* traits = std::ranges::find_if(scenario::model_table, named);
      if (traits == scenario::model_table.end()) throw std::runtime_error("no model");
      file.model = traits->of;
    }
    file.csv_hash = json.at("plan_csv_sha256");
    for (const Json& input : json.at("inputs"))
      file.inputs.push_back({input.at("name"), input.at("sha256")});
  } catch (const std::exception&) {
    throw InputError({path, 0, 0},
                     "is damaged, or made by another version; put it back, or plan anew");
  }
  return file;
}

std::string differences(const PlanFile& a, const PlanFile& b) {
  std::vector<std::string> names;
  if (a.program != b.program) names.emplace_back("version of the program");
  if (a.curves != b.curves) names.emplace_back("`--curves`");
  if (a.cases != b.cases)
    names.push_back("number of cases (" + std::to_string(a.cases) + ", not " +
                    std::to_string(b.cases) + ")");
  for (const HashedFile& input : b.inputs)
    if (std::ranges::find(a.inputs, input) == a.inputs.end()) names.push_back(ticked(input.path));
  if (names.empty()) names.emplace_back("`--set`");
  return joined(names, ", ");
}

std::uint64_t case_id(const scenario::Case& one, const std::vector<HashedFile>& files) {
  // What only says how results are shown, or is left open, and did not exist when the first plans
  // were made, changes no id: ids name results of years.
  constexpr std::array<std::string_view, 7> later{
      "paper = ",  "picture = ",   "png = ",         "regression = ",
      "report = ", "tissue_at = ", "size = \"auto\""};
  std::string text;
  for (const std::string& line : split(scenario::spelled_out(one), '\n'))
    if (std::ranges::none_of(later, [&](std::string_view key) { return line.starts_with(key); }))
      text += (text.empty() ? "" : "\n") + line;
  if (one.at_least && *one.at_least != scenario::Model::hertz && !one.scenario.solver.model)
    text += std::string("\nat_least = ") + scenario::traits(*one.at_least).word;
  for (const auto& [name, hash] : files)
    if (std::ranges::find(one.files, name) != one.files.end()) text += name + " " + hash + "\n";
  return id_of(sha256(text).substr(0, 16)).value_or(0);
}

std::uint64_t twin_id(std::uint64_t id, std::size_t number) {
  return id_of(sha256(id_text(id) + " " + std::to_string(number)).substr(0, 16)).value_or(0);
}

std::string Shard::text() const { return std::to_string(number) + "-of-" + std::to_string(of); }

Shard parse_shard(const std::string& text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto number = whole_number(text.substr(0, slash));
  const auto of = whole_number(text.substr(std::min(slash + 1, text.size())));
  constexpr double most = 1e8;  // as `--of`; a double beyond 2^64 has no whole number of its own
  if (!number || !of || *number < 1.0 || *number > *of || *of > most ||
      std::fmod(*number, 1.0) != 0.0 || std::fmod(*of, 1.0) != 0.0)
    throw InputError({}, "`--shard` wants a part and the number of parts, got `" + text +
                             "`; write `--shard 3/16`");
  return {static_cast<std::size_t>(*number), static_cast<std::size_t>(*of)};
}

FolderLock::FolderLock(const std::string& folder, const std::string& name) {
  make_folders(folder + "/locks");
  const std::string path = folder + "/locks/" + name + ".lock";
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw SystemError(path + " cannot be made: " + std::strerror(errno));
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    if (reason == ENOSYS || reason == ENOLCK || reason == EOPNOTSUPP) {
      warning_ = folder + ": its file system has no locks, so that two processes may run part " +
                 name + " at once, which costs time and does no harm";
      return;
    }
    file_ = {};
    const std::string text = trimmed(read_text(path));
    const std::string who = text.empty() ? "another process" : text;
    if (reason == EWOULDBLOCK)
      throw PartIsRun({folder, 0, 0}, "part " + name + " is run already, by " + who +
                                          "; wait for it, or run another `--shard`");
    throw SystemError(path + " cannot be locked: " + std::strerror(reason));
  }
  const std::string who = "process " + std::to_string(::getpid()) + " on " + host_name() + "\n";
  // The text only informs users: if it cannot be written, the lock holds all the same.
  if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, who.data(), who.size(), 0) < 0) return;
}

namespace {

// Cases that differ only in what a set-up does not depend on have equal texts.
std::string set_up_key(const scenario::Family& family, std::size_t i, bool meshed) {
  const bool one_tissue = family.base.regions.empty();
  std::string text;
  for (const scenario::Setting& setting : family.design.settings(i)) {
    const std::string& key = setting.key;
    const bool scales = one_tissue && key == "tissue.young_modulus";
    const bool after = !meshed && !key.starts_with("tissue.") && !key.starts_with("region");
    if (!scales && !after) text += setting.word + "\n";
  }
  return text;
}

class Trial {
 public:
  Trial(const scenario::Family& family, bool keeps_curves)
      : family_(family), keeps_curves_(keeps_curves), files_(scenario::hashed(family.inputs)) {}

  // The time of all cases, s; nothing if a case does not end as it should.
  std::optional<double> seconds() {
    constexpr double most = 8.0;           // cases
    constexpr double most_nodes = 2000.0;  // of all cases, because a set-up cannot be interrupted
    const std::size_t count = family_.design.count();
    const scenario::Case middle = scenario::make_case(family_, count / 2);
    const bool meshed = middle.scenario.meshed();
    const double nodes = meshed ? scene::expected_nodes(middle.scenario.tissue.mesh) : 1.0;
    const std::size_t tried =
        std::min(count, static_cast<std::size_t>(std::clamp(most_nodes / nodes, 1.0, most)));
    const std::size_t first = std::min(count / 2, count - tried);
    std::set<std::string> keys;
    for (std::size_t i = first; i < first + tried; ++i) keys.insert(set_up_key(family_, i, meshed));

    const std::optional<double> apart = run(first, tried);
    if (!apart) return alone(middle);
    if (tried == count) return apart;
    const std::optional<double> shared = run(first, tried);
    if (!shared) return std::nullopt;
    const double set_up = std::max(0.0, *apart - *shared) / static_cast<double>(keys.size());
    return set_up * set_ups(family_, meshed) +
           *shared / static_cast<double>(tried) * static_cast<double>(count);
  }

 private:
  static constexpr double longest = 1.0;  // s

  // How long cases take, with what earlier calls have left; nothing after `longest`.
  std::optional<double> run(std::size_t first, std::size_t count) {
    const Stopwatch watch;
    std::vector<scene::Scene> scenes;
    for (std::size_t i = first; i < first + count && watch.seconds() < longest; ++i) {
      const scenario::Case one = scenario::make_case(family_, i);
      (void)case_id(one, files_);
      scenes.push_back(run::build_scene(one, family_, shapes_));
      scenes.back().scenario.output.keep_rows_only();
      scenes.back().surface_displacements = &surface_displacements_;
    }
    const StopScope deadline(longest - watch.seconds());
    for (const scene::Scene& scene : scenes) {
      const record::CaseRecord record = run::run_case(scene);
      if (record.outcome == record::Outcome::interrupted) return std::nullopt;
      (void)row_of(scene, record, keeps_curves_);
    }
    return scenes.size() == count ? std::optional(watch.seconds()) : std::nullopt;
  }

  // From one case, which may end early.
  std::optional<double> alone(const scenario::Case& one) {
    const Stopwatch watch;
    scene::Scene scene = run::build_scene(one, family_, shapes_);
    const double set_up = std::max(watch.seconds(), shapes_.seconds(scene.scenario));
    scene.scenario.output.keep_rows_only();
    const StopScope deadline(longest);
    const Stopwatch running_watch;
    const record::CaseRecord record = run::run_case(scene);
    const std::optional<double> done = run::share_done(scene, record);
    if (!done) return std::nullopt;
    const double running = running_watch.seconds() / *done;
    return set_up * set_ups(family_, true) + running * static_cast<double>(family_.design.count());
  }

  const scenario::Family& family_;
  bool keeps_curves_;
  std::vector<HashedFile> files_;
  scene::SpecimenShapes shapes_;
  scene::SurfaceDisplacementStore surface_displacements_;
};

// The largest memory of this process so far, bytes: it has had more cases at once than a worker.
double most_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);  // Linux counts in KiB
}

}  // namespace

double set_ups(const scenario::Family& family, bool meshed) {
  constexpr std::size_t most = 2048;
  const std::size_t count = family.design.count();
  const std::size_t tries = std::min(count, most);
  std::set<std::string> found;
  for (std::size_t t = 0; t < tries; ++t)
    found.insert(set_up_key(family, t * count / tries, meshed));
  const auto different = static_cast<double>(found.size());
  const auto tried = static_cast<double>(tries);
  return different < 0.5 * tried ? different : different / tried * static_cast<double>(count);
}

std::string SweepForecast::text() const {
  return "about " + rounded_text(seconds, 2) + " s on one worker and " +
         rounded_text(bytes / 1e6, 2) + " MB" + (curves ? " besides the curves" : "");
}

std::optional<SweepForecast> forecast(const scenario::Family& family, bool keeps_curves) {
  constexpr double row = 2400.0;  // bytes, about; docs/sweeps.md
  std::optional<double> seconds;
  try {
    seconds = Trial(family, keeps_curves).seconds();
  } catch (const InputError&) {  // planning reports invalid cases
  } catch (const MeshError&) {
  }
  if (!seconds) return std::nullopt;
  const std::size_t cases = family.design.count();
  return SweepForecast{.cases = cases,
                       .seconds = *seconds,
                       .bytes = row * static_cast<double>(cases),
                       .memory = most_memory(),
                       .curves = keeps_curves};
}

}  // namespace palpate::sweep
