// Newton's steps.
#include "solid/press.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/stop_scope.h"

namespace palpate::solid {
namespace {

struct FacePoint {
  std::array<double, 3> corners{};  // barycentric
  std::array<double, 6> values{};
  std::array<double, 6> along_1{}, along_2{};  // derivatives
  double weight = 0.0;                         // of the area of 1/2
};

// Values and derivatives of the six functions of a face.
FacePoint face_point(double x, double y, double weight) {
  const std::array<double, 3> l{1.0 - x - y, x, y};
  constexpr std::array<double, 3> dx{-1.0, 1.0, 0.0};
  constexpr std::array<double, 3> dy{-1.0, 0.0, 1.0};
  FacePoint at{.corners = l, .values = face_values(l), .weight = weight};
  for (std::size_t i = 0; i < 3; ++i) {
    at.along_1[i] = (4.0 * l[i] - 1.0) * dx[i];
    at.along_2[i] = (4.0 * l[i] - 1.0) * dy[i];
    const std::size_t j = (i + 1) % 3;
    at.along_1[3 + i] = 4.0 * (l[i] * dx[j] + l[j] * dx[i]);
    at.along_2[3 + i] = 4.0 * (l[i] * dy[j] + l[j] * dy[i]);
  }
  return at;
}

// Radon's rule with seven points, exact to degree five.
const std::array<FacePoint, 7>& rule() {
  static const std::array<FacePoint, 7> all = [] {
    const double root = std::sqrt(15.0);
    std::array<FacePoint, 7> found;
    std::size_t k = 0;
    found[k++] = face_point(1.0 / 3.0, 1.0 / 3.0, 9.0 / 80.0);
    for (const double sign : {-1.0, 1.0}) {
      const double a = (6.0 + sign * root) / 21.0;
      const double w = (155.0 + sign * root) / 2400.0;
      found[k++] = face_point(a, a, w);
      found[k++] = face_point(1.0 - 2.0 * a, a, w);
      found[k++] = face_point(a, 1.0 - 2.0 * a, w);
    }
    return found;
  }();
  return all;
}

}  // namespace

std::optional<Indenter::Meeting> Indenter::at(const Vec3& place) const {
  const auto& [c_1, c_2] = curvature;
  const double c = 0.5 * (c_1 + c_2);
  const Vec3 own = place - pole;
  const double upright = 1.0 - c * own.z();
  if (upright <= 0.0) return std::nullopt;
  const Vec3 down(c_1 * own.x(), c_2 * own.y(), -upright);
  const double inside =
      2.0 * own.z() - c_1 * own.x() * own.x() - c_2 * own.y() * own.y() - c * own.z() * own.z();
  const double length = down.norm();
  return Meeting{inside / (length + (c_1 == c_2 ? 1.0 : length)), down / length};
}

std::optional<double> Indenter::gap(const Vec3& place) const {
  const auto& [c_1, c_2] = curvature;
  const Vec3 own = place - pole;
  const double q = c_1 * own.x() * own.x() + c_2 * own.y() * own.y();
  const double root = 1.0 - 0.5 * (c_1 + c_2) * q;
  if (root < 0.0) return std::nullopt;
  return q / (1.0 + std::sqrt(root)) - own.z();
}

bool Indenter::near(const Vec3& place, double reach) const {
  const auto& [c_1, c_2] = curvature;
  const Vec3 own = place - pole;
  const double least = std::min(c_1, c_2);
  const double aside = own.head<2>().norm() + (least > 0.0 ? -reach : reach);
  const double lowest = least > 0.0 ? 0.5 * least * std::max(0.0, aside) * std::max(0.0, aside)
                                    : least * aside * aside;
  return own.z() + reach > lowest;
}

Contact::Contact(const Elements& elements, std::span<const OuterFace> faces, double stiffness)
    : stiffness_(stiffness) {
  const std::vector<Vec3>& nodes = elements.mesh().nodes;
  for (const OuterFace& face : faces) {
    Own own{.nodes = face.nodes};
    const auto node = [&](std::size_t a) -> const Vec3& { return nodes[as_index(own.nodes[a])]; };
    own.middle = (node(0) + node(1) + node(2)) / 3.0;
    for (std::size_t a = 0; a < 6; ++a)
      own.reach = std::max(own.reach, (node(a) - own.middle).norm());
    for (std::size_t q = 0; q < face_points; ++q) {
      const FacePoint& at = rule()[q];
      Vec3 first = Vec3::Zero();
      Vec3 second = Vec3::Zero();
      for (std::size_t a = 0; a < 6; ++a) {
        own.places[q] += at.values[a] * node(a);
        first += at.along_1[a] * node(a);
        second += at.along_2[a] * node(a);
      }
      const Vec3 across = first.cross(second);
      own.areas[q] = at.weight * across.norm();
      own.normals[q] = across.normalized();
    }
    std::size_t k = 0;
    for (std::size_t r = 0; r < 18; ++r)
      for (std::size_t c = 0; c <= r; ++c) {
        const int row = elements.unknown(3 * own.nodes[r / 3] + static_cast<int>(r % 3));
        const int column = elements.unknown(3 * own.nodes[c / 3] + static_cast<int>(c % 3));
        own.entries[k++] = row < 0 || column < 0
                               ? -1
                               : elements.entry(std::max(row, column), std::min(row, column));
      }
    faces_.push_back(own);
  }
}

std::vector<double> Contact::half_depths(std::span<const Indenter> indenters) const {
  std::vector<double> half(indenters.size(), 0.0);
  for (const Own& face : faces_)
    for (std::size_t i = 0; i < indenters.size(); ++i) {
      if (!indenters[i].near(face.middle, face.reach)) continue;
      for (const Vec3& place : face.places)
        if (const auto found = indenters[i].at(place))
          half[i] = std::max(half[i], 0.5 * found->depth);
    }
  return half;
}

template <class Visit>
void Contact::for_each(const Vector& displacement, std::span<const Indenter> indenters,
                       std::span<const double> least, const Visit& visit) const {
  for (const Own& face : faces_) {
    std::array<Vec3, 6> moved;
    double most = 0.0;
    for (std::size_t a = 0; a < 6; ++a) {
      moved[a] = displacement.segment<3>(3 * face.nodes[a]);
      most = std::max(most, moved[a].norm());
    }
    for (std::size_t i = 0; i < indenters.size(); ++i) {
      if (!indenters[i].near(face.middle, face.reach + most)) continue;
      for (std::size_t q = 0; q < face_points; ++q) {
        Vec3 change = Vec3::Zero();
        for (std::size_t a = 0; a < 6; ++a) change += rule()[q].values[a] * moved[a];
        const auto found = indenters[i].at(face.places[q] + change);
        if (!found) continue;
        const double s = indenters[i].share;
        const double depth = s * found->depth + (1.0 - s) * face.normals[q].dot(change);
        if (depth <= 0.0) continue;
        if (!least.empty()) {
          const auto undeformed = indenters[i].at(face.places[q]);
          if (!undeformed || undeformed->depth < least[i]) continue;
        }
        visit(face, q, i, Overlap{depth, s * found->normal - (1.0 - s) * face.normals[q]});
      }
    }
  }
}

void Contact::add(const Vector& displacement, std::span<const Indenter> indenters,
                  std::span<const double> least, Vector& force,
                  Eigen::SparseMatrix<double>& stiffness, std::vector<Met>& met) const {
  met.assign(indenters.size(), {});
  double* values = stiffness.valuePtr();
  for_each(displacement, indenters, least,
           [&](const Own& face, std::size_t q, std::size_t i, const Overlap& here) {
             const double pressure = stiffness_ * here.depth;
             const double area = face.areas[q];
             Met& own = met[i];
             own.force += area * pressure * here.push;
             own.work += area * pressure * here.depth;
             own.area += area;
             own.moment +=
                 area * pressure * (face.places[q] - indenters[i].pole).head<2>().squaredNorm();
             const std::array<double, 6>& n = rule()[q].values;
             for (std::size_t a = 0; a < 6; ++a)
               force.segment<3>(3 * face.nodes[a]) -= n[a] * area * pressure * here.push;
             const Eigen::Matrix3d change = area * stiffness_ * here.push * here.push.transpose();
             const int* entry = face.entries.data();
             for (std::size_t r = 0; r < 18; ++r)
               for (std::size_t c = 0; c <= r; ++c, ++entry)
                 if (*entry >= 0)
                   values[*entry] +=
                       n[r / 3] * n[c / 3] *
                       change(static_cast<Eigen::Index>(r % 3), static_cast<Eigen::Index>(c % 3));
           });
}

std::vector<Vec3> Contact::tractions(const Vector& displacement,
                                     std::span<const Indenter> indenters) const {
  const auto nodes = static_cast<std::size_t>(displacement.size() / 3);
  std::array<std::array<double, 6>, face_points> weights;
  for (std::size_t q = 0; q < face_points; ++q) weights[q] = part_values(rule()[q].corners);
  std::vector<double> areas(nodes, 0.0);
  std::vector<Vec3> mean(nodes, Vec3::Zero());
  const auto spread = [&](const Own& face, std::size_t q, const Vec3& traction,
                          std::vector<Vec3>& sums) {
    for (std::size_t a = 0; a < 6; ++a)
      sums[as_index(face.nodes[a])] += weights[q][a] * face.areas[q] * traction;
  };
  const auto divide = [&](std::vector<Vec3>& sums) {
    for (std::size_t n = 0; n < nodes; ++n)
      if (areas[n] > 0.0) sums[n] /= areas[n];
  };
  for (const Own& face : faces_)
    for (std::size_t q = 0; q < face_points; ++q)
      for (std::size_t a = 0; a < 6; ++a)
        areas[as_index(face.nodes[a])] += weights[q][a] * face.areas[q];
  for_each(displacement, indenters, {},
           [&](const Own& face, std::size_t q, std::size_t, const Overlap& here) {
             spread(face, q, stiffness_ * here.depth * here.push, mean);
           });
  divide(mean);
  std::vector<Vec3> again(nodes, Vec3::Zero());
  for (const Own& face : faces_)
    for (std::size_t q = 0; q < face_points; ++q) {
      Vec3 traction = Vec3::Zero();
      for (std::size_t a = 0; a < 6; ++a) traction += weights[q][a] * mean[as_index(face.nodes[a])];
      spread(face, q, traction, again);
    }
  divide(again);
  for (std::size_t n = 0; n < nodes; ++n) mean[n] += mean[n] - again[n];
  return mean;
}

double Contact::energy(const Vector& displacement, std::span<const Indenter> indenters) const {
  double sum = 0.0;
  for_each(displacement, indenters, {},
           [&](const Own& face, std::size_t q, std::size_t, const Overlap& here) {
             sum += 0.5 * face.areas[q] * stiffness_ * here.depth * here.depth;
           });
  return sum;
}

namespace {

constexpr double stiff = 100.0;     // penalty over E / h
constexpr double last_step = 3e-4;  // of the travel: Newton's, the next is a sixth of it or less
constexpr double longest = 0.5;     // of the size: a step's largest change of displacement
// Of the contact's force, by that step. A wall that bends bears little: within the displacement
// above, its force may be twice too large.
constexpr double last_change = 5e-3;
constexpr int most_steps = 40;
constexpr int most_halvings = 5;

Vec3 sum_of(std::span<const Met> met) {
  Vec3 sum = Vec3::Zero();
  for (const Met& one : met) sum += one.force;
  return sum;
}

}  // namespace

const tissue::Isotropic& tissue_at_top(const Body& body) {
  double top = -HUGE_VAL;
  int region = 0;
  for (const OuterFace& face : body.met) {
    const double z = body.mesh.nodes[as_index(face.nodes[0])].z();
    if (z <= top) continue;
    top = z;
    region = body.mesh.regions[as_index(face.element)];
  }
  return body.tissues[as_index(region)];
}

double Answer::normal() const { return std::accumulate(forces.begin(), forces.end(), 0.0); }

Press::Press(Body body)
    : body_(std::move(body)),
      elements_(body_.mesh, body_.tissues, body_.held),
      contact_(elements_, body_.met, stiff * tissue_at_top(body_).young_modulus / body_.size) {
  Vector force;
  elements_.assemble(Vector::Zero(static_cast<Eigen::Index>(3 * body_.mesh.nodes.size())), force,
                     linear_);
  factors_.analyse(linear_, elements_.first_unknowns());
}

void Press::begin(const Vec3& finger) {
  now_ = {finger, Vector::Zero(static_cast<Eigen::Index>(3 * body_.mesh.nodes.size())),
          std::vector<double>(points * body_.mesh.elements.size(), 0.0)};
  has_before_ = false;
}

// Factors the stiffness with a share of the linear one, if it is not positive definite alone.
bool Press::factor() {
  constexpr double first_share = 0.02;
  constexpr double most_share = 50.0;
  double share = 0.0;
  for (;;) {
    StopScope::end_if_stopped();
    ++factorisations_;
    if (factors_.factor(stiffness_)) return true;
    const double more = std::max(first_share, 2.0 * share);
    share += more;
    if (share > most_share) return false;
    stiffness_ += more * linear_;
  }
}

// Solves stiffness_ x = right: by conjugate gradients with the last factors as preconditioner while
// these are near, else by new ones.                                                 decision 477
bool Press::solve(const Vector& right, Vector& x) {
  constexpr double tolerance = 0.05;  // a sixth is what Newton's next step leaves of this one
  constexpr std::size_t enough = 12;  // iterations after which the factors are near no more
  constexpr std::size_t most = 16;
  if (near_) {
    std::size_t iterations = 0;
    double error = 0.0;
    vectors_.right = right;
    vectors_.x.setZero(right.size());
    const bool solved = conjugate_gradients<1>(
        vectors_, tolerance, most,
        [&](const Vector& p, Vector& image) {
          ++iterations;
          image = stiffness_.selfadjointView<Eigen::Lower>() * p;
        },
        [&](const Vector& r, Vector& z) { factors_.solve(r, z); },
        [](std::size_t, double, double next) { return next; }, error);
    near_ = iterations <= enough;
    if (solved) {
      x = vectors_.x;
      return true;
    }
  }
  const int before = factorisations_;
  if (!factor()) return false;
  near_ = factorisations_ == before + 1;  // without a share of the linear stiffness
  factors_.solve(right, x);
  return true;
}

// Of an indenter with its pole there, in the mirrors through the finger's point: 0 beyond one,
// where it is the image of another.
int Press::images_of(const Vec3& pole) const {
  const double near = 1e-6 * body_.size;
  int images = 1;
  for (const int axis : {0, 1}) {
    if (!body_.mirrored[as_index(axis)] || std::abs(pole[axis]) < near) continue;
    images *= pole[axis] > 0.0 ? 2 : 0;
  }
  return images;
}

// Whether the vertical line through a place leaves the displaced body where it is outside already,
// or enters it where it is inside.
bool Press::walls_cross(const Vector& displacement, const Vec3& place) const {
  // Beside the edges that lie on mirrors.
  const Vec3 line = place + body_.size * Vec3(0.0131, 0.0073, 0.0);
  std::vector<std::pair<double, bool>> crossings;  // height, and whether it enters from above
  for (const OuterFace& face : body_.mesh.boundary) {
    std::array<Vec3, 6> at;
    for (std::size_t i = 0; i < 6; ++i)
      at[i] = body_.mesh.nodes[as_index(face.nodes[i])] +
              displacement.segment<3>(3 * face.nodes[i]) - line;
    for (const auto& [a, b, c] : face_parts) {
      const auto twice = [&](std::size_t from, std::size_t to) {
        return at[from].x() * at[to].y() - at[from].y() * at[to].x();
      };
      const double of_a = twice(b, c), of_b = twice(c, a), of_c = twice(a, b);
      const double sum = of_a + of_b + of_c;
      if (sum == 0.0 || std::min({of_a / sum, of_b / sum, of_c / sum}) <= 0.0) continue;
      crossings.emplace_back((of_a * at[a].z() + of_b * at[b].z() + of_c * at[c].z()) / sum,
                             sum > 0.0);
    }
  }
  std::sort(crossings.rbegin(), crossings.rend());
  bool inside = false;
  for (const auto& [height, enters] : crossings) {
    if (enters == inside) return true;
    inside = enters;
  }
  return false;
}

std::vector<Indenter> Press::finger_at(const Vec3& place) const {
  std::vector<Indenter> moved = indenters_;
  for (Indenter& one : moved) one.pole += place;
  return moved;
}

std::optional<Answer> Press::settle(const Vec3& finger, bool extrapolate) {
  const std::vector<Indenter> indenters = finger_at(finger);
  Vector u = now_.displacement;
  std::vector<double> pressures = now_.pressures;
  if (extrapolate) {
    const double way = (now_.finger - before_.finger).norm();
    const double share = (finger - now_.finger).norm() / way;
    u += share * (now_.displacement - before_.displacement);
    for (std::size_t i = 0; i < pressures.size(); ++i)
      pressures[i] += share * (now_.pressures[i] - before_.pressures[i]);
  }
  elements_.set_pressures(std::move(pressures));
  Vector force;
  Vector right(elements_.unknowns());
  Vector solution;
  Vector step = Vector::Zero(u.size());
  std::vector<Met> met;
  const std::vector<double> half = contact_.half_depths(indenters);
  const std::span<const double> none;
  near_ = false;
  walls_meet_ = false;
  for (int i = 0; i < most_steps; ++i) {
    const double least = elements_.assemble(u, force, stiffness_);
    if (!(least > -1.0)) return std::nullopt;
    contact_.add(u, indenters, i == 0 ? std::span(half) : none, force, stiffness_, met);
    const Vec3 before = sum_of(met);
    for (int d = 0; d < static_cast<int>(u.size()); ++d)
      if (const int unknown = elements_.unknown(d); unknown >= 0) right[unknown] = -force[d];
    if (!solve(right, solution)) return std::nullopt;
    const double most = solution.size() > 0 ? solution.cwiseAbs().maxCoeff() : 0.0;
    if (!std::isfinite(most)) return std::nullopt;
    const double share = std::min(1.0, longest * body_.size / most);
    for (int d = 0; d < static_cast<int>(u.size()); ++d)
      if (const int unknown = elements_.unknown(d); unknown >= 0) step[d] = solution[unknown];
    elements_.advance(u, step, share);
    u += share * step;
    if (i == 0 || most > last_step * body_.travel) continue;
    const double folded = elements_.assemble(u, force, stiffness_);
    if (!(folded > 0.0)) return std::nullopt;
    walls_meet_ = std::any_of(indenters.begin(), indenters.end(),
                              [&](const Indenter& one) { return walls_cross(u, one.pole); });
    if (walls_meet_) return std::nullopt;
    contact_.add(u, indenters, none, force, stiffness_, met);
    const Vec3 after = sum_of(met);
    if ((after - before).norm() > last_change * after.norm()) continue;
    Answer answer;
    answer.force = -body_.copies * after;
    double work = 0.0;
    double moment = 0.0;
    for (std::size_t k = 0; k < met.size(); ++k) {
      const Met& one = met[k];
      answer.forces.push_back(-body_.copies * one.force.z());
      work += body_.copies * one.work;
      moment += body_.copies * one.moment;
      answer.area += body_.copies * one.area;
      if (one.area > 0.0) answer.touching += images_of(indenters_[k].pole);
    }
    for (int axis = 0; axis < 2; ++axis)
      if (body_.mirrored[as_index(axis)]) answer.force[axis] = 0.0;
    if (answer.normal() > 0.0) {
      answer.lost = work / answer.normal();
      answer.spread = std::sqrt(moment / answer.normal());
    }
    for (const Vec3& traction : contact_.tractions(u, indenters))
      answer.peak = std::max(answer.peak, traction.norm());
    before_ = std::move(now_);
    has_before_ = true;
    now_ = {finger, std::move(u), elements_.pressures()};
    return answer;
  }
  return std::nullopt;
}

std::optional<Answer> Press::go(const Vec3& finger) {
  Vec3 wanted = finger;
  int halved = 0;
  for (;;) {
    const Vec3 way = wanted - now_.finger;
    const Vec3 last = now_.finger - before_.finger;
    const bool straight = has_before_ && way.norm() < 4.0 * last.norm() &&
                          way.dot(last) > 0.99 * way.norm() * last.norm();
    auto found = settle(wanted, straight);
    if (!found && straight) found = settle(wanted, false);
    if (found && wanted == finger) return found;
    if (found) {
      wanted = finger;
      continue;
    }
    if (++halved > most_halvings) return std::nullopt;
    wanted = 0.5 * (now_.finger + wanted);
  }
}

std::optional<Vector> Press::look(const Vec3& finger) {
  const State now = now_, before = before_;
  const bool had_before = has_before_;
  const auto found = go(finger);
  std::optional<Vector> displacement;
  if (found) displacement = std::move(now_.displacement);
  now_ = now;
  before_ = before;
  has_before_ = had_before;
  return displacement;
}

}  // namespace palpate::solid
