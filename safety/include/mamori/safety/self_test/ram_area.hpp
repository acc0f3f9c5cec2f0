// SPDX-License-Identifier: Apache-2.0
/// @file
/// Memory as the march tests see it: words that are read and written exactly when the test says so.
///
/// @satisfies SWR-SLF-005, SWR-SLF-006      Design: docs/design/self_tests.md#memory
#ifndef MAMORI_SAFETY_SELF_TEST_RAM_AREA_HPP
#define MAMORI_SAFETY_SELF_TEST_RAM_AREA_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::safety {

/// Words of real memory, whatever objects live there.
///
/// Thread safety: none. Time: O(1), one access each. Memory: two words.
class RamArea final {
  public:
    using Word = std::uint32_t;

    /// @param[in] first lowest address, a multiple of the size of a word; not nullptr.
    /// @param[in] size  number of words, >= 1.
    constexpr RamArea(void* first, std::size_t size) noexcept : first_(first), size_(size) {
        MAMORI_REQUIRE(1, first != nullptr && size >= 1U);
    }

    constexpr std::size_t size() const noexcept { return size_; }
    /// @param[in] index 0 .. size() - 1; anything else is an own bug and ends in the assertion handler.
    Word read(std::size_t index) const noexcept {
        MAMORI_REQUIRE(2, index < size_);
        return static_cast<Cell*>(first_)[index];
    }
    void write(std::size_t index, Word value) noexcept {
        MAMORI_REQUIRE(3, index < size_);
        static_cast<Cell*>(first_)[index] = value;
    }

  private:
    // Volatile: each access is one. may_alias: whatever lives there is of another type.
    using Cell [[gnu::may_alias]] = volatile Word;

    void* first_;
    std::size_t size_;
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SELF_TEST_RAM_AREA_HPP
