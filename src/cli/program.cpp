// Verbs by their arguments, errors by their exit codes.
#include "cli/program.h"

#include <exception>

#include "base/error.h"
#include "cli/talk.h"
#include "cli/verbs.h"
#include "scenario/family.h"

namespace palpate::cli {
namespace {

int dispatch(const Arguments& arguments) {
  const Talk talk(arguments.manner);
  if (const auto* one = std::get_if<Run>(&arguments.verb)) return run(*one, arguments, talk);
  if (const auto* one = std::get_if<Explain>(&arguments.verb)) return explain(*one);
  if (const auto* one = std::get_if<Fit>(&arguments.verb)) return fit_columns(*one);
  if (const auto* one = std::get_if<Compare>(&arguments.verb)) return compare(*one);
  if (const auto* one = std::get_if<Bless>(&arguments.verb)) return bless(*one, talk);
  if (const auto* one = std::get_if<Mesh>(&arguments.verb)) return mesh(*one, talk);
  if (const auto* one = std::get_if<Reference>(&arguments.verb)) return refer(*one, talk);
  if (const auto* one = std::get_if<Bench>(&arguments.verb)) return bench(*one, talk);
  if (const auto* one = std::get_if<Chart>(&arguments.verb)) return chart(*one, arguments, talk);
  if (const auto* one = std::get_if<Stability>(&arguments.verb))
    return stability(*one, arguments, talk);
  if (const auto* one = std::get_if<Sweep>(&arguments.verb)) return sweep(*one, arguments, talk);
  if (const auto* one = std::get_if<Identify>(&arguments.verb))
    return identify(*one, arguments, talk);
  if (const auto* one = std::get_if<Export>(&arguments.verb)) return export_results(*one, talk);
  if (const auto* one = std::get_if<Device>(&arguments.verb)) return device(*one, talk);
  print(scenario::manual());
  return exit_good;
}

}  // namespace

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
    return dispatch(std::get<Arguments>(parsed));
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
