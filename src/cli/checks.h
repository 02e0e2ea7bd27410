// What the verbs that compare print and write: texts, JSON, JUnit XML and annotations.
#pragma once

#include <span>

#include "cli/arguments.h"
#include "cli/talk.h"
#include "compare/compare.h"

namespace palpate::cli {

// Prints the checks (with `--quiet` only what differs, with `--json` one object per column), and
// writes what `options` asks for. Throws InputError for a form of annotations that is not known,
// SystemError if a file cannot be written.
void report_checks(std::span<const compare::Check> checks, const CheckOptions& options,
                   const Talk& talk);

}  // namespace palpate::cli
