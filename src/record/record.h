// What a case leaves behind: rows over time, maps, findings, and how it ended.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "geometry/tet_mesh.h"
#include "record/pressure_map.h"
#include "record/scene_picture.h"
#include "record/table.h"

namespace palpate::record {

// One row of force_indentation.csv, SI.
struct ContactRow {
  int step = 0;  // counted from 1
  double time = 0.0;
  double travel = 0.0;          // of the finger below the undeformed surface, m
  double indentation = 0.0;     // h of eq. (2), m
  double force = 0.0;           // F_c + F_a, normal, N
  double contact_force = 0.0;   // F_c, N
  double friction = 0.0;        // F_m = mu (F_c + W): what the contact can carry, N
  double ambient = 0.0;         // F_a, N
  double contact_radius = 0.0;  // m
  double peak_pressure = 0.0;   // Pa
  double tissue_radius = 0.0;   // m, infinite on a flat
  int contacts = 0;
  double slide = 0.0;       // m, sideways
  double tangential = 0.0;  // N, size of the tangential forces together
};

// What a live device adds to a row; NaN where it tells none.
struct MeasuredRow {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::array<double, 3> place{};                 // m, of the finger from its first touch; z upwards
  double force = none;                           // N, that the device measured; pressing positive
  std::array<double, 3> sent{none, none, none};  // N, that the device was told to show
};

// One row of strain_time.csv, SI; compression positive.
struct StrainRow {
  int step = 0;
  double time = 0.0;
  double stress = 0.0;  // Pa
  double strain = 0.0;
};

// The deformed specimen at one moment.
struct TissueFrame {
  int step = 0;
  double time = 0.0;                     // s
  std::vector<Vec3> displacement;        // m, one a node
  std::vector<double> contact_pressure;  // Pa, one a node: its part of the contact forces over its
                                         // part of the skin
};

// A named number (or word); the unit is the name's last part.
struct Finding {
  std::string name;
  Cell value;
};

// `stopped`: a device ended it, by its link or for safety.
enum class Outcome { completed, diverged, interrupted, stopped };

struct CaseRecord {
  std::string name;
  Outcome outcome = Outcome::completed;
  std::string reason;             // a sentence, unless completed
  double last_stable_time = 0.0;  // s
  std::vector<ContactRow> contact;
  std::vector<MeasuredRow> measured;  // one a row of `contact` in a live run; else empty
  std::vector<StrainRow> strain;
  std::vector<PressureMap> maps;
  geometry::TetMesh mesh;  // of `frames`; empty where none are asked for
  std::vector<TissueFrame> frames;
  ScenePicture picture;  // without faces where none is asked for
  std::vector<Finding> findings;
  std::vector<std::string> remarks;  // on validity, in sentences
  std::string chosen;                // what stands for every `auto`, as `key = word`, by commas
  double seconds = 0.0;              // that the case took: for run.json only
  std::vector<std::pair<std::string, std::string>> attached;  // files of a live run: name, content
};

// The CSV files' tables, in the order and units of docs/results.md.
[[nodiscard]] Table contact_table(const std::vector<CaseRecord>& records);
[[nodiscard]] Table strain_table(const std::vector<CaseRecord>& records);

[[nodiscard]] const char* outcome_word(Outcome outcome);

}  // namespace palpate::record
