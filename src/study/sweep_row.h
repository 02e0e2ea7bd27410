// One finished case of a sweep as one line of text, sealed by a checksum.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/record.h"
#include "record/table.h"

namespace palpate::study {

enum class SweepOutcome : std::uint8_t { completed, diverged, failed };
[[nodiscard]] const char* outcome_word(SweepOutcome outcome);

// What is known of a row before it is read whole.
struct SweepHead {
  std::uint64_t id = 0;       // of the case
  std::uint32_t attempt = 1;  // a greater one replaces a smaller one
  SweepOutcome outcome = SweepOutcome::completed;
  std::uint64_t seal = 0;  // of all of the line: equal seals, equal lines
};

struct SweepRow {
  std::uint64_t id = 0;
  std::uint32_t attempt = 1;
  SweepOutcome outcome = SweepOutcome::completed;
  std::string reason = {};                   // a sentence, unless completed
  std::string name = {};                     // of the case
  std::vector<record::Finding> values = {};  // findings, then the parameters of fits
  std::vector<std::string> remarks = {};
  record::Table curve = {};  // without the column `case`; without columns where it is not kept
};

// 16 hexadecimal digits, as ids are written, and back; nothing where it is no such text.
[[nodiscard]] std::string id_text(std::uint64_t id);
[[nodiscard]] std::optional<std::uint64_t> id_of(std::string_view text);

// The row as a line with its line feed. `plan`, the plan's hash, goes into the seal, so that a row
// of another plan does not pass for one of this.
[[nodiscard]] std::string row_line(const SweepRow& row, std::string_view plan);

// A line without its line feed; nothing where the seal does not fit it.
[[nodiscard]] std::optional<SweepHead> read_head(std::string_view line, std::string_view plan);
[[nodiscard]] std::optional<SweepRow> read_row(std::string_view line, std::string_view plan);

}  // namespace palpate::study
