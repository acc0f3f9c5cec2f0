// SPDX-License-Identifier: Apache-2.0
#include "component_pool.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <random>

namespace mamori::verification::bench {
namespace {

constexpr std::size_t kClassCount = 8U;

/// Base class, so that the name exists before the component.
struct NameOfOne {
    std::array<char, 21U> name{};  ///< digits of a 64-bit number, plus the terminator
};

class Counting : private NameOfOne, public Component {
  public:
    Counting() noexcept : Component(name.data()) {}
    std::uint64_t run_count{0U};

    /// Each component of a table has its own name.
    void set_name(std::size_t number) noexcept {
        static_cast<void>(std::to_chars(name.data(), name.data() + name.size() - 1U, number));
    }

  protected:
    ~Counting() = default;
};

/// Each class has its own function with different work, so that a linker does not fold them into one.
template <std::size_t kClass>
class CountingOf final : public Counting {
  public:
    Status on_execute(ContextHandle) noexcept override {
        ++run_count;
        work_ += kClass;
        return Status::kOk;
    }

  private:
    std::uint64_t work_{0U};
};

}  // namespace

struct ComponentPool::Block {
    CountingOf<1U> a;
    CountingOf<2U> b;
    CountingOf<3U> c;
    CountingOf<4U> d;
    CountingOf<5U> e;
    CountingOf<6U> f;
    CountingOf<7U> g;
    CountingOf<8U> h;
    std::array<Counting*, kClassCount> all{&a, &b, &c, &d, &e, &f, &g, &h};
};

ComponentPool::ComponentPool(std::size_t count, ClassOrder order)
    : block_count_((count + kClassCount - 1U) / kClassCount),
      blocks_(std::make_unique<Block[]>(block_count_)) {
    for (std::size_t i = 0U; i < block_count_ * kClassCount; ++i) {
        blocks_[i / kClassCount].all[i % kClassCount]->set_name(i);
    }
    if (order == ClassOrder::kMixed) {
        std::minstd_rand random{1U};  // the same order in each run
        for (std::size_t i = 0U; i < block_count_; ++i) {
            std::shuffle(blocks_[i].all.begin(), blocks_[i].all.end(), random);
        }
    }
}
ComponentPool::~ComponentPool() = default;

Component& ComponentPool::at(std::size_t index) noexcept {
    return *blocks_[index / kClassCount].all[index % kClassCount];
}

std::uint64_t ComponentPool::count_runs() const noexcept {
    std::uint64_t sum = 0U;
    for (std::size_t i = 0U; i < block_count_; ++i) {
        for (const Counting* component : blocks_[i].all) {
            sum += component->run_count;
        }
    }
    return sum;
}

}  // namespace mamori::verification::bench
