// Parses the command line, runs the verb, and turns errors into exit codes.
#include "cli/program.h"

#include <exception>

#include "base/error.h"
#include "cli/talk.h"
#include "cli/verbs.h"
#include "report/machine.h"

namespace palpate::cli {

std::string program_identity() {
  const report::Build build = report::this_build();
  return "palpate " + build.version + ", " + build.type + ", " + build.compiler + ", " +
         build.flags;
}

int program(const std::vector<std::string>& given) {
  try {
    const auto parsed = parse(given);
    if (const auto* answer = std::get_if<Answer>(&parsed)) {
      print(answer->text);
      return exit_good;
    }
    if (const auto* wrong = std::get_if<UsageError>(&parsed)) {
      Talk::error("palpate: " + wrong->message);
      return exit_input;
    }
    const auto& arguments = std::get<Arguments>(parsed);
    const Talk talk(arguments.manner);
    return std::visit([&](const auto& command) { return perform(command, arguments, talk); },
                      arguments.verb);
  } catch (const InputError& error) {
    Talk::error(error.what());
    return exit_input;
  } catch (const MeshError& error) {
    Talk::error(std::string("palpate: ") + error.what());
    return exit_mesh;
  } catch (const LinkError& error) {
    Talk::error(error.what());
    return exit_device;
  } catch (const std::exception& error) {
    Talk::error(std::string("palpate: ") + error.what());
    return exit_internal;
  }
}

}  // namespace palpate::cli
