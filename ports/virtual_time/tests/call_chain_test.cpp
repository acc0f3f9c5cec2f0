// SPDX-License-Identifier: Apache-2.0
// Goal: on_execute is at most five calls away from the code that runs the windows.
// Method: on_execute takes its backtrace. CMakeLists.txt compiles the functions of this chain without
// optimisation and without always_inline, so each call of the source is one frame. A host with one call more
// shows that the count finds it.
#include <cxxabi.h>
#include <dlfcn.h>
#include <execinfo.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/virtual_host.hpp"
#include "mamori/trace/verifies.hpp"

// Not in an unnamed namespace: dladdr() finds the names of exported functions only.
namespace mamori::ports::virtual_time::call_chain {

using verification::Polarity;
using verification::Technique;
using verification::verifies;

/// Names of the functions that are running, innermost first.
std::vector<std::string> take_backtrace() {
    std::array<void*, 64> addresses{};
    const int count = backtrace(addresses.data(), static_cast<int>(addresses.size()));
    std::vector<std::string> names;
    for (int i = 0; i < count; ++i) {
        Dl_info info{};
        const bool is_found = dladdr(addresses.at(static_cast<std::size_t>(i)), &info) != 0;
        const char* const symbol = is_found && info.dli_sname != nullptr ? info.dli_sname : "?";
        int status = 0;
        char* const name = abi::__cxa_demangle(symbol, nullptr, nullptr, &status);
        names.emplace_back(name == nullptr ? symbol : name);
        std::free(name);
    }
    return names;
}

/// Keeps the functions from run_window to its on_execute, innermost first.
class Probe final : public Component {
  public:
    constexpr Probe() noexcept : Component("probe") {}
    OutPort<double> out{*this, "out"};
    using Ports = mamori::Ports<&Probe::out>;
    std::vector<std::string>* chain{nullptr};

    Status on_execute(ContextHandle) noexcept override {
        chain->clear();
        bool is_in_chain = false;
        for (const std::string& name : take_backtrace()) {
            is_in_chain = is_in_chain || name.find("Probe::on_execute") != std::string::npos;
            if (is_in_chain) {
                chain->push_back(name);
            }
            if (name.find("Executive::run_window") != std::string::npos) {
                return Status::kOk;
            }
        }
        chain->clear();
        return Status::kOk;
    }
};
class Sink final : public Component {
  public:
    constexpr Sink() noexcept : Component("sink") {}
    InPort<double> in{*this, "in"};
    using Ports = mamori::Ports<&Sink::in>;
};
class Listener final : public ExecutionObserver {
  public:
    Listener() noexcept : ExecutionObserver(Span<ExecutionRecord>{records_}) {}
    void on_budget_overrun(std::size_t, std::size_t, Instant) noexcept override {}
    void on_late_release(std::size_t, Duration, Instant) noexcept override {}

  private:
    std::array<ExecutionRecord, 2> records_{};
};
/// Runs the work through one function more than VirtualHost.
class LongerHost final : public WindowHost {
  public:
    Instant get_now() const noexcept override { return host_.get_now(); }
    Instant get_step_end() const noexcept override { return host_.get_step_end(); }
    std::size_t run_within(const Work& work, Instant deadline) noexcept override {
        return host_.run_within(work, deadline);
    }
    bool has_returned(std::size_t window) const noexcept override { return host_.has_returned(window); }

  private:
    IndexedVirtualHost host_{Span<Duration>{}};
};

Probe probe;
Sink sink;
constexpr auto kAlone = system(frame(1_ms), window("w", 0_ms, 1_ms, budget(1_ms), run(probe)));
constexpr auto kForward = system(frame(1_ms), window("w", 0_ms, 1_ms, budget(1_ms), run(probe, sink)),
                                 connect(probe.out, sink.in, any_age()));

/// Runs one window. @return the functions from run_window to on_execute, both included.
template <typename Table>
std::vector<std::string> find_chain(const Table& table, WindowHost& host, bool is_observed) {
    std::vector<std::string> chain;
    Listener listener;
    ExecutiveFor<Table> executive{table};
    executive.set_observer(is_observed ? &listener : nullptr);
    probe.chain = &chain;
    EXPECT_EQ(executive.initialize(), Status::kOk);
    EXPECT_EQ(executive.start(), Status::kOk);
    EXPECT_EQ(executive.run_window(0U, host), WindowOutcome::kCompleted);
    EXPECT_EQ(executive.stop(), Status::kOk);
    EXPECT_EQ(executive.finalize(), Status::kOk);
    return chain;
}

std::string join(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) {
        text += name + '\n';
    }
    return text;
}

constexpr std::size_t kCallsMax = 5U;

TEST(CallChainTest, OnExecuteOfAnUnobservedWindowIsAtMostFiveCallsFromRunWindow) {
    verifies("SWR-KRN-041");
    IndexedVirtualHost host{Span<Duration>{}};

    const std::vector<std::string> chain = find_chain(kAlone, host, false);

    ASSERT_FALSE(chain.empty());
    EXPECT_LE(chain.size(), kCallsMax) << join(chain);
}

TEST(CallChainTest, OnExecuteOfASupervisedWindowIsAtMostFiveCallsFromRunWindow) {
    verifies("SWR-KRN-041", Technique::kEquivalenceClasses);
    IndexedVirtualHost host{Span<Duration>{}};

    const std::vector<std::string> chain = find_chain(kAlone, host, true);

    ASSERT_FALSE(chain.empty());
    EXPECT_LE(chain.size(), kCallsMax) << join(chain);
}

TEST(CallChainTest, OnExecuteOfAForwardingWindowIsAtMostFiveCallsFromRunWindow) {
    verifies("SWR-KRN-041", Technique::kEquivalenceClasses);
    IndexedVirtualHost host{Span<Duration>{}};

    const std::vector<std::string> chain = find_chain(kForward, host, true);

    ASSERT_FALSE(chain.empty());
    EXPECT_LE(chain.size(), kCallsMax) << join(chain);
}

TEST(CallChainTest, OneCallMoreIsFound) {
    verifies("SWR-KRN-041", Technique::kFaultInjection, Polarity::kViolation);
    LongerHost host;

    const std::vector<std::string> chain = find_chain(kAlone, host, false);

    EXPECT_EQ(chain.size(), kCallsMax + 1U) << join(chain);
}

}  // namespace mamori::ports::virtual_time::call_chain
