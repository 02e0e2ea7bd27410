// Running gnuplot, which may be missing, fail, or never end.
#include "report/gnuplot.h"

#include <unistd.h>

#include <filesystem>
#include <optional>
#include <system_error>

#include "base/files.h"
#include "base/text.h"
#include "report/process.h"

namespace palpate::report {
namespace {

namespace fs = std::filesystem;

// Why no picture came of it, as the middle of a sentence; empty where all is well.
std::string failure(const ProcessResult& result, const DrawOptions& options) {
  const std::string program = "`" + options.program + "` ";
  switch (result.end) {
    case ProcessResult::End::not_found: return program + "is not installed";
    case ProcessResult::End::timed_out:
      return program + "took longer than " + rounded_text(options.limit) + " s";
    case ProcessResult::End::killed:
      return program + "was ended by signal " + std::to_string(result.code);
    case ProcessResult::End::exited: break;
  }
  if (result.code == 0) return {};
  return program + "failed (" + trimmed(result.output) + ")";
}

std::string remedy(const ProcessResult& result, const std::string& script) {
  if (result.end == ProcessResult::End::not_found)
    return "; install gnuplot (Debian: gnuplot-nox) and run `gnuplot " + script + "` there";
  return "; run `gnuplot " + script + "` there to see why";
}

// A file that the figure reads and that is not there: gnuplot would leave its curves out.
std::optional<std::string> missing_file(const Sheet& sheet, const fs::path& folder) {
  for (const std::string& file : sheet.reads)
    if (!fs::exists(folder / file)) return file;
  return std::nullopt;
}

struct Picture {
  bool drawn = false;
  std::string warning = {};
};

// One picture, drawn beside and renamed.
Picture draw_picture(const Sheet& sheet, const std::string& format, const std::string& folder,
                     const DrawOptions& options) {
  const std::string script = sheet.name + ".gp";
  const std::string picture = sheet.name + "." + format;
  const std::string beside = picture + ".part" + std::to_string(::getpid());
  const std::string not_drawn = picture + " was not drawn in " + folder + ": ";
  if (const auto file = missing_file(sheet, folder))
    return {false, not_drawn + "`" + *file + "` is not there; run the scenario again"};
  // -d: the user's own gnuplot settings stay out.
  const ProcessResult result =
      run_process({.argv = {options.program, "-d", "-e",
                            "format='" + format + "'; target='" + beside + "'", script},
                   .folder = folder,
                   .limit = options.limit});
  const fs::path from = fs::path(folder) / beside;
  std::string why = failure(result, options);
  std::error_code error;
  if (why.empty()) fs::rename(from, fs::path(folder) / picture, error);
  if (error) why = "it cannot be renamed (" + error.message() + ")";
  if (!why.empty()) {
    fs::remove(from, error);
    return {false, not_drawn + why + remedy(result, script)};
  }
  const std::string said = trimmed(result.output);
  if (said.empty()) return {true, {}};
  return {true, picture + " in " + folder + " may not be complete; gnuplot said: " + said};
}

}  // namespace

Drawing draw(const Figure& figure, const std::string& folder, const DrawOptions& options) {
  Sheet sheet{figure.name, gnuplot_script(figure), {}};
  for (const Series& series : figure.series) sheet.reads.push_back(series.csv_file);
  return draw(sheet, folder, options);
}

Drawing draw(const Sheet& sheet, const std::string& folder, const DrawOptions& options) {
  Drawing drawing;
  const std::string script = sheet.name + ".gp";
  write_atomically((fs::path(folder) / script).string(), sheet.script);
  drawing.files.push_back(script);
  std::vector<std::string> formats{"svg"};
  if (options.format == PictureFormat::svg_and_pdf) formats.push_back("pdf");
  for (const std::string& format : formats) {
    const Picture picture = draw_picture(sheet, format, folder, options);
    if (picture.drawn) drawing.files.push_back(sheet.name + "." + format);
    if (!drawing.warning.empty() && !picture.warning.empty()) drawing.warning += "\n";
    drawing.warning += picture.warning;
  }
  return drawing;
}

}  // namespace palpate::report
