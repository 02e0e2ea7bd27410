// Makes a family of cases from a TOML text: one after the other, collecting the files that they
// read and their problems.
#include "scenario/family.h"

#include <algorithm>
#include <filesystem>

#include "base/fields.h"
#include "base/text.h"
#include "scenario/schema.h"

namespace palpate::scenario {
namespace {

// A case, as far as it could be made.
struct Made {
  Case one;          // without a name
  Scenario as_read;  // without the values that follow from other keys
  Reading reading;
  std::vector<Problem> together;  // of several keys together, each of which is valid
};

// Adds the problems that are new, because every case may repeat the same ones.
void add_new(std::vector<Problem>& all, const std::vector<Problem>& more) {
  for (const Problem& problem : more) {
    const bool known = std::ranges::any_of(
        all, [&](const Problem& other) { return other.text() == problem.text(); });
    if (!known) all.push_back(problem);
  }
}

// All values that were read, with those that have no effect, as TOML.
std::string all_values(const Scenario& scenario) {
  Scenario copy = scenario;
  return fields_as_toml([&](FieldVisitor& visitor) { fields(visitor, copy); }, Written::all);
}

std::string shown_words(const std::vector<Setting>& settings) {
  std::vector<std::string> words;
  for (const Setting& setting : settings) words.push_back(setting.word);
  return ticked(joined(words, ", "));
}

// The files that a row of a table names.
std::string files_of(const std::vector<Setting>& row) {
  std::string files;
  for (const Setting& setting : row)
    if (names_file(setting.key)) files += setting.value.text + "\n";
  return files;
}

// The entry of an ignored key, or of an ignored table that contains it; null if the key is read.
const Unread* find_unread(const std::string& key, const Reading& reading) {
  for (const Unread& one : reading.unread)
    if (key == one.path || key.starts_with(one.path + ".")) return &one;
  return nullptr;
}

// Reads, completes and checks the document with these settings.
Made make(const Family& family, const std::vector<Setting>& settings, Sources& sources) {
  Made made;
  Node document = family.document;
  for (const Setting& setting : settings) {
    set_value(document, setting.key, setting.value, setting.place);
    made.one.swept.emplace_back(setting.key, setting.word);
  }
  Scenario& scenario = made.one.scenario;
  made.reading = read_fields(document, [&](FieldVisitor& visitor) { fields(visitor, scenario); });
  made.as_read = scenario;
  std::vector<Problem>& problems = made.reading.problems;
  complete(scenario, document);
  made.one.materials = find_materials(scenario, document, sources, problems);
  if (problems.empty()) {
    scenario.tissue.viscosity = law_of(scenario, made.one.materials.tissue, document);
    check(made.one, document, made.together);
  }
  made.one.files = sources.used;
  made.one.folder = family.folder;
  return made;
}

std::string case_name(const Family& family, std::size_t i,
                      const std::vector<std::pair<std::string, std::string>>& swept) {
  return swept.empty() ? family.name : family.design.case_name(i, swept);
}

class Trial {
 public:
  explicit Trial(Family& family) : family_(family) {}

  // Adds files to the family's inputs; two different files with one name are a problem. The first
  // input is the scenario itself; results contain its echo, `scenario.toml`, instead.
  void remember(const std::vector<Sources::ReadFile>& read) {
    for (const auto& [added, place] : read) {
      std::vector<InputFile>& inputs = family_.inputs;
      const auto known =
          std::find_if(inputs.begin() + 1, inputs.end(),
                       [&name = added.name](const InputFile& other) { return other.name == name; });
      if (added.name == "scenario.toml")
        add_problems({{place, ticked(added.name) +
                                  " is the name of the echo among the results; rename the file"}});
      else if (known == inputs.end())
        inputs.push_back(added);
      else if (known->content != added.content)
        add_problems({{place, "two different files are called " + ticked(added.name) +
                                  ", and a result folder holds a copy of each; rename one"}});
    }
  }

  // Makes case i; the first case made becomes the family's base.
  Case make(std::size_t i) {
    const std::vector<Setting> settings = family_.design.settings(i);
    Made made = take(settings);
    if (!begun_) family_.base = made.as_read;
    begun_ = true;
    add_problems(made.reading.problems);
    add_problems(made.together);
    const Design::Kind kind = family_.design.kind();
    if ((kind == Design::Kind::list || kind == Design::Kind::csv) && problems_.empty())
      refuse_equal(rows_, made, settings, "");
    made.one.name = case_name(family_, i, made.one.swept);
    return made.one;
  }

  // Builds all cases, or a spread sample of `most`, plus every table row that names a file.
  void try_cases(std::size_t most) {
    const Design& design = family_.design;
    const std::size_t count = design.count();
    const std::size_t tried = std::min(count, most);
    std::set<std::string> seen;
    for (std::size_t k = 0; k < tried; ++k) {
      const std::size_t i = tried == count || k == 0 ? k : k * (count - 1) / (tried - 1);
      (void)make(i);
      seen.insert(files_of(design.settings(i)));
    }
    if (design.kind() != Design::Kind::csv || tried == count) return;
    for (std::size_t i = 0; i < count; ++i)
      if (seen.insert(files_of(design.settings(i))).second) (void)make(i);
  }

  // Checks that case names are different, and that `display_scale` uses existing names.
  void check_names(const Place& sweep) {
    if (!problems_.empty()) return;
    std::vector<std::string> names;
    for (const Case& one : family_.cases) names.push_back(one.name);
    for (const auto& [name, factor] : family_.base.output.display_scale) {
      if (std::ranges::find(names, name) != names.end()) continue;
      add_problems({{place_of(family_.document, "output.display_scale." + name),
                     "`display_scale` names no case `" + name + "`; " +
                         did_you_mean(name, names, "cases: " + joined(names, ", "))}});
    }
    const std::set<std::string> different(names.begin(), names.end());
    if (different.size() != names.size())
      add_problems({{sweep, "two cases of `sweep` have the same name; give each value once"}});
  }

  // Checks every value of a list and both ends of a range, with the other factors as in the first
  // case: they must be within the key's limits and different from each other. Checks also that
  // every swept key is read by at least one case.
  void check_factors() {
    if (!problems_.empty() || family_.design.empty()) return;
    const Design::Kind kind = family_.design.kind();
    if (kind != Design::Kind::list && kind != Design::Kind::csv)
      for (std::size_t f = 0; f < family_.design.factors().size(); ++f) check_values(f);
    if (problems_.empty()) check_swept_keys();
  }

  // Throws InputError with all problems, if there are any.
  void finish() {
    family_.title = family_.base.title.empty() ? family_.name : family_.base.title;
    sort_by_place(problems_);
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  void add_problems(const std::vector<Problem>& problems) {
    for (Problem problem : problems) {
      // The remedy for a range with values that are not whole is a list.
      for (const Factor& factor : family_.design.factors())
        for (const Varied& varied : factor.keys)
          if (varied.interval && problem.place == varied.interval->from.place &&
              problem.message.find("wants a whole number") != std::string::npos)
            problem.message =
                ticked(varied.key) +
                " wants whole numbers, which a range does not keep to; give a list, as `[1, 2, 3]`";
      add_new(problems_, {problem});
    }
  }

  Made take(const std::vector<Setting>& settings) {
    Sources sources{family_.folder, family_.library};
    Made made = scenario::make(family_, settings, sources);
    add_new(family_.notes, made.reading.notes);
    family_.library.tissues.merge(sources.found.tissues);
    family_.library.geometry.merge(sources.found.geometry);
    remember(sources.read);
    for (const Setting& setting : settings) {
      const Unread* const unread = find_unread(setting.key, made.reading);
      if (unread == nullptr)
        read_[setting.key] = true;
      else
        unread_[setting.key] = unread->when;
    }
    contact_only_ = contact_only_ || poisson_in_contact_only(made.one.scenario);
    return made;
  }

  void refuse_equal(std::map<std::string, std::string>& seen, const Made& made,
                    const std::vector<Setting>& values, const std::string& of) {
    const auto [known, added] = seen.emplace(all_values(made.as_read), shown_words(values));
    if (!added)
      add_problems(
          {{values.front().value.place, known->second + " and " + shown_words(values) + of +
                                            " make the same case; keep one of them"}});
  }

  void check_values(std::size_t factor) {
    std::vector<Setting> settings = family_.design.settings(0);
    std::map<std::string, std::string> seen;  // words, by all values read
    for (const std::vector<Setting>& values : family_.design.extremes(factor)) {
      for (const Setting& value : values)
        *std::ranges::find(settings, value.key, &Setting::key) = value;
      const Made made = take(settings);
      add_problems(made.reading.problems);
      // A combination in a grid is a case; one in a sample may be no case, so it is not refused.
      if (family_.design.kind() == Design::Kind::grid) add_problems(made.together);
      if (made.reading.problems.empty())
        refuse_equal(seen, made, values, " of " + ticked(family_.design.factors()[factor].name));
    }
  }

  void check_swept_keys() {
    for (const Setting& setting : family_.design.settings(0)) {
      const auto unread = unread_.find(setting.key);
      if (unread != unread_.end() && !read_.contains(setting.key))
        add_problems({{setting.place,
                       ticked(setting.key) + " is swept and changes nothing: it is used only " +
                           unread->second + "; take it out of `[sweep]` or change that"}});
      if (setting.key == "tissue.poisson_ratio" && contact_only_)
        add_new(family_.notes,
                {{setting.place, ticked(setting.key) + " " + poisson_in_contact_only_text}});
    }
  }

  Family& family_;
  bool begun_ = false;
  std::map<std::string, std::string> rows_;  // of lists and tables: their words, by the values read
  std::vector<Problem> problems_;
  std::map<std::string, std::string> unread_;  // swept keys that some case ignores, with the
                                               // condition under which they would be read
  std::map<std::string, bool> read_;           // swept keys that some case has read
  bool contact_only_ = false;                  // poisson_in_contact_only() holds for some case
};

}  // namespace

const char* const poisson_in_contact_only_text =
    "reaches the contact only: independent springs have a ratio of their own (findings.csv)";

bool poisson_in_contact_only(const Scenario& scenario) {
  const Solver& solver = scenario.solver;
  return solver.model && traits(*solver.model).independent() &&
         solver.volume.value_or(Solver::Volume::none) == Solver::Volume::none;
}

std::vector<std::string> unread_keys(const Family& family, std::size_t i, Solver::Model chosen) {
  std::vector<Setting> settings = family.design.settings(i);
  settings.push_back({"solver.model", {}, text_node(traits(chosen).word), {}});
  Sources sources{family.folder, family.library};
  const Made made = make(family, settings, sources);
  settings.pop_back();
  std::vector<std::string> keys;
  for (const Setting& setting : settings)
    if (find_unread(setting.key, made.reading) != nullptr) keys.push_back(setting.key);
  return keys;
}

namespace {

// A family with its design and without cases, and the place of its [sweep].
struct Opened {
  Family family;
  Place sweep;
  std::vector<Sources::ReadFile> read;  // the CSV file of the design, if there is one
};

Opened open(const std::string& text, const std::string& path,
            const std::vector<std::string>& settings) {
  Opened opened;
  Family& family = opened.family;
  const std::filesystem::path file(path);
  family.name = file.stem().string();
  family.folder = file.parent_path().string();
  family.document = parse_toml(text, path);
  for (const std::string& setting : settings) {
    const auto [key, value] = parse_assignment(setting);
    set_value(family.document, key, value, value.place);
  }
  family.inputs.push_back({file.filename().string(), text});
  opened.sweep = place_of(family.document, "sweep");
  const Place file_place = place_of(family.document, "sweep.file");
  family.design = take_design(family.document, family.folder);
  const CaseTable& table = family.design.table();
  if (family.design.kind() == Design::Kind::csv)
    opened.read.push_back(
        {{std::filesystem::path(table.path()).filename().string(), table.text()}, file_place});
  return opened;
}

// The standard input has no name of its own.
std::string name_of(const std::string& found) { return found == "-" ? "stdin" : found; }

}  // namespace

Family parse(const std::string& text, const std::string& path,
             const std::vector<std::string>& settings) {
  Opened opened = open(text, path, settings);
  Family& family = opened.family;
  const std::size_t count = family.design.count();
  if (count > most_cases)
    throw InputError(opened.sweep, "`sweep` makes " + std::to_string(count) +
                                       " cases, and more than " + std::to_string(most_cases) +
                                       " are planned first: `palpate sweep plan " + path + "`");
  Trial trial(family);
  trial.remember(opened.read);
  for (std::size_t i = 0; i < count; ++i) family.cases.push_back(trial.make(i));
  trial.check_factors();
  trial.check_names(opened.sweep);
  trial.finish();
  return std::move(family);
}

Family read(const std::string& path, const std::vector<std::string>& settings) {
  const std::string found = file_of(path);
  return parse(read_text(found), name_of(found), settings);
}

Family parse_case(const std::string& text, const std::string& path,
                  const std::vector<std::string>& settings, std::size_t i) {
  Family family = open(text, path, settings).family;
  family.design = family.design.only(i);
  Trial trial(family);
  family.cases = {trial.make(0)};
  trial.finish();
  return family;
}

Family outline_text(const std::string& text, const std::string& path,
                    const std::vector<std::string>& settings) {
  Opened opened = open(text, path, settings);
  Family& family = opened.family;
  Trial trial(family);
  trial.remember(opened.read);
  constexpr std::size_t of_many = 256;
  trial.try_cases(family.design.count() <= most_cases ? most_cases : of_many);
  trial.check_factors();
  trial.finish();
  return std::move(family);
}

Family outline_planned(const std::string& path) {
  Opened opened = open(read_text(path), path, {});
  Trial trial(opened.family);
  trial.remember(opened.read);
  trial.try_cases(1);
  trial.finish();
  return std::move(opened.family);
}

Family outline(const std::string& path, const std::vector<std::string>& settings) {
  const std::string found = file_of(path);
  return outline_text(read_text(found), name_of(found), settings);
}

std::vector<HashedFile> hashed(const std::vector<InputFile>& files) {
  std::vector<HashedFile> all;
  for (const InputFile& file : files) all.push_back({file.name, sha256(file.content)});
  return all;
}

const Case& case_named(const Family& family, const std::string& name) {
  return *std::ranges::find(family.cases, name, &Case::name);
}

Case make_case(const Family& family, std::size_t i) {
  Sources sources{family.folder, family.library};
  Made made = make(family, family.design.settings(i), sources);
  for (const auto* problems : {&made.reading.problems, &made.together})
    if (!problems->empty()) throw InputError(*problems);
  made.one.name = case_name(family, i, made.one.swept);
  made.one.at_least = family.at_least;
  return std::move(made.one);
}

namespace {

namespace fs = std::filesystem;

fs::path example_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path top = program.parent_path().parent_path();
  const fs::path installed = top / "share/palpate/scenarios";
  // A program that was built in a checkout takes those of the checkout.
  fs::path own = top.parent_path() / "scenarios";
  if (!fs::exists(installed, error) && fs::exists(own / "quickstart.toml", error)) return own;
  return error ? fs::path() : installed;
}

}  // namespace

std::string find(const std::string& given) {
  const fs::path path(given);
  std::error_code error;
  if (given == "-" || path.has_parent_path() || path.has_extension() || fs::exists(path, error))
    return given;
  const fs::path example = example_folder() / (given + ".toml");
  return fs::is_regular_file(example, error) ? example.string() : given;
}

std::string file_of(const std::string& given) {
  std::string found = find(given);
  const fs::path path(given);
  std::error_code error;
  if (found != given || given == "-" || path.has_parent_path() || path.has_extension() ||
      fs::exists(path, error) || error)
    return found;
  std::string kind = "press";
  for (const Starter& starter : starters())
    if (given == starter.word.word) kind = given;
  throw InputError({given, 0, 0}, "is neither a file nor an installed example; " +
                                      did_you_mean(given, examples(),
                                                   "`palpate new " + kind + "` writes " + kind +
                                                       ".toml, a scenario to begin with"));
}

std::vector<std::string> examples() {
  std::vector<std::string> names;
  for (const std::string& entry : entries_of(example_folder().string()))
    if (fs::path(entry).extension() == ".toml") names.push_back(fs::path(entry).stem().string());
  return names;
}

}  // namespace palpate::scenario
