// SPDX-License-Identifier: Apache-2.0
/// @file
/// Stands in for std::atomic in the kernel's buffers, so that Relacy can run them under every order that the
/// C++ memory model allows: a load may give any value that happens-before does not rule out. Relacy's
/// header redefines words of the language, so it is included here, last, and they are given back.
#ifndef MAMORI_VERIFICATION_MEMORY_MODEL_RELAXED_WORD_HPP
#define MAMORI_VERIFICATION_MEMORY_MODEL_RELAXED_WORD_HPP

#include <atomic>
#include <cstddef>
#include <cstdint>

#include <relacy/relacy.hpp>

#undef assert
#undef calloc
#undef delete
#undef errno
#undef free
#undef malloc
#undef memory_order_acq_rel
#undef memory_order_acquire
#undef memory_order_consume
#undef memory_order_relaxed
#undef memory_order_release
#undef memory_order_seq_cst
#undef new
#undef realloc

namespace mamori::verification {

/// Orders as they are written in the code under test.
struct AsWritten {
    static std::memory_order weaken(std::memory_order order) { return order; }
    static std::memory_order weaken_store(std::memory_order order, std::uint64_t) { return order; }
};

/// Threads of the suites.
constexpr unsigned kWriter = 0U;
constexpr unsigned kReader = 1U;

/// A seeded defect: each operation of thread kThread that asks for kFrom gets kTo.
template <std::memory_order kFrom, std::memory_order kTo, unsigned kThread>
struct Weakened {
    static std::memory_order weaken(std::memory_order order) {
        return order == kFrom && rl::thread_index() == kThread ? kTo : order;
    }
    static std::memory_order weaken_store(std::memory_order order, std::uint64_t) { return weaken(order); }
};

/// A seeded defect: the announcement of the overwriting FIFO, whose values are below those of an entry, gets
/// no order.
struct WeakAnnouncement : AsWritten {
    static std::memory_order weaken_store(std::memory_order order, std::uint64_t value) {
        return value < 0x100U ? std::memory_order_relaxed : order;
    }
};

/// One word. `Orders` may weaken the orders, to seed a defect.
template <typename T, typename Orders = AsWritten>
class RelaxedWord {
  public:
    using value_type = T;
    static constexpr bool is_always_lock_free = true;                            // NOLINT: as std::atomic
    RelaxedWord(T value = T{}) { word_.store(value, rl::mo_relaxed, RL_INFO); }  // NOLINT: as std::atomic

    T load(std::memory_order order) const { return word_.load(get(Orders::weaken(order)), RL_INFO); }
    void store(T value, std::memory_order order) {
        word_.store(value, get(Orders::weaken_store(order, value)), RL_INFO);
    }
    T exchange(T value, std::memory_order order) {
        return word_.exchange(value, get(Orders::weaken(order)), RL_INFO);
    }
    bool compare_exchange_strong(T& expected, T value, std::memory_order success, std::memory_order failure) {
        return word_.compare_exchange_strong(expected, value, get(Orders::weaken(success)), RL_INFO,
                                             get(Orders::weaken(failure)), RL_INFO);
    }

  private:
    static rl::memory_order get(std::memory_order order) {
        switch (order) {
            case std::memory_order_relaxed:
                return rl::mo_relaxed;
            case std::memory_order_acquire:
                return rl::mo_acquire;
            case std::memory_order_release:
                return rl::mo_release;
            case std::memory_order_acq_rel:
                return rl::mo_acq_rel;
            case std::memory_order_consume:
            case std::memory_order_seq_cst:
                break;
        }
        return rl::mo_seq_cst;
    }

    rl::atomic<T> word_;
};

/// Payload of a slot: Relacy watches the accesses and reports each pair that happens-before does not order.
/// The slot itself only tells by its address which of the payloads is meant.
template <typename Slot, std::size_t kBytes>
class Payloads {
  public:
    void write(const void* buffer, const Slot& slot, unsigned value) { get(buffer, slot)(RL_INFO) = value; }
    unsigned read(const void* buffer, const Slot& slot) { return get(buffer, slot)(RL_INFO); }

  private:
    rl::var<unsigned>& get(const void* buffer, const Slot& slot) {
        const auto offset =
            reinterpret_cast<std::uintptr_t>(&slot) - reinterpret_cast<std::uintptr_t>(buffer);
        return payloads_[offset / sizeof(Slot)];
    }

    rl::var<unsigned> payloads_[kBytes / sizeof(Slot) + 1U];
};

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_MEMORY_MODEL_RELAXED_WORD_HPP
