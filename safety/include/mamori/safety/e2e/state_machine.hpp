// SPDX-License-Identifier: Apache-2.0
/// @file
/// State of a channel over its last checks: one bad frame is weather, many are a broken channel, and so is
/// silence.
///
/// @satisfies SWR-E2E-010, SWR-E2E-011      Design: docs/design/e2e.md#state-of-a-channel
/// Source:   AUTOSAR SWS E2E Library, state machine (release 4.3: one window, not cleared on the way to
/// kInvalid)
#ifndef MAMORI_SAFETY_E2E_STATE_MACHINE_HPP
#define MAMORI_SAFETY_E2E_STATE_MACHINE_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/safety/e2e/check_status.hpp"

namespace mamori::safety {

/// State of a channel. Content may be used in kValid only.
enum class ChannelState : std::uint8_t {
    kNoData,   ///< nothing usable came yet
    kInit,     ///< frames come, not enough of them to judge
    kValid,    ///< enough good ones, few enough bad ones
    kInvalid,  ///< too many bad ones, or too few good ones
};

/// What is demanded of the checks in the window, in one state.
struct WindowDemand {
    std::uint8_t ok_min{1U};     ///< good checks, 1 .. window; 0 would leave a silent channel valid for ever
    std::uint8_t error_max{0U};  ///< damaged frames, 0 .. window - 1
};

/// Demands of a channel, by the state in which they are asked.
struct ChannelDemands {
    WindowDemand in_init{};     ///< met: to kValid; more errors: to kInvalid
    WindowDemand in_valid{};    ///< not met: to kInvalid
    WindowDemand in_invalid{};  ///< met: to kValid
};

/// @param[in] window number of checks that are looked at.
/// @return true when every demand is inside its range, and the window is 1 .. 255.
constexpr bool are_sound(const ChannelDemands& demands, std::size_t window) noexcept {
    for (const WindowDemand& demand : {demands.in_init, demands.in_valid, demands.in_invalid}) {
        if (demand.ok_min < 1U || demand.ok_min > window || demand.error_max >= window) {
            return false;
        }
    }
    return window <= 255U;
}

/// Judges a channel by the statuses of its last checks.
///
/// Thread safety: none. Time: O(window). Memory: none of its own beside some words.
class ChannelStateMachine final {
  public:
    /// @param[in] window  storage for the statuses; must outlive this object; its size is the window, 1 ..
    /// 255.
    /// @param[in] demands where they are not sound, every check() is refused and the state stays kNoData.
    constexpr ChannelStateMachine(Span<ProfileStatus> window, const ChannelDemands& demands) noexcept
        : window_(window), demands_(demands), is_ready_(are_sound(demands, window.size())) {
        restart();
    }

    /// Notes the status of one check, silence included, and judges the channel anew. Once per check of the
    /// channel.
    /// @return kOk; kPreconditionNotMet (demands refused).
    Status check(ProfileStatus status) noexcept;

    /// Begins anew, as after construction.
    constexpr void restart() noexcept {
        for (ProfileStatus& status : window_) {
            status = ProfileStatus::kNotAvailable;
        }
        next_ = 0U;
        ok_count_ = 0U;
        error_count_ = 0U;
        state_ = ChannelState::kNoData;
    }

    ChannelState get_state() const noexcept { return state_; }
    /// True where the content of an accepted frame may be used.
    bool is_valid() const noexcept { return state_ == ChannelState::kValid; }
    /// Good checks in the window.
    std::size_t get_ok_count() const noexcept { return ok_count_; }
    /// Damaged frames in the window. Repeated, misordered and missing ones are not among them.
    std::size_t get_error_count() const noexcept { return error_count_; }

  private:
    void note(ProfileStatus status) noexcept;
    bool meets(const WindowDemand& demand) const noexcept;
    ChannelState calc_next(ProfileStatus status) const noexcept;

    Span<ProfileStatus> window_;
    ChannelDemands demands_;
    std::size_t next_{0U};
    std::size_t ok_count_{0U};
    std::size_t error_count_{0U};
    ChannelState state_{ChannelState::kNoData};
    bool is_ready_;
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_STATE_MACHINE_HPP
