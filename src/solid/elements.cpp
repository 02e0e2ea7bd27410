// Sums over elements in their order, so that results do not depend on anything else.
#include "solid/elements.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"

namespace palpate::solid {
namespace {

using Edge = std::array<int, 2>;

Edge sorted(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// Whether the element's Jacobian is positive at its integration points and corners, by a margin
// against that of its straight tetrahedron.
bool stands(const Mesh& mesh, const Element& element) {
  constexpr double least = 0.1;
  const auto jacobian = [&](const Functions& at) {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    for (std::size_t a = 0; a < 10; ++a)
      matrix += mesh.nodes[as_index(element[a])] * at.derivatives[a].transpose();
    return matrix.determinant();
  };
  const auto corner = [&](std::size_t a) { return mesh.nodes[as_index(element[a])]; };
  const double straight =
      (corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(corner(3) - corner(0));
  for (const Functions& at : at_points())
    if (jacobian(at) < least * straight) return false;
  for (std::size_t a = 0; a < 4; ++a) {
    std::array<double, 4> only{};
    only[a] = 1.0;
    if (jacobian(functions_at(only)) < least * straight) return false;
  }
  return straight > 0.0;
}

}  // namespace

Functions functions_at(const std::array<double, 4>& l) {
  static const std::array<Vec3, 4> slope{Vec3(-1, -1, -1), Vec3(1, 0, 0), Vec3(0, 1, 0),
                                         Vec3(0, 0, 1)};
  Functions at;
  for (std::size_t a = 0; a < 4; ++a) {
    at.values[a] = l[a] * (2.0 * l[a] - 1.0);
    at.derivatives[a] = (4.0 * l[a] - 1.0) * slope[a];
  }
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] =
        std::pair(as_index(geometry::corner_edges[e][0]), as_index(geometry::corner_edges[e][1]));
    at.values[4 + e] = 4.0 * l[i] * l[j];
    at.derivatives[4 + e] = 4.0 * (l[i] * slope[j] + l[j] * slope[i]);
  }
  return at;
}

std::array<double, 6> face_values(const std::array<double, 3>& corners) {
  const auto& [a, b, c] = corners;
  return {a * (2.0 * a - 1.0), b * (2.0 * b - 1.0), c * (2.0 * c - 1.0),
          4.0 * a * b,         4.0 * b * c,         4.0 * c * a};
}

std::array<double, 6> part_values(const std::array<double, 3>& corners) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (corners[i] <= 0.5) continue;
    std::array<double, 6> values{};
    values[i] = 2.0 * corners[i] - 1.0;
    values[3 + i] = 2.0 * corners[(i + 1) % 3];
    values[3 + (i + 2) % 3] = 2.0 * corners[(i + 2) % 3];
    return values;
  }
  return {0.0, 0.0, 0.0, 1.0 - 2.0 * corners[2], 1.0 - 2.0 * corners[0], 1.0 - 2.0 * corners[1]};
}

const std::array<Functions, points>& at_points() {
  static const std::array<Functions, points> all = [] {
    const double b = (5.0 - std::sqrt(5.0)) / 20.0;  // exact for polynomials of degree two
    std::array<Functions, points> found;
    for (std::size_t q = 0; q < points; ++q) {
      std::array<double, 4> at{b, b, b, b};
      at[q] = 1.0 - 3.0 * b;
      found[q] = functions_at(at);
    }
    return found;
  }();
  return all;
}

Mesh quadratic(const geometry::TetMesh& from, const Middle& middle) {
  Mesh mesh;
  mesh.nodes = from.nodes;
  mesh.regions.resize(from.tetrahedra.size(), 0);
  std::map<Edge, int> middles;
  for (std::size_t t = 0; t < from.tetrahedra.size(); ++t) {
    mesh.regions[t] = from.region(static_cast<int>(t));
    Element element{};
    for (std::size_t a = 0; a < 4; ++a) element[a] = from.tetrahedra[t][a];
    for (std::size_t e = 0; e < 6; ++e) {
      const int i = element[as_index(geometry::corner_edges[e][0])];
      const int j = element[as_index(geometry::corner_edges[e][1])];
      const auto [found, added] =
          middles.try_emplace(sorted(i, j), static_cast<int>(mesh.nodes.size()));
      if (added) mesh.nodes.emplace_back(0.5 * (mesh.nodes[as_index(i)] + mesh.nodes[as_index(j)]));
      element[4 + e] = found->second;
    }
    mesh.elements.push_back(element);
  }
  std::map<std::array<int, 3>, int> uses;
  const auto key = [](std::array<int, 3> face) {
    std::ranges::sort(face);
    return face;
  };
  const auto corners = [&](std::size_t t, const std::array<int, 3>& face) {
    const auto& element = mesh.elements[t];
    return std::array<int, 3>{element[as_index(face[0])], element[as_index(face[1])],
                              element[as_index(face[2])]};
  };
  for (std::size_t t = 0; t < mesh.elements.size(); ++t)
    for (const auto& face : geometry::outward_faces) ++uses[key(corners(t, face))];
  for (std::size_t t = 0; t < mesh.elements.size(); ++t)
    for (const auto& face : geometry::outward_faces) {
      const std::array<int, 3> c = corners(t, face);
      if (uses[key(c)] != 1) continue;
      OuterFace one{.element = static_cast<int>(t)};
      for (std::size_t i = 0; i < 3; ++i) {
        one.nodes[i] = c[i];
        one.nodes[3 + i] = middles.at(sorted(c[i], c[(i + 1) % 3]));
      }
      mesh.boundary.push_back(one);
    }
  std::map<int, Vec3> straight;  // of the middles that were moved
  if (middle)
    for (const auto& [edge, node] : middles) {
      const auto place = middle(edge);
      if (!place) continue;
      straight[node] = mesh.nodes[as_index(node)];
      mesh.nodes[as_index(node)] = *place;
    }
  // A node that is put back may be needed by a neighbour, so that all are looked at again.
  for (bool all_stand = false; !all_stand;) {
    all_stand = true;
    for (const Element& element : mesh.elements) {
      if (stands(mesh, element)) continue;
      // The one that moved farthest goes back.
      auto farthest = straight.end();
      for (std::size_t a = 4; a < 10; ++a) {
        const auto was = straight.find(element[a]);
        if (was == straight.end()) continue;
        const auto moved = [&](const auto& one) {
          return (mesh.nodes[as_index(one->first)] - one->second).squaredNorm();
        };
        if (farthest == straight.end() || moved(was) > moved(farthest)) farthest = was;
      }
      if (farthest == straight.end())
        throw MeshError(
            "a tetrahedron of the mesh is flat; change the size or the surface a little");
      mesh.nodes[as_index(farthest->first)] = farthest->second;
      straight.erase(farthest);
      all_stand = false;
    }
  }
  return mesh;
}

namespace {

using Nine = std::array<double, 9>;     // rows of a matrix
using Thirty = std::array<double, 30>;  // three numbers for each of ten nodes

constexpr double least_ratio = 0.02;  // J below which an element counts as folded

// 1 + sum of u_a G_a^T.
Nine stretch(const Thirty& u, const Thirty& g) {
  Nine f{1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (std::size_t a = 0; a < 30; a += 3)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) f[3 * i + k] += u[a + i] * g[a + k];
  return f;
}

Nine cofactors(const Nine& f) {
  return {f[4] * f[8] - f[5] * f[7], f[5] * f[6] - f[3] * f[8], f[3] * f[7] - f[4] * f[6],
          f[2] * f[7] - f[1] * f[8], f[0] * f[8] - f[2] * f[6], f[1] * f[6] - f[0] * f[7],
          f[1] * f[5] - f[2] * f[4], f[2] * f[3] - f[0] * f[5], f[0] * f[4] - f[1] * f[3]};
}

double ratio_of(const Nine& f, const Nine& c) { return f[0] * c[0] + f[1] * c[1] + f[2] * c[2]; }

// M G_a for all ten functions.
Thirty times(const Nine& m, const Thirty& g) {
  Thirty out;
  for (std::size_t a = 0; a < 30; a += 3)
    for (std::size_t i = 0; i < 3; ++i)
      out[a + i] = m[3 * i] * g[a] + m[3 * i + 1] * g[a + 1] + m[3 * i + 2] * g[a + 2];
  return out;
}

Thirty gathered(const Element& element, const Vector& x) {
  Thirty out;
  for (std::size_t a = 0; a < 10; ++a)
    for (int i = 0; i < 3; ++i) out[3 * a + as_index(i)] = x[3 * element[a] + i];
  return out;
}

}  // namespace

Elements::Elements(const Mesh& mesh, std::span<const tissue::Isotropic> tissues,
                   std::span<const char> held)
    : mesh_(&mesh), tissues_(tissues.begin(), tissues.end()) {
  for (const int region : mesh.regions) {
    const tissue::Isotropic& own = tissues[as_index(region)];
    shear_.push_back(tissue::shear_modulus(own));
    const double bulk = tissue::bulk_modulus(own);
    own_bulk_.push_back(std::min(bulk, own_share * shear_.back()));
    mean_bulk_.push_back(bulk - own_bulk_.back());
  }
  pressures_.assign(points * mesh.elements.size(), 0.0);
  unknowns_.assign(3 * mesh.nodes.size(), -1);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const int before = count_;
    for (std::size_t i = 3 * n; i < 3 * n + 3; ++i)
      if (held[i] == 0) unknowns_[i] = count_++;
    if (count_ > before) first_.push_back(before);
  }
  first_.push_back(count_);
  find_points();
  find_pattern();
}

void Elements::find_points() {
  for (const Element& element : mesh_->elements)
    for (const Functions& at : at_points()) {
      Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();  // dx / d(coordinates)
      for (std::size_t a = 0; a < 10; ++a)
        jacobian += mesh_->nodes[as_index(element[a])] * at.derivatives[a].transpose();
      Point point;
      point.weight = jacobian.determinant() / 24.0;
      const Eigen::Matrix3d back = jacobian.inverse().transpose();
      for (std::size_t a = 0; a < 10; ++a) {
        const Vec3 gradient = back * at.derivatives[a];
        for (std::size_t k = 0; k < 3; ++k)
          point.gradient[3 * a + k] = gradient[static_cast<Eigen::Index>(k)];
      }
      points_.push_back(point);
    }
}

void Elements::find_pattern() {
  std::vector<std::vector<int>> rows(as_index(count_));  // by columns
  std::array<int, 30> own;
  const auto gather = [&](const Element& element) {
    for (std::size_t a = 0; a < 10; ++a)
      for (int i = 0; i < 3; ++i)
        own[3 * a + as_index(i)] = unknowns_[as_index(3 * element[a] + i)];
  };
  for (const Element& element : mesh_->elements) {
    gather(element);
    for (const int column : own)
      for (const int row : own)
        if (column >= 0 && row >= column) rows[as_index(column)].push_back(row);
  }
  pattern_.resize(count_, count_);
  std::vector<int> sizes;
  for (std::vector<int>& list : rows) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
    sizes.push_back(static_cast<int>(list.size()));
  }
  pattern_.reserve(sizes);
  for (int column = 0; column < count_; ++column)
    for (const int row : rows[as_index(column)]) pattern_.insert(row, column) = 0.0;
  pattern_.makeCompressed();
  entries_.reserve(465 * mesh_->elements.size());
  for (const Element& element : mesh_->elements) {
    gather(element);
    for (std::size_t r = 0; r < 30; ++r)
      for (std::size_t c = 0; c <= r; ++c)
        entries_.push_back(own[r] < 0 || own[c] < 0
                               ? -1
                               : entry(std::max(own[r], own[c]), std::min(own[r], own[c])));
  }
}

int Elements::entry(int row, int column) const {
  const int* begin = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[column];
  const int* end = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[column + 1];
  const int* found = std::lower_bound(begin, end, row);
  return found == end || *found != row ? -1 : static_cast<int>(found - pattern_.innerIndexPtr());
}

// Per point, with h_a = F^-T G_a, f_a = F G_a, c = mu J^(-2/3) and t, s the parts of the pressure:
//   K_ab = c ((G_a . G_b) 1 - 2/3 (f_a h_b^T + h_a f_b^T) + 2/9 I1 h_a h_b^T + I1/3 h_b h_a^T)
//          + t h_a h_b^T - s h_b h_a^T                                   docs/theory.md [solid]
double Elements::assemble(const Vector& displacement, Vector& force,
                          Eigen::SparseMatrix<double>& stiffness) {
  if (stiffness.nonZeros() != pattern_.nonZeros()) stiffness = pattern_;
  double* values = stiffness.valuePtr();
  std::fill(values, values + stiffness.nonZeros(), 0.0);
  force.setZero(static_cast<Eigen::Index>(3 * mesh_->nodes.size()));
  double least = 1.0;
  std::array<double, 900> k;
  for (std::size_t e = 0; e < mesh_->elements.size(); ++e) {
    const Element& element = mesh_->elements[e];
    const Thirty u = gathered(element, displacement);
    k.fill(0.0);
    Thirty f{};
    Thirty volume_change{};
    double volume = 0.0;
    double now = 0.0;
    const bool mean = mean_bulk_[e] > 0.0;
    for (std::size_t q = points * e; q < points * (e + 1); ++q) {
      const Thirty& g = points_[q].gradient;
      const double w = points_[q].weight;
      const Nine stretched = stretch(u, g);
      const Nine c = cofactors(stretched);
      const double ratio = ratio_of(stretched, c);
      least = std::min(least, ratio);
      const double j = std::max(ratio, least_ratio);
      Nine back;
      for (std::size_t i = 0; i < 9; ++i) back[i] = c[i] / j;
      double first = 0.0;
      for (const double x : stretched) first += x * x;
      const double scaled = w * shear_[e] / std::cbrt(j * j);
      const double own = own_bulk_[e];
      const double pressed = w * pressures_[q] * j;
      const double along = 2.0 / 9.0 * first * scaled + w * own * j * j + pressed;
      const double across = first / 3.0 * scaled - pressed;
      const Thirty h = times(back, g);
      const Thirty fg = times(stretched, g);
      const double spherical = w * own * (ratio - 1.0) * j - first / 3.0 * scaled;
      for (std::size_t a = 0; a < 30; ++a) f[a] += scaled * fg[a] + spherical * h[a];
      if (mean) {
        volume += w;
        now += w * ratio;
        for (std::size_t a = 0; a < 30; ++a) volume_change[a] += w * j * h[a];
      }
      for (std::size_t a = 0; a < 30; a += 3) {
        std::array<double, 3> left;   // of h_b^T
        std::array<double, 3> right;  // of f_b^T
        for (std::size_t i = 0; i < 3; ++i) {
          left[i] = along * h[a + i] - 2.0 / 3.0 * scaled * fg[a + i];
          right[i] = -2.0 / 3.0 * scaled * h[a + i];
        }
        for (std::size_t b = 0; b <= a; b += 3) {
          const double dot = scaled * (g[a] * g[b] + g[a + 1] * g[b + 1] + g[a + 2] * g[b + 2]);
          for (std::size_t i = 0; i < 3; ++i) {
            double* row = &k[30 * (a + i) + b];
            const double turned = across * h[b + i];
            for (std::size_t l = 0; l < 3; ++l)
              row[l] += left[i] * h[b + l] + right[i] * fg[b + l] + turned * h[a + l];
            row[i] += dot;
          }
        }
      }
    }
    if (mean) {
      const double pressure = mean_bulk_[e] * (now / volume - 1.0);
      const double rate = mean_bulk_[e] / volume;
      for (std::size_t a = 0; a < 30; ++a) f[a] += pressure * volume_change[a];
      for (std::size_t r = 0; r < 30; ++r)
        for (std::size_t c = 0; c <= r; ++c)
          k[30 * r + c] += rate * volume_change[r] * volume_change[c];
    }
    for (std::size_t a = 0; a < 10; ++a)
      for (int i = 0; i < 3; ++i) force[3 * element[a] + i] += f[3 * a + as_index(i)];
    const int* entries = &entries_[465 * e];
    for (std::size_t r = 0; r < 30; ++r)
      for (std::size_t c = 0; c <= r; ++c, ++entries)
        if (*entries >= 0) values[*entries] += k[30 * r + c];
  }
  return least;
}

double Elements::energy(const Vector& displacement) const {
  double sum = 0.0;
  for (std::size_t e = 0; e < mesh_->elements.size(); ++e) {
    const Thirty u = gathered(mesh_->elements[e], displacement);
    double volume = 0.0;
    double now = 0.0;
    for (std::size_t q = points * e; q < points * (e + 1); ++q) {
      const Nine f = stretch(u, points_[q].gradient);
      const double ratio = ratio_of(f, cofactors(f));
      const double w = points_[q].weight;
      double first = 0.0;
      for (const double x : f) first += x * x;
      sum += 0.5 * w * shear_[e] * (first / std::cbrt(ratio * ratio) - 3.0);
      sum += 0.5 * w * own_bulk_[e] * (ratio - 1.0) * (ratio - 1.0);
      volume += w;
      now += w * ratio;
    }
    const double change = now / volume - 1.0;
    sum += 0.5 * volume * mean_bulk_[e] * change * change;
  }
  return sum;
}

void Elements::advance(const Vector& displacement, const Vector& step, double share) {
  for (std::size_t e = 0; e < mesh_->elements.size(); ++e) {
    const Thirty u = gathered(mesh_->elements[e], displacement);
    const Thirty du = gathered(mesh_->elements[e], step);
    double volume = 0.0;
    double sum = 0.0;
    std::array<double, points> dilatation{};
    for (std::size_t q = 0; q < points; ++q) {
      const Point& point = points_[points * e + q];
      const Nine f = stretch(u, point.gradient);
      const Nine c = cofactors(f);
      const Thirty change = times(c, point.gradient);
      double dilated = ratio_of(f, c) - 1.0;
      for (std::size_t a = 0; a < 30; ++a) dilated += change[a] * du[a];
      dilatation[q] = dilated;
      volume += point.weight;
      sum += point.weight * dilated;
    }
    for (std::size_t q = 0; q < points; ++q) {
      double& pressure = pressures_[points * e + q];
      const double next = own_bulk_[e] * dilatation[q] + mean_bulk_[e] * sum / volume;
      pressure += share * (next - pressure);
    }
  }
}

}  // namespace palpate::solid
