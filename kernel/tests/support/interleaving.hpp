// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs the two sides of a lock-free exchange in every interleaving of their steps, and counts them. A step
/// ends before each operation on an atomic and wherever a scenario calls step(), so the code under test is
/// the real one, cut where another core could come in between. The order is sequentially consistent: what a
/// weaker order allows on top is the matter of the memory-model test and of the thread sanitizer.
#ifndef MAMORI_KERNEL_TESTS_SUPPORT_INTERLEAVING_HPP
#define MAMORI_KERNEL_TESTS_SUPPORT_INTERLEAVING_HPP

#include <ucontext.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define MAMORI_TEST_THREAD_SANITIZER 1
#endif
#elif defined(__SANITIZE_THREAD__)
#define MAMORI_TEST_THREAD_SANITIZER 1
#endif
#ifdef MAMORI_TEST_THREAD_SANITIZER
extern "C" {
void* __tsan_get_current_fiber(void);
void* __tsan_create_fiber(unsigned flags);
void __tsan_switch_to_fiber(void* fiber, unsigned flags);
}
#endif

namespace mamori::testing_support {

/// Tells the thread sanitizer which stack runs; without it, nothing.
class SanitizerFiber {
  public:
#ifdef MAMORI_TEST_THREAD_SANITIZER
    static SanitizerFiber current() { return SanitizerFiber{__tsan_get_current_fiber()}; }
    static SanitizerFiber create() { return SanitizerFiber{__tsan_create_fiber(0U)}; }
    void announce() const { __tsan_switch_to_fiber(fiber_, 0U); }

  private:
    explicit SanitizerFiber(void* fiber) : fiber_(fiber) {}
    void* fiber_;
#else
    static SanitizerFiber current() { return {}; }
    static SanitizerFiber create() { return {}; }
    void announce() const {}
#endif
};

/// One side: a body on a stack of its own that runs from step to step.
class Side {
  public:
    Side() {
        static_cast<void>(getcontext(&own_));  // it has no way to fail
        own_.uc_stack.ss_sp = stack_.data();
        own_.uc_stack.ss_size = stack_.size();
        own_.uc_link = nullptr;
        makecontext(&own_, &Side::run_for_ever, 0);
    }
    Side(const Side&) = delete;
    Side& operator=(const Side&) = delete;

    /// Runs `body` up to its first step.
    void begin(std::function<void()> body) {
        body_ = std::move(body);
        is_done_ = false;
        resume();
    }
    /// Runs on to the next step, or to the end.
    void resume() {
        running() = this;
        caller_fiber_ = SanitizerFiber::current();
        fiber_.announce();
        static_cast<void>(swapcontext(&caller_, &own_));
        running() = nullptr;
    }
    bool is_done() const { return is_done_; }

    /// Ends the step that runs now; without effect outside an exploration.
    static void step() {
        if (running() != nullptr) {
            running()->pause();
        }
    }

  private:
    static Side*& running() {
        static Side* side = nullptr;
        return side;
    }
    /// A stack is made once and serves all interleavings: no run unwinds it.
    static void run_for_ever() {
        Side* const self = running();
        while (true) {
            self->body_();
            self->is_done_ = true;
            self->pause();
        }
    }
    void pause() {
        caller_fiber_.announce();
        static_cast<void>(swapcontext(&own_, &caller_));
    }

    ucontext_t own_{};
    ucontext_t caller_{};
    SanitizerFiber fiber_{SanitizerFiber::create()};
    SanitizerFiber caller_fiber_{SanitizerFiber::current()};
    std::vector<char> stack_ = std::vector<char>(std::size_t{256U} * 1024U);
    std::function<void()> body_;
    bool is_done_{true};
};

inline void step() {
    Side::step();
}

/// What an exploration found.
struct Exploration {
    std::uint64_t interleaving_count{0U};
    std::string violation;  ///< empty: none in any interleaving
    std::string schedule;   ///< of the violation: 'w' and 'r' in the order of the steps
};

/// Runs `Scenario` in every interleaving, or up to the first violation. A fresh one is made for each; it has
/// write_side(), read_side(), finish() (called after both) and a std::string member `violation`.
template <typename Scenario>
Exploration explore() {
    struct Choice {
        bool is_reader;
        bool has_other;  ///< the other side could have gone on here, and has not been tried yet
    };
    Exploration result;
    std::array<Side, 2> sides;
    std::vector<Choice> path;
    while (true) {
        Scenario scenario;
        sides[0].begin([&scenario] { scenario.write_side(); });
        sides[1].begin([&scenario] { scenario.read_side(); });
        for (std::size_t depth = 0U; !sides[0].is_done() || !sides[1].is_done(); ++depth) {
            if (depth == path.size()) {
                path.push_back({sides[0].is_done(), !sides[0].is_done() && !sides[1].is_done()});
            }
            sides[path[depth].is_reader ? 1U : 0U].resume();
        }
        scenario.finish();
        ++result.interleaving_count;
        if (!scenario.violation.empty()) {
            result.violation = scenario.violation;
            for (const Choice& choice : path) {
                result.schedule += choice.is_reader ? 'r' : 'w';
            }
            return result;
        }
        while (!path.empty() && !path.back().has_other) {
            path.pop_back();
        }
        if (path.empty()) {
            return result;
        }
        path.back() = {true, false};
    }
}

/// Stands in for std::atomic: each operation is one step.
template <typename T>
class SteppedAtomic {
  public:
    using value_type = T;
    static constexpr bool is_always_lock_free = true;                   // NOLINT: as std::atomic
    constexpr SteppedAtomic(T value = T{}) noexcept : value_(value) {}  // NOLINT: as std::atomic
    SteppedAtomic(const SteppedAtomic&) = delete;
    SteppedAtomic& operator=(const SteppedAtomic&) = delete;

    T load(std::memory_order) const noexcept {
        step();
        return value_;
    }
    void store(T value, std::memory_order) noexcept {
        step();
        value_ = value;
    }
    T exchange(T value, std::memory_order) noexcept {
        step();
        return std::exchange(value_, value);
    }
    bool compare_exchange_strong(T& expected, T value, std::memory_order, std::memory_order) noexcept {
        step();
        const bool is_equal = value_ == expected;
        (is_equal ? value_ : expected) = is_equal ? value : value_;
        return is_equal;
    }

  private:
    T value_;
};

/// Stands in for std::atomic: counts the atomic exchanges, and keeps the address of the last stored word.
template <typename T>
struct CountedAtomic : SteppedAtomic<T> {
    using SteppedAtomic<T>::SteppedAtomic;
    static inline std::uint32_t exchange_count{0U};
    static inline const void* last_stored{nullptr};

    void store(T value, std::memory_order order) noexcept {
        last_stored = this;
        SteppedAtomic<T>::store(value, order);
    }
    T exchange(T value, std::memory_order order) noexcept {
        ++exchange_count;
        return SteppedAtomic<T>::exchange(value, order);
    }
    bool compare_exchange_strong(T& expected, T value, std::memory_order success,
                                 std::memory_order failure) noexcept {
        ++exchange_count;
        return SteppedAtomic<T>::compare_exchange_strong(expected, value, success, failure);
    }
};

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_SUPPORT_INTERLEAVING_HPP
