// SPDX-License-Identifier: Apache-2.0
// A real-time host with a thread for each piece of work. It complies with the contract or has one defect that
// requires work on another thread.
#ifndef MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_THREAD_HOST_HPP
#define MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_THREAD_HOST_HPP

#include <array>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "mamori/ports/conformance/host_contract.hpp"

namespace mamori::ports::conformance {

enum class ThreadFlaw { kNone, kSaysReturnedTooEarly, kCutsTooEarly, kCountsWhatHangs, kRunsStepTwice };

class ThreadHost final : public WindowHost {
  public:
    explicit ThreadHost(ThreadFlaw flaw) : flaw_(flaw) {}
    ~ThreadHost() {
        for (Window& window : windows_) {
            join(window);
        }
    }
    ThreadHost(const ThreadHost&) = delete;
    ThreadHost& operator=(const ThreadHost&) = delete;

    Instant get_now() const noexcept override {
        const auto since = std::chrono::steady_clock::now() - origin_;
        return {std::chrono::duration_cast<std::chrono::nanoseconds>(since).count()};
    }
    Instant get_step_end() const noexcept override { return get_now(); }
    bool has_returned(std::size_t window) const noexcept override {
        return flaw_ == ThreadFlaw::kSaysReturnedTooEarly || windows_[window].is_done.load();
    }

    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        Window& window = windows_[work.window];
        if (!window.is_done) {
            return 0U;  // only if the end was reported before
        }
        join(window);
        window.is_done = false;
        window.count = 0U;
        window.thread = std::thread{[this, &window, work, deadline] { serve(window, work, deadline); }};
        const Instant until = flaw_ == ThreadFlaw::kCutsTooEarly ? Instant{0} : deadline;
        while (!window.is_done && get_now() < until) {
            std::this_thread::yield();
        }
        const std::size_t count = window.count;
        const bool is_whole = count == work.count && window.is_done;
        if (flaw_ == ThreadFlaw::kCountsWhatHangs) {
            return work.count;
        }
        return is_whole || count < work.count ? count : work.count - 1U;
    }

  private:
    struct Window {
        std::thread thread;
        std::atomic<bool> is_done{true};
        std::atomic<std::size_t> count{0U};
    };

    void serve(Window& window, const Work& work, Instant deadline) noexcept {
        for (std::size_t i = 0U; i < work.count; ++i) {
            work.run(work.argument, work.first + i, work.first + i + 1U);
            if (flaw_ == ThreadFlaw::kRunsStepTwice && i == 0U) {
                work.run(work.argument, work.first, work.first + 1U);
            }
            if (get_now() > deadline) {
                break;
            }
            window.count = i + 1U;
        }
        window.is_done = true;
    }

    static void join(Window& window) {
        if (window.thread.joinable()) {
            window.thread.join();
        }
    }

    ThreadFlaw flaw_;
    std::chrono::steady_clock::time_point origin_{std::chrono::steady_clock::now()};
    std::array<Window, HostRig::kWindowCount> windows_;
};

class ThreadHostRig final : public HostRig {
  public:
    explicit ThreadHostRig(ThreadFlaw flaw) : host_(flaw) {}
    /// A host with a false report of an end still has hanging threads.
    ~ThreadHostRig() override {
        for (std::atomic<bool>& is_released : is_released_) {
            is_released = true;
        }
    }

    Instant get_now() const override { return host_.get_now(); }
    void wait_until(Instant instant) override {
        while (host_.get_now() < instant) {
            std::this_thread::yield();
        }
    }
    Duration get_tick() const override { return 200_us; }
    bool is_exact() const override { return false; }
    WindowHost& get_host() override { return host_; }
    void plan(const WindowHost::Work& work, const std::vector<StepPlan>&) override {
        is_released_.at(work.window) = false;
    }
    void spend(std::size_t window, const StepPlan& step) noexcept override {
        while (step.is_hang && !is_released_[window]) {
            std::this_thread::yield();
        }
        const Instant end = host_.get_now() + step.time;
        while (host_.get_now() < end) {
        }
    }
    void release(std::size_t window) noexcept override { is_released_[window] = true; }

  private:
    std::array<std::atomic<bool>, kWindowCount> is_released_{};
    ThreadHost host_;
};

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_THREAD_HOST_HPP
