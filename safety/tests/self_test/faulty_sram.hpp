// SPDX-License-Identifier: Apache-2.0
/// @file
/// Simulated memory with the faults that march tests are measured by. The faults sit below the accesses, so
/// an algorithm cannot tell it from real memory.
#ifndef MAMORI_SAFETY_TESTS_SELF_TEST_FAULTY_SRAM_HPP
#define MAMORI_SAFETY_TESTS_SELF_TEST_FAULTY_SRAM_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mamori::safety {

enum class FaultKind {
    kNone,
    kStuckAt,             ///< the victim holds `value`
    kTransition,          ///< the victim cannot change to `value`
    kCouplingInversion,   ///< a change of the aggressor to `trigger` inverts the victim
    kCouplingIdempotent,  ///< a change of the aggressor to `trigger` makes the victim `value`
    kCouplingState,       ///< while the aggressor is `trigger`, the victim is `value`
    kNoCell,         ///< address `aggressor` has no cell: writes are lost, reads give `value` in all bits
    kOtherCell,      ///< address `aggressor` has the cell of `victim`
    kSecondCell,     ///< address `aggressor` has the cell of `victim` too; reads are wired and (0), or (1)
    kDeceptiveRead,  ///< a read gives the right value and inverts the victim
};

/// Bits are numbered through all words. For faults of addresses, aggressor and victim are words.
struct MemoryFault {
    FaultKind kind{FaultKind::kNone};
    std::size_t aggressor{0U};
    std::size_t victim{0U};
    bool trigger{false};
    bool value{false};
};

class FaultySram final {
  public:
    using Word = std::uint8_t;
    static constexpr std::size_t kBits = 8U;

    explicit FaultySram(std::size_t words, const MemoryFault& fault = {})
        : cells_(words, 0xA5U), fault_(fault) {
        settle();
    }

    std::size_t size() const { return cells_.size(); }
    Word read(std::size_t index) {
        ++reads_;
        touched_.push_back(index);
        if (fault_.kind == FaultKind::kNoCell && index == fault_.aggressor) {
            return fault_.value ? 0xFFU : 0x00U;
        }
        if (fault_.kind == FaultKind::kOtherCell && index == fault_.aggressor) {
            return cells_[fault_.victim];
        }
        if (fault_.kind == FaultKind::kSecondCell && index == fault_.aggressor) {
            const Word other = cells_[fault_.victim];
            return static_cast<Word>(fault_.value ? cells_[index] | other : cells_[index] & other);
        }
        const Word value = cells_[index];
        if (fault_.kind == FaultKind::kDeceptiveRead && index == fault_.victim / kBits) {
            set(fault_.victim, !get(fault_.victim));
        }
        return value;
    }
    void write(std::size_t index, Word value) {
        ++writes_;
        touched_.push_back(index);
        if (fault_.kind == FaultKind::kNoCell && index == fault_.aggressor) {
            return;
        }
        if (fault_.kind == FaultKind::kOtherCell && index == fault_.aggressor) {
            cells_[fault_.victim] = value;
            return;
        }
        if (fault_.kind == FaultKind::kSecondCell && index == fault_.aggressor) {
            cells_[fault_.victim] = value;
        }
        const bool aggressor_before = get_aggressor();
        const bool victim_before = get_victim();
        cells_[index] = value;
        if (fault_.kind == FaultKind::kTransition && victim_before != fault_.value &&
            get_victim() == fault_.value) {
            set(fault_.victim, victim_before);
        }
        const bool is_triggered = aggressor_before != get_aggressor() && get_aggressor() == fault_.trigger;
        if (fault_.kind == FaultKind::kCouplingInversion && is_triggered) {
            set(fault_.victim, !get_victim());
        }
        if (fault_.kind == FaultKind::kCouplingIdempotent && is_triggered) {
            set(fault_.victim, fault_.value);
        }
        settle();
    }

    /// The contents, past all faults of addresses.
    std::vector<Word> cells_;
    std::size_t reads_{0U};
    std::size_t writes_{0U};
    std::vector<std::size_t> touched_{};

  private:
    bool get(std::size_t bit) const {
        return ((std::uint64_t{cells_[bit / kBits]} >> (bit % kBits)) & 1U) != 0U;
    }
    void set(std::size_t bit, bool value) {
        // As the widest word, so that no narrower one is widened with a sign on the way.
        const std::uint64_t mask = std::uint64_t{1U} << (bit % kBits);
        const std::uint64_t cell = cells_[bit / kBits];
        cells_[bit / kBits] = static_cast<Word>(value ? cell | mask : cell & ~mask);
    }
    bool get_aggressor() const { return fault_.aggressor < size() * kBits && get(fault_.aggressor); }
    bool get_victim() const { return fault_.victim < size() * kBits && get(fault_.victim); }
    void settle() {
        const bool is_forced =
            fault_.kind == FaultKind::kStuckAt ||
            (fault_.kind == FaultKind::kCouplingState && get_aggressor() == fault_.trigger);
        if (is_forced) {
            set(fault_.victim, fault_.value);
        }
    }

    MemoryFault fault_;
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_TESTS_SELF_TEST_FAULTY_SRAM_HPP
