// SPDX-License-Identifier: Apache-2.0
// Goal: a component in C runs as any component, and its ports carry the values of the ports in C++.
// Method: the functions of a component in C, compiled as C++; each action, return code and port function.
// The C compilers compile the components of examples/c_components.
#include "mamori/kernel/c/c_component.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"

extern "C" {
typedef struct CDetail {
    std::int16_t angles[2];
    bool is_valid;
} CDetail;
typedef struct CSample {
    std::int32_t number;
    CDetail details[2];
} CSample;
typedef struct CPart {
    MAMORI_IN_PORT(CSample) in;
    MAMORI_IN_PORT(double) gain;
    MAMORI_OUT_PORT(CSample) out;
    MamoriStatus result;
    MamoriContext context;
    const char* called;
} CPart;
}
MAMORI_FIELDS(CDetail, angles, is_valid)
MAMORI_FIELDS(CSample, number, details)

namespace mamori {
namespace {

using namespace verification;

template <const char* kName>
MamoriStatus call(void* self, MamoriContext context) {
    auto& part = *static_cast<CPart*>(self);
    part.called = kName;
    part.context = context;
    return part.result;
}
template <const char* kName>
MamoriStatus call_once(void* self) {
    return call<kName>(self, {-7, -7});
}

constexpr char kInitialize[] = "on_initialize";
constexpr char kFinalize[] = "on_finalize";
constexpr char kStartup[] = "on_startup";
constexpr char kShutdown[] = "on_shutdown";
constexpr char kActivated[] = "on_activated";
constexpr char kDeactivated[] = "on_deactivated";
constexpr char kAborting[] = "on_aborting";
constexpr char kError[] = "on_error";
constexpr char kReset[] = "on_reset";
constexpr char kExecute[] = "on_execute";
constexpr char kStateUpdate[] = "on_state_update";
constexpr char kRateChanged[] = "on_rate_changed";
constexpr MamoriActions kAll{&call_once<kInitialize>, &call_once<kFinalize>, &call<kStartup>,
                             &call<kShutdown>,        &call<kActivated>,     &call<kDeactivated>,
                             &call<kAborting>,        &call<kError>,         &call<kReset>,
                             &call<kExecute>,         &call<kStateUpdate>,   &call<kRateChanged>};
constexpr MamoriActions kNone{};

class CPartComponent final : public CComponent {
  public:
    constexpr explicit CPartComponent(const MamoriActions& actions) noexcept
        : CComponent("part", actions, &part_) {}
    InPort<CSample> in{*this, "in"};
    InPort<double, Need::kOptional> gain{*this, "gain"};
    OutPort<CSample> out{*this, "out"};
    using Ports = mamori::Ports<&CPartComponent::in, &CPartComponent::gain, &CPartComponent::out>;
    CPart& get_part() noexcept { return part_; }

  private:
    CPart part_{c_port(in), c_port(gain), c_port(out), MAMORI_RTC_OK, {}, nullptr};
};

constexpr ContextHandle kHandle{3, Instant{5'000'000'000}};

/// Calls all twelve actions in the order of the struct.
std::vector<Status> call_all(Component& component) {
    return {component.on_initialize(),          component.on_finalize(),
            component.on_startup(kHandle),      component.on_shutdown(kHandle),
            component.on_activated(kHandle),    component.on_deactivated(kHandle),
            component.on_aborting(kHandle),     component.on_error(kHandle),
            component.on_reset(kHandle),        component.on_execute(kHandle),
            component.on_state_update(kHandle), component.on_rate_changed(kHandle)};
}

TEST(CComponentTest, EachActionCallsItsFunctionWithTheStructAndTheContext) {
    verifies("SWR-CIF-001", Technique::kInterface);
    CPartComponent sut{kAll};
    const CPart& part = sut.get_part();
    const auto expect_call = [&part](Status status, const char* name) {
        EXPECT_EQ(status, Status::kOk) << name;
        EXPECT_STREQ(part.called, name);
        EXPECT_EQ(part.context.id, 3) << name;
        EXPECT_EQ(part.context.now_ns, 5'000'000'000) << name;
    };

    EXPECT_EQ(sut.on_initialize(), Status::kOk);
    EXPECT_STREQ(part.called, "on_initialize");
    EXPECT_EQ(sut.on_finalize(), Status::kOk);
    EXPECT_STREQ(part.called, "on_finalize");
    expect_call(sut.on_startup(kHandle), "on_startup");
    expect_call(sut.on_shutdown(kHandle), "on_shutdown");
    expect_call(sut.on_activated(kHandle), "on_activated");
    expect_call(sut.on_deactivated(kHandle), "on_deactivated");
    expect_call(sut.on_aborting(kHandle), "on_aborting");
    expect_call(sut.on_error(kHandle), "on_error");
    expect_call(sut.on_reset(kHandle), "on_reset");
    expect_call(sut.on_execute(kHandle), "on_execute");
    expect_call(sut.on_state_update(kHandle), "on_state_update");
    expect_call(sut.on_rate_changed(kHandle), "on_rate_changed");
}

TEST(CComponentTest, AMissingActionSucceeds) {
    verifies("SWR-CIF-001", Technique::kBoundaryValues);
    CPartComponent sut{kNone};

    EXPECT_EQ(call_all(sut), std::vector<Status>(12U, Status::kOk));
}

TEST(CComponentTest, EachReturnCodeIsTheStatusOfTheAction) {
    verifies("SWR-CIF-002", Technique::kEquivalenceClasses);
    CPartComponent sut{kAll};
    for (MamoriStatus code = MAMORI_RTC_OK; code <= MAMORI_PRECONDITION_NOT_MET; ++code) {
        sut.get_part().result = code;

        EXPECT_EQ(call_all(sut), std::vector<Status>(12U, static_cast<Status>(code))) << code;
    }
    static_assert(MAMORI_RTC_ERROR == static_cast<std::uint32_t>(Status::kError));
    static_assert(MAMORI_BAD_PARAMETER == static_cast<std::uint32_t>(Status::kBadParameter));
    static_assert(MAMORI_UNSUPPORTED == static_cast<std::uint32_t>(Status::kUnsupported));
    static_assert(MAMORI_OUT_OF_RESOURCES == static_cast<std::uint32_t>(Status::kOutOfResources));
}

TEST(CComponentTest, ANumberThatIsNotAReturnCodeIsAnError) {
    verifies("SWR-CIF-002", Technique::kBoundaryValues, Polarity::kViolation);
    CPartComponent sut{kAll};
    for (const MamoriStatus code : {6U, 0x80000000U, 0xFFFFFFFFU}) {
        sut.get_part().result = code;

        EXPECT_EQ(sut.on_initialize(), Status::kError) << code;
        EXPECT_EQ(sut.on_execute(kHandle), Status::kError) << code;
    }
}

TEST(CComponentTest, AnInputInCShowsTheValueOfTheInputInCpp) {
    verifies("SWR-CIF-003", Technique::kInterface);
    CPartComponent sut{kNone};
    const CPart& part = sut.get_part();
    EXPECT_EQ(MAMORI_READ(part.in)->number, 0);
    EXPECT_FALSE(MAMORI_IS_NEW(part.in));
    EXPECT_EQ(MAMORI_CALC_STATUS(part.in, (MamoriContext{3, 0})), MAMORI_BUFFER_EMPTY);
    static constexpr AgeLimits kLimits{Duration{100}, Duration{0}};
    sut.in.set_age_limits(kLimits);

    sut.in.take({CSample{42, {{{1, 2}, true}, {{3, 4}, false}}}, 1U, Instant{1'000}});

    EXPECT_EQ(MAMORI_READ(part.in)->number, 42);
    EXPECT_EQ(MAMORI_READ(part.in)->details[1].angles[1], 4);
    EXPECT_TRUE(MAMORI_IS_NEW(part.in));
    EXPECT_EQ(MAMORI_CALC_STATUS(part.in, (MamoriContext{3, 1'100})), MAMORI_PORT_OK);
    EXPECT_EQ(MAMORI_CALC_STATUS(part.in, (MamoriContext{3, 1'101})), MAMORI_BUFFER_TIMEOUT);
    sut.end_read_pass();
    EXPECT_FALSE(MAMORI_IS_NEW(part.in));
    EXPECT_EQ(MAMORI_READ(part.gain), &sut.gain.read());
}

TEST(CComponentTest, AnOutputInCWritesToTheOutputInCpp) {
    verifies("SWR-CIF-003", Technique::kInterface);
    CPartComponent sut{kNone};
    const CSample first{1, {{{10, 20}, true}, {{30, 40}, true}}};
    const CSample second{2, {}};

    MAMORI_WRITE(sut.get_part().out, &first);
    MAMORI_WRITE(sut.get_part().out, &second);

    EXPECT_EQ(sut.out.get_written_count(), 2U);
    ASSERT_TRUE(sut.out.publish(Instant{7}));
    EXPECT_EQ(sut.out.get_published().number, 2);
}

/// The fields of CSample in C++.
struct CppDetail {
    std::array<std::int16_t, 2U> angles{};
    bool is_valid{};
};
struct CppSample {
    std::int32_t number{};
    std::array<CppDetail, 2U> details{};
};

}  // namespace
}  // namespace mamori
MAMORI_FIELDS(mamori::CppDetail, angles, is_valid)
MAMORI_FIELDS(mamori::CppSample, number, details)
namespace mamori {
namespace {

TEST(CComponentTest, AnArrayInCHasTheBytesOfAnArrayInCpp) {
    verifies("SWR-CIF-004", Technique::kBackToBack);
    const CSample in_c{-5, {{{1, 2}, true}, {{3, -4}, false}}};
    const CppSample in_cpp{-5, {{{{1, 2}, true}, {{3, -4}, false}}}};
    std::array<std::byte, max_encoded_size<CSample>()> c_bytes{};
    std::array<std::byte, max_encoded_size<CppSample>()> cpp_bytes{};

    const Result<std::size_t> c_size = encode(in_c, {c_bytes.data(), c_bytes.size()}, ByteOrder::kBig);
    const Result<std::size_t> cpp_size =
        encode(in_cpp, {cpp_bytes.data(), cpp_bytes.size()}, ByteOrder::kBig);

    ASSERT_TRUE(c_size.has_value());
    EXPECT_EQ(c_size.get_value(), cpp_size.get_value());
    EXPECT_EQ(c_bytes, cpp_bytes);
    TraceHash c_hash;
    TraceHash cpp_hash;
    c_hash.add(in_c);
    cpp_hash.add(in_cpp);
    EXPECT_EQ(c_hash.get_value(), cpp_hash.get_value());
}

MAMORI_CONSTINIT CPartComponent static_part{kAll};
constexpr auto kSystem =
    system(frame(Duration{1'000'000}),
           window("part", Duration{0}, Duration{500'000}, budget(Duration{400'000}), run(static_part)),
           connect(static_part.out, static_part.in, delayed_by_a_frame(), any_age()));
MAMORI_CHECK(kSystem);

TEST(CComponentTest, AComponentInCIsStaticAndPartOfASystemTable) {
    verifies("SWR-CIF-005", Technique::kInterface);
    EXPECT_EQ(make_view(kSystem).components.size(), 1U);
    EXPECT_EQ(make_view(kSystem).ports.size(), 3U);
    EXPECT_STREQ(make_view(kSystem).ports[2].output->get_name(), "out");
}

}  // namespace
}  // namespace mamori
