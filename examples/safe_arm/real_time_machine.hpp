// SPDX-License-Identifier: Apache-2.0
/// @file
/// Everything around the safety software in real time: the plant on a thread of its own, one frame behind the
/// commands as in virtual time, so that its computing takes no time from a window.
///
/// @satisfies SWR-TIM-004      Design: docs/design/timing.md#plant
#ifndef EXAMPLES_SAFE_ARM_REAL_TIME_MACHINE_HPP
#define EXAMPLES_SAFE_ARM_REAL_TIME_MACHINE_HPP

#include <semaphore.h>

#include <atomic>
#include <cstdint>
#include <thread>

#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/simbody_sim/arm_plant.hpp"

namespace safe_arm {

/// Devices of a run by the clock. The operator presses start as in virtual time.
///
/// Calling context: the listener's calls from the thread that runs the windows, each O(1) without blocking.
/// Memory: that of the plant.
class RealTimeMachine final : public mamori::ports::posix_rt::OpeningObserver {
  public:
    /// Starts the thread. @param[in] plant must outlive this object; nobody else may touch it meanwhile.
    explicit RealTimeMachine(mamori::sim::ArmPlant& plant);
    RealTimeMachine(const RealTimeMachine&) = delete;
    RealTimeMachine& operator=(const RealTimeMachine&) = delete;
    ~RealTimeMachine();

    /// Before the first window of a frame: the newest sample into the process image.
    void before_opening(const mamori::FrameSchedule::Opening& opening,
                        mamori::Instant woke) noexcept override;
    /// After the last window of a frame: the commands to the plant.
    void after_opening(const mamori::FrameSchedule::Opening& opening,
                       mamori::WindowOutcome outcome) noexcept override;

    /// Frames for which the plant was not ready: its time stood still meanwhile, and its sample was an old
    /// one.
    std::uint64_t get_late_count() const noexcept { return late_count_; }
    /// False once the plant's state is no longer finite.
    bool is_plant_sound() const noexcept { return is_plant_sound_.load(std::memory_order_relaxed); }

  private:
    struct Command {
        mamori::safety::ArmOutputs outputs{};
        bool is_watchdog_expired{false};
        bool is_start_pressed{false};
    };
    void serve();

    mamori::sim::ArmPlant& plant_;
    Command command_{};                   ///< belongs to the thread while it steps
    mamori::safety::ArmInputs sample_{};  ///< likewise
    bool is_stepping_{false};             ///< as the runner knows it
    std::uint64_t late_count_{0U};
    std::atomic<bool> is_plant_sound_{true};
    std::atomic<bool> is_ending_{false};
    sem_t wanted_{};
    sem_t done_{};
    std::thread thread_;
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_REAL_TIME_MACHINE_HPP
