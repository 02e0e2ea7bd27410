// A list that reuses the memory of removed elements for new ones.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace palpate::mechanics {

// Element::renew() resets an element but keeps the memory of its own lists. Nothing is allocated
// unless the list becomes longer than it has ever been.
template <class Element>
class KeptList {
 public:
  KeptList() = default;
  ~KeptList() = default;
  KeptList(const KeptList& other) : all_(other.begin(), other.end()), size_(other.size_) {}
  KeptList(KeptList&& other) noexcept
      : all_(std::move(other.all_)), size_(std::exchange(other.size_, 0)) {}
  KeptList& operator=(const KeptList& other) {
    if (this == &other) return *this;
    resize(other.size_);
    std::copy(other.begin(), other.end(), begin());
    return *this;
  }
  // Both lists keep the memory of their elements.
  KeptList& operator=(KeptList&& other) noexcept {
    swap(other);
    other.clear();
    return *this;
  }
  void swap(KeptList& other) noexcept {
    all_.swap(other.all_);
    std::swap(size_, other.size_);
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t room() const { return all_.size(); }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] auto begin() { return all_.begin(); }
  [[nodiscard]] auto begin() const { return all_.begin(); }
  [[nodiscard]] auto end() { return all_.begin() + static_cast<std::ptrdiff_t>(size_); }
  [[nodiscard]] auto end() const { return all_.begin() + static_cast<std::ptrdiff_t>(size_); }
  [[nodiscard]] Element& operator[](std::size_t i) { return all_[i]; }
  [[nodiscard]] const Element& operator[](std::size_t i) const { return all_[i]; }
  [[nodiscard]] Element& front() { return all_.front(); }
  [[nodiscard]] const Element& front() const { return all_.front(); }

  // Appends a reset element.
  Element& add() {
    if (size_ == all_.size())
      all_.emplace_back();
    else
      all_[size_].renew();
    return all_[size_++];
  }
  void resize(std::size_t size) {
    size_ = std::min(size, size_);
    while (size_ < size) (void)add();
  }
  void clear() { size_ = 0; }
  void erase(std::size_t i) {
    for (; i + 1 < size_; ++i) std::swap(all_[i], all_[i + 1]);
    --size_;
  }
  // Calls leaves(element) once per element, in order, and removes those for which it returns true.
  template <class Leaves>
  void erase_if(const Leaves& leaves) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      if (leaves(all_[i])) continue;
      if (kept != i) std::swap(all_[kept], all_[i]);
      ++kept;
    }
    size_ = kept;
  }
  // Allocates at least `count` elements and calls reserve(element) for every allocated element.
  template <class Reserve>
  void make_room(std::size_t count, const Reserve& reserve) {
    if (all_.size() < count) all_.resize(count);
    for (Element& one : all_) reserve(one);
  }

 private:
  std::vector<Element> all_;  // elements beyond size_ are kept for their memory
  std::size_t size_ = 0;
};

}  // namespace palpate::mechanics
