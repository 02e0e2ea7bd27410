// Messages on wrong command lines: a sentence with a remedy.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace palpate::commands {

// The message on the first word that is neither a verb nor an option of `app`, if there is one.
[[nodiscard]] std::optional<std::string> wrong_word(const CLI::App& app,
                                                    const std::vector<std::string>& arguments);

// The message for an error of CLI11.
[[nodiscard]] std::string sentence(const CLI::App& app, const CLI::ParseError& error);

}  // namespace palpate::commands
