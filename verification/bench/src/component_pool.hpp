// SPDX-License-Identifier: Apache-2.0
/// @file
/// Components with minimal work, for the scheduler cases. Only one source file contains their classes, so
/// that no compiler can replace a virtual call in another file by its body.
#ifndef MAMORI_VERIFICATION_BENCH_COMPONENT_POOL_HPP
#define MAMORI_VERIFICATION_BENCH_COMPONENT_POOL_HPP

#include <cstddef>
#include <cstdint>
#include <memory>

#include "mamori/kernel/component/component.hpp"

namespace mamori::verification::bench {

/// Order of components of different classes: always the same order of eight, or a different order for each
/// eight, which a processor cannot predict.
enum class ClassOrder : std::uint8_t { kInTurn, kMixed };

/// Components of several classes, adjacent in memory.
class ComponentPool {
  public:
    /// @param[in] count components, > 0.
    explicit ComponentPool(std::size_t count, ClassOrder order = ClassOrder::kInTurn);
    ~ComponentPool();
    ComponentPool(const ComponentPool&) = delete;
    ComponentPool& operator=(const ComponentPool&) = delete;

    /// @param[in] index 0 .. count - 1.
    Component& at(std::size_t index) noexcept;
    /// @return how often on_execute() of any of them was called.
    std::uint64_t count_runs() const noexcept;

  private:
    struct Block;
    std::size_t block_count_;
    std::unique_ptr<Block[]> blocks_;
};

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_COMPONENT_POOL_HPP
