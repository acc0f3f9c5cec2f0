// SPDX-License-Identifier: Apache-2.0
// A host in simulated time that complies with the contract and records what the rules request of it.
#ifndef MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_RECORDING_HOST_HPP
#define MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_RECORDING_HOST_HPP

#include <array>
#include <string>
#include <vector>

#include "exact_host.hpp"
#include "mamori/ports/conformance/host_contract.hpp"

namespace mamori::ports::conformance {

class RecordingHostRig final : public HostRig, public WindowHost {
  public:
    /// @param[out] calls receives one line per request; must outlive this object.
    explicit RecordingHostRig(std::string& calls) : calls_(calls) {}

    Instant get_now() const noexcept override { return rig_.get_now(); }
    Instant get_step_end() const noexcept override { return rig_.get_host().get_step_end(); }
    void wait_until(Instant instant) override {
        calls_ += "wait " + std::to_string((instant - get_now()).ns) + "\n";
        rig_.wait_until(instant);
    }
    Duration get_tick() const override { return rig_.get_tick(); }
    bool is_exact() const override { return true; }
    WindowHost& get_host() override { return *this; }
    void plan(const WindowHost::Work& work, const std::vector<StepPlan>& steps) override {
        steps_.clear();
        for (const StepPlan& step : steps) {
            const bool is_hang_only = step.is_hang && step.time == Duration{0};
            steps_ += is_hang_only ? " hang" : " " + std::to_string(step.time.ns);
        }
        rig_.plan(work, steps);
    }
    void spend(std::size_t window, const StepPlan& step) noexcept override {
        spent_ += " " + std::to_string(window) + ":" + std::to_string(step.time.ns);
    }
    void release(std::size_t window) noexcept override {
        calls_ += "release " + std::to_string(window) + "\n";
        rig_.release(window);
    }
    bool has_returned(std::size_t window) const noexcept override {
        calls_ += "ask " + std::to_string(window) + "\n";
        return true;
    }
    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        constexpr std::array<const char*, 3U> kPasses{"execute", "update", "mode"};
        calls_ += std::string{kPasses.at(static_cast<std::size_t>(work.pass))} + ", component " +
                  std::to_string(work.component) + ", from " + std::to_string(work.first) + ":" + steps_ +
                  " within " + std::to_string((deadline - get_now()).ns);
        spent_.clear();
        const std::size_t count = rig_.get_host().run_within(work, deadline);
        calls_ += ", spent" + spent_ + "\n";
        return count;
    }

  private:
    std::string& calls_;
    std::string steps_;
    std::string spent_;
    mutable ExactHostRig rig_{HostFlaw::kNone};
};

}  // namespace mamori::ports::conformance

#endif  // MAMORI_PORTS_CONFORMANCE_TESTS_SUPPORT_RECORDING_HOST_HPP
