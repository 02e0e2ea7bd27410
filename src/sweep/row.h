// One finished case of a sweep as a row of a journal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/journal.h"
#include "record/record.h"
#include "record/table.h"
#include "scene/scene.h"

namespace palpate::sweep {

enum class SweepOutcome : std::uint8_t { completed, diverged, failed };
[[nodiscard]] constexpr const char* outcome_word(SweepOutcome outcome) {
  return name_of<SweepOutcome::failed>(outcome);
}

// The part of a row that is kept in memory for every case.
struct SweepHead {
  std::uint64_t id = 0;       // of the case
  std::uint32_t attempt = 1;  // the row with the highest attempt counts
  SweepOutcome outcome = SweepOutcome::completed;
  std::uint64_t seal = 0;  // checksum of the line: lines with equal seals are equal
};

struct SweepRow {
  std::uint64_t id = 0;
  std::uint32_t attempt = 1;
  SweepOutcome outcome = SweepOutcome::completed;
  std::string reason = {};                   // a sentence; empty if completed
  std::string name = {};                     // of the case
  std::vector<record::Finding> values = {};  // findings, then the parameters of fits
  std::vector<record::Neglected> neglected = {};
  record::Table curve = {};  // without the column `case`; no columns if curves are not kept
};

// An id as 16 hexadecimal digits, and back; nothing for any other text.
[[nodiscard]] std::string id_text(std::uint64_t id);
[[nodiscard]] std::optional<std::uint64_t> id_of(std::string_view text);

[[nodiscard]] record::Table journal_row(const SweepRow& row);

// Nothing if a column is missing or invalid. head_of() leaves the seal 0: it is not in the table.
[[nodiscard]] std::optional<SweepHead> head_of(const record::Table& row);
[[nodiscard]] std::optional<SweepRow> row_of(const record::Table& row);

// What a sweep keeps of a finished case: findings, parameters of fits if the scenario asks for
// them, and the curve if it is to be kept; without id and attempt.
[[nodiscard]] SweepRow row_of(const scene::Scene& scene, const record::CaseRecord& record,
                              bool keeps_curve);

}  // namespace palpate::sweep
