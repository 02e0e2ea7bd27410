// Interpolation over radii and places.
#include "mechanics/body_surface_displacement.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "contact/hertz.h"
#include "scene/first_touch.h"
#include "scene/refining_press.h"
#include "scene/specimen_shape.h"

namespace palpate::mechanics {
namespace {

// An energy-optimal contact on a thin layer is at most sqrt(2) times as wide as Hertz's.
constexpr double widest = 1.4;
constexpr double stated = 1e-9;  // weights below it count as none

// The largest part of s, and of the half-space's surface displacement, by which e corrects s.
constexpr double most_corrected = 0.75;
constexpr double least_corrected = 0.02;

// s + e, m/N. Where e is larger than s the mesh is too coarse, and the correction is limited.
// `known` is the part of the half-space's surface displacement that e may correct, m/N.
double corrected(const BeyondHalfSpace& beyond, double known) {
  return beyond.surface_displacement +
         std::min(beyond.error, most_corrected * std::abs(beyond.surface_displacement) + known);
}

}  // namespace

BodySurfaceDisplacement::BodySurfaceDisplacement(const scene::Scene& scene,
                                                 const tissue::Part& part,
                                                 std::span<const char> held, double deepest)
    : scene_(&scene),
      part_(&part),
      held_(held.begin(), held.end()),
      surface_(&*scene.specimen->surface),
      largest_(widest * contact::hertz::contact_radius(deepest, scene.law().radius)),
      modulus_(scene.scenario.tissue.young_modulus),
      plane_modulus_(
          1.0 / (1.0 - scene.scenario.tissue.poisson_ratio * scene.scenario.tissue.poisson_ratio)),
      shear_compliance_((2.0 - scene.scenario.tissue.poisson_ratio) * 2.0 *
                        (1.0 + scene.scenario.tissue.poisson_ratio)),
      rubs_(scene.scenario.contact.friction > 0.0 && !scene.layer &&
            scene.scenario.contact.slip == scenario::Contact::Slip::mindlin &&
            scene.specimen->base == tissue::Base::bonded),
      first_(scene::first_touch(scene).at) {
  // Between regions a vertex belongs to the tissue of the triangle that is asked for first.
  if (scene.surface_displacements != nullptr && !scene.scenario.solver.rings &&
      scene.scenario.regions.empty())
    key_ = key();
}

// All that a Place in one tissue depends on, except for its vertex and normal.
std::string BodySurfaceDisplacement::key() const {
  const scenario::Resolved& scenario = scene_->scenario;
  std::string key = scene::shape_key(scenario);
  if (scene::refines(scenario)) key += scene::refining_key(scenario);
  const auto add = [&](double number) { key += " " + number_text(number); };
  add(scenario.tissue.poisson_ratio);
  add(as_index(scenario.solver.model));
  add(as_index(scenario.solver.volume));
  add(scene_->specimen->base == tissue::Base::bonded ? 1.0 : 0.0);
  add(rubs_ ? 1.0 : 0.0);
  add(largest_);
  const Vec3 first = surface_->position(first_);
  for (Eigen::Index axis = 0; axis < 3; ++axis) add(first[axis]);
  return key;
}

void BodySurfaceDisplacement::make_couplings() {
  if (coupling_) return;
  coupling_.emplace(*scene_, *part_, held_, modulus_);
  if (!scene_->layer) return;
  const scene::Specimen& specimen = *scene_->specimen;
  std::vector<char> slides = held_;
  const double close = 1e-9 * specimen.height();
  for (std::size_t n = 0; n < part_->network.rest.size(); ++n)
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const double place = part_->network.rest[n][axis];
      if (place <= specimen.low[axis] + close || place >= specimen.high[axis] - close)
        slides[3 * n + as_index(axis)] = 1;
    }
  sliding_.emplace(*scene_, *part_, slides, modulus_);
}

// The presses of find_shear().
std::array<EnergyCoupling::Press, 3> BodySurfaceDisplacement::shear_presses(
    const contact::Patch& patch) {
  const Vec3 x = patch.axis;
  const Vec3 y = patch.normal.cross(x);
  return {{{patch, x}, {patch, y}, {patch, (x + y).normalized(), true}}};
}

// From loads along two axes and between them. The half-space's own is 3 q / (20 a), q = (2 - nu)/G.
Eigen::Matrix3d BodySurfaceDisplacement::find_shear(
    const contact::Patch& patch, std::span<const BeyondHalfSpace, 3> beyond) const {
  const auto along = [&](std::size_t load) {
    return corrected(beyond[load], least_corrected * 0.15 * shear_compliance_ / patch.a);
  };
  const Vec3 x = patch.axis;
  const Vec3 y = patch.normal.cross(x);
  const double of_x = along(0);
  const double of_y = along(1);
  const double of_both = along(2) - 0.5 * (of_x + of_y);
  return of_x * x * x.transpose() + of_y * y * y.transpose() +
         of_both * (x * y.transpose() + y * x.transpose());
}

BodySurfaceDisplacement::Place BodySurfaceDisplacement::evaluate(const contact::Patch& like) {
  make_couplings();
  Place place;
  place.normal = like.normal;
  std::vector<EnergyCoupling::Press> presses(radii, {like, -like.normal});
  for (std::size_t k = 0; k < radii; ++k) {
    presses[k].patch.axis = like.normal.unitOrthogonal();
    presses[k].patch.a = presses[k].patch.b = steps[k] * largest_;
  }
  std::vector<BeyondHalfSpace> sliding;
  if (sliding_) sliding = sliding_->beyond(presses);
  // A straight line over the radius serves for what the body adds to shear.
  constexpr std::size_t narrow = 1;
  constexpr std::size_t wide = 3;
  if (rubs_)
    for (const std::size_t k : {narrow, wide})
      for (const EnergyCoupling::Press& press : shear_presses(presses[k].patch))
        presses.push_back(press);
  std::vector<BeyondHalfSpace> all = coupling_->beyond(presses);
  for (std::size_t k = 0; k < radii; ++k) {
    const contact::Patch& patch = presses[k].patch;
    BeyondHalfSpace& beyond = all[k];
    if (sliding_) {
      const BeyondHalfSpace& slides = sliding[k];
      beyond.surface_displacement =
          0.5 * (beyond.surface_displacement - slides.surface_displacement);
      beyond.error = 0.5 * std::abs(beyond.error - slides.error);
      beyond.doubt = 0.5 * std::abs(beyond.doubt - slides.doubt);
      place.surface_displacement[k] = beyond.surface_displacement;
    } else {
      // 3/(5 E' a) is the half-space's own surface displacement, docs/theory.md [energy].
      place.surface_displacement[k] =
          corrected(beyond, least_corrected * 0.6 / (plane_modulus_ * patch.a));
    }
    place.error[k] = beyond.error;
    place.doubt[k] = beyond.doubt;
    if (k == 2) place.rest = std::move(beyond.rest);
  }
  if (rubs_) {
    const std::span shears(all.begin() + radii, all.end());
    const Eigen::Matrix3d low = find_shear(presses[narrow].patch, shears.first<3>());
    const Eigen::Matrix3d high = find_shear(presses[wide].patch, shears.last<3>());
    for (std::size_t k = 0; k < radii; ++k)
      place.shear[k] =
          low + (steps[k] - steps[narrow]) / (steps[wide] - steps[narrow]) * (high - low);
  }
  place.solution_error = coupling_->take_solution_error();
  if (sliding_)
    place.solution_error = std::max(place.solution_error, sliding_->take_solution_error());
  return place;
}

// From the store, or evaluated.
BodySurfaceDisplacement::Place BodySurfaceDisplacement::place_at(const contact::Patch& like,
                                                                 int vertex) {
  std::optional<Place> place;
  if (!key_.empty()) place = scene_->surface_displacements->find(key_, vertex, like.normal);
  if (!place) {
    place = evaluate(like);
    if (!key_.empty()) scene_->surface_displacements->keep(key_, vertex, *place);
  }
  solution_error_ = std::max(solution_error_, place->solution_error);
  return std::move(*place);
}

const BodySurfaceDisplacement::Place& BodySurfaceDisplacement::at_vertex(
    const contact::Patch& patch, std::size_t corner) {
  const int triangle = patch.at.triangle;
  const int vertex = surface_->surface().triangles[as_index(triangle)][corner];
  const Vec3& normal = surface_->corner_normal(triangle, corner);
  auto& sides = at_vertices_[vertex];
  for (const auto& [side, place] : sides)
    if (side == normal) return place;
  contact::Patch here = patch;
  here.at.weights = Vec3::Unit(static_cast<Eigen::Index>(corner));
  here.position = surface_->surface().vertices[as_index(vertex)];
  here.normal = normal;
  return sides.emplace_back(normal, place_at(here, vertex)).second;
}

// Fills shares_: linear weights of the corners or, in the triangle of the first touch, of that
// place and two corners.
void BodySurfaceDisplacement::spread(const contact::Patch& patch) {
  shares_.fill({});
  std::array<double, 3> weights{patch.at.weights[0], patch.at.weights[1], patch.at.weights[2]};
  if (patch.at.triangle == first_.triangle) {
    // The largest multiple of the first touch's weights that leaves no weight negative.
    double part = 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double own = first_.weights[static_cast<Eigen::Index>(k)];
      if (own > stated) part = std::min(part, weights[k] / own);
    }
    for (std::size_t k = 0; k < 3; ++k)
      weights[k] -= part * first_.weights[static_cast<Eigen::Index>(k)];
    if (part > stated) {
      if (!at_first_) {
        contact::Patch here = patch;
        here.at = first_;
        here.position = surface_->position(first_);
        here.normal = surface_->normal(first_);
        at_first_ = place_at(here, -1);
      }
      shares_[3] = {&*at_first_, part};
    }
  }
  for (std::size_t k = 0; k < 3; ++k)
    if (weights[k] > stated) shares_[k] = {&at_vertex(patch, k), weights[k]};
}

// On a crease the value changes from one side's to the other's as the perpendicular turns.
std::span<const BodySurfaceDisplacement::Side> BodySurfaceDisplacement::sides_of(
    const contact::Patch& patch) {
  sides_.fill({patch, 1.0});
  if (!(patch.turned > 0.0)) return std::span(sides_).first(1);
  sides_[1].patch.at = patch.beyond;
  sides_[0].part = 1.0 - patch.turned;
  sides_[1].part = patch.turned;
  return sides_;
}

BodySurfaceDisplacement::Polynomials BodySurfaceDisplacement::polynomials(double ratio) {
  const double x = std::min(ratio, steps.back());
  Polynomials at{.fading = std::exp(x - ratio)};
  for (std::size_t k = 0; k < radii; ++k) {
    double product = 1.0;
    double slope = 0.0;
    for (std::size_t j = 0; j < radii; ++j) {
      if (j == k) continue;
      const double gap = steps[k] - steps[j];
      slope = (slope * (x - steps[j]) + product) / gap;
      product *= (x - steps[j]) / gap;
    }
    at.product[k] = product;
    at.slope[k] = slope;
    at.value[k] = product + slope * (1.0 - at.fading);
  }
  return at;
}

BodySurfaceDisplacement::Value BodySurfaceDisplacement::at(const contact::Patch& patch) {
  Value value;
  const Polynomials over_radius = polynomials(patch.radius() / largest_);
  for (const auto& [side, part] : sides_of(patch)) {
    spread(side);
    for (const auto& [place, share] : shares_) {
      if (place == nullptr) continue;
      const double weight = part * share;
      for (std::size_t k = 0; k < radii; ++k) {
        const double surface_displacement = place->surface_displacement[k] / modulus_;
        value.surface_displacement += weight * over_radius.value[k] * surface_displacement;
        value.slope +=
            weight * over_radius.slope[k] * over_radius.fading / largest_ * surface_displacement;
        value.error += weight * over_radius.product[k] * place->error[k] / modulus_;
        value.doubt += weight * over_radius.product[k] * place->doubt[k] / modulus_;
      }
    }
  }
  return value;
}

Eigen::Matrix3d BodySurfaceDisplacement::shear(const contact::Patch& patch) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  if (!rubs_) return sum;
  const Polynomials over_radius = polynomials(patch.radius() / largest_);
  for (const auto& [side, part] : sides_of(patch)) {
    spread(side);
    for (const auto& [place, share] : shares_) {
      if (place == nullptr) continue;
      // The shortest rotation between the normals.                  docs/theory.md [between]
      const Eigen::Matrix3d turn =
          Eigen::Matrix3d::Identity() - (patch.normal + place->normal) * patch.normal.transpose() /
                                            (1.0 + patch.normal.dot(place->normal));
      const double weight = part * share;
      for (std::size_t k = 0; k < radii; ++k)
        sum += weight * over_radius.value[k] * turn * place->shear[k] * turn.transpose();
    }
  }
  sum /= modulus_;
  return sum;
}

std::vector<double> BodySurfaceDisplacement::errors(const contact::Patch& patch) {
  make_couplings();
  std::vector<double> errors = coupling_->beyond(patch, -patch.normal).errors;
  if (sliding_) {
    const std::vector<double> slides = sliding_->beyond(patch, -patch.normal).errors;
    for (std::size_t t = 0; t < errors.size(); ++t)
      errors[t] = 0.5 * std::abs(errors[t] - slides[t]);
  }
  for (double& error : errors) error /= modulus_;
  return errors;
}

double BodySurfaceDisplacement::rest(const Vec3& normal, const contact::Spread& read,
                                     std::span<const int> nodes, const contact::Patch& pressed) {
  spread(pressed);
  double sum = 0.0;
  for (const auto& [place, weight] : shares_) {
    if (place == nullptr) continue;
    for (std::size_t k = 0; k < read.vertices.size(); ++k)
      if (const int node = nodes[as_index(read.vertices[k])]; node >= 0)
        sum -= weight * read.shares[k] * normal.dot(place->rest.segment<3>(3 * node));
  }
  return sum / modulus_;
}

void BodySurfaceDisplacement::make_ready(double reach) {
  const Vec3 middle = surface_->position(first_);
  const auto& triangles = surface_->surface().triangles;
  contact::Patch patch;
  patch.at = first_;
  patch.position = middle;
  patch.normal = surface_->normal(first_);
  spread(patch);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    patch.at.triangle = static_cast<int>(t);
    const bool near = std::ranges::any_of(triangles[t], [&](int vertex) {
      return (surface_->surface().vertices[as_index(vertex)] - middle).norm() <= reach;
    });
    for (std::size_t k = 0; near && k < 3; ++k) (void)at_vertex(patch, k);
  }
}

}  // namespace palpate::mechanics
