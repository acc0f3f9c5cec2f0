// SPDX-License-Identifier: Apache-2.0
/// @file
/// One table for a system and its safety: the parts of mamori::system(...), and those of safety_part.hpp.
/// MAMORI_SAFETY_CHECK makes the compiler check it; SafetyState executes it.
///
///     static constexpr auto kSystem = mamori::safety::system(
///         mamori::frame(1_ms),
///         mamori::window("protect", 0_us, 300_us, mamori::budget(250_us), mamori::run(monitor, supervisor)),
///         mamori::faults<Fault::kOverspeed, Fault::kMonitorSilent, Fault::kReactionLate>(),
///         mamori::react(Fault::kOverspeed, Reaction::kSs1, mamori::within(20_ms)), ...
///         mamori::safety::confirm(Fault::kOverspeed, {2U}),
///         mamori::safety::supervise(monitor, mamori::safety::alive(), mamori::safety::deadline(150_us),
///                                   mamori::safety::raises(Fault::kMonitorSilent)),
///         mamori::safety::supervise(supervisor, mamori::safety::alive(), mamori::safety::deadline(150_us)),
///         mamori::safety::confirmed_by(monitor.state, StopConfirmation::kStandstill, ...),
///         mamori::safety::cycle(...));
///     MAMORI_SAFETY_CHECK(kSystem);
///
/// @satisfies SWR-CYC-001      Design: docs/design/safety_cycle.md#the-table
#ifndef MAMORI_SAFETY_SYSTEM_HPP
#define MAMORI_SAFETY_SYSTEM_HPP

#include <array>
#include <cstddef>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/system/system_extension.hpp"
#include "mamori/safety/assumptions/assumption_table.hpp"
#include "mamori/safety/cycle/safety_part.hpp"

namespace mamori::safety {

/// A system table with the rows of the safety layer.
template <typename PartTypes>
struct SafetySystem : DescribedSystem<PartTypes> {
    static constexpr std::size_t kFaultCount = PartTypes::Faults::kSize;
    static constexpr std::size_t kCycleCount = extension::kPartCount<CycleTag, PartTypes>;
    std::array<SuperviseRow, extension::kPartCount<SuperviseTag, PartTypes>> supervised{};
    std::array<ConfirmRow, extension::kPartCount<ConfirmTag, PartTypes>> confirmations{};
    std::array<StopSourceRow, extension::kPartCount<StopSourceTag, PartTypes>> stop_sources{};
    std::array<SelfTestRow, extension::kPartCount<SelfTestTag, PartTypes>> self_tests{};
    std::array<ProtectRow, extension::kPartCount<ProtectTag, PartTypes>> protections{};
    std::array<AssumptionRow, extension::kPartCount<AssumptionTag, PartTypes>> assumptions{};
    CycleRow cycle{};
};

/// The rows of the safety layer, for code that works with any table. The table must outlive it.
struct SafetyView {
    Span<const SuperviseRow> supervised{};
    Span<const ConfirmRow> confirmations{};
    Span<const StopSourceRow> stop_sources{};
    Span<const SelfTestRow> self_tests{};
    Span<const ProtectRow> protections{};
    Span<const AssumptionRow> assumptions{};
    const CycleRow& cycle;
};
/// @param[in] table must outlive the result.
template <typename Types>
constexpr SafetyView make_safety_view(const SafetySystem<Types>& table) noexcept {
    return {table.supervised,  table.confirmations, table.stop_sources, table.self_tests,
            table.protections, table.assumptions,   table.cycle};
}

template <typename Types, typename... Faults>
constexpr void add_part(extension::TableBuilder<SafetySystem<Types>>& builder,
                        const SupervisePart<Faults...>& part) noexcept {
    std::size_t next = 0U;
    for (const SuperviseRow& row : builder.table.supervised) {
        next += row.watch.component != nullptr ? 1U : 0U;
    }
    builder.table.supervised[next] = part.row;
}
template <typename Types, typename Fault>
constexpr void add_part(extension::TableBuilder<SafetySystem<Types>>& builder,
                        const ConfirmPart<Fault>& part) noexcept {
    std::size_t next = 0U;
    for (const ConfirmRow& row : builder.table.confirmations) {
        next += row.fault != kNoFault ? 1U : 0U;
    }
    builder.table.confirmations[next] = part.row;
}
template <typename Types>
constexpr void add_part(extension::TableBuilder<SafetySystem<Types>>& builder,
                        const StopSourcePart& part) noexcept {
    std::size_t next = 0U;
    for (const StopSourceRow& row : builder.table.stop_sources) {
        next += row.port != nullptr ? 1U : 0U;
    }
    builder.table.stop_sources[next] = part.row;
}

template <typename Types, typename Fault>
constexpr void add_part(extension::TableBuilder<SafetySystem<Types>>& builder,
                        const SelfTestPart<Fault>& part) noexcept {
    std::size_t next = 0U;
    for (const SelfTestRow& row : builder.table.self_tests) {
        next += row.check != nullptr ? 1U : 0U;
    }
    builder.table.self_tests[next] = part.row;
}
template <typename Types, typename Fault>
constexpr void add_part(extension::TableBuilder<SafetySystem<Types>>& builder,
                        const ProtectPart<Fault>& part) noexcept {
    std::size_t next = 0U;
    for (const ProtectRow& row : builder.table.protections) {
        next += row.receiver != nullptr ? 1U : 0U;
    }
    builder.table.protections[next] = part.row;
}
template <typename Types>
constexpr void add_part(extension::TableBuilder<SafetySystem<Types>>& builder,
                        const AssumptionRow& row) noexcept {
    std::size_t next = 0U;
    for (const AssumptionRow& other : builder.table.assumptions) {
        next += other.check != nullptr ? 1U : 0U;
    }
    builder.table.assumptions[next] = row;
}
template <typename Types, typename... Faults>
constexpr void add_part(extension::TableBuilder<SafetySystem<Types>>& builder,
                        const CyclePart<Faults...>& part) noexcept {
    builder.table.cycle = part.row;
}

/// Builds the table as mamori::system() does. MAMORI_SAFETY_CHECK reports violated rules.
template <typename... Parts>
constexpr auto system(Frame frame_part, const Parts&... parts) noexcept {
    return extension::build<SafetySystem>(frame_part, parts...);
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SYSTEM_HPP
