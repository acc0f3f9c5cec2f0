// SPDX-License-Identifier: Apache-2.0
/// @file
/// Survival notice: the message by which a node reports state and health of each of its components, as both
/// ends describe it.
///
///     constexpr mamori::safety::NoticeNode kArm{0xA4A1U, 1_ms, 10U, std::array{"reader", "guard",
///     "notifier"}};
///
/// @satisfies SWR-NTC-001, SWR-NTC-003, SWR-NTC-007      Design: docs/design/supervision.md#survival-notice
#ifndef MAMORI_SAFETY_NOTICE_NOTICE_HPP
#define MAMORI_SAFETY_NOTICE_NOTICE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/text.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/lifecycle.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/kernel/payload/trace_hash.hpp"
#include "mamori/safety/e2e/message.hpp"
#include "mamori/safety/e2e/profile_04.hpp"
#include "mamori/safety/supervision/execution_supervisor.hpp"

namespace mamori::safety {

/// Maximum number of components in a notice.
inline constexpr std::size_t kNoticeComponentMax = 256U;

/// Description of a node, the same constant in the programs of both ends.
template <std::size_t kCount>
struct NoticeNode {
    std::uint32_t id{0U};            ///< of the node: data id of its notice, unique among all E2E channels
    Duration frame{0};               ///< major frame of the node, > 0
    std::uint32_t every_frames{0U};  ///< a notice is sent in each of these major frames, >= 1
    std::array<const char*, kCount> components{};  ///< names of its table, in table order; static storage
};
template <std::size_t kCount>
NoticeNode(std::uint32_t, Duration, std::uint32_t, std::array<const char*, kCount>) -> NoticeNode<kCount>;

/// Time between two notices.
template <std::size_t kCount>
constexpr Duration get_period(const NoticeNode<kCount>& node) noexcept {
    return {node.frame.ns * static_cast<std::int64_t>(node.every_frames)};
}

/// Version of a description: a hash of the period and of the component names in their order.
template <std::size_t kCount>
constexpr std::uint64_t calc_version(const NoticeNode<kCount>& node) noexcept {
    TraceHash hash;
    hash(node.frame.ns);
    hash(node.every_frames);
    for (const char* name : node.components) {
        for (const char character : make_text(name)) {
            hash(character);
        }
        hash('\0');  // separates the names
    }
    return hash.get_value();
}

/// Rejects a description that no node can have.
template <const auto& kNode>
constexpr bool is_sound_node() noexcept {
    constexpr std::int64_t kLongest = std::numeric_limits<std::int64_t>::max() / 4;
    static_assert(!kNode.components.empty() && kNode.components.size() <= kNoticeComponentMax,
                  "a notice reports 1 to 256 components; describe the components of the table");
    static_assert(kNode.frame > Duration{0}, "the major frame of the node must be longer than 0");
    static_assert(kNode.every_frames >= 1U, "a notice is sent in every n-th major frame; specify n >= 1");
    static_assert(kNode.every_frames == 0U || kNode.frame.ns <= kLongest / kNode.every_frames,
                  "the time between two notices exceeds 73 years; specify fewer major frames");
    for (const char* name : kNode.components) {
        if (name == nullptr || !is_name(name)) {
            return false;
        }
    }
    return true;
}

/// State and health of a component in one byte of a notice.
struct ComponentReport {
    LifecycleState state{LifecycleState::kCreated};
    LocalStatus status{LocalStatus::kExpired};
};
constexpr std::uint8_t to_byte(ComponentReport report) noexcept {
    return static_cast<std::uint8_t>(static_cast<std::uint32_t>(report.state) |
                                     (static_cast<std::uint32_t>(report.status) << 2U));
}
/// The inverse. A byte that no sender writes reports an expired component.
constexpr ComponentReport to_report(std::uint8_t byte) noexcept {
    const std::uint32_t status = std::uint32_t{byte} >> 2U;
    return {static_cast<LifecycleState>(byte & 3U), status < static_cast<std::uint32_t>(LocalStatus::kExpired)
                                                        ? static_cast<LocalStatus>(status)
                                                        : LocalStatus::kExpired};
}

/// Content of a notice. The number of the notice is the counter of its E2E header, the node its data id.
template <std::size_t kCount>
struct NoticeValue {
    std::uint64_t version{0U};                      ///< calc_version() of the description
    std::uint64_t frame{0U};                        ///< number of the major frame that sent it
    std::uint8_t health{0U};                        ///< GlobalStatus
    std::array<std::uint8_t, kCount> components{};  ///< to_byte() of each
};

}  // namespace mamori::safety

template <std::size_t kCount>
struct mamori::Fields<mamori::safety::NoticeValue<kCount>> {
    static constexpr bool kDeclared = true;
    template <typename Self, typename Call>
    static constexpr decltype(auto) apply(Self& self, Call&& call) noexcept {
        return call(self.version, self.frame, self.health, self.components);
    }
};

namespace mamori::safety {

/// Types of the notice of one node. AUTOSAR profile 7: 64-bit checksum, 32-bit counter, identifier sent.
/// @tparam kNode constexpr NoticeNode of static storage duration.
template <const auto& kNode>
struct NoticeFor {
    static_assert(is_sound_node<kNode>(), "each component needs a name of the system table");

    static constexpr std::size_t kCount = kNode.components.size();
    static constexpr std::uint32_t kLength = 20U + 17U + static_cast<std::uint32_t>(kCount);
    static constexpr SentIdChannel kChannel{kNode.id, kLength, kLength};
    using Value = NoticeValue<kCount>;
    using Message = E2eMessage<Value, E2eProfile07<>, kChannel>;
    /// Payload of the ports that carry the notice.
    using Frame = typename Message::Frame;
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_NOTICE_NOTICE_HPP
