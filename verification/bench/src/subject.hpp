// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a benchmark program measures: subjects, gathered in cases. The subjects of one case do the same work
/// in different ways, so their times may be divided by one another; the subjects of different cases may not.
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

/// One way to do a case's operation.
class Subject {
  public:
    virtual ~Subject() = default;

    /// Does the operation `count` times.
    /// @return a sum that only done work can give: see calc_expected() of the case's kind.
    virtual std::uint64_t run(std::uint64_t count) = 0;
};

/// Proof that the work was done: the sum that a run of `count` operations returns.
using CalcExpected = std::uint64_t (*)(std::uint64_t count, std::size_t size);

/// A subject that can be made; making it may throw, and then the subject is reported as absent with the
/// exception's text.
struct Candidate {
    std::string name;
    std::unique_ptr<Subject> (*make)();
};

/// Subjects to compare. `size` is what the case is repeated over: payload [byte] or number of components.
struct Case {
    std::string metric;
    std::size_t size;
    std::string unit;          ///< of one operation's time
    std::uint64_t operations;  ///< of that unit in one operation of a subject, > 0
    CalcExpected calc_expected;
    std::vector<Candidate> candidates;
};

/// A peer that this program was built without.
struct AbsentPeer {
    std::string name;
    std::string reason;
};

/// Payload of `kSize` bytes.
template <std::size_t kSize>
using Message = std::array<std::uint64_t, kSize / sizeof(std::uint64_t)>;

/// What operation number `i` writes: two messages in turn, with 0 and 1 as first word. They are made
/// beforehand: a word stored just before the copy that reads it in wider pieces would stall the processor,
/// and hide what is to be measured.
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

/// Sizes of the scheduler cases [components].
inline constexpr std::array<std::size_t, 3> kComponentCounts{10U, 100U, 1000U};

/// Tells the compiler that `object` may be read and written here, so that no work on it is left out or moved.
template <typename T>
inline void touch(T& object) noexcept {
    asm volatile("" : : "r"(&object) : "memory");
}

template <typename T>
std::unique_ptr<Subject> make_subject() {
    return std::make_unique<T>();
}

/// Adds `kSubject<kSize>` to the port case of each size. @param[in] cases one per element of kPortSizes, in
/// that order.
template <template <std::size_t> class kSubject>
void add_to_ports(std::vector<Case>& cases, const std::string& name) {
    cases[0].candidates.push_back({name, &make_subject<kSubject<kPortSizes[0]>>});
    cases[1].candidates.push_back({name, &make_subject<kSubject<kPortSizes[1]>>});
    cases[2].candidates.push_back({name, &make_subject<kSubject<kPortSizes[2]>>});
    cases[3].candidates.push_back({name, &make_subject<kSubject<kPortSizes[3]>>});
}

/// Adds `kSubject<kSize>` to the case of end-to-end protection of each size, as add_to_ports().
template <template <std::size_t> class kSubject>
void add_to_e2e(std::vector<Case>& cases, const std::string& name) {
    cases[0].candidates.push_back({name, &make_subject<kSubject<kE2eSizes[0]>>});
    cases[1].candidates.push_back({name, &make_subject<kSubject<kE2eSizes[1]>>});
    cases[2].candidates.push_back({name, &make_subject<kSubject<kE2eSizes[2]>>});
}

/// Adds `kSubject<kCount>` to the scheduler case of each size, as add_to_ports().
template <template <std::size_t> class kSubject>
void add_to_schedulers(std::vector<Case>& cases, const std::string& name) {
    cases[0].candidates.push_back({name, &make_subject<kSubject<kComponentCounts[0]>>});
    cases[1].candidates.push_back({name, &make_subject<kSubject<kComponentCounts[1]>>});
    cases[2].candidates.push_back({name, &make_subject<kSubject<kComponentCounts[2]>>});
}

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_SUBJECT_HPP
