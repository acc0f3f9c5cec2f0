// SPDX-License-Identifier: Apache-2.0
// A real-time host with a step that runs on until the host ends, and that reports the end of its work before.
#ifndef MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_STUCK_HOST_HPP
#define MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_STUCK_HOST_HPP

#include <atomic>
#include <thread>
#include <vector>

#include "mamori/ports/conformance/host_contract.hpp"

namespace mamori::ports::conformance {

class StuckHostRig final : public HostRig, public WindowHost {
  public:
    /// @param[in] stuck_step index of the step that does not end.
    /// @param[in] count      number of steps that the host counts.
    StuckHostRig(std::size_t stuck_step, std::size_t count) : stuck_step_(stuck_step), count_(count) {}
    ~StuckHostRig() override {
        is_free_ = true;
        if (thread_.joinable()) {
            thread_.join();
        }
    }
    StuckHostRig(const StuckHostRig&) = delete;
    StuckHostRig& operator=(const StuckHostRig&) = delete;

    Instant get_now() const noexcept override { return {now_ns_}; }
    Instant get_step_end() const noexcept override { return {now_ns_}; }
    void wait_until(Instant) override {}
    Duration get_tick() const override { return 1_us; }
    bool is_exact() const override { return false; }
    WindowHost& get_host() override { return *this; }
    void plan(const WindowHost::Work&, const std::vector<StepPlan>&) override {}
    void release(std::size_t) noexcept override {}
    bool has_returned(std::size_t) const noexcept override { return true; }
    void spend(std::size_t, const StepPlan&) noexcept override {
        if (spent_++ == stuck_step_) {
            is_stuck_ = true;
            while (!is_free_) {
                std::this_thread::yield();
            }
        }
    }
    /// Returns while the step is stuck.
    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        thread_ =
            std::thread{[this, work] { work.run(work.argument, work.first, work.first + stuck_step_ + 1U); }};
        while (!is_stuck_) {
            std::this_thread::yield();
        }
        now_ns_ = count_ < work.count ? deadline.ns : now_ns_.load();
        return count_;
    }

  private:
    std::size_t stuck_step_;
    std::size_t count_;
    std::size_t spent_{0U};
    std::atomic<std::int64_t> now_ns_{0};
    std::atomic<bool> is_stuck_{false};
    std::atomic<bool> is_free_{false};
    std::thread thread_;
};

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_STUCK_HOST_HPP
