// Data as bytes from a child process to its parent, the same program with the same byte order.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/vec3.h"

namespace palpate::meshing {

template <typename Item>
void append(std::string& bytes, const Item* items, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<Item>);
  bytes.append(reinterpret_cast<const char*>(items), count * sizeof(Item));
}

// Lists are preceded by their lengths.
template <typename Item>
void append(std::string& bytes, const std::vector<Item>& items) {
  const std::size_t count = items.size();
  append(bytes, &count, 1);
  append(bytes, items.data(), count);
}
inline void append(std::string& bytes, const std::vector<Vec3>& places) {
  const std::size_t count = places.size();
  append(bytes, &count, 1);
  for (const Vec3& place : places) append(bytes, place.data(), 3);
}

// Takes items in the order in which they were appended.
class ChildBytes {
 public:
  // `library` is the name of the library that the child ran. Both must outlive this object.
  ChildBytes(const std::string& bytes, const char* library) : bytes_(bytes), library_(library) {}

  // Throws MeshError if fewer than `count` items are left.
  template <typename Item>
  void take(Item* items, std::size_t count) {
    require<Item>(count);
    if (count > 0) std::memcpy(items, bytes_.data() + at_, count * sizeof(Item));
    at_ += count * sizeof(Item);
  }
  template <typename Item>
  void take(std::vector<Item>& items) {
    const std::size_t count = take_count();
    require<Item>(count);
    items.resize(count);
    take(items.data(), count);
  }
  void take(std::vector<Vec3>& places) {
    for (std::size_t left = take_count(); left > 0; --left) take(places.emplace_back().data(), 3);
  }
  [[nodiscard]] bool done() const { return at_ == bytes_.size(); }
  [[noreturn]] void refuse() const {
    throw MeshError("the data from " + std::string(library_) + " are incomplete; run it again");
  }

 private:
  std::size_t take_count() {
    std::size_t count = 0;
    take(&count, 1);
    return count;
  }
  template <typename Item>
  void require(std::size_t count) const {
    if (count > (bytes_.size() - at_) / sizeof(Item)) refuse();
  }

  const std::string& bytes_;
  const char* library_;
  std::size_t at_ = 0;
};

}  // namespace palpate::meshing
