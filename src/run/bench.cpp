// Measures the functions that a press calls with a clock.
#include "run/bench.h"

#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"
#include "mechanics/pressed_mesh.h"
#include "scene/first_touch.h"

namespace palpate::run {
namespace {

constexpr int warm_up = 50;  // frames before the counted ones, to fill caches

template <class Work>
double seconds(const Work& work) {
  const Stopwatch watch;
  work();
  return watch.seconds();
}

// Times the stages separately.
class Stages {
 public:
  Stages(const scene::Scene& scene, int substeps)
      : mesh_(scene), seeing_(mesh_.part()), substeps_(substeps) {
    mesh_.set_step(scene.specimen->plan.substep);
  }

  // `before` and `after` are the touches of the complete press before and after this frame.
  std::optional<std::string> frame(const mechanics::Touch& before, const mechanics::Touch& after,
                                   FrameTime& time) {
    std::optional<std::string> wrong;
    const bool follows = mesh_.forces_follow_finger();
    // Forces that follow the finger use contacts with the surface at rest.
    const auto* const deformed = follows ? nullptr : &mesh_.state().displacement;
    mechanics::Touch touch = before;
    for (int k = 1; k <= substeps_ && !wrong; ++k) {
      const Vec3 finger =
          before.finger + static_cast<double>(k) / substeps_ * (after.finger - before.finger);
      const double search = seconds([&] { seeing_.detect(finger, deformed); });
      time.collision += search;
      if (follows) {
        time.force += seconds([&] { wrong = mesh_.try_out(finger, touch); }) - search;
        continue;
      }
      const auto solve = [&](mechanics::Touch& now) {
        return seeing_.settle(
            now, [](auto&, auto& compliance) -> auto& { return compliance; }, 1);
      };
      time.force += seconds([&] { wrong = seeing_.find(finger, touch, solve); });
    }
    if (wrong) return wrong;
    time.deformation = seconds([&] {
      for (int k = 0; k < substeps_ && !wrong; ++k) wrong = mesh_.move(after);
    });
    return wrong;
  }

  [[nodiscard]] double displacement() {
    return mesh_.displacement()
        .reshaped<Eigen::RowMajor>(Eigen::AutoSize, 3)
        .rowwise()
        .norm()
        .maxCoeff();
  }

 private:
  mechanics::PressedMesh mesh_;
  mechanics::SurfaceContacts seeing_;
  int substeps_;
};

}  // namespace

Bench bench(const scene::Scene& scene, int frames) {
  const scene::TimePlan& plan = scene.specimen->plan;
  const int all = warm_up + frames;
  const double deepest = scene::deepest_travel(scene.scenario, scene.law());
  mechanics::PressedMesh mesh(scene);
  mesh.set_step(plan.substep);
  Stages stages(scene, plan.substeps);
  mechanics::ContactHistory history(scene);
  mechanics::Touch touch;
  const Vec3 first = scene::first_touch(scene).finger;
  touch.finger = first;
  Bench found;
  // The complete frames are timed first and the stages afterwards on a second mesh; interleaved
  // they would disturb each other's caches.
  std::vector<FrameTime> times;
  std::vector<mechanics::Touch> touches{touch};
  for (int frame = 0; frame < all; ++frame) {
    std::optional<std::string> wrong;
    FrameTime time;
    time.whole = seconds([&] {
      for (int k = 1; k <= plan.substeps && !wrong; ++k) {
        const double done = frame + static_cast<double>(k) / plan.substeps;
        touch.travel = deepest * done / all;
        wrong =
            mesh.step(first - touch.travel * Vec3::UnitZ(), done * plan.time_step, history, touch);
      }
    });
    if (wrong) {
      found.wrong = "frame " + std::to_string(frame + 1) + ": " + *wrong;
      break;
    }
    times.push_back(time);
    touches.push_back(touch);
  }
  for (std::size_t frame = 0; frame < times.size(); ++frame) {
    const mechanics::Touch& after = touches[frame + 1];
    if (auto wrong = stages.frame(touches[frame], after, times[frame])) {
      found.wrong = "frame " + std::to_string(frame + 1) + ": " + *wrong;
      break;
    }
    if (frame >= warm_up) found.frames.push_back(times[frame]);
  }
  found.force = touch.force();
  found.displacement = stages.displacement();
  return found;
}

double percentile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace palpate::run
