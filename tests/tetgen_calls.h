// What tests that call TetGen share: the time that it is given, and what it is refused with.
#pragma once

#include <functional>
#include <string>

#include "base/error.h"
#include "refusal.h"

namespace palpate::test {

inline constexpr double time_given = 60.0;  // s: a hundred times what the tests' meshes need

inline std::string mesh_complaint(const std::function<void()>& work) {
  return refusal<MeshError>(work);
}

}  // namespace palpate::test
