// `palpate manual`, `schema`, `completion` and `new`: texts made from the tables of keys and
// options.
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "commands/command.h"
#include "report/manifest.h"
#include "scenario/family.h"
#include "scenario/schema.h"

namespace palpate::cli {
namespace {

// What stands behind the verbs on the page of the program.
constexpr const char* further = R"(## Exit codes

| code | meaning |
| --- | --- |
| 0 | good |
| 1 | an internal error |
| 2 | bad input |
| 3 | a comparison differs |
| 4 | a case diverged |
| 5 | an unsuitable mesh |
| 6 | a device's link, or a stop for safety |
| 7 | a sweep with missing, diverged or failed cases |
| 8 | another process runs the part of a sweep |
| 75 | interrupted; the same call continues |
| 130 | interrupted |

## Files and environment

| name | meaning |
| --- | --- |
| share/palpate/scenarios | Examples beside the program's folder: `palpate run quickstart` runs one by its name. |
| - | As the name of a scenario or of a measured curve: the standard input. |
| NO_COLOR | If it is set, messages have no colours; without a terminal they never have. |
)";

}  // namespace

int perform(const Manual& command, const Arguments&, const Talk&) {
  const std::string version = "palpate " + report::this_build().version;
  if (command.page == "commands") {
    const commands::Command program = described();
    print(command.man ? commands::man_page(
                            {"palpate", 1, "mechanical tests on virtual soft tissue", version},
                            program, further)
                      : commands::markdown_page(program, further));
  } else {
    print(command.man ? commands::man_page({"palpate-scenario", 5, "keys of a scenario", version},
                                           scenario::manual())
                      : scenario::manual());
  }
  return exit_good;
}

int perform(const Schema&, const Arguments&, const Talk&) {
  print(scenario::schema());
  return exit_good;
}

int perform(const Completion& command, const Arguments&, const Talk&) {
  print(std::string(commands::completion_script(command.shell)));
  return exit_good;
}

int perform(const New& command, const Arguments&, const Talk& talk) {
  for (const scenario::Starter& starter : scenario::starters()) {
    if (command.kind != starter.word.word) continue;
    if (command.file == "-") {
      print(std::string(starter.text));
      break;
    }
    const std::string file = command.file.empty() ? command.kind + ".toml" : command.file;
    if (!command.force && std::filesystem::exists(file))
      throw InputError({file, 0, 0}, "exists; give another name, or `--force` to replace it");
    make_folders(std::filesystem::path(file).parent_path().string());
    write_atomically(file, starter.text);
    talk.event("wrote", {{"file", file}});
    talk.say(file + ": " + starter.word.meaning + "; `palpate run " + file + "` runs it");
    talk.next("explain", file);
  }
  return exit_good;
}

}  // namespace palpate::cli
