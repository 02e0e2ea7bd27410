// What a shell offers at the tab key.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/key_tree.h"
#include "commands/command.h"

namespace palpate::commands {

// What may stand for the last of `words`, the words behind the program's name. Each line is a word
// and, behind a tab, its meaning. The lines `:files` and `:folders` ask the shell for its own
// names. `keys` are those of KEY=VALUE, `examples` the names that a SCENARIO may have besides
// files.
[[nodiscard]] std::string complete(const Command& program, const std::vector<std::string>& words,
                                   std::span<const FlatKey> keys,
                                   std::span<const std::string> examples);

// The script that makes a shell (bash, zsh, fish) ask the program for completions.
[[nodiscard]] std::string completion_script(std::string_view shell);

}  // namespace palpate::commands
