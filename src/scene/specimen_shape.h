// What of a specimen its substances do not change, built once for all cases that share it.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "contact/layer.h"
#include "contact/layer_sinking.h"
#include "geometry/smooth_surface.h"
#include "geometry/tet_mesh.h"
#include "scenario/scenario.h"
#include "tissue/stiffness.h"

namespace palpate::scene {

struct SpecimenShape {
  geometry::TetMesh mesh;
  std::vector<int> skin;  // the node of every vertex of `surface`
  geometry::SmoothSurface surface;
  double top_area = 0.0;     // m^2, of the flat upper end; 0 where there is none
  double bottom_area = 0.0;  // m^2
};

// The keys of a scenario that its SpecimenShape may depend on, with their values: equal texts mean
// the same shape, to the bit. Keys of the substances, the contact, the solver and the loads are
// left out; all others, new ones too, count.
[[nodiscard]] std::string shape_key(const scenario::Scenario& scenario);

// Shapes by their keys. What it gives does not depend on who asked first; safe for several threads,
// of which one builds while the others that want the same wait.
class SpecimenShapes {
 public:
  // Relative mesh files are looked for in `folder`. Throws what specimen_mesh() throws, each time
  // that it is asked. What is returned lives as long as this.
  [[nodiscard]] const SpecimenShape& shape(const scenario::Scenario& scenario,
                                           const std::string& folder);

  // The springs' fit to that shape.
  [[nodiscard]] const tissue::SpringFit& fit(const scenario::Scenario& scenario,
                                             const std::string& folder);

  // How many shapes it holds.
  [[nodiscard]] std::size_t size();

  // Tables of a layer, which take as long to build as a thousand presses on it.
  [[nodiscard]] contact::LayerLaw layer_law(const contact::Layer& layer);
  [[nodiscard]] contact::LayerSinking layer_sinking(const contact::Layer& layer);

 private:
  struct Entry {
    std::mutex building;
    std::unique_ptr<SpecimenShape> shape;
    std::unique_ptr<tissue::SpringFit> fit;
  };
  [[nodiscard]] Entry& entry(const scenario::Scenario& scenario);

  std::mutex looking_up_;
  std::map<std::string, Entry> entries_;

  std::mutex looking_up_layer_;
  std::map<std::vector<double>, contact::LayerLaw> laws_;  // by every number of the layer
  std::map<std::vector<double>, contact::LayerSinking> sinkings_;
};

}  // namespace palpate::scene
