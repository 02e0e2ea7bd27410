// The part of a specimen that does not depend on its materials, built once for all its cases.
#pragma once

#include <array>
#include <atomic>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "contact/layer.h"
#include "geometry/smooth_surface.h"
#include "geometry/tet_mesh.h"
#include "meshing/surface_repair.h"
#include "scenario/resolved.h"
#include "scene/refining_press.h"
#include "tissue/stiffness.h"

namespace palpate::scene {

struct SpecimenShape {
  geometry::TetMesh mesh;
  std::vector<int> outer_surface;  // the node of every vertex of `surface`
  geometry::SmoothSurface surface;
  double top_area = 0.0;     // m^2, of the flat upper end; 0 if there is none
  double bottom_area = 0.0;  // m^2
  double base_level = 0.0;   // m, absolute; the surface up to this height is the base
  std::string warning = {};  // of SpecimenMesh
  std::string straightened = {};
  std::optional<Refined> refined = {};
};

[[nodiscard]] SpecimenShape shape_of(geometry::TetMesh mesh, double base_level);

// The scenario's mesh, not refined, with its surface. Unless it comes from a file, no edge of the
// surface crosses the border of the base. Throws what specimen_mesh() throws. `of_file` is the
// surface of the scenario's file, if it names one.
[[nodiscard]] SpecimenShape make_shape(const scenario::Resolved& scenario,
                                       const std::string& folder,
                                       const geometry::SmoothSurface* of_file);

// The keys on which a scenario's SpecimenShape depends, with their values: scenarios with equal
// texts have the same shape, to the bit.
[[nodiscard]] std::string shape_key(const scenario::Resolved& scenario);

// Shapes by their keys. Results do not depend on the order of requests. Thread-safe: while a thread
// builds a shape, others that need the same shape wait.
class SpecimenShapes {
 public:
  // Relative mesh files are looked for in `folder`. Throws what specimen_mesh() throws, at each
  // call. The result lives as long as this object.
  [[nodiscard]] const SpecimenShape& shape(const scenario::Resolved& scenario,
                                           const std::string& folder);

  // The same, made by `make` if it is not there yet.
  using Make = std::function<SpecimenShape()>;
  const SpecimenShape& shape(const scenario::Resolved& scenario, const Make& make);

  // The fit of the springs to that shape.
  [[nodiscard]] const tissue::SpringFit& fit(const scenario::Resolved& scenario,
                                             const std::string& folder);

  // The surface of a file for closed forms, or a sentence on why there is none.
  struct FileSurface {
    std::shared_ptr<const geometry::SmoothSurface> surface;
    std::string warning;         // of meshing::WholeSurface
    std::string part;            // likewise
    std::string fault;           // why there is no surface
    std::exception_ptr refusal;  // the same as it was thrown
    // Throws the refusal, if there is one.
    [[nodiscard]] const std::shared_ptr<const geometry::SmoothSurface>& must() const;
  };
  // The surface of a scenario whose shape is a SurfaceFile, turned as the scenario says; read and
  // mended once.
  [[nodiscard]] const FileSurface& surface(const scenario::Resolved& scenario,
                                           const std::string& folder);

  // The number of the part of that file that is nearest to a place (m) in its coordinates; 0 if it
  // has only one, or cannot be read.
  [[nodiscard]] int near_part(const scenario::Resolved& scenario, const std::string& folder,
                              const Vec3& place);

  // Takes over a surface that another object has read.
  void know_surface(const scenario::Resolved& scenario, const std::string& folder,
                    SpecimenShapes& from);

  // Numbers that follow from a key alone, made by `make` if they are not there yet.
  using Numbers = std::array<double, 6>;
  const Numbers& kept_numbers(const std::string& key, const std::function<Numbers()>& make);

  // How long the shape of this scenario with its fit took to make, and all shapes so far, s.
  [[nodiscard]] double seconds(const scenario::Resolved& scenario);
  [[nodiscard]] double seconds() const { return seconds_; }

  // The number of shapes.
  [[nodiscard]] std::size_t size();

 private:
  struct Entry {
    std::mutex building;
    std::unique_ptr<SpecimenShape> shape;
    std::unique_ptr<tissue::SpringFit> fit;
    double seconds = 0.0;
  };
  template <class Part, class Made>
  void fill(Entry& entry, std::unique_ptr<Part>& part, const Made& made);
  [[nodiscard]] Entry& entry(const scenario::Resolved& scenario);
  struct FileEntry {
    std::mutex reading;
    FileSurface surface;
  };
  [[nodiscard]] FileEntry& file_entry(const scenario::Resolved& scenario,
                                      const std::string& folder);
  // All parts of a file, mended, or why they cannot be read.
  struct AllParts {
    std::mutex reading;
    std::optional<meshing::MendedSurface> mended;
    std::exception_ptr refusal;
  };
  // Throws the refusal, if there is one.
  [[nodiscard]] const meshing::MendedSurface& all_parts(const scenario::Resolved& scenario,
                                                        const std::string& folder);

  std::mutex looking_up_;
  std::map<std::string, Entry> entries_;
  std::atomic<double> seconds_ = 0.0;
  std::map<std::string, AllParts> parts_;      // by path, unit and what is mended
  std::map<std::string, FileEntry> surfaces_;  // by these, part and turn

  std::map<std::string, std::pair<std::mutex, std::optional<Numbers>>> numbers_;
};

// The table of a layer; building it takes as long as a thousand presses.
[[nodiscard]] contact::LayerLaw layer_law(const contact::Layer& layer);

}  // namespace palpate::scene
