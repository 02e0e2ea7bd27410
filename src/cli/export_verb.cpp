// `palpate export`: writes results in the formats of other tools.
#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/whole_folder.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "record/csv.h"
#include "report/export.h"
#include "scenario/family.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

const report::ExportFormat& format_of(const std::string& name) {
  std::vector<std::string> known;
  for (const report::ExportFormat& one : report::export_formats()) {
    if (one.name == name) return one;
    known.emplace_back(one.name);
  }
  const auto near = nearest(name, known);
  refuse("`--to` does not know `" + name + "`" +
         (near ? "; did you mean `" + *near + "`?" : "; it is one of " + joined(known, ", ")));
}

// The file of the curves in a result folder, or the file itself.
std::string curve_file_of(const std::string& result) {
  if (!fs::is_directory(result)) return result;
  for (const char* name : {"force_indentation.csv", "strain_time.csv"})
    if (const fs::path file = fs::path(result) / name; fs::exists(file)) return file.string();
  throw InputError({result, 0, 0},
                   "holds neither force_indentation.csv nor strain_time.csv; give the folder of a "
                   "result, or a CSV file");
}

std::string name_of(const std::string& result) {
  fs::path path = fs::path(result).lexically_normal();
  if (path.filename().empty()) path = path.parent_path();
  return fs::is_directory(result) ? path.filename().string() : path.stem().string();
}

// Adds the radius of the finger if the result folder contains the scenario.
void add_radii(const std::string& result, std::vector<report::ExportCurve>& curves) {
  const fs::path file = fs::path(result) / "scenario.toml";
  if (!fs::is_directory(result) || !fs::exists(file)) return;
  try {
    const scenario::Family family = scenario::read(file.string(), {});
    for (report::ExportCurve& curve : curves)
      for (const scenario::Case& one : family.cases)
        if (one.name == curve.name || family.cases.size() == 1)
          curve.tip_radius = one.scenario.finger.radius;
  } catch (const InputError&) {  // an edited scenario.toml does not prevent the export
  }
}

void keep_case(std::vector<report::ExportCurve>& curves, const std::string& wanted,
               const std::string& file) {
  std::vector<std::string> names;
  for (const report::ExportCurve& curve : curves) names.push_back(curve.name);
  std::erase_if(curves, [&](const report::ExportCurve& curve) { return curve.name != wanted; });
  if (!curves.empty()) return;
  const auto near = nearest(wanted, names);
  throw InputError({file, 0, 0}, "has no case `" + wanted + "`" +
                                     (near ? "; did you mean `" + *near + "`?"
                                           : "; cases: " + joined(names, ", ")));
}

// A case's name as a file name: characters special to file systems or shells become `_`.
std::string file_name(const std::string& name) {
  std::string safe;
  for (const char c : name) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       c == '.' || c == '-' || c == '_' || c == '+' || c == '=';
    safe += plain ? c : '_';
  }
  return safe.empty() || safe[0] == '.' ? "_" + safe : safe;
}

}  // namespace

int perform(const Export& command, const Arguments&, const Talk& talk) {
  const report::ExportFormat& format = format_of(command.format);
  const std::string file = curve_file_of(command.result);
  std::vector<report::ExportCurve> curves =
      report::export_curves(record::read_csv(file), name_of(command.result));
  if (curves.empty())
    throw InputError({file, 0, 0}, "holds no rows; run the scenario again, or give another file");
  if (!command.case_name.empty()) keep_case(curves, command.case_name, file);
  add_radii(command.result, curves);

  // All texts and names are made before the first file, so that a refusal writes no file.
  std::vector<std::pair<fs::path, std::string>> files;
  std::set<fs::path> names;
  for (const report::ExportCurve& curve : curves) {
    const fs::path path =
        fs::path(command.out) / (file_name(curve.name) + std::string(format.ending));
    if (!names.insert(path).second)
      throw InputError({file, 0, 0}, "two cases would be written to " + path.string() +
                                         "; export them one by one with `--case` and `--out`");
    std::error_code ignored;
    if (fs::equivalent(path, file, ignored))
      throw InputError({path.string(), 0, 0},
                       "is the file to be exported and is not replaced; give another `--out`");
    try {
      files.emplace_back(path, format.text(curve));
    } catch (const InputError& error) {
      throw InputError({file, 0, 0}, error.problems().front().message);
    }
    if (!command.force && fs::exists(path) && !holds(path.string(), files.back().second))
      throw InputError({path.string(), 0, 0},
                       "is there already and says something else; give `--force` to replace it, "
                       "or another `--out`");
  }
  make_folders(command.out);
  for (const auto& [path, text] : files) {
    write_atomically(path.string(), text);
    talk.say("wrote " + path.string());
    talk.event("wrote", {{"file", path.string()}});
  }
  return exit_good;
}

}  // namespace palpate::cli
