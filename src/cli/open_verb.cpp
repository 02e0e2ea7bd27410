// `palpate open`: shows a result in the desktop's browser, or says where its page is.
#include <cstdlib>
#include <filesystem>

#include "base/child_process.h"
#include "base/error.h"
#include "base/files.h"
#include "cli/program.h"
#include "cli/verbs.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

// report.html, or the first figure. Throws InputError if there is neither.
std::string page_of(const std::string& result) {
  const fs::path report = fs::path(result) / "report.html";
  if (fs::exists(report)) return report.string();
  for (const std::string& file : entries_of(result))
    if (fs::path(file).extension() == ".svg") return file;
  throw InputError({result, 0, 0},
                   "has neither `report.html` nor a figure; give the folder of a result, as "
                   "`out/quickstart`");
}

bool has_display() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

}  // namespace

int perform(const Open& command, const Arguments&, const Talk& talk) {
  const std::string page = fs::absolute(page_of(command.result)).string();
  const bool shown = has_display() && [&] {
    return run_process({.argv = {"xdg-open", page}}).good();
  }();
  if (shown)
    talk.say(page + " is shown");
  else
    print(page + "\n");
  return exit_good;
}

}  // namespace palpate::cli
