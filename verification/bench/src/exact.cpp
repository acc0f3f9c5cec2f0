// SPDX-License-Identifier: Apache-2.0
/// @file
/// Executes one operation a given number of times under callgrind. Only instructions inside the functions
/// measured_... count. callgrind collects while one of them runs, and clears its counts at begin_counting(),
/// after a warm-up.
///
///     mamori_exact --about                     operations, compiler and C library as JSON
///     mamori_exact OPERATION COUNT [--sealed]  --sealed: without any system call, or the process is killed
///
/// @satisfies SWR-BEN-006, SWR-BEN-007      Design: docs/design/bench.md#exact-counts
#include <gnu/libc-version.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "connection_rig.hpp"
#include "e2e_rig.hpp"
#include "executive_rig.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "seal.hpp"
#include "seqlock.hpp"
#include "subject.hpp"

namespace mamori::verification::bench {
namespace {

/// A port with a value to write; the last value read is stored so that the compiler keeps the read.
template <std::size_t kSize>
struct PortRig {
    Message<kSize> value{};
    Message<kSize> read{};
    OutPort<Message<kSize>> out{kNoOwner, "out"};
    InPort<Message<kSize>> in{kNoOwner, "in"};

    void exchange() noexcept {
        out.write(value);
        out.publish(Instant{});
        touch(out);
        in.take(out.get_published_sample());
        touch(in);
        read[0] = in.read()[0];
    }
};

struct SeqlockRig {
    Message<64U> value{};
    Message<64U> read{};
    Seqlock<Message<64U>> lock;
};

/// A message of 64 bytes that is protected and then checked.
template <typename Profile>
struct FrameRig {
    static constexpr safety::SentIdChannel kChannel{0x0A0B0C0DU, 64U, 64U};
    static_assert(safety::is_sound<Profile, kChannel>());

    std::array<std::byte, 64U> frame{};
    safety::E2eProtector<Profile> sender{kChannel};
    safety::HardenedE2eChecker<Profile> receiver{kChannel, {1U}};

    void exchange() noexcept {
        static_cast<void>(sender.protect(frame));
        touch(frame);
        safety::CheckStatus status = receiver.check(frame);
        touch(status);
    }
};

PortRig<8U> g_port_8;
PortRig<64U> g_port_64;
SeqlockRig g_seqlock;
FrameRig<safety::E2eProfile04<>> g_frame;
FrameRig<safety::E2eProfile07<>> g_frame_p07;
E2eRig<32U> g_e2e_port;
const Message<32U> g_e2e_value{};
ComponentPool g_pool{1U};
Component* g_component = &g_pool.at(0U);
ExecutiveRig<10U, CountingClock> g_ten;
ExecutiveRig<20U, CountingClock> g_twenty;
ExecutiveRig<10U, CountingClock> g_supervised_ten;
ExecutiveRig<20U, CountingClock> g_supervised_twenty;
ExecutiveRig<10U, SystemClock> g_clocked_ten;
ExecutiveRig<20U, SystemClock> g_clocked_twenty;
ConnectionRig<10U, 8U> g_ten_connections_8;
ConnectionRig<20U, 8U> g_twenty_connections_8;
ConnectionRig<10U, 64U> g_ten_connections_64;
ConnectionRig<20U, 64U> g_twenty_connections_64;
void* volatile g_leftover;

}  // namespace

// callgrind receives these names as arguments; C linkage keeps them unchanged.
extern "C" {
[[gnu::noinline]] void measured_port_8() {
    g_port_8.exchange();
}
[[gnu::noinline]] void measured_port_64() {
    g_port_64.exchange();
}
[[gnu::noinline]] void measured_seqlock_64() {
    g_seqlock.lock.write(g_seqlock.value);
    touch(g_seqlock);
    static_cast<void>(g_seqlock.lock.try_read(g_seqlock.read));
    touch(g_seqlock);
}
[[gnu::noinline]] void measured_e2e_64() {
    g_frame.exchange();
}
[[gnu::noinline]] void measured_e2e_p07_64() {
    g_frame_p07.exchange();
}
[[gnu::noinline]] void measured_e2e_port_32() {
    g_e2e_port.exchange(g_e2e_value);
}
[[gnu::noinline]] void measured_crc32_64() {
    safety::Crc<safety::kCrc32P4> crc;
    crc.add(g_frame.frame);
    std::uint32_t value = crc.get_value();
    touch(value);
}
[[gnu::noinline]] void measured_virtual_call() {
    static_cast<void>(g_component->on_execute({0, Instant{}}));
    touch(g_component);
}
[[gnu::noinline]] void measured_cycle_10() {
    g_ten.run_cycle();
}
[[gnu::noinline]] void measured_cycle_20() {
    g_twenty.run_cycle();
}
[[gnu::noinline]] void measured_supervised_cycle_10() {
    g_supervised_ten.run_supervised_cycle();
}
[[gnu::noinline]] void measured_supervised_cycle_20() {
    g_supervised_twenty.run_supervised_cycle();
}
[[gnu::noinline]] void measured_clocked_cycle_10() {
    g_clocked_ten.run_supervised_cycle();
}
[[gnu::noinline]] void measured_clocked_cycle_20() {
    g_clocked_twenty.run_supervised_cycle();
}
[[gnu::noinline]] void measured_connections_8_10() {
    g_ten_connections_8.run_frame();
}
[[gnu::noinline]] void measured_connections_8_20() {
    g_twenty_connections_8.run_frame();
}
[[gnu::noinline]] void measured_connections_64_10() {
    g_ten_connections_64.run_frame();
}
[[gnu::noinline]] void measured_connections_64_20() {
    g_twenty_connections_64.run_frame();
}
// Two intentional violations, which the checks of the other operations must find.
[[gnu::noinline]] void measured_seeded_heap() {
    g_leftover = std::malloc(8U);
    std::free(g_leftover);
}
[[gnu::noinline]] void measured_seeded_system_call() {
    syscall(SYS_getppid);
}

/// callgrind clears its counts here.
[[gnu::noinline]] void begin_counting() {
    asm volatile("" : : : "memory");
}
}

namespace {

struct Operation {
    const char* name;
    void (*work)();
};

constexpr std::array<Operation, 20> kOperations{{
    {"port_8", &measured_port_8},
    {"port_64", &measured_port_64},
    {"seqlock_64", &measured_seqlock_64},
    {"e2e_64", &measured_e2e_64},
    {"e2e_p07_64", &measured_e2e_p07_64},
    {"e2e_port_32", &measured_e2e_port_32},
    {"crc32_64", &measured_crc32_64},
    {"virtual_call", &measured_virtual_call},
    {"cycle_10", &measured_cycle_10},
    {"cycle_20", &measured_cycle_20},
    {"supervised_cycle_10", &measured_supervised_cycle_10},
    {"supervised_cycle_20", &measured_supervised_cycle_20},
    {"clocked_cycle_10", &measured_clocked_cycle_10},
    {"clocked_cycle_20", &measured_clocked_cycle_20},
    {"connections_8_10", &measured_connections_8_10},
    {"connections_8_20", &measured_connections_8_20},
    {"connections_64_10", &measured_connections_64_10},
    {"connections_64_20", &measured_connections_64_20},
    {"seeded_heap", &measured_seeded_heap},
    {"seeded_system_call", &measured_seeded_system_call},
}};

constexpr unsigned long kWarmUpCount = 16U;

int print_about() {
    std::printf("{\"compiler\": \"%s\", \"c_library\": \"glibc %s\", \"operations\": [",
                MAMORI_BENCH_COMPILER, gnu_get_libc_version());
    for (std::size_t i = 0U; i < kOperations.size(); ++i) {
        std::printf("%s\"%s\"", i == 0U ? "" : ", ", kOperations[i].name);
    }
    std::puts("]}");
    return 0;
}

int fail(const char* text, const char* word) {
    std::fprintf(stderr, "mamori_exact: %s '%s'; see mamori_exact --about\n", text, word);
    return 2;
}

int run(const Operation& operation, unsigned long count, bool is_sealed) {
    g_supervised_ten.supervise();
    g_supervised_twenty.supervise();
    g_clocked_ten.supervise();
    g_clocked_twenty.supervise();
    for (unsigned long i = 0U; i < kWarmUpCount; ++i) {
        operation.work();
    }
    if (is_sealed && !seal_process()) {
        std::fputs("mamori_exact: this system does not let a process give its system calls up\n", stderr);
        return 1;
    }
    begin_counting();
    for (unsigned long i = 0U; i < count; ++i) {
        operation.work();
    }
    leave_sealed(0);
}

}  // namespace
}  // namespace mamori::verification::bench

int main(int argc, char** argv) {
    using namespace mamori::verification::bench;
    if (argc == 2 && std::strcmp(argv[1], "--about") == 0) {
        return print_about();
    }
    const bool is_sealed = argc == 4 && std::strcmp(argv[3], "--sealed") == 0;
    if (argc != 3 && !is_sealed) {
        return fail("wants OPERATION COUNT [--sealed], not", argc > 1 ? argv[1] : "");
    }
    char* end = nullptr;
    const unsigned long count = std::strtoul(argv[2], &end, 10);
    if (count == 0U || *end != '\0') {
        return fail("COUNT is a whole number from 1 on, not", argv[2]);
    }
    for (const Operation& operation : kOperations) {
        if (std::strcmp(operation.name, argv[1]) == 0) {
            return run(operation, count, is_sealed);
        }
    }
    return fail("there is no operation", argv[1]);
}
