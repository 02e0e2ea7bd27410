// The result of one case: rows over time, maps, findings, and how the case ended.
#pragma once

#include <array>
#include <chrono>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/vec3.h"
#include "base/words.h"
#include "geometry/tet_mesh.h"
#include "record/table.h"

namespace palpate::record {

// Values row by row from the lowest y, x fastest; the pressure of a pixel is the mean over it.
struct PressureMap {
  int width = 0;
  int height = 0;
  double pitch = 0.0;          // m, side of a pixel
  Vec3 origin = Vec3::Zero();  // m, centre of the first pixel
  double time = 0.0;           // s
  std::string scenario_case;   // the case's name
  int step = 0;                // counted from 1
  double contact_force = 0.0;  // N, the exact value of integral(map)
  // width * height values each
  std::vector<float> pressure;  // Pa, compression positive
  // Pa per area of the map, of the finger on the tissue
  std::vector<float> traction_x, traction_y, traction_z;
  std::vector<float> gap;  // m, between finger and tissue; 0 in contact, infinite beside the finger
};

// The integral of the pressure over the map, N.
[[nodiscard]] inline double integral(const PressureMap& map) {
  double sum = 0.0;
  for (const float pressure : map.pressure) sum += static_cast<double>(pressure);
  return sum * map.pitch * map.pitch;
}

// The parts of a scene at rest that a picture shows.
struct ScenePicture {
  static constexpr const char* cavity = "cavity";
  struct Face {
    std::array<Vec3, 3> corners;  // m, counter-clockwise from outside
    int region = 0;               // on the inner side of the face
    int within = -1;              // region on the outer side; -1: the face is part of the surface
    bool held = false;            // by the base
  };
  struct Sphere {
    Vec3 centre = Vec3::Zero();  // m
    double radius = 0.0;         // m
  };
  std::vector<Face> faces;             // of the specimen at rest; empty: no picture
  std::vector<std::string> materials;  // one per region; after them `cavity`, if there is one
  std::string base;                    // what holds the held faces
  std::vector<Sphere> finger;          // at its first touch
  double travel = 0.0;                 // m, the deepest
  std::string load;                    // on the top, between plates: `1 kPa`; empty under a finger
  Vec3 touch = Vec3::Zero();           // m, on the surface, where the first slide begins
  std::vector<Vec3> slides;            // m, displacements, each from the end of the previous one
  Vec3 towards = -Vec3::UnitZ();       // the direction of the press
  // The directions of the scenario's x, y and z in the picture, where z is up.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

// An effect that a model leaves out.
struct Neglected {
  std::string what;  // "viscosity"
  // Of the force (in a uniform test of the strain) by the effect, relative; empty if it is not
  // known.
  std::optional<double> change = {};
  std::string when = {};    // in words: "which would add 36 % to the force while pressing"
  std::string remedy = {};  // an instruction such as "add `key = value`"; empty if there is none
  std::string beside = {};  // what the stated error does not contain; empty if it contains it

  [[nodiscard]] std::string sentence() const;  // "viscosity, which would ...; add ..."
};
// "viscosity and tissue that has not relaxed": what the errors beside these do not contain.
[[nodiscard]] std::string uncounted(std::span<const Neglected> effects);

// The answer of a case in three plain sentences, as `run`, `explain` and reports show it.
// Each member is one or more whole sentences for a reader who knows neither the program nor the
// theory. All are empty before the case has been judged.
struct Answer {
  std::string model;  // which model, and why: "Chosen: layer, ... hertz would be 14 % low: ..."
  std::string error;  // the largest force (or strain) if the case has run, with its stated error
  std::string neglected;  // which effects are neglected, what each would change, and its remedy
  std::vector<Neglected> effects;      // these, the largest first
  std::string verdict;                 // of a live run: whether measured force and model agree
  std::optional<double> stated_error;  // relative, of the force or strain; empty if not estimated
  // What `error` says beside the error; both are empty where none is estimated.
  std::string tolerance;  // "tolerance 5 %, and no model comes nearer"
  std::string uncounted;  // what the error does not contain, "viscosity"; empty if nothing
};

// ", not counting viscosity"; empty if the error contains everything.
[[nodiscard]] inline std::string uncounted_text(const Answer& answer) {
  return answer.uncounted.empty() ? "" : ", not counting " + answer.uncounted;
}

// One row of force_indentation.csv, SI.
struct ContactRow {
  int step = 0;                 // counted from 1
  double time = 0.0;            // s
  double travel = 0.0;          // of the finger below the undeformed surface, m
  double indentation = 0.0;     // h of eq. (2), m
  double force = 0.0;           // on the hand along z, docs/theory.md [hand_force], N
  double contact_force = 0.0;   // F_c along z, N
  double friction = 0.0;        // F_m = mu (F_c + W), the friction limit [friction], N
  double ambient = 0.0;         // F_a, N
  double contact_radius = 0.0;  // m
  double peak_pressure = 0.0;   // Pa
  double tissue_radius = 0.0;   // m, infinite on a flat
  int contacts = 0;
  double slide = 0.0;       // m, sideways
  double tangential = 0.0;  // N, magnitude of the sum of the tangential forces
  double mesh_error = 0.0;  // of the contact force, as a fraction of it; not in the CSV
};

// Values of a live device for a row; NaN where the device gives none.
struct MeasuredRow {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::array<double, 3> place{};                 // m, of the finger from its first touch; z upwards
  double force = none;                           // N, measured by the device; pressing positive
  std::array<double, 3> sent{none, none, none};  // N, commanded to the device
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
  std::vector<Vec3> displacement;        // m, one per node
  std::vector<double> contact_pressure;  // Pa, one per node: its share of the contact forces
                                         // divided by its share of the surface's area
};

// A named number (or word); the name ends with the unit.
struct Finding {
  std::string name;
  Cell value;
};

// `stopped`: ended by a device, because of its link or a safety rule.
enum class Outcome { completed, diverged, interrupted, stopped };

struct CaseRecord {
  std::string name;
  Outcome outcome = Outcome::completed;
  std::string reason;     // a sentence; empty if completed
  bool unstable = false;  // ended because the motion grew by itself: no row of it is a result
  double last_stable_time = 0.0;  // s
  std::vector<ContactRow> contact;
  std::vector<MeasuredRow> measured;  // one per row of `contact` in a live run; otherwise empty
  std::vector<StrainRow> strain;
  std::vector<PressureMap> maps;
  geometry::TetMesh mesh;  // of `frames`; empty if no frames are requested
  std::vector<TissueFrame> frames;
  ScenePicture picture;  // without faces if no picture is requested
  std::vector<Finding> findings;
  std::vector<std::string> warnings;  // sentences on the validity of the result
  Answer answer;                      // of a case that has ended
  std::string chosen;                 // values chosen for `auto`: `key = word`, comma-separated
  double seconds = 0.0;               // run time, for run.json only
  std::vector<std::pair<std::string, std::string>> attached;  // files of a live run: name, content
  // When the first row after the start had been computed; nothing before.
  std::optional<std::chrono::steady_clock::time_point> first_row;

  // Adds a row, and notes that moment. The other rows are those of the same loading history.
  void add(const ContactRow& row) { note(contact.size()), contact.push_back(row); }
  void add(const StrainRow& row) { note(strain.size()), strain.push_back(row); }

 private:
  void note(std::size_t rows) {
    if (rows == 1) first_row = std::chrono::steady_clock::now();
  }
};

// The number of the finding with this name; nothing if there is none.
[[nodiscard]] std::optional<double> number_of(const CaseRecord& record, std::string_view finding);

// What a case was run for: the largest force, or without a finger the largest strain under a
// prescribed stress, or the largest stress under a prescribed strain. Nothing without rows.
struct Peak {
  std::string of = {};  // `force`
  double value = 0.0;
  std::string unit = {};  // ` N`
};
[[nodiscard]] std::optional<Peak> peak_of(const CaseRecord& record);

// The time (s) of its last row; 0 without rows.
[[nodiscard]] double end_time(const CaseRecord& record);

// How far the result of a case goes that ended early: `up to a displacement of 3.6 mm`, or to a
// time where the finger was not pressing deeper; empty if nothing was computed.
[[nodiscard]] std::string reached_text(const CaseRecord& record);

// The tables of the CSV files, with the columns and units of docs/results.md.
[[nodiscard]] Table contact_table(const std::vector<CaseRecord>& records);
[[nodiscard]] Table strain_table(const std::vector<CaseRecord>& records);

[[nodiscard]] constexpr const char* outcome_word(Outcome outcome) {
  return name_of<Outcome::stopped>(outcome);
}

// The columns `case,step,time_s,force_N`: the measured force of every row; null if it has none.
[[nodiscard]] Table measured_force_table(const std::vector<CaseRecord>& records);

}  // namespace palpate::record
