// What is wrong with a command line, in a sentence with a remedy.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace palpate::cli {

// The first word that no verb or option of `app` is; nothing where all are.
[[nodiscard]] std::optional<std::string> wrong_word(const CLI::App& app,
                                                    const std::vector<std::string>& arguments);

// CLI11's complaint; `what` of it names an option or positional without quotes.
[[nodiscard]] std::string sentence(const CLI::App& app, const CLI::ParseError& error);

}  // namespace palpate::cli
