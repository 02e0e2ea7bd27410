// `palpate open`: shows the page of a result, or a page of all results below a folder, in the
// desktop's browser, or says where it is.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/child_process.h"
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/written.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "page/page.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

// The reports below a folder, relative to it, by name. Partial folders of running or killed
// processes have a dot in their names and are excluded.
std::vector<std::string> reports_below(const fs::path& folder) {
  std::vector<std::string> found;
  std::error_code error;
  for (fs::recursive_directory_iterator
           at(folder, fs::directory_options::skip_permission_denied, error),
       end;
       !error && at != end; at.increment(error)) {
    if (at->is_directory(error) &&
        at->path().filename().string().find(".partial") != std::string::npos)
      at.disable_recursion_pending();
    else if (at->path().filename() == page::file_name)
      found.push_back(fs::relative(at->path(), folder).generic_string());
  }
  std::ranges::sort(found);
  return found;
}

// A relative link to a path: no letter of it is read as a scheme, a query or a fragment.
std::string link_of(const std::string& path) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string link = "./";
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                       std::string_view("/._-~").find(c) != std::string_view::npos;
    if (plain)
      link += c;
    else
      link += {'%', digits[byte >> 4], digits[byte & 15]};
  }
  return link;
}

// The first figure of a report; nothing where it has none, or one that is large for a page of many.
page::Markup picture(const fs::path& file, const std::string& report, const std::string& words) {
  constexpr std::uintmax_t most = 400000;  // bytes
  std::error_code error;
  if (file.extension() != ".svg" || fs::file_size(file, error) > most || error) return {};
  std::string prefix;
  for (const char c : report + file.stem().string())
    prefix += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return page::element(
      "figure", page::element("div", page::inline_svg(read_text(file.string()), prefix, words),
                              {{"class", page::class_of(file.string())}}));
}

// ` It took 1.2 s.` from run.json beside a report; nothing where it has no times.
std::string took(const fs::path& report) {
  const fs::path file = report.parent_path() / "run.json";
  if (!fs::exists(file)) return {};
  const auto json = nlohmann::json::parse(read_text(file.string()), nullptr, false);
  double seconds = 0.0;
  if (json.is_object() && json.contains("finished") && json["finished"].is_array())
    for (const auto& one : json["finished"])
      if (one.contains("timings_s"))
        for (const auto& [stage, time] : one["timings_s"].items())
          if (time.is_number()) seconds += time.get<double>();
  return seconds >= 0.01 ? " It took " + rounded_text(seconds, 2) + " s." : "";
}

// Writes index.html of the reports below a folder and returns its path.
std::string index_of(const fs::path& folder, const std::vector<std::string>& reports,
                     const Talk& talk) {
  page::Page page("Results", "index");
  std::array<std::size_t, 3> verdicts{};  // agrees, differs, not said
  page::Markup items;
  std::set<std::string> headings;
  for (const std::string& report : reports) {
    const page::Summary summary = page::summary_of(read_text((folder / report).string()));
    const std::string title = summary.title.empty() ? report : summary.title;
    page::Markup shown;
    for (const std::string& name : summary.pictures)
      if (shown.empty() || !summary.paper.empty())
        shown += picture((folder / report).parent_path() / name, report, title);
    std::string heading = title.substr(0, title.find(" – palpate"));
    // `Sweep: `; a run needs no such word.
    std::string kind =
        title.substr(std::min(heading.size() + std::string(" – palpate ").size(), title.size()));
    kind = kind.empty() || kind == "run" ? "" : capitalized(kind) + ": ";
    if (!headings.insert(heading).second)  // of results with the same title, each with its folder
      heading += " (" + fs::path(report).parent_path().generic_string() + ")";
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      const std::string cell = "\"verdict\">" + std::string(page::verdicts[i]) + "<";
      for (std::size_t at = summary.paper.find(cell); at != std::string::npos;
           at = summary.paper.find(cell, at + 1))
        ++verdicts[i];
    }
    if (!summary.paper.empty())  // a result beside the paper's text is shown whole
      page.section(
          heading,
          page::element("div",
                        shown + page::Markup::ready(summary.paper) +
                            page::element("p", page::link(link_of(report), "All of this result")),
                        {{"class", "whole"}}));
    else
      items += page::element("section",
                             shown + page::element("h3", page::link(link_of(report), heading)) +
                                 page::element("p", kind + summary.answer +
                                                        (summary.answer.ends_with('.') ? "" : ".") +
                                                        took(folder / report)));
  }
  if (const std::size_t all = verdicts[0] + verdicts[1] + verdicts[2]; all > 0)
    page.headline(std::to_string(verdicts[0]) + " of " + std::to_string(all),
                  "statements of the paper agree with these runs, " + std::to_string(verdicts[1]) +
                      " differ, and " + std::to_string(verdicts[2]) + " the text does not settle");
  const std::string count = count_text(reports.size(), "report");
  page.answer({count + "."});
  if (!items.empty()) page.section("Reports", page::element("div", items, {{"class", "cards"}}));
  std::string index = (folder / "index.html").string();
  write_atomically(index, page.html());
  talk.say(index + ": " + count);
  return index;
}

// The report of a result, an index of those below, or the first figure.
std::string page_of(const std::string& folder, const Talk& talk) {
  if (!fs::is_directory(folder))
    throw InputError({folder, 0, 0}, "is no folder; give the one of a result, as `out/quickstart`");
  if (const fs::path own = fs::path(folder) / page::file_name; fs::exists(own)) return own.string();
  if (const auto reports = reports_below(folder); !reports.empty())
    return index_of(folder, reports, talk);
  for (const std::string& file : entries_of(folder))
    if (fs::path(file).extension() == ".svg") return file;
  throw InputError({folder, 0, 0}, "holds neither `" + std::string(page::file_name) +
                                       "` nor a figure; give a folder of results, as `out`");
}

bool has_display() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

}  // namespace

int perform(const Open& command, const Arguments&, const Talk& talk) {
  const std::string page = fs::absolute(page_of(command.result, talk)).string();
  const bool shown = has_display() && [&] {
    return run_process({.argv = {"xdg-open", page}}).good();
  }();
  if (talk.json())
    talk.event("page", {{"path", page}, {"shown", shown}});
  else if (shown)
    talk.say(page + " is shown");
  else
    print(page + "\n");
  return exit_good;
}

}  // namespace palpate::cli
