// The contact models of `palpate fit`: options to a ContactTest.
#pragma once

#include "cli/arguments.h"
#include "fit/adhesive.h"
#include "fit/contact_model.h"

namespace palpate::cli {

// A length above 0 from an option's text, m. Throws InputError.
[[nodiscard]] double length_of(const std::string& option, const std::string& text);

[[nodiscard]] fit::AdhesiveTest adhesive_test(const Fit& command);

// The test that the options describe. Throws InputError for unknown words, for a tip without its
// size, and for options that contradict each other.
[[nodiscard]] fit::ContactTest contact_test(const Fit& command);

}  // namespace palpate::cli
