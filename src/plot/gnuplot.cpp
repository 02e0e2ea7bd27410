// Runs gnuplot, which may be missing, fail, or not end.
#include "plot/gnuplot.h"

#include <unistd.h>

#include <filesystem>
#include <optional>
#include <system_error>

#include "base/child_process.h"
#include "base/error.h"
#include "base/files.h"
#include "base/stop_scope.h"
#include "base/text.h"

namespace palpate::plot {
namespace {

namespace fs = std::filesystem;

constexpr const char* was_not_drawn = " was not drawn in ";

// Why no picture was drawn, as the middle of a sentence; empty on success.
std::string failure(const ChildResult& result, const DrawOptions& options) {
  const std::string program = "`" + options.program + "` ";
  switch (result.end) {
    case ChildResult::End::not_found: return program + "is not installed";
    case ChildResult::End::timed_out:
      return program + "took longer than " + rounded_text(options.limit) + " s";
    case ChildResult::End::killed:
      return program + "was ended by signal " + std::to_string(result.code);
    case ChildResult::End::stopped: return "the drawing was interrupted";
    case ChildResult::End::exited: break;
  }
  if (result.code == 0) return {};
  return program + "failed (" + trimmed(result.output) + ")";
}

std::string remedy(const ChildResult& result, const std::string& script) {
  if (result.end == ChildResult::End::not_found)
    return "; install gnuplot (Debian: gnuplot-nox) and run `gnuplot " + script + "` there";
  return "; run `gnuplot " + script + "` there to see why";
}

// The first file that the script reads and that is missing; gnuplot would leave out its curves.
std::optional<std::string> missing_file(const Sheet& sheet, const fs::path& folder) {
  for (const std::string& file : sheet.reads)
    if (!fs::exists(folder / file)) return file;
  return std::nullopt;
}

struct Picture {
  bool drawn = false;
  std::string warning = {};
};

// Draws one picture into a temporary file and renames it.
Picture draw_picture(const Sheet& sheet, const std::string& format, const std::string& folder,
                     const DrawOptions& options) {
  const std::string script = sheet.name + ".gp";
  const std::string picture = sheet.name + "." + format;
  const std::string beside = picture + ".part" + std::to_string(::getpid());
  const std::string not_drawn = picture + was_not_drawn + folder + ": ";
  if (const auto file = missing_file(sheet, folder))
    return {false, not_drawn + "`" + *file + "` is missing; run the scenario again"};
  if (StopScope::stopped()) return {false, not_drawn + "the drawing was interrupted"};
  // -d: without the user's gnuplot settings.
  const ChildResult result =
      run_process({.argv = {options.program, "-d", "-e",
                            "format='" + format + "'; target='" + beside + "'", script},
                   .folder = folder,
                   .limit = options.limit});
  const fs::path from = fs::path(folder) / beside;
  const std::string why = failure(result, options);
  std::error_code error;
  if (why.empty()) fs::rename(from, fs::path(folder) / picture, error);
  if (error) throw SystemError(not_drawn + "it cannot be renamed (" + error.message() + ")");
  if (!why.empty()) {
    fs::remove(from, error);
    return {false, not_drawn + why + remedy(result, script)};
  }
  const std::string said = trimmed(result.output);
  if (said.empty()) return {true, {}};
  return {true, picture + " in " + folder + " may not be complete; gnuplot said: " + said};
}

}  // namespace

Sheet sheet_of(const Figure& figure) {
  Sheet sheet{figure.name, gnuplot_script(figure), {}};
  for (const Series& series : figure.series) sheet.reads.push_back(series.csv_file);
  return sheet;
}

Drawing draw(const Sheet& sheet, const std::string& folder, const DrawOptions& options) {
  Drawing drawing;
  const std::string script = sheet.name + ".gp";
  write_atomically((fs::path(folder) / script).string(), sheet.script, Disk::later);
  drawing.files.push_back(script);
  for (const std::string& format : options.formats) {
    const Picture picture = draw_picture(sheet, format, folder, options);
    if (picture.drawn) drawing.files.push_back(sheet.name + "." + format);
    if (!drawing.warning.empty() && !picture.warning.empty()) drawing.warning += "\n";
    drawing.warning += picture.warning;
  }
  return drawing;
}

std::string missing_figures(const std::vector<std::string>& warnings) {
  std::size_t count = 0;
  for (const std::string& warning : warnings)
    for (auto at = warning.find(was_not_drawn); at != std::string::npos;
         at = warning.find(was_not_drawn, at + 1))
      ++count;
  if (count == 0) return {};
  return "; " + std::to_string(count) +
         (count == 1 ? " figure was not drawn" : " figures were not drawn");
}

void draw(const Sheet& sheet, WholeFolder& folder, std::vector<std::string>& warnings,
          const DrawOptions& options) {
  const Drawing drawing = draw(sheet, folder.partial(), options);
  folder.add(drawing.files);
  if (!drawing.warning.empty()) warnings.push_back(drawing.warning);
}

}  // namespace palpate::plot
