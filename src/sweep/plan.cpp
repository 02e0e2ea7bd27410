// Makes a plan from copies of its inputs in a temporary folder, which is then renamed.
#include "sweep/plan.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <unordered_map>
#include <unordered_set>

#include "base/document.h"
#include "base/files.h"
#include "base/text.h"
#include "base/whole_folder.h"
#include "record/csv.h"
#include "record/table.h"
#include "run/choose.h"
#include "run/share_out.h"
#include "scene/scene.h"
#include "scene/specimen_shape.h"
#include "sweep/journal.h"
#include "sweep/plan_file.h"
#include "sweep/row.h"
#include "sweep/shard.h"

namespace palpate::sweep {
namespace {

namespace fs = std::filesystem;

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
      : original_(original), copy_(copy), files_(hashed_inputs(copy)) {}

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
  HashedNames files_;
};

void refuse_twins(const scenario::Family& family, const std::vector<std::uint64_t>& ids) {
  std::vector<std::uint32_t> order(ids.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
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
        std::replace(word.begin(), word.end(), '\n', ' ');  // one line per case
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
    throw InputError({old->folder, 0, 0},
                     "keeps no curves, and the new plan does; plan without `--curves`, or without "
                     "`--reuse`");
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
                      .inputs = hashed_inputs(copy)};
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

}  // namespace palpate::sweep
