// Loads of the half-space's field on the body, the solution for the rest, and its error.
#include "mechanics/energy_coupling.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <list>
#include <numbers>

#include "base/error.h"
#include "scenario/model_traits.h"

namespace palpate::mechanics {

using integrate::Vector;

namespace {

// Relative error of solutions in the energy norm. The surface displacement is an energy: its error
// is the square.
constexpr double tolerance = 3e-4;

// Under the patch itself nothing is left over, because the finger's pressure acts there.
constexpr double under_finger = 1.05;
// Cosine between a facet and the plane of the contact: the curvature is followed on flatter ones.
constexpr double steepest = 0.3;

// The longest edge over the distance on which the rest varies, up to which the estimate sees what a
// tetrahedron misses.
constexpr double seen_width = 0.45;

}  // namespace

// Quadrature of the half-space's tractions over the faces, for one patch.
class EnergyCoupling::Loads {
 public:
  Loads(const geometry::TetMesh& mesh, const geometry::SmoothSurface& outer_surface,
        const contact::Patch& patch, const Tissue& tissue, int finer, const Vec3& along)
      : mesh_(&mesh),
        outer_surface_(&outer_surface),
        patch_(&patch),
        axes_(axes_of(patch)),
        field_(patch.a, patch.b, {tissue.shear_modulus, tissue.elastic.poisson_ratio}, finer,
               axes_.transpose() * along),
        finer_(finer),
        presses_(along.dot(patch.normal) < -0.5),
        elastic_(tissue.elastic) {
    nodal = integrate::Vector::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
    curved = nodal;
  }

  [[nodiscard]] Vec3 displacement(int node) const {
    return axes_ * field_.at(local(mesh_->nodes[as_index(node)])).displacement;
  }

  void add(const Face& face, const integrate::Vector& interpolated) {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = local(mesh_->nodes[as_index(face.nodes[k])]);
    normal_ = axes_.transpose() * face.normal;
    // The plane of the contact is free of stress outside the patch.
    const double flat = 1e-9 * (corners[1] - corners[0]).norm();
    if (!face.interface && std::ranges::all_of(corners, [&](const Vec3& corner) {
          return std::abs(corner.z()) <= flat;
        }))
      return;
    divide(face, corners, {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}, 0, interpolated);
  }

  integrate::Vector nodal;   // N/N, g
  integrate::Vector curved;  // N/N, of a curved surface under the patch
  double known = 0.0;        // m/N, c

 private:
  [[nodiscard]] static Eigen::Matrix3d axes_of(const contact::Patch& patch) {
    Eigen::Matrix3d axes;
    axes << patch.axis, patch.normal.cross(patch.axis), patch.normal;
    return axes;
  }
  [[nodiscard]] Vec3 local(const Vec3& point) const {
    return axes_.transpose() * (point - patch_->position);
  }

  // Divides a triangle until it is small against its distance from the patch.
  void divide(const Face& face, const std::array<Vec3, 3>& corners,
              const std::array<Vec3, 3>& weights, int depth,
              const integrate::Vector& interpolated) {
    constexpr int deepest = 8;
    constexpr double nearest = 0.25;  // of the patch's radius
    double edge = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      edge = std::max(edge, (corners[(k + 1) % 3] - corners[k]).norm());
    const double distance = ((corners[0] + corners[1] + corners[2]) / 3.0).norm();
    const double size = std::max(0.6 * distance, nearest * patch_->radius());
    if (finer_ * edge <= size || depth == deepest)
      return integrate(face, corners, weights, interpolated);
    const std::array<Vec3, 3> middle{0.5 * (corners[1] + corners[2]),
                                     0.5 * (corners[2] + corners[0]),
                                     0.5 * (corners[0] + corners[1])};
    const std::array<Vec3, 3> share{0.5 * (weights[1] + weights[2]),
                                    0.5 * (weights[2] + weights[0]),
                                    0.5 * (weights[0] + weights[1])};
    for (std::size_t k = 0; k < 3; ++k)
      divide(face, {corners[k], middle[(k + 2) % 3], middle[(k + 1) % 3]},
             {weights[k], share[(k + 2) % 3], share[(k + 1) % 3]}, depth + 1, interpolated);
    divide(face, middle, share, depth + 1, interpolated);
  }

  void integrate(const Face& face, const std::array<Vec3, 3>& corners,
                 const std::array<Vec3, 3>& weights, const integrate::Vector& interpolated) {
    const double area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    for (std::size_t q = 0; q < 3; ++q) {  // degree 2
      Vec3 point = Vec3::Zero();
      Vec3 shares = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const double weight = k == q ? 2.0 / 3.0 : 1.0 / 6.0;
        point += weight * corners[k];
        shares += weight * weights[k];
      }
      Vec3 normal = normal_;
      if (face.triangle >= 0) {
        // The contact lies on the smooth surface, from which a coarse facet is far away.
        geometry::SurfacePoint at{.triangle = face.triangle, .weights = Vec3::Zero()};
        for (std::size_t k = 0; k < 3; ++k)
          at.weights[face.corners[k]] = shares[static_cast<Eigen::Index>(k)];
        point = local(outer_surface_->position(at));
        normal = axes_.transpose() * outer_surface_->normal(at);
      }
      if (!face.interface && normal.z() > 0.0 && std::abs(point.z()) < patch_->a) {
        const double x = point.x() / patch_->a;
        const double y = point.y() / patch_->b;
        const double from_centre = std::hypot(x, y);
        if (from_centre < 1.0 && presses_ && std::min(normal.z(), normal_.z()) > steepest)
          press_curved(face, corners, weights, shares, point, normal, from_centre, area / 3.0);
        if (from_centre < under_finger) continue;
      }
      const contact::FieldValue value = field_.at(point);
      const Vec3 traction = area / 3.0 * (axes_ * (value.stress * normal));
      Vec3 moved = axes_ * value.displacement;
      if (face.interface) {
        moved.setZero();
        for (std::size_t k = 0; k < 3; ++k)
          moved +=
              shares[static_cast<Eigen::Index>(k)] * interpolated.segment<3>(3 * face.nodes[k]);
      }
      for (int axis = 0; axis < 3; ++axis) {
        const double work = traction[axis] * moved[axis];
        if (face.held[as_index(axis)] && !face.interface) {
          known += work;
          continue;
        }
        known -= work;
        for (std::size_t k = 0; k < 3; ++k)
          nodal[3 * face.nodes[k] + axis] -= shares[static_cast<Eigen::Index>(k)] * traction[axis];
      }
    }
  }

  // What a surface that is curved under the patch changes to the first order in its height z above
  // the plane: beyond the half-space's stress it carries stress grad z - z grad p in the plane. The
  // work of the second term on a shape function N is p (z grad N + N grad z), integrated by parts.
  // `r` is the distance from the centre, 0 to 1; an ellipse counts as a circle of its area.
  //                              docs/theory.md [curved]; K. L. Johnson 1985, eq. (3.41)-(3.43)
  void press_curved(const Face& face, const std::array<Vec3, 3>& corners,
                    const std::array<Vec3, 3>& weights, const Vec3& shares, const Vec3& point,
                    const Vec3& normal, double r, double area) {
    using Eigen::Vector2d;
    const Vector2d slope = -normal.head<2>() / normal.z();
    const double seen = area * normal.z();  // from above
    const double root = std::sqrt(1.0 - r * r);
    const double middle = 1.5 / (std::numbers::pi * patch_->a * patch_->b);  // Pa/N
    const double p = middle * root;
    const double spread = r < 1e-6 ? 1.5 : (1.0 - root * root * root) / (r * r);
    const double nu = elastic_.poisson_ratio;
    const double sideways = (1.0 - 2.0 * nu) / 3.0 * middle * spread;
    const Vector2d outward = point.head<2>().stableNormalized();
    const Vector2d around(-outward.y(), outward.x());
    const Vector2d pull = p * slope + (sideways - p) * outward.dot(slope) * outward -
                          (sideways + 2.0 * nu * p) * around.dot(slope) * around;
    const double moved =  // inwards
        0.5 * sideways / tissue::shear_modulus(elastic_) * patch_->radius() * r;
    known -= seen * moved * outward.dot(pull);
    Eigen::Matrix2d edges;
    edges << (corners[1] - corners[0]).head<2>(), (corners[2] - corners[0]).head<2>();
    const Eigen::Matrix2d inverse = edges.transpose().inverse();
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vector2d gradient =
          inverse * Vector2d(weights[1][k] - weights[0][k], weights[2][k] - weights[0][k]);
      const Vector2d load = seen * (p * point.z() * gradient + shares[k] * pull);
      const Vec3 force = axes_.leftCols<2>() * load;
      for (int axis = 0; axis < 3; ++axis)
        if (!face.held[as_index(axis)]) curved[3 * face.nodes[as_index(k)] + axis] += force[axis];
    }
  }

  const geometry::TetMesh* mesh_;
  const geometry::SmoothSurface* outer_surface_;
  const contact::Patch* patch_;
  Eigen::Matrix3d axes_;  // columns: the patch's axes
  contact::PatchField field_;
  int finer_;
  bool presses_;
  tissue::Isotropic elastic_;
  Vec3 normal_ = Vec3::Zero();
};

EnergyCoupling::EnergyCoupling(const scene::Scene& scene, const tissue::Part& part,
                               std::span<const char> held, double unit)
    : outer_surface_(&*scene.specimen->surface),
      held_(held.begin(), held.end()),
      springs_(part.network),
      solver_(tolerance),
      volume_(scenario::traits(scene.scenario.solver.model).coupled() ? scene.scenario.solver.volume
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
    if (*std::ranges::min_element(corners) < 0) continue;
    mesh_.tetrahedra.push_back(corners);
    mesh_.regions.push_back(specimen.mesh.region(static_cast<int>(t)));
  }
  uses_ = geometry::face_uses(mesh_);
  for (const auto& triangle : specimen.surface->surface().triangles) {
    std::array<int, 3> nodes{};
    for (std::size_t k = 0; k < 3; ++k)
      nodes[k] = number[as_index(specimen.outer_surface[as_index(triangle[k])])];
    std::ranges::sort(nodes);
    triangle_of_[nodes] = static_cast<int>(surface_triangles_.size());
    surface_triangles_.push_back(nodes);
  }
  for (const int node : specimen.outer_surface) part_node_.push_back(number[as_index(node)]);
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
  if (!solver_.prepare(stiffness(), held_)) throw MeshError(tissue::not_held);
}

// The linear finite elements of the mesh are its coupled springs; those of a tissue without
// stiffness are excluded.
BlockMatrix EnergyCoupling::stiffness(std::span<const char> only) const {
  std::vector<tissue::Isotropic> tissues;
  for (const Tissue& tissue : tissues_) tissues.push_back(tissue.elastic);
  geometry::TetMesh mesh = mesh_;
  if (!only.empty()) {
    const int none = static_cast<int>(tissues.size());
    tissues.push_back(tissues.front());
    tissues.back().young_modulus = 0.0;
    for (std::size_t t = 0; t < only.size(); ++t)
      if (only[t] == 0) mesh.regions[t] = none;
  }
  tissue::Network network = springs_;
  tissue::couple(network, mesh, tissues, volume_, scene::own_share);
  return tissue::stiffness_matrix(network);
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
  const std::array<int, 3>& key = surface_triangles_[as_index(triangle)];
  const auto found = std::ranges::lower_bound(uses_, key, {}, &geometry::FaceUse::key);
  if (found == uses_.end() || found->key != key) return 0;  // outside the part
  return mesh_.regions[as_index(found->tetrahedron)];
}

const EnergyCoupling::Home& EnergyCoupling::home(int region) {
  std::optional<Home>& known = homes_[as_index(region)];
  if (known) return *known;
  std::vector<char> away(mesh_.tetrahedra.size(), 0);
  for (std::size_t t = 0; t < away.size(); ++t) away[t] = mesh_.regions[t] != region ? 1 : 0;
  return known.emplace(make_home(std::move(away), region));
}

// A half-space has no field above its plane: over a place its stress is that of the place, also
// within the patch, however high the point lies. What lies higher above the plane than beside the
// contact, as another strand of a knot, is away from home.
std::vector<char> EnergyCoupling::hanging_over(const contact::Patch& patch, int region) const {
  std::vector<char> high(mesh_.nodes.size(), 0);
  for (std::size_t n = 0; n < high.size(); ++n) {
    const Vec3 from = mesh_.nodes[n] - patch.position;
    const double height = from.dot(patch.normal);
    high[n] = height > 0.0 && 2.0 * height * height > from.squaredNorm() ? 1 : 0;
  }
  std::vector<char> away(mesh_.tetrahedra.size(), 0);
  bool hangs = false;
  for (std::size_t t = 0; t < away.size(); ++t) {
    const auto& corners = mesh_.tetrahedra[t];
    const bool over =
        std::ranges::all_of(corners, [&](int node) { return high[as_index(node)] != 0; });
    hangs = hangs || (over && mesh_.regions[t] == region);
    away[t] = over || mesh_.regions[t] != region ? 1 : 0;
  }
  return hangs ? away : std::vector<char>{};
}

EnergyCoupling::Home EnergyCoupling::make_home(std::vector<char> away, int region) const {
  Home here;
  here.away = std::move(away);
  const auto at_home = [&](const geometry::FaceUse& use) {
    return here.away[as_index(use.tetrahedron)] == 0;
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
      face.held[axis] = std::ranges::all_of(
          own.nodes, [&](int node) { return held_[3 * as_index(node) + axis] != 0; });
    if (const auto outer_surface = triangle_of_.find(own.key);
        !shared && outer_surface != triangle_of_.end()) {
      face.triangle = outer_surface->second;
      const auto& vertices = outer_surface_->surface().triangles[as_index(face.triangle)];
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
    if (here.away[t] == 0) continue;
    several = true;
    const char other = mesh_.regions[t] != region ? other_tissue : 1;
    for (const int node : mesh_.tetrahedra[t])
      here.other[as_index(node)] = std::max(here.other[as_index(node)], other);
  }
  if (several) here.others = stiffness(here.away);
  return here;
}

BeyondHalfSpace EnergyCoupling::beyond(const contact::Patch& patch, const Vec3& along, int finer) {
  const Press press{patch, along};
  return std::move(beyond(std::span(&press, 1), finer).front());
}

std::vector<BeyondHalfSpace> EnergyCoupling::beyond(std::span<const Press> presses, int finer) {
  struct Case {
    const Home* home;
    Vector loads;         // N/N, g
    Vector curved;        // N/N, of a curved surface under the patch
    double known;         // m/N, c
    Vector interpolated;  // m/N, of the half-space in other tissues
    Vector held_by;       // m/N, w on supports: minus the half-space's
  };
  const Eigen::Index freedoms = static_cast<Eigen::Index>(held_.size());
  std::vector<Case> cases;
  std::vector<Vector> right;
  std::list<Home> below;  // parts of the body that hang over a contact
  for (const auto& [patch, along, sum_of_two] : presses) {
    const int region = region_under(patch.at.triangle);
    std::vector<char> away = hanging_over(patch, region);
    const bool hangs = !away.empty();
    if (hangs && (below.empty() || below.back().away != away))
      below.push_back(make_home(std::move(away), region));
    const Home& here = hangs ? below.back() : home(region);
    Loads loads(mesh_, *outer_surface_, patch, tissues_[as_index(region)], finer, along);
    Case& one = cases.emplace_back(
        Case{&here, {}, {}, 0.0, Vector::Zero(freedoms), Vector::Zero(freedoms)});
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
    result.surface_displacement =
        one.known + one.loads.dot(result.rest) + 2.0 * one.curved.dot(result.rest);
    for (Eigen::Index d = 0; d < freedoms; ++d)
      if (held_[as_index(d)] != 0) result.surface_displacement -= reaction[d] * one.held_by[d];
    find_errors(presses[i].patch, one.interpolated, *one.home, result);
  }
  return results;
}

// Zienkiewicz and Zhu 1992: the stress is recovered at the nodes by a linear fit over the
// tetrahedra around them, of one tissue at a time; the error is the energy of the difference.
void EnergyCoupling::find_errors(const contact::Patch& patch, const Vector& interpolated,
                                 const Home& home, BeyondHalfSpace& result) const {
  const Vector& rest = result.rest;
  using Stress = Eigen::Matrix<double, 6, 1>;  // xx yy zz xy xz yz
  const std::size_t count = elements_.size();
  std::vector<Stress> stresses(count);
  std::vector<double> dilations(count);
  std::vector<double> shared(count_around_.size(), 0.0);  // around (node, region)
  std::vector<double> volumes(count_around_.size(), 0.0);
  double whole = 0.0;
  for (std::size_t t = 0; t < count; ++t) {
    const Element& element = elements_[t];
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Index first = 3 * mesh_.tetrahedra[t][k];
      Vec3 moved = rest.segment<3>(first);
      if (home.away[t] != 0) moved += interpolated.segment<3>(first);
      gradient += moved * element.gradients.row(static_cast<Eigen::Index>(k));
    }
    dilations[t] = gradient.trace();
    whole += element.volume;
    for (const int at : around_[t]) {
      shared[as_index(at)] += element.volume * dilations[t];
      volumes[as_index(at)] += element.volume;
    }
    const double shear = tissues_[as_index(mesh_.regions[t])].shear_modulus;
    const double mean = 2.0 / 3.0 * dilations[t];
    const auto deviator = [&](int i, int j) {
      return shear * (gradient(i, j) + gradient(j, i) - (i == j ? mean : 0.0));
    };
    stresses[t] << deviator(0, 0), deviator(1, 1), deviator(2, 2), deviator(0, 1), deviator(0, 2),
        deviator(1, 2);
  }
  const double scale = std::cbrt(whole / static_cast<double>(count));
  std::vector<Eigen::Matrix4d> left(count_around_.size(), Eigen::Matrix4d::Zero());
  std::vector<Eigen::Matrix<double, 4, 6>> right(count_around_.size(),
                                                 Eigen::Matrix<double, 4, 6>::Zero());
  for (std::size_t t = 0; t < count; ++t) {
    const Tissue& tissue = tissues_[as_index(mesh_.regions[t])];
    double pressure = tissue.own_bulk * dilations[t];
    for (const int at : around_[t])
      pressure += 0.25 * tissue.shared_bulk * shared[as_index(at)] / volumes[as_index(at)];
    stresses[t].head<3>().array() += pressure;
    const auto& corners = mesh_.tetrahedra[t];
    Vec3 centre = Vec3::Zero();
    for (const int node : corners) centre += 0.25 * mesh_.nodes[as_index(node)];
    for (std::size_t k = 0; k < 4; ++k) {
      Eigen::Vector4d basis;
      basis << 1.0, (centre - mesh_.nodes[as_index(corners[k])]) / scale;
      left[as_index(around_[t][k])] += basis * basis.transpose();
      right[as_index(around_[t][k])] += basis * stresses[t].transpose();
    }
  }
  std::vector<Stress> nodal(count_around_.size());
  for (std::size_t i = 0; i < nodal.size(); ++i) {
    constexpr int fewest = 8;  // tetrahedra for a linear fit; otherwise their mean
    const double number = left[i](0, 0);
    if (count_around_[i] < fewest) {
      nodal[i] = right[i].row(0).transpose() / number;
      continue;
    }
    const Eigen::Matrix4d ridged = left[i] + 1e-9 * number * Eigen::Matrix4d::Identity();
    nodal[i] = (ridged.ldlt().solve(right[i])).row(0).transpose();
  }
  // Twice the energy of a stress, J per m^3.
  const auto density = [&](std::size_t t, Stress stress) {
    const Tissue& tissue = tissues_[as_index(mesh_.regions[t])];
    const double pressure = stress.head<3>().sum() / 3.0;
    stress.head<3>().array() -= pressure;
    const double shear = (stress.head<3>().squaredNorm() + 2.0 * stress.tail<3>().squaredNorm()) /
                         (2.0 * tissue.shear_modulus);
    return shear + pressure * pressure / (tissue.own_bulk + tissue.shared_bulk);
  };
  result.errors.assign(count, 0.0);
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t q = 0; q < 4; ++q) {  // four points, degree 2
      constexpr double far = 0.13819660112501051;
      Stress difference = -stresses[t];
      for (std::size_t k = 0; k < 4; ++k)
        difference += (k == q ? 1.0 - 3.0 * far : far) * nodal[as_index(around_[t][k])];
      result.errors[t] += 0.25 * elements_[t].volume * density(t, difference);
    }
    result.error += result.errors[t];
  }
  // The rest of the displacement varies over the distance from the contact and, at the contact,
  // over that to the next boundary. Of what wider tetrahedra miss, the estimate sees a part only.
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < mesh_.nodes.size(); ++n)
    if (held_[3 * n + 2] != 0 || home.other[n] == other_tissue)
      nearest = std::min(nearest, (mesh_.nodes[n] - patch.position).norm());
  nearest = std::max(nearest, 0.5 * patch.radius());
  for (std::size_t t = 0; t < count; ++t) {
    const auto node = [&](std::size_t k) -> const Vec3& {
      return mesh_.nodes[as_index(mesh_.tetrahedra[t][k])];
    };
    double longest = 0.0;
    for (const auto& [a, b] : geometry::corner_edges)
      longest = std::max(longest, (node(as_index(a)) - node(as_index(b))).norm());
    const Vec3 centre = 0.25 * (node(0) + node(1) + node(2) + node(3));
    const double ratio = longest / (seen_width * ((centre - patch.position).norm() + nearest));
    const double unseen = std::max(0.0, ratio * ratio - 1.0) * result.errors[t];
    result.doubt += unseen;
    result.errors[t] += unseen;
  }
  // A boundary moved outwards by d lowers the compliance by d times the density of energy there.
  for (const Face& face : home.faces) {
    const std::size_t t = as_index(face.tetrahedron);
    const double change = std::abs(face.cut_off) * density(t, stresses[t]);
    result.doubt += change;
    result.errors[t] += change;
  }
}

// The volume between a face and the smooth surface over it, by three points.
double EnergyCoupling::cut_off(const Face& face) const {
  const auto& corners = outer_surface_->surface().triangles[as_index(face.triangle)];
  const auto vertex = [&](std::size_t k) -> const Vec3& {
    return outer_surface_->surface().vertices[as_index(corners[k])];
  };
  const Vec3 twice_area = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    geometry::SurfacePoint at{.triangle = face.triangle, .weights = Vec3::Constant(0.5)};
    at.weights[k] = 0.0;  // the middles of the sides: exact to degree 2
    sum += (outer_surface_->position(at) - outer_surface_->flat_position(at)).dot(twice_area) / 6.0;
  }
  return sum;
}

}  // namespace palpate::mechanics
