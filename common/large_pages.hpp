// Memory that is read from end to end in every step.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <vector>

namespace kerf {

/// An allocator that asks Linux for large pages where there is enough for one of them: what streams
/// through a core then waits less for the addresses of its pages.
template <class T> struct LargePages {
  using value_type = T;
  static constexpr std::size_t page = std::size_t{1} << 21; // bytes

  LargePages() = default;
  template <class Other> LargePages(const LargePages<Other>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < page)
      return static_cast<T*>(::operator new (bytes, std::align_val_t{alignof(T)}));
    void* const memory = ::operator new (bytes, std::align_val_t{page});
    ::madvise(memory, bytes, MADV_HUGEPAGE); // it works without, too
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    const std::size_t alignment = count * sizeof(T) < page ? alignof(T) : page;
    ::operator delete (memory, std::align_val_t{alignment});
  }

  friend bool operator==(const LargePages&, const LargePages&) = default;
};

template <class T> using LargeVector = std::vector<T, LargePages<T>>;

} // namespace kerf
