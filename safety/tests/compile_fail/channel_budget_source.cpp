// SPDX-License-Identifier: Apache-2.0
// Compiled by channel_budget_compile_test.cpp with one defect at a time; without a defect it compiles.
#include "mamori/safety/e2e/channel_budget.hpp"

namespace {

using namespace mamori::safety;

#ifdef MAMORI_DEFECT_CHANNEL
constexpr std::size_t kLengthMin = 8U;
#else
constexpr std::size_t kLengthMin = 16U;
#endif
#ifdef MAMORI_DEFECT_LENGTH
constexpr std::size_t kLengthMax = 8192U;
#else
constexpr std::size_t kLengthMax = 16U;
#endif
#ifdef MAMORI_DEFECT_LIST
constexpr std::size_t kListLength = 15U;
#else
constexpr std::size_t kListLength = 14U;
#endif
#ifdef MAMORI_DEFECT_BUDGET
constexpr double kErrors = 1e-2;
#else
constexpr double kErrors = 1e-3;
#endif
#ifdef MAMORI_DEFECT_USE
constexpr double kRate = 0.0;
#else
constexpr double kRate = 1000.0;
#endif

constexpr SentIdChannel kSent{0x0A0B0C0DU, kLengthMin, kLengthMax};
constexpr ChannelUse kSentUse{kRate, kErrors};
static_assert(is_within_budget<E2eProfile44<>, kSent, kSentUse>());

constexpr IdListChannel kListed{{1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 10U, 11U, 12U, 13U, 14U, 15U, 16U},
                                kListLength};
constexpr ChannelUse kListedUse{1.0, 1e-9};
static_assert(is_within_budget<E2eProfile22<>, kListed, kListedUse>());

}  // namespace
