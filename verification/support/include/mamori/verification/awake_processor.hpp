// SPDX-License-Identifier: Apache-2.0
/// @file
/// Keeps a processor from sleeping while a run is measured. One that sleeps is given back, by a virtual
/// machine to its host, and each wake-up then has to wait until it is there again: what is to be told apart
/// from the run would be the greater part of it.
#ifndef MAMORI_VERIFICATION_AWAKE_PROCESSOR_HPP
#define MAMORI_VERIFICATION_AWAKE_PROCESSOR_HPP

#include <atomic>
#include <thread>

namespace mamori::verification {

/// A thread that computes on the processor, below all others there (SCHED_IDLE, which needs no right). When
/// Linux refuses either, it ends at once: the run is the same, on a noisier machine. One whole processor is
/// used up.
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
