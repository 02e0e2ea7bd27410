// Makes a family of cases from a TOML text.
#include "scenario/family.h"

#include <algorithm>
#include <filesystem>

#include "base/files.h"
#include "base/text.h"
#include "scenario/trial.h"

namespace palpate::scenario {
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
  const std::string found = find(path);
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
  const std::string found = find(path);
  return outline_text(read_text(found), name_of(found), settings);
}

const Case& case_named(const Family& family, const std::string& name) {
  return *std::find_if(family.cases.begin(), family.cases.end(),
                       [&](const Case& one) { return one.name == name; });
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
  const fs::path own = top.parent_path() / "scenarios";
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

std::vector<std::string> examples() {
  std::vector<std::string> names;
  for (const std::string& entry : entries_of(example_folder().string()))
    if (fs::path(entry).extension() == ".toml") names.push_back(fs::path(entry).stem().string());
  return names;
}

}  // namespace palpate::scenario
