// SPDX-License-Identifier: Apache-2.0
// Goal: a component with the C interface of RTMSafety runs as any component.
// Method: the functions of such a component, compiled as C++; each callback, each return code, a create
// function that fails. examples/c_components/rtmsafety has a component in C.
#include "mamori/kernel/c/rtmsafety_component.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

using ReturnCode = std::int64_t;
struct PartObject {
    ReturnCode (*onInitialize)();
    ReturnCode (*onFinalize)();
    ReturnCode (*onStartup)();
    ReturnCode (*onShutdown)();
    ReturnCode (*onActivated)();
    ReturnCode (*onDeactivated)();
    ReturnCode (*onAborting)();
    ReturnCode (*onError)();
    ReturnCode (*onReset)();
    ReturnCode (*onExecute)();
};

/// As the component of RTMSafety: all data are global.
struct {
    std::vector<std::string> calls;
    ReturnCode result{0};
    ReturnCode create_result{0};
    bool has_all{true};
} g_part;

template <const char* kName>
ReturnCode call() {
    g_part.calls.emplace_back(kName);
    return g_part.result;
}
constexpr char kInitialize[] = "on_initialize";
constexpr char kFinalize[] = "on_finalize";
constexpr char kStartup[] = "on_startup";
constexpr char kShutdown[] = "on_shutdown";
constexpr char kActivated[] = "on_activated";
constexpr char kDeactivated[] = "on_deactivated";
constexpr char kAborting[] = "on_aborting";
constexpr char kErrorState[] = "on_error";
constexpr char kReset[] = "on_reset";
constexpr char kExecute[] = "on_execute";

ReturnCode create_part(PartObject* part) {
    g_part.calls.emplace_back("create");
    if (g_part.has_all) {
        *part = {&call<kInitialize>, &call<kFinalize>,    &call<kStartup>,  &call<kShutdown>,
                 &call<kActivated>,  &call<kDeactivated>, &call<kAborting>, &call<kErrorState>,
                 &call<kReset>,      &call<kExecute>};
    }
    return g_part.create_result;
}

class Part final : public RtmSafetyComponent<&create_part> {
  public:
    constexpr Part() noexcept : RtmSafetyComponent("part") {}
};

class RtmSafetyComponentTest : public ::testing::Test {
  protected:
    RtmSafetyComponentTest() { g_part = {}; }
    ~RtmSafetyComponentTest() override { static_cast<void>(sut_.on_finalize()); }
    std::vector<Status> call_all() {
        const ContextHandle handle{0, Instant{}};
        return {sut_.on_initialize(),    sut_.on_startup(handle),     sut_.on_activated(handle),
                sut_.on_execute(handle), sut_.on_aborting(handle),    sut_.on_error(handle),
                sut_.on_reset(handle),   sut_.on_deactivated(handle), sut_.on_shutdown(handle),
                sut_.on_finalize()};
    }
    Part sut_;
};

TEST_F(RtmSafetyComponentTest, EachActionCallsItsCallbackAfterTheCreateFunction) {
    verifies("SWR-CIF-010", Technique::kInterface);
    EXPECT_EQ(call_all(), std::vector<Status>(10U, Status::kOk));

    EXPECT_EQ(g_part.calls, (std::vector<std::string>{"create", "on_initialize", "on_startup", "on_activated",
                                                      "on_execute", "on_aborting", "on_error", "on_reset",
                                                      "on_deactivated", "on_shutdown", "on_finalize"}));
}

TEST_F(RtmSafetyComponentTest, ACallbackThatIsNotStoredSucceedsAlsoAfterAFormerLife) {
    verifies("SWR-CIF-010", Technique::kBoundaryValues);
    ASSERT_EQ(sut_.on_initialize(), Status::kOk);
    g_part = {};
    g_part.has_all = false;

    EXPECT_EQ(call_all(), std::vector<Status>(10U, Status::kOk));

    EXPECT_EQ(g_part.calls, std::vector<std::string>{"create"});
}

TEST_F(RtmSafetyComponentTest, EachReturnCodeIsTheStatusAndAnyOtherNumberAnError) {
    verifies("SWR-CIF-010", Technique::kBoundaryValues, Polarity::kViolation);
    for (const ReturnCode code : {1LL, 2LL, 3LL, 4LL, 5LL, 6LL, -1LL, 0x100000000LL}) {
        g_part.result = code;
        const Status expected = code >= 1 && code <= 5 ? static_cast<Status>(code) : Status::kError;

        EXPECT_EQ(call_all(), std::vector<Status>(10U, expected)) << code;
    }
}

TEST_F(RtmSafetyComponentTest, AFailedCreateFunctionKeepsTheComponentFromItsLife) {
    verifies("SWR-CIF-010", Technique::kFaultInjection, Polarity::kViolation);
    g_part.create_result = 1;

    EXPECT_EQ(sut_.initialize(), Status::kError);

    EXPECT_FALSE(sut_.is_alive());
    EXPECT_EQ(g_part.calls, std::vector<std::string>{"create"});
    EXPECT_EQ(sut_.on_execute({0, Instant{}}), Status::kOk);
    EXPECT_EQ(g_part.calls, std::vector<std::string>{"create"});
}

TEST_F(RtmSafetyComponentTest, ASecondObjectIsRejectedUntilTheFirstIsFinalized) {
    verifies("SWR-CIF-010", Technique::kFaultInjection, Polarity::kViolation);
    Part second;
    g_part.result = 1;
    EXPECT_EQ(sut_.initialize(), Status::kError);
    g_part.result = 0;
    EXPECT_EQ(second.initialize(), Status::kOk);
    g_part.calls.clear();

    EXPECT_EQ(sut_.initialize(), Status::kPreconditionNotMet);

    EXPECT_TRUE(g_part.calls.empty());
    EXPECT_EQ(second.finalize(), Status::kOk);
    EXPECT_EQ(sut_.initialize(), Status::kOk);
}

MAMORI_CONSTINIT Part static_part;

TEST_F(RtmSafetyComponentTest, TheComponentIsConstantInitialised) {
    verifies("SWR-CIF-005", Technique::kInterface);
    EXPECT_STREQ(static_part.get_name(), "part");
    EXPECT_EQ(static_part.initialize(), Status::kOk);
    EXPECT_EQ(static_part.finalize(), Status::kOk);
}

}  // namespace
}  // namespace mamori
