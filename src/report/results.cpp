// Writes the files of a result.
#include "report/results.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <system_error>

#include "base/error.h"
#include "base/files.h"
#include "base/stop_scope.h"
#include "plot/gnuplot.h"
#include "record/csv.h"
#include "record/table.h"
#include "report/exr.h"
#include "report/family_figures.h"
#include "report/map_picture.h"
#include "report/run_page.h"
#include "report/scene_picture.h"
#include "report/vtu.h"
#include "tissue/coupled.h"

namespace palpate::report {
namespace {

namespace fs = std::filesystem;

std::string numbered(const char* stem, std::size_t number, const char* ending) {
  std::string digits = std::to_string(number);
  while (digits.size() < 3) digits.insert(digits.begin(), '0');
  return std::string(stem) + "_" + digits + ending;
}

// The name of a case's file, with the case's row in findings.csv as a number if there are several.
std::string case_file(const char* stem, std::size_t index, std::size_t cases, const char* ending) {
  if (cases == 1) return std::string(stem) + ending;
  return numbered((std::string(stem) + "_case").c_str(), index + 1, ending);
}

// The columns of the swept keys, with their units.
std::vector<record::SweptColumn> swept_columns(const scenario::Family& family,
                                               const std::vector<record::CaseRecord>& records) {
  std::vector<record::SweptColumn> columns;
  for (const std::string& key : family.design.keys()) columns.emplace_back(key);
  for (const record::CaseRecord& record : records) {
    const scenario::Case& one = scenario::case_named(family, record.name);
    for (std::size_t i = 0; i < columns.size(); ++i)
      columns[i].see(record::swept_cell(one.swept[i].second));
  }
  return columns;
}

// findings.csv: case, the swept keys, then one column per finding, empty for cases without it.
record::Table findings_table(const scenario::Family& family,
                             const std::vector<record::CaseRecord>& records) {
  record::Table table;
  table.columns = {"case"};
  const std::vector<record::SweptColumn> swept = swept_columns(family, records);
  for (const record::SweptColumn& column : swept) table.columns.push_back(column.name());
  const std::size_t fixed = table.columns.size();
  for (const record::CaseRecord& record : records)
    for (const record::Finding& finding : record.findings)
      if (table.find(finding.name) < 0) table.columns.push_back(finding.name);
  for (const record::CaseRecord& record : records) {
    std::vector<record::Cell> row(table.columns.size());
    row[0] = record.name;
    const scenario::Case& one = scenario::case_named(family, record.name);
    for (std::size_t i = 1; i < fixed; ++i)
      row[i] = swept[i - 1].cell(record::swept_cell(one.swept[i - 1].second));
    for (const record::Finding& finding : record.findings)
      row[as_index(table.find(finding.name))] = finding.value;
    table.rows.push_back(row);
  }
  return table;
}

const char* curve_name(const scenario::Family& family) {
  return family.base.uniform() ? "strain_time.csv" : "force_indentation.csv";
}

record::Table curve_table(const scenario::Family& family,
                          const std::vector<record::CaseRecord>& records) {
  return family.base.uniform() ? record::strain_table(records) : record::contact_table(records);
}

// The rows and findings of a record, without its maps and meshes.
std::vector<record::CaseRecord> rows_of(const record::CaseRecord& record) {
  std::vector<record::CaseRecord> rows(1);
  rows[0].name = record.name;
  rows[0].contact = record.contact;
  rows[0].strain = record.strain;
  rows[0].measured = record.measured;
  rows[0].findings = record.findings;
  return rows;
}

// Writes what a result has beside its tables, an interrupted one for a tenth of a second.
class Extras {
 public:
  template <class Write>
  void add(Write write) {
    const auto now = std::chrono::steady_clock::now();
    if (!until_ && StopScope::stopped()) until_ = now + std::chrono::milliseconds(100);
    if (until_ && now > *until_)
      ++omitted_;
    else
      write();
  }
  [[nodiscard]] std::size_t omitted() const { return omitted_; }

 private:
  std::optional<std::chrono::steady_clock::time_point> until_;
  std::size_t omitted_ = 0;
};

// Files with a few rows per case.
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

std::string origin_of(const scenario::Family& family) {
  std::string text;
  for (const scenario::InputFile& input : family.inputs)
    text += input.name + " " + sha256(input.content) + "\n";
  return text + scenario::echo(family);
}

ResultFolder::ResultFolder(const std::string& out, const scenario::Family& family, Replace replace,
                           const std::string& origin)
    : family_(&family), folder_((fs::path(out) / family.name).string(), "result", replace, origin) {
  folder_.refuse_what_is_there();
}

std::string ResultFolder::growing(const std::string& name) {
  folder_.keep(name);
  return folder_.file(name);
}

void ResultFolder::take_grown(const std::string& name) {
  if (fs::exists(folder_.file(name))) grown_.insert(name);
}

std::vector<std::string> ResultFolder::rows_left_beside() const {
  std::vector<std::string> found;
  for (const std::string& left : folder_.left_beside())
    // A folder with run.json is a complete result that could not replace an older one.
    if (fs::exists(left + "/force_indentation.csv") && !fs::exists(left + "/run.json"))
      found.push_back(left + "/force_indentation.csv");
  return found;
}

void ResultFolder::keep(std::size_t index, const record::CaseRecord& record) {
  const bool ended = record.outcome != record::Outcome::interrupted;
  const std::string curve = curve_name(*family_);
  std::string rows;
  if (ended && !grown_.contains(curve))
    rows = record::csv_text(curve_table(*family_, rows_of(record)));
  const std::lock_guard lock(keeping_);
  if (ended) keep_for_a_kill(numbered("case", index + 1, "") + "/", curve, record, rows);
  ahead_.emplace(index, std::move(rows));
  for (; ahead_.contains(next_); ++next_)
    rows_hash_.add(add_rows(rows_, ahead_.extract(next_).mapped()));
}

// Quick cases together, a fiftieth of the work so far: to write and remove two files of each takes
// longer than to compute it again.
void ResultFolder::keep_for_a_kill(const std::string& folder, const std::string& curve,
                                   const record::CaseRecord& record, const std::string& rows) {
  record::CaseRecord found;
  found.name = record.name;
  found.findings = record.findings;
  unkept_.push_back(std::move(found));
  add_rows(unkept_rows_, rows);
  seconds_ += record.seconds;
  const double worth_keeping = std::clamp(0.02 * seconds_, 0.05, 1.0);  // s
  if (record.seconds > 0.0 && seconds_ - kept_seconds_ < worth_keeping) return;
  kept_seconds_ = seconds_;
  if (!cases_kept_) folder_.keep(folder + "findings.csv");  // written last
  cases_kept_ = true;
  make_folders(folder_.file(folder));
  if (!rows.empty()) write_atomically(folder_.file(folder + curve), unkept_rows_, Disk::later);
  write_atomically(folder_.file(folder + "findings.csv"),
                   record::csv_text(findings_table(*family_, unkept_)), Disk::later);
  unkept_.clear();
  unkept_rows_.clear();
}

std::string_view ResultFolder::add_rows(std::string& all, std::string_view text) {
  if (!all.empty()) text.remove_prefix(std::min(text.find('\n') + 1, text.size()));
  all += text;
  return text;
}

namespace {

void write_tissue(const scenario::Family& family, const std::vector<record::CaseRecord>& records,
                  WholeFolder& folder, Extras& extras) {
  std::size_t number = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    std::vector<TimedFile> series;
    for (const record::TissueFrame& frame : records[i].frames)
      extras.add([&] {
        const std::vector<Strain> strain =
            tissue::small_strain(records[i].mesh, frame.displacement);
        series.push_back({frame.time, numbered("tissue", ++number, ".vtu")});
        folder.write(series.back().file, vtu_bytes({.mesh = records[i].mesh,
                                                    .time = frame.time,
                                                    .displacement = frame.displacement,
                                                    .contact_pressure = frame.contact_pressure,
                                                    .strain = strain}));
      });
    if (!series.empty())
      folder.write(case_file("tissue", i, family.cases.size(), ".pvd"), pvd_bytes(series));
  }
}

void write_pictures(const scenario::Family& family, const std::vector<record::CaseRecord>& records,
                    WholeFolder& folder, Extras& extras) {
  if (!family.base.output.picture) return;
  const bool several = family.cases.size() > 1;
  for (std::size_t i = 0; i < records.size(); ++i)
    if (!records[i].picture.faces.empty())
      extras.add([&] {
        folder.write(case_file("scene", i, family.cases.size(), ".svg"),
                     scene_svg(records[i].picture,
                               several ? family.title + ": " + records[i].name : family.title));
      });
}

}  // namespace

std::vector<std::string> ResultFolder::finish(const std::vector<record::CaseRecord>& records,
                                              const std::vector<fit::NamedFit>& fits,
                                              const Origin& origin) {
  std::vector<std::string> warnings;
  scenario::Chosen chosen;
  for (const record::CaseRecord& record : records) chosen.emplace_back(record.name, record.chosen);
  const std::string echo = scenario::echo(*family_, chosen);
  folder_.write("scenario.toml", echo);
  for (const scenario::InputFile& input : family_->inputs)
    if (&input != &family_->inputs.front()) folder_.write(input.name, input.content);
  const std::string curve = curve_name(*family_);
  if (grown_.contains(curve))
    folder_.add({curve});
  else {
    for (const auto& [index, rows] : ahead_) rows_hash_.add(add_rows(rows_, rows));
    folder_.write(curve, rows_, rows_hash_.digits());
  }
  for (const auto& [name, table] : short_files(*family_, records, fits))
    folder_.write(name, record::csv_text(table));
  for (const std::string& name : grown_)
    if (name != curve) folder_.add({name});
  for (const record::CaseRecord& record : records)
    for (const auto& [name, content] : record.attached) folder_.write(name, content);

  const std::string hash = sha256(echo);
  std::size_t number = 0;
  Extras extras;
  for (const record::CaseRecord& record : records)
    for (const record::PressureMap& map : record.maps)
      extras.add([&] {
        const std::string name = numbered("pressure", ++number, "");
        folder_.write(name + ".exr", exr_bytes(map, {{"palpate:scenarioSha256", hash}}));
        if (family_->base.output.png)
          plot::draw(map_sheet(map, name), folder_, warnings, {.formats = {"png"}});
      });
  write_tissue(*family_, records, folder_, extras);
  write_pictures(*family_, records, folder_, extras);
  if (extras.omitted() > 0)
    warnings.push_back(
        std::to_string(extras.omitted()) +
        " of the pressure maps, meshes and pictures were not written; run the scenario again");

  // A gauge without displacement leaves no rows of the model.
  const bool has_rows = std::ranges::any_of(records, [](const auto& record) {
    return !record.contact.empty() || !record.strain.empty();
  });
  std::vector<plot::Figure> figures;
  const std::string readings = folder_.file("force_time.csv");
  const bool gauge_alone =
      !has_rows && fs::exists(readings) && record::read_csv(readings).rows.size() > 1;
  if (family_->base.output.figures && (has_rows || gauge_alone)) {
    plot::DrawOptions options;
    options.formats = picture_formats(family_->base.output);
    figures =
        has_rows ? family_figures(*family_, records, fits) : std::vector{gauge_figure(*family_)};
    for (const plot::Figure& figure : figures)
      plot::draw(plot::sheet_of(figure), folder_, warnings, options);
  }

  if (family_->base.output.report)
    write_run_page({.family = *family_, .records = records, .fits = fits, .figures = figures},
                   folder_);

  Manifest manifest{
      .origin = origin, .inputs = scenario::hashed(family_->inputs), .outputs = folder_.files()};
  for (const record::CaseRecord& record : records)
    manifest.cases.push_back({record.name, record.reason, record.seconds});
  manifest.complete = records.size() == family_->cases.size() && extras.omitted() == 0;
  folder_.write("run.json", manifest_text(manifest));

  using State = WholeFolder::State;
  return folder_.put(manifest.complete ? State::complete : State::incomplete, warnings);
}

}  // namespace palpate::report
