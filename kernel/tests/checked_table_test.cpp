// SPDX-License-Identifier: Apache-2.0
// Goal: an executive of a table that the compiler has checked still rejects each violation that the compiler
// cannot see, as any other executive does, and runs what its table needs. Method: tables with such
// violations, some with rows that mamori::system() never makes.
#include <gtest/gtest.h>

#include <array>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

/// Writes its cycle count in the first pass, or in the second.
class Source final : public Component {
  public:
    constexpr explicit Source(const char* name) noexcept : Component(name) {}
    OutPort<int> out{*this, "out"};
    using Ports = mamori::Ports<&Source::out>;
    Status on_execute(ContextHandle) noexcept override {
        out.write(++count_);
        return Status::kOk;
    }

  private:
    int count_{0};
};
class Sink final : public Component {
  public:
    constexpr explicit Sink(const char* name) noexcept : Component(name) {}
    InPort<int> in{*this, "in"};
    using Ports = mamori::Ports<&Sink::in>;
    int last{0};
    int updates{0};
    Status on_execute(ContextHandle) noexcept override {
        last = in.read();
        return Status::kOk;
    }
    Status on_state_update(ContextHandle) noexcept override {
        ++updates;
        return Status::kOk;
    }
};
/// Cannot be constructed by the compiler alone, so its lists are not checked there.
struct Key {};
class Secretive final : public Component {
  public:
    constexpr Secretive(Key, const char* name) noexcept : Component(name) {}
    OutPort<int> out{*this, "out"};
    using Ports = mamori::Ports<>;
};
class Tuned final : public Component {
  public:
    constexpr Tuned(Key, const char* name) noexcept : Component(name) {}
    Parameter<int> gain{*this, "gain", 1, between(0, 9)};
};
class Adjustable final : public Component {
  public:
    constexpr explicit Adjustable(const char* name) noexcept : Component(name) {}
    Parameter<int> gain{*this, "gain", 1, between(0, 9)};
    using Parameters = mamori::Parameters<&Adjustable::gain>;
};

MAMORI_CONSTINIT Source source{"source"};
MAMORI_CONSTINIT Sink sink{"sink"};
MAMORI_CONSTINIT Sink namesake{"source"};
MAMORI_CONSTINIT Sink other_sink{"other_sink"};
MAMORI_CONSTINIT Secretive secretive{Key{}, "secretive"};
MAMORI_CONSTINIT Tuned tuned{Key{}, "tuned"};
MAMORI_CONSTINIT Adjustable adjustable{"adjustable"};
MAMORI_CONSTINIT Adjustable twin{"adjustable"};

template <typename... Cs>
constexpr auto make_table(Cs&... components) noexcept {
    return system(frame(1_ms), window("w", 0_us, 500_us, budget(400_us), run(components...)));
}
template <typename Table, typename Change>
constexpr Table change(Table table, const Change& change) noexcept {
    change(table);
    return table;
}

template <typename... Cs>
constexpr auto make_fork(Cs&... others) noexcept {
    return system(frame(1_ms),
                  window("w", 0_us, 500_us, budget(400_us), run(source, sink, other_sink, others...)),
                  connect(source.out, sink.in, any_age()), connect(source.out, other_sink.in, any_age()));
}
constexpr auto kFork = make_fork();
constexpr auto kForkWithParameter = make_fork(adjustable);
constexpr auto kForward = system(frame(1_ms), window("w", 0_us, 500_us, budget(400_us), run(source, sink)),
                                 connect(source.out, sink.in, any_age()));
constexpr auto kPlain =
    system(frame(1_ms), window("w", 0_us, 400_us, budget(300_us), run(source)),
           window("v", 500_us, 400_us, budget(300_us), run(sink)), connect(source.out, sink.in, any_age()));
constexpr auto kSets = system(frame(1_ms), window("w", 0_us, 500_us, budget(400_us), run(adjustable)),
                              configuration_set("high", assign(adjustable.gain, 5)));

constexpr auto kNamesakes =
    system(frame(1_ms), window("w", 0_us, 500_us, budget(400_us), run(source, namesake)),
           connect(source.out, namesake.in, any_age()));
constexpr auto kSecretive = make_table(secretive);
constexpr auto kTuned = make_table(tuned);
constexpr auto kSecretiveWithParameter = make_table(adjustable, secretive);
constexpr auto kTunedWithParameter = make_table(adjustable, tuned);
constexpr auto kTwins = make_table(adjustable, twin);
/// `kIndex`: of the row with the violation.
template <const auto& kTable, std::size_t kIndex>
constexpr auto kWithoutCount = change(kTable, [](auto& table) { table.ports[kIndex].count = nullptr; });
template <const auto& kTable, std::size_t kIndex>
constexpr auto kWithoutLatch =
    change(kTable, [](auto& table) { table.connections[kIndex].operations.latch = nullptr; });
template <const auto& kTable, std::size_t kIndex>
constexpr auto kWithoutRestart =
    change(kTable, [](auto& table) { table.connections[kIndex].operations.restart = nullptr; });
constexpr auto kTooFewValues =
    change(kSets, [](auto& table) { table.configuration.assignments[0].value_count = 0U; });

template <const auto& kTable>
MAMORI_CONSTINIT ExecutiveFor<typename CheckedTable<kTable>::Table> executive{kChecked<kTable>};
MAMORI_CONSTINIT SystemModes modes{make_view(kSets)};
MAMORI_CONSTINIT ExecutiveFor executive_with_sets{kChecked<kSets>, modes};
MAMORI_CONSTINIT SystemModes false_modes{make_view(kTooFewValues)};
MAMORI_CONSTINIT ExecutiveFor executive_with_false_sets{kChecked<kTooFewValues>, false_modes};

/// An executive that checks everything must agree.
template <const auto& kTable>
void expect_refused() {
    EXPECT_EQ(executive<kTable>.initialize(), Status::kBadParameter);
    ExecutiveFor unproven{kTable};
    EXPECT_EQ(unproven.initialize(), Status::kBadParameter);
    EXPECT_EQ(executive<kTable>.get_failed_component(), unproven.get_failed_component());
}

TEST(CheckedTableTest, TwoComponentsWithOneNameAreRejected) {
    verifies("SWR-KRN-070", Technique::kFaultInjection, Polarity::kViolation);
    expect_refused<kNamesakes>();
    expect_refused<kTwins>();
}

TEST(CheckedTableTest, PortThatIsNotListedIsRejected) {
    verifies("SWR-KRN-070", Technique::kFaultInjection, Polarity::kViolation);
    expect_refused<kSecretive>();
    EXPECT_EQ(executive<kSecretive>.get_failed_component(), 0U);
    expect_refused<kSecretiveWithParameter>();
}

TEST(CheckedTableTest, ParameterThatIsNotListedIsRejected) {
    verifies("SWR-KRN-070", Technique::kFaultInjection, Polarity::kViolation);
    expect_refused<kTuned>();
    EXPECT_EQ(executive<kTuned>.get_failed_component(), 0U);
    expect_refused<kTunedWithParameter>();
    EXPECT_EQ(executive<kTunedWithParameter>.get_failed_component(), 1U);
}

template <const auto& kTable, std::size_t kIndex>
void expect_functions_are_required() {
    expect_refused<kWithoutCount<kTable, kIndex>>();
    expect_refused<kWithoutLatch<kTable, kIndex>>();
    expect_refused<kWithoutRestart<kTable, kIndex>>();
}

TEST(CheckedTableTest, MissingFunctionIsRejected) {
    verifies("SWR-KRN-070", Technique::kFaultInjection, Polarity::kViolation);
    expect_functions_are_required<kFork, 0U>();
    expect_functions_are_required<kFork, 1U>();
    expect_functions_are_required<kForkWithParameter, 0U>();
    expect_functions_are_required<kForkWithParameter, 1U>();
}

TEST(CheckedTableTest, SetWithTooFewValuesIsRejected) {
    verifies("SWR-KRN-070", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(executive_with_false_sets.initialize(), Status::kBadParameter);
    ExecutiveFor unproven{kTooFewValues, false_modes};
    EXPECT_EQ(unproven.initialize(), Status::kBadParameter);
}

TEST(CheckedTableTest, SoundTableWithSetsStarts) {
    verifies("SWR-KRN-070", Technique::kRequirementsBased);
    ASSERT_EQ(executive_with_sets.initialize(), Status::kOk);
    EXPECT_EQ(executive_with_sets.start(), Status::kOk);
    EXPECT_EQ(executive_with_sets.stop(), Status::kOk);
    EXPECT_EQ(executive_with_sets.finalize(), Status::kOk);
}

TEST(CheckedTableTest, ForwardConnectionAndSecondPassAreServed) {
    verifies("SWR-KRN-071", Technique::kRequirementsBased);
    Executive& sut = executive<kForward>;
    FakeHost host;
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    const int updates = sink.updates;
    EXPECT_EQ(sut.run_window(0U, host), WindowOutcome::kCompleted);
    EXPECT_EQ(sink.last, source.out.get_published());
    EXPECT_EQ(sink.updates, updates + 1);
    EXPECT_EQ(sut.stop(), Status::kOk);
    EXPECT_EQ(sut.finalize(), Status::kOk);
}

TEST(CheckedTableTest, ObserverOfATableWithoutForwardConnectionReceivesItsRecords) {
    verifies("SWR-KRN-071", Technique::kRequirementsBased);
    SpyObserver observer;
    ExecutiveFor sut{kChecked<kPlain>};
    FakeHost host;
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    sut.set_observer(&observer);
    EXPECT_EQ(sut.run_window(0U, host), WindowOutcome::kCompleted);
    EXPECT_EQ(observer.take_seen(2U), (std::vector<std::uint32_t>{ExecutionRecord::kWithin, 0U}));
    EXPECT_EQ(sut.stop(), Status::kOk);
    EXPECT_EQ(sut.finalize(), Status::kOk);
}

TEST(CheckedTableTest, IntrospectionOfATableWithoutForwardConnectionShowsTheTimes) {
    verifies("SWR-KRN-071", Technique::kRequirementsBased);
    SpyObserver observer;
    IntrospectionFor introspection{kPlain};
    ExecutiveFor sut{kChecked<kPlain>};
    FakeHost host;
    host.durations[{0U, FakeHost::Pass::kExecute}] = 30_us;
    sut.set_observer(&observer);
    sut.set_introspection(&introspection);
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    EXPECT_EQ(sut.run_window(0U, host), WindowOutcome::kCompleted);
    ComponentSnapshot shown{};
    ASSERT_EQ(introspection.read_component(0U, shown), Status::kOk);
    EXPECT_EQ(shown.worst_used, 30_us);
    EXPECT_EQ(sut.stop(), Status::kOk);
    EXPECT_EQ(sut.finalize(), Status::kOk);
}

TEST(CheckedTableTest, TableWithoutForwardConnectionIsServedToo) {
    verifies("SWR-KRN-071", Technique::kRequirementsBased);
    Executive& sut = executive<kPlain>;
    FakeHost host;
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    const int updates = sink.updates;
    EXPECT_EQ(sut.run_window(0U, host), WindowOutcome::kCompleted);
    EXPECT_EQ(sut.run_window(1U, host), WindowOutcome::kCompleted);
    EXPECT_EQ(sink.last, source.out.get_published());
    EXPECT_EQ(sink.updates, updates + 1);
    EXPECT_EQ(sut.stop(), Status::kOk);
    EXPECT_EQ(sut.finalize(), Status::kOk);
}

}  // namespace
}  // namespace mamori
