// The files of a result, in the order in which they depend on each other.
#include "report/results.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "base/error.h"
#include "base/files.h"
#include "record/csv.h"
#include "report/exr.h"
#include "report/family_figures.h"
#include "report/gnuplot.h"
#include "report/manifest.h"
#include "report/scene_picture.h"
#include "report/vtu.h"
#include "tissue/strain.h"

namespace palpate::report {
namespace {

namespace fs = std::filesystem;

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw SystemError(path + " cannot be made: " + error.message());
}

void move(const std::string& from, const std::string& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw SystemError(from + " cannot be renamed to " + to + ": " + error.message());
}

bool is_complete(const std::string& folder) {
  const std::string manifest = folder + "/run.json";
  return fs::exists(manifest) &&
         read_text(manifest).find("\"complete\": true") != std::string::npos;
}

// A folder of the user's own that happens to have the scenario's name, as with `--out .`.
bool is_foreign(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(path, ignored)) || fs::exists(path + "/run.json"))
    return false;
  return !fs::is_directory(path) || !fs::is_empty(path);
}

std::string numbered(const char* stem, std::size_t number, const char* ending) {
  std::string digits = std::to_string(number);
  while (digits.size() < 3) digits.insert(digits.begin(), '0');
  return std::string(stem) + "_" + digits + ending;
}

// A file that every case has: by the case's row in findings.csv where there are several.
std::string case_file(const char* stem, std::size_t index, std::size_t cases, const char* ending) {
  if (cases == 1) return std::string(stem) + ending;
  return numbered((std::string(stem) + "_case").c_str(), index + 1, ending);
}

}  // namespace

record::Table findings_table(const scenario::Family& family,
                             const std::vector<record::CaseRecord>& records) {
  record::Table table;
  table.columns = {"case"};
  for (const std::string& key : family.design.keys()) table.columns.push_back(key);
  const std::size_t fixed = table.columns.size();
  for (const record::CaseRecord& record : records)
    for (const record::Finding& finding : record.findings)
      if (table.find(finding.name) < 0) table.columns.push_back(finding.name);
  for (const record::CaseRecord& record : records) {
    std::vector<record::Cell> row(table.columns.size());
    row[0] = record.name;
    const auto one = std::find_if(family.cases.begin(), family.cases.end(),
                                  [&](const auto& other) { return other.name == record.name; });
    for (std::size_t i = 1; i < fixed; ++i) row[i] = one->swept[i - 1].second;
    for (const record::Finding& finding : record.findings)
      row[static_cast<std::size_t>(table.find(finding.name))] = finding.value;
    table.rows.push_back(row);
  }
  return table;
}

namespace {

const char* curve_name(const scenario::Family& family) {
  return family.base.uniform() ? "strain_time.csv" : "force_indentation.csv";
}

record::Table curve_table(const scenario::Family& family,
                          const std::vector<record::CaseRecord>& records) {
  return family.base.uniform() ? record::strain_table(records) : record::contact_table(records);
}

// A row a case.
CsvFiles short_files(const scenario::Family& family, const std::vector<record::CaseRecord>& records,
                     const std::vector<fit::NamedFit>& fits) {
  CsvFiles files;
  files.emplace_back("findings.csv", findings_table(family, records));
  if (family.base.output.fits) files.emplace_back("fits.csv", fit::fit_table(fits));
  return files;
}

}  // namespace

CsvFiles csv_files(const scenario::Family& family, const std::vector<record::CaseRecord>& records,
                   const std::vector<fit::NamedFit>& fits) {
  CsvFiles files = short_files(family, records, fits);
  files.emplace(files.begin(), curve_name(family), curve_table(family, records));
  return files;
}

ResultFolder::ResultFolder(const std::string& out, const scenario::Family& family, bool replace)
    : family_(&family),
      path_((fs::path(out) / family.name).string()),
      partial_(path_ + ".partial-" + std::to_string(::getpid())),
      replace_(replace) {
  if (!replace && is_complete(path_))
    throw InputError({path_, 0, 0},
                     "holds a finished result; give `--force` to replace it, or another `--out`");
  if (is_foreign(path_))
    throw InputError({path_, 0, 0},
                     "is there and is no result, so that it is not replaced; give another `--out`, "
                     "or rename the scenario");
}

// Numbers of processes come again, in a container at once: a folder that was left is passed by.
void ResultFolder::open() {
  const std::string stem = partial_;
  if (const fs::path parent = fs::path(partial_).parent_path(); !parent.empty())
    make_folder(parent.string());
  std::error_code error;
  for (int i = 2; !fs::create_directory(partial_, error); ++i) {
    if (error) throw SystemError(partial_ + " cannot be made: " + error.message());
    partial_ = stem + "-" + std::to_string(i);
  }
  opened_ = true;
}

ResultFolder::~ResultFolder() {
  std::error_code ignored;
  const bool grows = std::any_of(growing_.begin(), growing_.end(), [&](const std::string& name) {
    return fs::exists(partial_ + "/" + name, ignored);
  });
  if (opened_ && !finished_ && !cases_kept_ && !grows) fs::remove_all(partial_, ignored);
}

std::string ResultFolder::growing(const std::string& name) {
  growing_.insert(name);
  return partial_ + "/" + name;
}

void ResultFolder::take_grown(const std::string& name) {
  std::error_code ignored;
  if (fs::exists(partial_ + "/" + name, ignored)) grown_.insert(name);
}

std::vector<std::string> ResultFolder::rows_left_beside() const {
  const fs::path place(path_);
  const std::string stem = place.filename().string() + ".partial-";
  const fs::path parent = place.has_parent_path() ? place.parent_path() : fs::path(".");
  std::vector<std::string> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(parent, ignored)) {
    const fs::path rows = entry.path() / "force_indentation.csv";
    // One with run.json is a whole result, beside an older one.
    if (entry.path().filename().string().starts_with(stem) && fs::exists(rows, ignored) &&
        !fs::exists(entry.path() / "run.json", ignored))
      found.push_back(rows.string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

void ResultFolder::keep(std::size_t index, const record::CaseRecord& record) {
  if (record.outcome == record::Outcome::interrupted) return;
  const std::string folder = partial_ + "/" + numbered("case", index + 1, "");
  make_folder(folder);
  const std::vector<record::CaseRecord> one{record};
  if (!record.contact.empty() && !grown_.contains("force_indentation.csv"))
    write_atomically(folder + "/force_indentation.csv",
                     record::csv_text(record::contact_table(one)));
  if (!record.strain.empty())
    write_atomically(folder + "/strain_time.csv", record::csv_text(record::strain_table(one)));
  write_atomically(folder + "/findings.csv", record::csv_text(findings_table(*family_, one)));
  cases_kept_ = true;
}

void ResultFolder::write(const std::string& name, const std::string& content) {
  write_atomically(partial_ + "/" + name, content);
  files_.push_back(name);
}

void ResultFolder::write_tissue(const std::vector<record::CaseRecord>& records) {
  std::size_t number = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    std::vector<TimedFile> series;
    for (const record::TissueFrame& frame : records[i].frames) {
      const std::vector<Strain> strain = tissue::small_strain(records[i].mesh, frame.displacement);
      series.push_back({frame.time, numbered("tissue", ++number, ".vtu")});
      write(series.back().file, vtu_bytes({.mesh = records[i].mesh,
                                           .time = frame.time,
                                           .displacement = frame.displacement,
                                           .contact_pressure = frame.contact_pressure,
                                           .strain = strain}));
    }
    if (!series.empty())
      write(case_file("tissue", i, family_->cases.size(), ".pvd"), pvd_bytes(series));
  }
}

void ResultFolder::write_pictures(const std::vector<record::CaseRecord>& records) {
  const bool several = family_->cases.size() > 1;
  for (std::size_t i = 0; i < records.size(); ++i)
    if (!records[i].picture.faces.empty())
      write(case_file("scene", i, family_->cases.size(), ".svg"),
            scene_svg(records[i].picture,
                      several ? family_->title + ": " + records[i].name : family_->title));
}

std::vector<std::string> ResultFolder::finish(const std::vector<record::CaseRecord>& records,
                                              const std::vector<fit::NamedFit>& fits,
                                              const Origin& origin) {
  std::vector<std::string> warnings;
  files_.clear();
  scenario::Chosen chosen;
  for (const record::CaseRecord& record : records) chosen.emplace_back(record.name, record.chosen);
  const std::string echo = scenario::echo(*family_, chosen);
  write("scenario.toml", echo);
  for (const scenario::InputFile& input : family_->inputs)
    if (&input != &family_->inputs.front()) write(input.name, input.content);
  const std::string curve = curve_name(*family_);
  if (grown_.contains(curve))
    files_.push_back(curve);
  else
    write(curve, record::csv_text(curve_table(*family_, records)));
  for (const auto& [name, table] : short_files(*family_, records, fits))
    write(name, record::csv_text(table));
  for (const std::string& name : grown_)
    if (name != curve) files_.push_back(name);
  for (const record::CaseRecord& record : records)
    for (const auto& [name, content] : record.attached) write(name, content);

  const std::string hash = sha256(echo);
  std::size_t number = 0;
  for (const record::CaseRecord& record : records)
    for (const record::PressureMap& map : record.maps)
      write(numbered("pressure", ++number, ".exr"),
            exr_bytes(map, {{"palpate:scenarioSha256", hash}}));
  write_tissue(records);
  write_pictures(records);

  if (family_->base.output.figures) {
    for (const Figure& figure : family_figures(*family_, records, fits)) {
      DrawOptions options;
      if (family_->base.output.pdf) options.format = PictureFormat::svg_and_pdf;
      const Drawing drawing = draw(figure, partial_, options);
      files_.insert(files_.end(), drawing.files.begin(), drawing.files.end());
      if (!drawing.warning.empty()) warnings.push_back(drawing.warning);
    }
  }

  Manifest manifest = begin_manifest(origin, family_->inputs);
  for (const std::string& file : files_) manifest.outputs.push_back(hashed_file(file, partial_));
  for (const record::CaseRecord& record : records)
    manifest.cases.push_back({record.name,
                              record.outcome == record::Outcome::completed
                                  ? CaseEntry::State::finished
                                  : CaseEntry::State::failed,
                              record.reason,
                              {{"run", record.seconds}}});
  manifest.complete = records.size() == family_->cases.size();
  write_atomically(partial_ + "/run.json", manifest_text(manifest));

  std::error_code ignored;
  for (std::size_t i = 0; i < family_->cases.size(); ++i)
    fs::remove_all(partial_ + "/" + numbered("case", i + 1, ""), ignored);
  finished_ = true;
  if (is_complete(path_) && !(replace_ && manifest.complete)) {  // of before, or of meanwhile
    warnings.push_back(path_ + " is a finished result and is not replaced; this run's is in " +
                       partial_);
    path_ = partial_;
  } else {
    put_in_place();
  }
  return warnings;
}

void ResultFolder::put_in_place() {
  if (!fs::exists(path_)) return move(partial_, path_);
  // The old and the new result change places at once; where the file system cannot do that, the
  // old one steps aside first.
  if (::renameat2(AT_FDCWD, partial_.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) != 0) {
    const std::string aside = partial_ + ".old";
    move(path_, aside);
    move(partial_, path_);
    move(aside, partial_);
  }
  std::error_code ignored;
  fs::remove_all(partial_, ignored);
}

}  // namespace palpate::report
