// Work by number, taken by several threads from one counter.
#pragma once

#include <cstddef>
#include <functional>

namespace palpate::run {

// Calls work(i) once for every i below `count`, on `workers` threads, this one among them. Returns
// when all calls have; then rethrows the failure of the least i, if there was one.
void share_out(std::size_t count, int workers, const std::function<void(std::size_t)>& work);

}  // namespace palpate::run
