// Distributes numbered tasks to several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace palpate::run {

// Calls work(i) once for every i below `count`, on `workers` threads including the calling one.
// All of them have the calling thread's StopScope. Returns when all calls have ended; rethrows the
// exception of the smallest i that had one.
void share_out(std::size_t count, int workers, const std::function<void(std::size_t)>& work);

}  // namespace palpate::run
