// Finds a scenario that is given by the name of an installed example.
#pragma once

#include <string>
#include <vector>

namespace palpate::scenario {

// The path itself if it is `-`, has a folder or an ending, or is a file that exists. A bare name
// such as `quickstart` is an installed example where share/palpate/scenarios beside the program's
// folder has one, or the checkout in which the program was built; otherwise it stays as it is.
[[nodiscard]] std::string find(const std::string& given);

// The names of the installed examples, in alphabetical order.
[[nodiscard]] std::vector<std::string> examples();

}  // namespace palpate::scenario
