#pragma once
#include <cstddef>
#include <new>
#include <vector>

namespace talus {

/// Allocates arrays that begin at a cache line, each at another place within the pages of memory. The system
/// gives large arrays whole pages, so that equal places of all of them would compete for the same few lines
/// of a cache: a loop over twenty arrays then reads each line from memory again and again.
template <class T>
class StaggeredAllocator {
  public:
    using value_type = T;
    StaggeredAllocator() = default;
    template <class U>
    StaggeredAllocator(const StaggeredAllocator<U>&) {}

    T* allocate(std::size_t count) {
        const std::size_t place = next_place();
        auto* whole = static_cast<std::byte*>(
            ::operator new (count * sizeof(T) + line + place, std::align_val_t{line}));
        std::byte* begin = whole + line + place;
        ::new (begin - sizeof(std::byte*)) std::byte*(whole);
        return reinterpret_cast<T*>(begin);
    }
    void deallocate(T* values, std::size_t) {
        auto* begin = reinterpret_cast<std::byte*>(values);
        ::operator delete (*std::launder(reinterpret_cast<std::byte**>(begin - sizeof(std::byte*))),
                           std::align_val_t{line});
    }
    friend bool operator==(const StaggeredAllocator&, const StaggeredAllocator&) { return true; }

  private:
    static constexpr std::size_t line = 64, lines_apart = 5, places = 13;
    static std::size_t next_place() {
        static std::size_t count = 0;
        return count++ % places * lines_apart * line;
    }
};

template <class T>
using StaggeredVector = std::vector<T, StaggeredAllocator<T>>;

}  // namespace talus
