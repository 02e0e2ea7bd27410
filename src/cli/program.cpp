// Parses the command line, runs the verb, and turns errors into exit codes.
#include "cli/program.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string_view>

#include "base/error.h"
#include "base/stop_scope.h"
#include "cli/interrupt.h"
#include "cli/talk.h"
#include "cli/verbs.h"
#include "report/manifest.h"

namespace palpate::cli {

std::string program_identity() {
  const report::Build build = report::this_build();
  return "palpate " + build.version + ", " + build.type + ", " + build.compiler + ", " +
         build.flags;
}

namespace {

// A stream that is closed at the start would give its number to the next file that is opened, which
// would then receive the messages: letters that move a stand. Writing to the streams still fails.
void occupy_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) (void)::open("/dev/null", O_RDONLY);
}

// Where an allocation fails in a destructor or while a matrix is resized, libraries (nlohmann's
// JSON, Ceres, Eigen) end the program: a sentence and a documented exit code then, too.
void say_why_at_abort() {
  std::set_terminate(std::abort);  // without a text of its own
  std::signal(SIGABRT, [](int) {
    constexpr std::string_view text =
        "palpate: a library ended the program, as they do where the memory does not suffice; use a "
        "coarser mesh, fewer rows or less `--jobs`, and report it if there was memory left\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
    ::_exit(exit_internal);
  });
}

}  // namespace

int program(const std::vector<std::string>& given) {
  occupy_standard_streams();
  // A limit of file size must give an error message, like a full disk, and not end the program.
  std::signal(SIGXFSZ, SIG_IGN);
  say_why_at_abort();
  ::unsetenv("GNUTERM");                // scripts of figures set the terminal themselves
  end_at_interrupts(exit_interrupted);  // until a verb that has something to keep listens to them
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
  } catch (const KeyError& error) {
    Talk::error(std::string("palpate: ") + error.what());
    return exit_input;
  } catch (const MeshError& error) {
    Talk::error(std::string("palpate: ") + error.what());
    return exit_mesh;
  } catch (const LinkError& error) {
    Talk::error(error.what());
    return exit_device;
  } catch (const Stopped& stopped) {
    Talk::error(std::string("palpate: ") + stopped.what() + "; nothing was written");
    return exit_interrupted;
  } catch (const std::bad_alloc&) {
    Talk::error(
        "palpate: the memory does not suffice; use a coarser mesh, fewer rows or less `--jobs`");
    return exit_internal;
  } catch (const std::filesystem::filesystem_error& error) {
    // std::filesystem::exists() throws at names that no file can have.
    const std::string path = error.path1().string();
    Talk::error("palpate: `" + path.substr(0, 60) + (path.size() > 60 ? "...`: " : "`: ") +
                error.code().message() + "; check the path");
    return error.code() == std::errc::filename_too_long ? exit_input : exit_internal;
  } catch (const std::exception& error) {
    Talk::error(std::string("palpate: ") + error.what());
    return exit_internal;
  }
}

}  // namespace palpate::cli
