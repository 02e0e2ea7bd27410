// An identification is whole or not there.
#include "report/identified_folder.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "fit/identified_tables.h"
#include "fit/regression.h"
#include "record/csv.h"
#include "report/manifest.h"

namespace palpate::report {
namespace {

namespace fs = std::filesystem;

constexpr const char* table = "identified.csv";

void move(const std::string& from, const std::string& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw SystemError(from + " cannot be renamed to " + to + ": " + error.message());
}

// A folder beside the result, gone at the end unless it has been renamed.
class Beside {
 public:
  explicit Beside(std::string folder) : path_(std::move(folder)) {
    std::error_code error;
    fs::create_directories(path_, error);
    if (error) throw SystemError(path_ + " cannot be made: " + error.message());
  }
  ~Beside() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  void write(const std::string& name, const std::string& content) {
    write_atomically(path_ + "/" + name, content);
    files_.push_back(name);
  }
  void add(const std::vector<std::string>& files) {
    files_.insert(files_.end(), files.begin(), files.end());
  }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

 private:
  std::string path_;
  std::vector<std::string> files_;
};

// The scenario that `palpate run` repeats the fitted curve with.
std::string echo_of(const fit::Identification& found, const scenario::Family& family) {
  scenario::Family one = family;
  one.cases.resize(1);
  one.cases.front().scenario = found.scenario;
  one.design = {};
  std::string text = "# Fitted to a measurement: `palpate run` of this file repeats the curve.\n";
  for (const fit::Identified& each : found.unknowns) {
    const fit::Unknown& unknown = each.unknown;
    const std::string value = rounded_text(unknown.shown(each.estimate), 6) +
                              (unknown.unit ? " " + unknown.unit_text() : "");
    if (each.tied)
      text += "# " + unknown.key + " is not determined by itself: one of many values that fit.\n";
    if (unknown.what == fit::Unknown::What::contact_point)
      text += "# Travel 0 is at " + value + " of the measurement.\n";
    if (unknown.what == fit::Unknown::What::force_offset)
      text += "# contact.ambient_force holds the measurement's offset of " + value + ".\n";
  }
  return text + scenario::echo(one);
}

}  // namespace

IdentifiedFolder::IdentifiedFolder(const std::string& out, const std::string& name, bool replace)
    : path_((fs::path(out) / (name + "_identified")).string()) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(path_, ignored))) return;
  const bool finished = fs::exists(path_ + "/" + table);
  if (finished && !replace)
    throw InputError({path_, 0, 0},
                     "holds a finished identification; give `--force` to replace it, or another "
                     "`--out`");
  if (!finished && (!fs::is_directory(path_) || !fs::is_empty(path_)))
    throw InputError({path_, 0, 0},
                     "is there and is no identification, so that it is not replaced; give another "
                     "`--out`, or rename the scenario");
}

std::vector<std::string> IdentifiedFolder::write(const fit::Identification& found,
                                                 const scenario::Family& family,
                                                 const std::string& measured,
                                                 const Origin& origin) const {
  std::vector<std::string> warnings;
  Beside beside(path_ + ".partial-" + std::to_string(::getpid()));
  beside.write("scenario.toml", echo_of(found, family));
  for (const scenario::InputFile& input : family.inputs)
    if (&input != &family.inputs.front()) beside.write(input.name, input.content);
  beside.write(table, record::csv_text(fit::identified_table(found)));
  beside.write("correlation.csv", record::csv_text(fit::correlation_table(found)));
  beside.write("residuals.csv", record::csv_text(fit::residual_table(found)));
  std::vector<Sheet> sheets{identified_sheet(family.title, found)};
  if (!found.profile.empty()) {
    beside.write("profile.csv", record::csv_text(fit::profile_table(found)));
    sheets.push_back(profile_sheet(family.title, found));
  }
  for (const Sheet& sheet : sheets) {
    const Drawing drawing = draw(sheet, beside.path());
    beside.add(drawing.files);
    if (!drawing.warning.empty()) warnings.push_back(drawing.warning);
  }

  Manifest manifest = begin_manifest(origin, family.inputs);
  manifest.inputs.push_back(hashed_file(measured));
  for (const std::string& file : beside.files())
    manifest.outputs.push_back(hashed_file(file, beside.path()));
  manifest.complete = true;
  beside.write("run.json", manifest_text(manifest));

  if (!fs::exists(path_)) {
    move(beside.path(), path_);
    return warnings;
  }
  // The old one steps aside until the new one stands.
  const Beside aside(beside.path() + ".old");
  move(path_, aside.path());
  move(beside.path(), path_);
  return warnings;
}

}  // namespace palpate::report
