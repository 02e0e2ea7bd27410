// Steps of a mesh under loads that are known before it moves, and cases that stop to have them
// done.
#pragma once

#include <coroutine>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "run/monitor.h"
#include "run/stepper.h"
#include "scene/scene.h"
#include "tissue/lane_springs.h"

namespace palpate::run {

struct March {
  // What moves. In a lane the state gets its time and displacement, and no more.
  const scene::SpringBody* body = nullptr;
  EnergyMonitor* monitor = nullptr;
  Stepper* stepper = nullptr;
  integrate::State* state = nullptr;
  int standing = 0;  // another number: body and state have been set anew

  std::vector<double> times;              // s, at the end of every step
  std::vector<tissue::SparseLoad> loads;  // N, before the first step and after each; or one, which
                                          // stays
  std::optional<tissue::SparseLoad> first_load;  // N, that moves the first step instead, where the
                                                 // load has jumped and then stays
  integrate::MemoryRule rule = integrate::MemoryRule::exact;
  bool force_wanted = false;

  // What came of it.
  std::size_t done = 0;              // steps
  std::optional<std::string> wrong;  // with the step after those
  integrate::Vector force;           // N, of the springs at the end, where wanted

  [[nodiscard]] const tissue::SparseLoad& load(std::size_t step) const {
    return loads.size() == 1 ? loads.front() : loads[step];
  }
  // Ready for other steps of the same body.
  void clear();
};

// Does the steps of one body by itself.
void carry_out(March& march);

// Whether a scene's mesh moves in marches that lanes can do: central differences without dashpots
// between nodes, the loads known beforehand: of platens, or of a finger that does not feel the
// mesh move.
[[nodiscard]] bool suits_lanes(const scene::Scene& scene);

// A case on its way, which stops whenever its mesh is to be moved.
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

  // Goes on to the next march, which is to be carried out before this is called again; null at the
  // end of the case. Throws what the case throws.
  [[nodiscard]] March* next();

 private:
  explicit Course(std::coroutine_handle<promise_type> handle) : handle_(handle) {}
  std::coroutine_handle<promise_type> handle_;
};

// The whole course of a case by itself.
void carry_out(Course course);

}  // namespace palpate::run
