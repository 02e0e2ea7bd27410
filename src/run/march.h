// Series of solver steps under loads known in advance, and cases as coroutines that request them.
#pragma once

#include <coroutine>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mechanics/monitor.h"
#include "mechanics/stepper.h"
#include "scene/scene.h"
#include "tissue/lane_springs.h"

namespace palpate::run {

struct March {
  // The body that moves. In a lane only time and displacement of the state are updated.
  const scene::SpringBody* body = nullptr;
  mechanics::EnergyMonitor* monitor = nullptr;
  mechanics::Stepper* stepper = nullptr;
  integrate::State* state = nullptr;
  int standing = 0;  // changes when body and state have been replaced

  std::vector<double> times;                     // s, at the end of every step
  tissue::SparseLoad load;                       // N, in all of them
  std::optional<tissue::SparseLoad> first_load;  // N, in the first step, after a jump of the load
  integrate::MemoryRule rule = integrate::MemoryRule::exact;
  bool force_wanted = false;

  // Results:
  std::size_t done = 0;              // number of steps completed
  std::optional<std::string> wrong;  // error in the step after these
  integrate::Vector force;           // N, of the springs at the end, if force_wanted

  // Clears times, first load and results for the next series of steps of the same body.
  void clear();
};

// Carries out the steps of one body alone.
void carry_out(March& march);

// Whether a case can be computed in a lane: a uniform test by central differences, with linear
// kinematics and without dashpots between nodes (LaneSprings::can).
[[nodiscard]] bool suits_lanes(const scene::Scene& scene);

// A case as a coroutine: it pauses whenever its mesh has to be advanced, which its caller does.
class [[nodiscard]] Course {
 public:
  struct promise_type {  // NOLINT: the name that the language wants
    March* march = nullptr;
    std::exception_ptr failure;

    Course get_return_object() {
      return Course(std::coroutine_handle<promise_type>::from_promise(*this));
    }
    std::suspend_always initial_suspend() noexcept { return {}; }
    std::suspend_always final_suspend() noexcept { return {}; }
    std::suspend_always yield_value(March& wanted) noexcept {
      march = &wanted;
      return {};
    }
    void return_void() noexcept {}
    void unhandled_exception() { failure = std::current_exception(); }
  };

  Course(Course&& other) noexcept : handle_(std::exchange(other.handle_, {})) {}
  Course& operator=(Course&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Course() {
    if (handle_) handle_.destroy();
  }

  // Continues to the next march, which the caller carries out before the next call; null at the end
  // of the case. Rethrows exceptions of the case.
  [[nodiscard]] March* next();

 private:
  explicit Course(std::coroutine_handle<promise_type> handle) : handle_(handle) {}
  std::coroutine_handle<promise_type> handle_;
};

// Runs a case to its end alone.
void carry_out(Course course);

}  // namespace palpate::run
