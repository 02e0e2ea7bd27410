// Loads of the half-space's field on the body, and the solution for the rest.
#include "mechanics/energy_coupling.h"

#include <algorithm>
#include <map>
#include <numbers>

#include "base/error.h"
#include "mechanics/energy_loads.h"
#include "scenario/rungs.h"
#include "tissue/coupled.h"

namespace palpate::mechanics {

using integrate::Vector;

namespace {

// Of solutions, in the energy norm. The sinking is an energy: its error is the square.
constexpr double tolerance = 3e-4;

}  // namespace

EnergyCoupling::EnergyCoupling(const scene::Scene& scene, const tissue::Part& part,
                               std::span<const char> held, double unit)
    : skin_(&*scene.specimen->surface),
      held_(held.begin(), held.end()),
      pairs_(part.network.ends),
      solver_(tolerance),
      volume_(scenario::rung(scene.scenario.solver.model).coupled() ? scene.scenario.solver.volume
                                                                    : tissue::Volume::nodal) {
  const scene::Specimen& specimen = *scene.specimen;
  std::vector<int> number(specimen.mesh.nodes.size(), -1);
  for (std::size_t n = 0; n < part.nodes.size(); ++n)
    number[as_index(part.nodes[n])] = static_cast<int>(n);
  mesh_.nodes = part.network.rest;
  for (std::size_t t = 0; t < specimen.mesh.tetrahedra.size(); ++t) {
    std::array<int, 4> corners{};
    for (std::size_t k = 0; k < 4; ++k)
      corners[k] = number[as_index(specimen.mesh.tetrahedra[t][k])];
    if (*std::min_element(corners.begin(), corners.end()) < 0) continue;
    mesh_.tetrahedra.push_back(corners);
    mesh_.regions.push_back(specimen.mesh.region(static_cast<int>(t)));
  }
  uses_ = geometry::face_uses(mesh_);
  for (const auto& triangle : specimen.surface->surface().triangles) {
    std::array<int, 3> nodes{};
    for (std::size_t k = 0; k < 3; ++k)
      nodes[k] = number[as_index(specimen.skin[as_index(triangle[k])])];
    std::sort(nodes.begin(), nodes.end());
    triangle_of_[nodes] = static_cast<int>(skin_triangles_.size());
    skin_triangles_.push_back(nodes);
  }
  for (const int node : specimen.skin) part_node_.push_back(number[as_index(node)]);
  std::map<std::array<int, 2>, int> around;
  for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
    const auto& corners = mesh_.tetrahedra[t];
    Eigen::Matrix3d edges;
    for (std::size_t k = 1; k < 4; ++k)
      edges.col(static_cast<Eigen::Index>(k) - 1) =
          mesh_.nodes[as_index(corners[k])] - mesh_.nodes[as_index(corners[0])];
    Element element;
    element.gradients.bottomRows<3>() = edges.inverse();
    element.gradients.row(0) = -element.gradients.bottomRows<3>().colwise().sum();
    element.volume = edges.determinant() / 6.0;
    elements_.push_back(element);
    std::array<int, 4> numbers{};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto [found, added] = around.try_emplace({corners[k], mesh_.regions[t]},
                                                     static_cast<int>(count_around_.size()));
      if (added) count_around_.push_back(0);
      ++count_around_[as_index(found->second)];
      numbers[k] = found->second;
    }
    around_.push_back(numbers);
  }
  find_tissues(scene, unit);
  homes_.resize(tissues_.size());
  if (!solver_.prepare(stiffness([](int) { return true; }), held_))
    throw MeshError(tissue::not_held);
}

// Linear finite elements, whose pressure is partly that of volumes averaged around nodes.
template <class Takes>
BlockMatrix EnergyCoupling::stiffness(const Takes& takes) const {
  BlockMatrix matrix(static_cast<int>(mesh_.nodes.size()), pairs_);
  std::vector<std::vector<std::pair<int, Vec3>>> changes(count_around_.size());
  std::vector<double> volumes(count_around_.size(), 0.0);
  std::vector<double> weights(count_around_.size(), 0.0);
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    if (!takes(mesh_.regions[t])) continue;
    const Tissue& tissue = tissues_[as_index(mesh_.regions[t])];
    const auto& [gradients, volume] = elements_[t];
    const double lame = tissue.own_bulk - 2.0 / 3.0 * tissue.shear_modulus;
    const Eigen::Matrix4d products = gradients * gradients.transpose();
    for (Eigen::Index i = 0; i < 4; ++i)
      for (Eigen::Index j = 0; j < 4; ++j) {
        const Vec3 own = volume * gradients.row(i).transpose();
        const Eigen::RowVector3d other = gradients.row(j);
        BlockMatrix::Block& block =
            matrix.at(mesh_.tetrahedra[t][as_index(i)], mesh_.tetrahedra[t][as_index(j)]);
        block += lame * own * other + tissue.shear_modulus * other.transpose() * own.transpose();
        block.diagonal().array() += volume * tissue.shear_modulus * products(i, j);
      }
    if (tissue.shared_bulk <= 0.0) continue;
    for (const int at : around_[t]) {
      volumes[as_index(at)] += volume;
      weights[as_index(at)] += 0.25 * volume * tissue.shared_bulk;
      auto& row = changes[as_index(at)];
      for (std::size_t k = 0; k < 4; ++k) {
        const int node = mesh_.tetrahedra[t][k];
        const Vec3 change = volume * gradients.row(static_cast<Eigen::Index>(k)).transpose();
        const auto known = std::find_if(row.begin(), row.end(),
                                        [&](const auto& one) { return one.first == node; });
        if (known == row.end())
          row.emplace_back(node, change);
        else
          known->second += change;
      }
    }
  }
  for (std::size_t v = 0; v < changes.size(); ++v) {
    if (changes[v].empty()) continue;
    std::sort(changes[v].begin(), changes[v].end(),
              [](const auto& one, const auto& other) { return one.first < other.first; });
    for (const auto& [node, change] : changes[v]) {
      matrix.volumes.column.push_back(node);
      matrix.changes.emplace_back(change / volumes[v]);
    }
    matrix.volumes.start.push_back(static_cast<int>(matrix.changes.size()));
    matrix.weights.push_back(weights[v]);
  }
  if (!matrix.weights.empty()) matrix.end_volumes();
  return matrix;
}

void EnergyCoupling::find_tissues(const scene::Scene& scene, double unit) {
  const auto add = [&](const scenario::Resolved::Substance& substance) {
    const tissue::Isotropic elastic{substance.young_modulus / unit,
                                    std::min(substance.poisson_ratio, scene::most_poisson_ratio)};
    Tissue tissue{.elastic = elastic,
                  .shear_modulus = tissue::shear_modulus(elastic),
                  .own_bulk = tissue::bulk_modulus(elastic)};
    if (volume_ == tissue::Volume::nodal) {
      const double bulk = tissue.own_bulk;
      tissue.own_bulk = std::min(bulk, scene::own_share * tissue.shear_modulus);
      tissue.shared_bulk = bulk - tissue.own_bulk;
    }
    tissues_.push_back(tissue);
  };
  add(scene.scenario.tissue);
  for (const auto& region : scene.scenario.regions) add(region);
}

int EnergyCoupling::region_under(int triangle) const {
  const std::array<int, 3>& key = skin_triangles_[as_index(triangle)];
  const auto found = std::lower_bound(
      uses_.begin(), uses_.end(), key,
      [](const geometry::FaceUse& use, const auto& wanted) { return use.key < wanted; });
  if (found == uses_.end() || found->key != key) return 0;  // outside the part
  return mesh_.regions[as_index(found->tetrahedron)];
}

const EnergyCoupling::Home& EnergyCoupling::home(int region) {
  std::optional<Home>& known = homes_[as_index(region)];
  if (known) return *known;
  Home& here = known.emplace();
  const auto at_home = [&](const geometry::FaceUse& use) {
    return mesh_.regions[as_index(use.tetrahedron)] == region;
  };
  for (std::size_t i = 0; i < uses_.size();) {
    const bool shared = i + 1 < uses_.size() && uses_[i + 1].key == uses_[i].key;
    const geometry::FaceUse& first = uses_[i];
    const geometry::FaceUse& second = uses_[shared ? i + 1 : i];
    i += shared ? 2 : 1;
    if (at_home(first) == at_home(second) && (shared || !at_home(first))) continue;
    const geometry::FaceUse& own = at_home(first) ? first : second;
    Face face{.nodes = own.nodes, .interface = shared, .tetrahedron = own.tetrahedron};
    const auto corner = [&](std::size_t k) -> const Vec3& {
      return mesh_.nodes[as_index(own.nodes[k])];
    };
    face.normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    for (std::size_t axis = 0; axis < 3; ++axis)
      face.held[axis] = std::all_of(own.nodes.begin(), own.nodes.end(), [&](int node) {
        return held_[3 * as_index(node) + axis] != 0;
      });
    if (const auto skin = triangle_of_.find(own.key); !shared && skin != triangle_of_.end()) {
      face.triangle = skin->second;
      const auto& vertices = skin_->surface().triangles[as_index(face.triangle)];
      for (std::size_t k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c)
          if (part_node_[as_index(vertices[as_index(c)])] == own.nodes[k]) face.corners[k] = c;
      face.cut_off = cut_off(face);
    }
    here.faces.push_back(face);
  }
  here.other.assign(mesh_.nodes.size(), 0);
  bool several = false;
  for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
    if (mesh_.regions[t] == region) continue;
    several = true;
    for (const int node : mesh_.tetrahedra[t]) here.other[as_index(node)] = 1;
  }
  if (several) here.others = stiffness([&](int other) { return other != region; });
  return here;
}

BeyondHalfSpace EnergyCoupling::beyond(const contact::Patch& patch, const Vec3& along, int finer) {
  const Press press{patch, along};
  return std::move(beyond(std::span(&press, 1), finer).front());
}

std::vector<BeyondHalfSpace> EnergyCoupling::beyond(std::span<const Press> presses, int finer) {
  struct Case {
    int region;
    Vector loads;         // N/N, g
    Vector curved;        // N/N, of a curved skin under the patch
    double known;         // m/N, c
    Vector interpolated;  // m/N, of the half-space in other tissues
    Vector held_by;       // m/N, w on supports: minus the half-space's
  };
  const Eigen::Index freedoms = static_cast<Eigen::Index>(held_.size());
  std::vector<Case> cases;
  std::vector<Vector> right;
  for (const auto& [patch, along, sum_of_two] : presses) {
    const int region = region_under(patch.at.triangle);
    const Home& here = home(region);
    Loads loads(mesh_, *skin_, patch, tissues_[as_index(region)], finer, along);
    Case& one = cases.emplace_back(
        Case{region, {}, {}, 0.0, Vector::Zero(freedoms), Vector::Zero(freedoms)});
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
      const bool supported = held_[3 * n] != 0 || held_[3 * n + 1] != 0 || held_[3 * n + 2] != 0;
      if (!supported && here.other[n] == 0) continue;
      const auto first = 3 * static_cast<Eigen::Index>(n);
      const Vec3 moved = loads.displacement(static_cast<int>(n));
      if (here.other[n] != 0) one.interpolated.segment<3>(first) = moved;
      for (int axis = 0; axis < 3; ++axis)
        if (held_[3 * n + as_index(axis)] != 0) one.held_by[first + axis] = -moved[axis];
    }
    for (const Face& face : here.faces) loads.add(face, one.interpolated);
    if (here.others) {
      const Vector pull = *here.others * one.interpolated;
      loads.nodal -= pull;
      loads.known -= one.interpolated.dot(pull);
    }
    one.loads = std::move(loads.nodal);
    one.curved = std::move(loads.curved);
    one.known = loads.known;
    if (!sum_of_two) right.push_back(one.loads - solver_.matrix() * one.held_by);
  }

  std::vector<Vector> rest(right.size());
  if (!solver_.solve(right, rest)) throw MeshError(tissue::not_held);
  for (std::size_t i = 0; i < presses.size(); ++i)
    if (presses[i].sum_of_two)
      rest.insert(rest.begin() + static_cast<std::ptrdiff_t>(i),
                  (rest[i - 2] + rest[i - 1]) / std::numbers::sqrt2);
  std::vector<BeyondHalfSpace> results(presses.size());
  for (std::size_t i = 0; i < presses.size(); ++i) {
    const Case& one = cases[i];
    BeyondHalfSpace& result = results[i];
    result.rest = std::move(rest[i]);
    result.rest += one.held_by;
    const Vector reaction = solver_.matrix() * result.rest - one.loads;
    result.sinking = one.known + one.loads.dot(result.rest) + 2.0 * one.curved.dot(result.rest);
    for (Eigen::Index d = 0; d < freedoms; ++d)
      if (held_[as_index(d)] != 0) result.sinking -= reaction[d] * one.held_by[d];
    find_errors(presses[i].patch, one.interpolated, one.region, home(one.region), result);
  }
  return results;
}

}  // namespace palpate::mechanics
