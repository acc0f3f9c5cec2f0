// SPDX-License-Identifier: Apache-2.0
/// @file
/// The gate before a watchdog that asks a question: the answer comes out of the supervision itself, link by
/// link, so that a service that left a part out answers wrong.
///
/// @satisfies SWR-WDG-010, SWR-WDG-011, SWR-WDG-012, SWR-WDG-013
/// Design:   docs/design/supervision.md#challenge-and-response
/// Source:   IEC 61508-2:2010 Table A.10 (watchdog with separate time base and time window, combined with
///           logical monitoring of program sequence)
#ifndef MAMORI_SAFETY_SUPERVISION_CHALLENGE_GATE_HPP
#define MAMORI_SAFETY_SUPERVISION_CHALLENGE_GATE_HPP

#include <cstdint>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/supervision/watchdog_gate.hpp"

namespace mamori::safety {

/// Watchdog that poses questions, as a port offers it. When it gets no right answer in its window, the
/// drives lose their torque. It judges by itself: the right answers are not in this program.
class ChallengeWatchdog {
  public:
    /// The question that is open: the same one until it is answered, then another one. Must not block.
    /// @return the question; kError (the device gave none).
    virtual Result<std::uint32_t> get_question() noexcept = 0;

    /// Answers it, and restarts the watchdog's time if the answer is right. Must not block.
    /// @return kOk (right); kBadParameter (wrong: the device takes it as a failure); kError (it did not take
    ///         the answer).
    virtual Status answer(Instant now, std::uint32_t answer) noexcept = 0;

  protected:
    ~ChallengeWatchdog() = default;
};

/// What the gate did in one step.
enum class ChallengeOutcome : std::uint8_t {
    kAnswered,
    kHeldBack,  ///< healthy, but too early for the window
    kRefused,   ///< health is not proven: nothing was answered
    kFailed,    ///< no question of this cycle, or the device did not take the answer; tried again in the next
    kWrong,     ///< the answer was wrong: a part of the supervision was left out, doubled or moved
    kClosed,    ///< too many wrong answers, a missed window or a clock that ran backwards: none from here on
};

/// The same as the gate of the window says it.
constexpr ChallengeOutcome to_challenge_outcome(WatchdogOutcome outcome) noexcept {
    switch (outcome) {
        case WatchdogOutcome::kServiced:
            return ChallengeOutcome::kAnswered;
        case WatchdogOutcome::kHeldBack:
            return ChallengeOutcome::kHeldBack;
        case WatchdogOutcome::kRefused:
            return ChallengeOutcome::kRefused;
        case WatchdogOutcome::kFailed:
            return ChallengeOutcome::kFailed;
        case WatchdogOutcome::kClosed:
            return ChallengeOutcome::kClosed;
    }
    return ChallengeOutcome::kClosed;  // only a corrupted value comes here
}

/// Answers a watchdog on proven health, once for each question that it asked for:
///
///     ProofChain chain{gate.ask(now)};
///     const SupervisionStatus status = supervisor.step(now, chain);
///     outcome = gate.step(now, to_global_status(status), machine.is_consistent(), chain.get_value());
///
/// Thread safety: none; call ask() and step() once per supervision cycle from one execution context.
/// Time:          O(1) plus the device's. Memory: no heap.
class ChallengeGate final {
  public:
    /// @param[in] watchdog must outlive this object.
    /// @param[in] window   the watchdog's window, narrowed by the jitter of the calling context.
    /// @param[in] wrong_answers_tolerated as many as the device tolerates, or fewer; < 2^32 - 1.
    constexpr ChallengeGate(ChallengeWatchdog& watchdog, WatchdogWindow window,
                            std::uint32_t wrong_answers_tolerated = 0U) noexcept
        : service_(watchdog), gate_(service_, window), wrong_answers_tolerated_(wrong_answers_tolerated) {}
    ChallengeGate(const ChallengeGate&) = delete;
    ChallengeGate& operator=(const ChallengeGate&) = delete;

    /// Begins a supervision cycle.
    /// @param[in] now start of the cycle, as in ContextHandle::now.
    /// @return the question; 0 when the device gave none, and the step() of this cycle answers nothing.
    [[nodiscard]] std::uint32_t ask(Instant now) noexcept;

    /// Ends the cycle: decides about one answer and gives it.
    /// @param[in] now the same as in ask(): a proof of an earlier cycle is none.
    /// @param[in] status, is_state_consistent as WatchdogGate::step().
    /// @param[in] answer ProofChain::get_value() of this cycle.
    [[nodiscard]] ChallengeOutcome step(Instant now, GlobalStatus status, bool is_state_consistent,
                                        std::uint32_t answer) noexcept;

    /// Right answers, held at the largest number.
    std::uint32_t get_answer_count() const noexcept { return gate_.get_service_count(); }
    /// Wrong answers, up to one more than tolerated.
    std::uint32_t get_wrong_count() const noexcept { return wrong_count_; }
    bool is_closed() const noexcept { return wrong_count_ > wrong_answers_tolerated_ || gate_.is_closed(); }

  private:
    /// A service of the window's gate is the answer to the open question.
    class Service final : public Watchdog {
      public:
        explicit constexpr Service(ChallengeWatchdog& watchdog) noexcept : watchdog_(watchdog) {}
        std::uint32_t ask(Instant now) noexcept;
        void prepare(std::uint32_t answer) noexcept { answer_ = answer; }
        Status service(Instant now) noexcept override;
        /// Whether the last step answered wrong; ends the cycle.
        bool end() noexcept;

      private:
        ChallengeWatchdog& watchdog_;
        Instant asked_at_{};
        std::uint32_t answer_{0U};
        bool has_question_{false};
        bool was_wrong_{false};
    };

    Service service_;
    WatchdogGate gate_;
    std::uint32_t wrong_answers_tolerated_;
    std::uint32_t wrong_count_{0U};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SUPERVISION_CHALLENGE_GATE_HPP
