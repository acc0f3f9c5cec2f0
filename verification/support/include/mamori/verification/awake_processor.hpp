// SPDX-License-Identifier: Apache-2.0
/// @file
/// Keeps a processor awake during a measurement. A virtual machine releases a sleeping processor to its host.
/// Each wake-up would then wait for the processor, and these host causes would dominate the run.
#ifndef MAMORI_VERIFICATION_AWAKE_PROCESSOR_HPP
#define MAMORI_VERIFICATION_AWAKE_PROCESSOR_HPP

#include <atomic>
#include <thread>

namespace mamori::verification {

/// A thread that computes on the processor, below all other threads there (SCHED_IDLE, which needs no
/// privilege). If Linux denies priority or processor, the thread ends, and the host stays noisier. Uses one
/// processor.
class AwakeProcessor final {
  public:
    /// @param[in] processor its number, 0, 1, ...
    explicit AwakeProcessor(int processor);
    AwakeProcessor(const AwakeProcessor&) = delete;
    AwakeProcessor& operator=(const AwakeProcessor&) = delete;
    ~AwakeProcessor();

  private:
    void compute(int processor) const;

    std::atomic<bool> is_ending_{false};
    std::thread thread_;
};

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_AWAKE_PROCESSOR_HPP
