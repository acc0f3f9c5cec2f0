// SPDX-License-Identifier: Apache-2.0
/// @file
/// Subjects of a benchmark program, grouped in cases. The subjects of one case do the same work in different
/// ways, so the ratio of their times is meaningful. Ratios between different cases are not.
///
/// @satisfies SWR-BEN-001      Design: docs/design/bench.md#method
#ifndef MAMORI_VERIFICATION_BENCH_SUBJECT_HPP
#define MAMORI_VERIFICATION_BENCH_SUBJECT_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace mamori::verification::bench {

/// One implementation of the operation of a case.
class Subject {
  public:
    virtual ~Subject() = default;

    /// Executes the operation `count` times.
    /// @return a sum that only completed work yields: see calc_expected() of the kind of the case.
    virtual std::uint64_t run(std::uint64_t count) = 0;
};

/// Evidence of completed work: the sum that a run of `count` operations returns.
using CalcExpected = std::uint64_t (*)(std::uint64_t count, std::size_t size);

/// A subject that can be created. If its creation throws, the program reports the subject as absent with the
/// text of the exception.
struct Candidate {
    std::string name;
    std::unique_ptr<Subject> (*make)();
};

/// Subjects to compare. `size` varies between the repetitions of the case: payload [byte] or number of
/// components.
struct Case {
    std::string metric;
    std::size_t size;
    std::string unit;          ///< of the time of one operation
    std::uint64_t operations;  ///< units in one operation of a subject, > 0
    CalcExpected calc_expected;
    std::vector<Candidate> candidates;
};

/// A reference implementation that this build does not include.
struct AbsentPeer {
    std::string name;
    std::string reason;
};

/// Payload of `kSize` bytes.
template <std::size_t kSize>
using Message = std::array<std::uint64_t, kSize / sizeof(std::uint64_t)>;

/// The value of operation number `i`: two alternating messages, with 0 and 1 as first word. Both are created
/// in advance: if a wider copy reads a word that was stored just before, the processor stalls and hides the
/// measured effect.
template <std::size_t kSize>
class WrittenValues {
  public:
    WrittenValues() noexcept { messages_[1][0] = 1U; }
    const Message<kSize>& operator[](std::uint64_t number) const noexcept { return messages_[number & 1U]; }

  private:
    std::array<Message<kSize>, 2> messages_{};
};

/// Sizes of the port cases [byte].
inline constexpr std::array<std::size_t, 4> kPortSizes{8U, 64U, 1024U, 65536U};

/// Sizes of the payload in the cases of end-to-end protection [byte].
inline constexpr std::array<std::size_t, 3> kE2eSizes{8U, 64U, 1024U};

/// Sizes of the entries in the FIFO cases [byte].
inline constexpr std::array<std::size_t, 3> kFifoSizes{8U, 64U, 1024U};

/// Sizes of the scheduler cases [components].
inline constexpr std::array<std::size_t, 3> kComponentCounts{10U, 100U, 1000U};

/// Tells the compiler that `object` may be read and written here, so that it neither removes nor moves
/// operations on the object.
template <typename T>
inline void touch(T& object) noexcept {
    asm volatile("" : : "r"(&object) : "memory");
}

template <typename T>
std::unique_ptr<Subject> make_subject() {
    return std::make_unique<T>();
}

/// Adds `kSubject<kSize>` to the port case of each size. @param[in] cases one per element of kPortSizes, in
/// the same order.
template <template <std::size_t> class kSubject>
void add_to_ports(std::vector<Case>& cases, const std::string& name) {
    cases[0].candidates.push_back({name, &make_subject<kSubject<kPortSizes[0]>>});
    cases[1].candidates.push_back({name, &make_subject<kSubject<kPortSizes[1]>>});
    cases[2].candidates.push_back({name, &make_subject<kSubject<kPortSizes[2]>>});
    cases[3].candidates.push_back({name, &make_subject<kSubject<kPortSizes[3]>>});
}

/// Adds `kSubject<kSize>` to the end-to-end protection case of each size, like add_to_ports().
template <template <std::size_t> class kSubject>
void add_to_e2e(std::vector<Case>& cases, const std::string& name) {
    cases[0].candidates.push_back({name, &make_subject<kSubject<kE2eSizes[0]>>});
    cases[1].candidates.push_back({name, &make_subject<kSubject<kE2eSizes[1]>>});
    cases[2].candidates.push_back({name, &make_subject<kSubject<kE2eSizes[2]>>});
}

/// Adds `kSubject<kSize>` to the FIFO case of each size, like add_to_ports().
template <template <std::size_t> class kSubject>
void add_to_fifos(std::vector<Case>& cases, const std::string& name) {
    cases[0].candidates.push_back({name, &make_subject<kSubject<kFifoSizes[0]>>});
    cases[1].candidates.push_back({name, &make_subject<kSubject<kFifoSizes[1]>>});
    cases[2].candidates.push_back({name, &make_subject<kSubject<kFifoSizes[2]>>});
}

/// Adds `kSubject<kCount>` to the scheduler case of each size, like add_to_ports().
template <template <std::size_t> class kSubject>
void add_to_schedulers(std::vector<Case>& cases, const std::string& name) {
    cases[0].candidates.push_back({name, &make_subject<kSubject<kComponentCounts[0]>>});
    cases[1].candidates.push_back({name, &make_subject<kSubject<kComponentCounts[1]>>});
    cases[2].candidates.push_back({name, &make_subject<kSubject<kComponentCounts[2]>>});
}

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_SUBJECT_HPP
