// The options of each verb, added to its parser. They are written into the verb's struct.
#pragma once

#include "cli/arguments.h"

namespace CLI {
class App;
}  // namespace CLI

namespace palpate::cli {

void add_options(CLI::App& verb, Run& command);
void add_options(CLI::App& verb, Explain& command);
void add_options(CLI::App& verb, Fit& command);
void add_options(CLI::App& verb, Data& command);
void add_options(CLI::App& verb, Compare& command);
void add_options(CLI::App& verb, Golden& command);
void add_options(CLI::App& verb, Reference& command);
void add_options(CLI::App& verb, Chart& command);
void add_options(CLI::App& verb, Stability& command);
void add_options(CLI::App& verb, Sweep& command);
void add_options(CLI::App& verb, Identify& command);
void add_options(CLI::App& verb, Convert& convert);
void add_options(CLI::App& verb, Device& command);
void add_options(CLI::App& verb, New& command);
void add_options(CLI::App& verb, Open& command);
void add_options(CLI::App& verb, Manual& command);
void add_options(CLI::App& verb, Schema& command);
void add_options(CLI::App& verb, Completion& command);

}  // namespace palpate::cli
