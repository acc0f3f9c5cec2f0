// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reference implementation: iceoryx2 with its process-local service. The loop is in Rust (folder iceoryx2),
/// because one C call per operation would add a cost that users of iceoryx2 do not have.
#include <stdexcept>

#include "catalogue.hpp"

extern "C" {
void* mamori_bench_iceoryx2_open_8();
void* mamori_bench_iceoryx2_open_64();
void* mamori_bench_iceoryx2_open_1024();
void* mamori_bench_iceoryx2_open_65536();
std::uint64_t mamori_bench_iceoryx2_run_8(void* handle, std::uint64_t count);
std::uint64_t mamori_bench_iceoryx2_run_64(void* handle, std::uint64_t count);
std::uint64_t mamori_bench_iceoryx2_run_1024(void* handle, std::uint64_t count);
std::uint64_t mamori_bench_iceoryx2_run_65536(void* handle, std::uint64_t count);
}

namespace mamori::verification::bench {
namespace {

struct Functions {
    void* (*open)();
    std::uint64_t (*run)(void* handle, std::uint64_t count);
};

template <std::size_t kSize>
constexpr Functions kFunctions{};
template <>
constexpr Functions kFunctions<8U>{&mamori_bench_iceoryx2_open_8, &mamori_bench_iceoryx2_run_8};
template <>
constexpr Functions kFunctions<64U>{&mamori_bench_iceoryx2_open_64, &mamori_bench_iceoryx2_run_64};
template <>
constexpr Functions kFunctions<1024U>{&mamori_bench_iceoryx2_open_1024, &mamori_bench_iceoryx2_run_1024};
template <>
constexpr Functions kFunctions<65536U>{&mamori_bench_iceoryx2_open_65536, &mamori_bench_iceoryx2_run_65536};

template <std::size_t kSize>
class Iceoryx2 final : public Subject {
  public:
    Iceoryx2() : handle_(kFunctions<kSize>.open()) {
        if (handle_ == nullptr) {
            throw std::runtime_error("the process-local service could not be opened");
        }
    }

    std::uint64_t run(std::uint64_t count) override { return kFunctions<kSize>.run(handle_, count); }

  private:
    void* handle_;  ///< exists until the program ends
};

}  // namespace

void add_iceoryx2(PeerCases cases) {
    add_to_ports<Iceoryx2>(cases.ports, "iceoryx2 local");
}

}  // namespace mamori::verification::bench
