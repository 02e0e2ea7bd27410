// Splits edges one after the other, so that triangles always fit together.
#include "solid/surface_net.h"

#include <algorithm>
#include <queue>
#include <set>

#include "base/error.h"
#include "geometry/smooth_surface.h"
#include "meshing/cgal_library.h"

namespace palpate::solid {
namespace {

std::array<int, 2> edge_of(const std::array<int, 3>& triangle, std::size_t side) {
  const int a = triangle[side];
  const int b = triangle[(side + 1) % 3];
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

Vec3 placed_onto(Vec3 point, const std::function<Vec3(const Vec3&)>& onto,
                 std::span<const Plane> planes) {
  point = onto(point);
  // A plane that is inclined to the surface moves the point off again.
  constexpr int most_rounds = 30;
  for (int i = 0; i < most_rounds && !planes.empty(); ++i) {
    const Vec3 before = point;
    for (const Plane& plane : planes) plane.place(point);
    if ((point - before).norm() <= 1e-12 * point.norm()) break;
    point = onto(point);
  }
  for (const Plane& plane : planes) plane.place(point);
  return point;
}

SurfaceNet::SurfaceNet(geometry::Surface surface, std::vector<int> numbers, Onto onto)
    : vertices_(std::move(surface.vertices)),
      triangles_(std::move(surface.triangles)),
      numbers_(std::move(numbers)),
      onto_(std::move(onto)) {
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) connect(t);
}

void SurfaceNet::connect(int triangle) {
  for (std::size_t side = 0; side < 3; ++side)
    at_[edge_of(triangles_[as_index(triangle)], side)].push_back(triangle);
}

void SurfaceNet::disconnect(int triangle) {
  for (std::size_t side = 0; side < 3; ++side) {
    const auto found = at_.find(edge_of(triangles_[as_index(triangle)], side));
    std::erase(found->second, triangle);
    if (found->second.empty()) at_.erase(found);
  }
}

int SurfaceNet::add(const Vec3& point) {
  vertices_.push_back(point);
  return static_cast<int>(vertices_.size()) - 1;
}

void SurfaceNet::add(const std::array<int, 3>& triangle, int number) {
  triangles_.push_back(triangle);
  numbers_.push_back(number);
  connect(static_cast<int>(triangles_.size()) - 1);
}

// On the true surface, on every plane on which both ends are, and on `also`.
Vec3 SurfaceNet::placed(const Edge& edge, double share, const Plane* also) const {
  const Vec3& a = vertices_[as_index(edge[0])];
  const Vec3& b = vertices_[as_index(edge[1])];
  std::vector<int> numbers;
  for (const int t : at_.at(edge)) numbers.push_back(numbers_[as_index(t)]);
  std::vector<Plane> on;
  if (also != nullptr) on.push_back(*also);
  for (const Plane& plane : planes_)
    if (plane.beyond(a) == 0.0 && plane.beyond(b) == 0.0) on.push_back(plane);
  return placed_onto(
      a + share * (b - a), [&](const Vec3& point) { return onto_(point, numbers); }, on);
}

int SurfaceNet::split(const Edge& edge, const Vec3& at) {
  const int middle = add(at);
  const std::vector<int> around = at_.at(edge);
  for (const int t : around) {
    const std::array<int, 3> whole = triangles_[as_index(t)];
    disconnect(t);
    std::array<int, 3> other = whole;
    for (std::size_t i = 0; i < 3; ++i) {
      if (whole[i] == edge[1]) triangles_[as_index(t)][i] = middle;
      if (whole[i] == edge[0]) other[i] = middle;
    }
    triangles_.push_back(other);
    numbers_.push_back(numbers_[as_index(t)]);
    connect(t);
    connect(static_cast<int>(triangles_.size()) - 1);
  }
  return middle;
}

Vec3 SurfaceNet::twice_area(const std::array<int, 3>& triangle) const {
  const auto& [a, b, c] = triangle;
  return (vertices_[as_index(b)] - vertices_[as_index(a)])
      .cross(vertices_[as_index(c)] - vertices_[as_index(a)]);
}

bool SurfaceNet::crease(const Edge& edge) const {
  const std::vector<int>& around = at_.at(edge);
  if (around.size() != 2 || numbers_[as_index(around[0])] != numbers_[as_index(around[1])])
    return true;
  const auto normal = [&](int t) { return twice_area(triangles_[as_index(t)]).normalized(); };
  return normal(around[0]).dot(normal(around[1])) < geometry::crease_cosine;
}

void SurfaceNet::cut(const Plane& plane) {
  constexpr double near_part = 0.3;
  // Vertices near the plane move along an edge that crosses it: those on creases along creases,
  // those on a plane that was cut before along that plane.
  std::vector<int> creases(vertices_.size(), 0);
  for (const auto& [edge, around] : at_)
    if (crease(edge))
      for (const int v : edge) ++creases[as_index(v)];
  struct Move {
    double share = near_part;
    Edge along{-1, -1};
    int from = -1;
  };
  std::map<int, Move> moves;
  for (const auto& entry : at_) {
    const Edge& edge = entry.first;
    const double a = plane.beyond(vertices_[as_index(edge[0])]);
    const double b = plane.beyond(vertices_[as_index(edge[1])]);
    if (!(a * b < 0.0)) continue;
    const bool on_crease = crease(edge);
    for (const int end : {0, 1}) {
      const int v = edge[as_index(end)];
      const double share = std::abs(end == 0 ? a : b) / (std::abs(a) + std::abs(b));
      if (creases[as_index(v)] > 2 || (creases[as_index(v)] > 0 && !on_crease)) continue;
      const bool leaves = std::ranges::any_of(planes_, [&](const Plane& before) {
        return before.beyond(vertices_[as_index(v)]) == 0.0 &&
               before.beyond(vertices_[as_index(edge[as_index(1 - end)])]) != 0.0;
      });
      Move& move = moves[v];
      if (!leaves && share < move.share) move = {share, edge, end};
    }
  }
  planes_.push_back(plane);
  std::vector<std::pair<int, Vec3>> places;
  for (const auto& [v, move] : moves) {
    if (move.from < 0 || !movable_) continue;
    places.emplace_back(v,
                        placed(move.along, move.from == 0 ? move.share : 1.0 - move.share, &plane));
  }
  for (const auto& [v, to] : places) vertices_[as_index(v)] = to;
  std::vector<Edge> crossing;
  const double rounding = 1e-9 * (vertices_.front() - vertices_.back()).norm();
  for (Vec3& vertex : vertices_)
    if (std::abs(plane.beyond(vertex)) < rounding) plane.place(vertex);
  for (const auto& [edge, around] : at_)
    if (plane.beyond(vertices_[as_index(edge[0])]) * plane.beyond(vertices_[as_index(edge[1])]) <
        0.0)
      crossing.push_back(edge);
  for (const Edge& edge : crossing) {
    const double a = std::abs(plane.beyond(vertices_[as_index(edge[0])]));
    const double b = std::abs(plane.beyond(vertices_[as_index(edge[1])]));
    split(edge, placed(edge, a / (a + b), &plane));
  }
}

void SurfaceNet::drop_below(const Plane& plane) {
  std::vector<std::array<int, 3>> kept;
  std::vector<int> numbers;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    bool below = false;
    for (const int v : triangles_[t]) below = below || plane.beyond(vertices_[as_index(v)]) < 0.0;
    if (below) continue;
    kept.push_back(triangles_[t]);
    numbers.push_back(numbers_[t]);
  }
  std::vector<int> renamed(vertices_.size(), -1);
  std::vector<Vec3> used;
  for (auto& triangle : kept)
    for (int& v : triangle) {
      int& name = renamed[as_index(v)];
      if (name < 0) {
        name = static_cast<int>(used.size());
        used.push_back(vertices_[as_index(v)]);
      }
      v = name;
    }
  vertices_ = std::move(used);
  triangles_ = std::move(kept);
  numbers_ = std::move(numbers);
  at_.clear();
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) connect(t);
}

// Repeats a step that adds no vertices, without those whose triangles cross after it.
void SurfaceNet::without_crossings(std::optional<int> whole,
                                   const std::function<void(SurfaceNet&)>& step) {
  if (!whole) return step(*this);
  constexpr int most_rounds = 6;
  std::vector<char> kept(vertices_.size(), 0);
  for (int round = 0; round < most_rounds; ++round) {
    SurfaceNet changed = *this;
    changed.kept_ = kept;
    step(changed);
    geometry::Surface outer{changed.vertices_, {}};
    for (std::size_t t = 0; t < changed.triangles_.size(); ++t)
      if (changed.numbers_[t] == *whole) outer.triangles.push_back(changed.triangles_[t]);
    const auto crossing = meshing::cgal_library::self_intersections(outer);
    if (crossing.empty() || round + 1 == most_rounds) {
      *this = std::move(changed);
      kept_.clear();
      return;
    }
    for (const auto& pair : crossing)
      for (const int t : pair)
        for (const int v : outer.triangles[as_index(t)]) kept[as_index(v)] = 1;
  }
}

void SurfaceNet::refine(const std::function<double(const Vec3&)>& size, std::optional<int> whole) {
  constexpr double longest = 1.6;
  constexpr std::size_t most_vertices = 200'000;
  struct Long {
    double excess;  // length over wanted length
    Edge edge;
    [[nodiscard]] bool operator<(const Long& other) const {
      return excess != other.excess ? excess < other.excess : edge > other.edge;
    }
  };
  if (movable_) {
    without_crossings(whole, [](SurfaceNet& net) { net.smooth(0.0); });
    without_crossings(whole, [](SurfaceNet& net) { net.turn_edges(); });
  }
  for (;;) {
    std::priority_queue<Long> waiting;
    const auto look = [&](const Edge& edge) {
      const Vec3& a = vertices_[as_index(edge[0])];
      const Vec3& b = vertices_[as_index(edge[1])];
      const double excess = (a - b).norm() / size(0.5 * (a + b));
      if (excess > longest) waiting.push({excess, edge});
    };
    for (const auto& [edge, around] : at_) look(edge);
    if (waiting.empty()) break;
    // Edges are turned after every halving of the longest ones.
    const double until = std::max(longest, 0.5 * waiting.top().excess);
    while (!waiting.empty() && waiting.top().excess > until) {
      const Edge edge = waiting.top().edge;
      waiting.pop();
      if (!at_.contains(edge)) continue;
      const Vec3& a = vertices_[as_index(edge[0])];
      const Vec3& b = vertices_[as_index(edge[1])];
      // Where the nearest place of the surface is on another wall, or near an end, the parts
      // would not become shorter. (Half a circle has 0.71.)
      constexpr double longest_part = 0.8;
      Vec3 there = placed(edge, 0.5);
      if (std::max((there - a).norm(), (there - b).norm()) > longest_part * (a - b).norm())
        there = 0.5 * (a + b);
      if (vertices_.size() > most_vertices)
        throw MeshError(
            "its surface would have more than 200 000 vertices, so small is the contact beside the "
            "body; press deeper, with a larger finger, or a part of the body");
      const int middle = split(edge, there);
      std::set<Edge> near;
      for (const int end : edge)
        for (const int t : at_.at({end, middle}))
          for (std::size_t side = 0; side < 3; ++side)
            near.insert(edge_of(triangles_[as_index(t)], side));
      for (const Edge& other : near) look(other);
    }
    if (movable_) turn_edges();
  }
  if (!movable_) return;
  without_crossings(whole, [](SurfaceNet& net) {
    constexpr int rounds = 4;
    for (int round = 0; round < rounds; ++round) {
      net.smooth(1.0);
      net.turn_edges();
    }
  });
}

// Moves every vertex without a crease, and on no plane or inside one, by a share of the way to the
// mean of its neighbours and onto the true surface, where no triangle turns by more than 60 degrees
// or becomes a needle.
void SurfaceNet::smooth(double share) {
  std::vector<std::set<int>> near(vertices_.size());
  std::vector<std::set<int>> around(vertices_.size());  // triangles
  std::vector<char> fixed(vertices_.size(), 0);
  for (const auto& [edge, triangles] : at_) {
    const bool border = crease(edge);
    for (const std::size_t end : {0, 1}) {
      const auto v = as_index(edge[end]);
      near[v].insert(edge[1 - end]);
      around[v].insert(triangles.begin(), triangles.end());
      if (border) fixed[v] = 1;
    }
  }
  const auto own_area = [&](int t) { return twice_area(triangles_[as_index(t)]); };
  const auto needle = [&](int t) {
    constexpr double least = 0.1;  // of the sum of the squared edges; 0.577 for equal ones
    const auto& corners = triangles_[as_index(t)];
    double squares = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      squares += (vertices_[as_index(corners[i])] - vertices_[as_index(corners[(i + 1) % 3])])
                     .squaredNorm();
    return own_area(t).norm() < least * squares;
  };
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    if (fixed[v] != 0 || near[v].empty() || (!kept_.empty() && kept_[v] != 0)) continue;
    const Vec3 before = vertices_[v];
    Vec3 middle = Vec3::Zero();
    for (const int other : near[v])
      middle += vertices_[as_index(other)] / static_cast<double>(near[v].size());
    middle = before + share * (middle - before);
    bool leaves = false;
    for (const Plane& plane : planes_) {
      if (plane.beyond(before) != 0.0) continue;
      for (const int other : near[v])
        leaves = leaves || plane.beyond(vertices_[as_index(other)]) != 0.0;
      plane.place(middle);
    }
    if (leaves) continue;
    std::vector<Vec3> normals;
    for (const int t : around[v]) normals.push_back(own_area(t).normalized());
    const int number = numbers_[as_index(*around[v].begin())];
    vertices_[v] = onto_(middle, {&number, 1});
    std::size_t i = 0;
    for (const int t : around[v])
      if (own_area(t).normalized().dot(normals[i++]) < 0.5 || needle(t)) {
        vertices_[v] = before;
        break;
      }
  }
}

// Delaunay's criterion between two triangles: the opposite angles sum to at most pi.
void SurfaceNet::turn_edges() {
  constexpr int most_rounds = 20;
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<Edge> edges;
    for (const auto& [edge, around] : at_) edges.push_back(edge);
    bool turned = false;
    for (const Edge& edge : edges) {
      const auto found = at_.find(edge);
      if (found == at_.end() || crease(edge)) continue;
      const Vec3& a = vertices_[as_index(edge[0])];
      const Vec3& b = vertices_[as_index(edge[1])];
      const std::array<int, 2> pair{found->second[0], found->second[1]};
      std::array<int, 2> tips{};
      for (std::size_t i = 0; i < 2; ++i)
        for (const int v : triangles_[as_index(pair[i])])
          if (v != edge[0] && v != edge[1]) tips[i] = v;
      if (!kept_.empty() &&
          std::ranges::any_of(tips, [&](int v) { return kept_[as_index(v)] != 0; }))
        continue;
      // An edge along a plane stays, but for those between triangles on it.
      if (std::ranges::any_of(planes_, [&](const Plane& plane) {
            return plane.beyond(a) == 0.0 && plane.beyond(b) == 0.0 &&
                   plane.beyond(vertices_[as_index(tips[0])]) != 0.0;
          }))
        continue;
      const auto angle = [&](int v) {
        const Vec3& tip = vertices_[as_index(v)];
        return angle_between(a - tip, b - tip);
      };
      if (angle(tips[0]) + angle(tips[1]) <= M_PI + 1e-6) continue;
      if (at_.contains({std::min(tips[0], tips[1]), std::max(tips[0], tips[1])})) continue;
      // A triangle with the edge in its own direction: (from, to, tip).
      std::array<int, 2> way = edge;
      const auto& first = triangles_[as_index(pair[0])];
      for (std::size_t i = 0; i < 3; ++i)
        if (first[i] == edge[1] && first[(i + 1) % 3] == edge[0]) way = {edge[1], edge[0]};
      const std::array<int, 3> one{way[0], tips[1], tips[0]};
      const std::array<int, 3> two{way[1], tips[0], tips[1]};
      const Vec3 before = twice_area(triangles_[as_index(pair[0])]);
      const Vec3 other = twice_area(triangles_[as_index(pair[1])]);
      const Vec3 mean = before.normalized() + other.normalized();
      const double least = 0.05 * std::min(before.norm(), other.norm());
      if (twice_area(one).dot(mean) < least || twice_area(two).dot(mean) < least) continue;
      for (const int t : pair) disconnect(t);
      triangles_[as_index(pair[0])] = one;
      triangles_[as_index(pair[1])] = two;
      for (const int t : pair) connect(t);
      turned = true;
    }
    if (!turned) return;
  }
}

std::vector<std::array<int, 2>> SurfaceNet::edges_on(const Plane& plane) const {
  std::vector<Edge> found;
  for (const auto& [edge, around] : at_)
    if (plane.beyond(vertices_[as_index(edge[0])]) == 0.0 &&
        plane.beyond(vertices_[as_index(edge[1])]) == 0.0)
      found.push_back(edge);
  return found;
}

}  // namespace palpate::solid
