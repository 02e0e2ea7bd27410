// METIS uses rand(), which all threads share: without this lock its orders would depend on them.
#pragma once

#include <mutex>

namespace palpate {

// Held by whoever calls METIS.
std::mutex& metis_lock();

}  // namespace palpate
