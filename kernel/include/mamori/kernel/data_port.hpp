// SPDX-License-Identifier: Apache-2.0
/// @file
/// Latest-value data ports. A component writes into its OutPort and reads its InPort; the executive moves
/// values at window boundaries, so what is read does not depend on how long the code took (logical execution
/// time). Within one window the executive hands a value on to the components that come later in its order.
///
/// @satisfies SWR-KRN-015, SWR-KRN-016      Design: docs/design/kernel.md#ports
#ifndef MAMORI_KERNEL_DATA_PORT_HPP
#define MAMORI_KERNEL_DATA_PORT_HPP

#include <cstdint>

#include "mamori/kernel/fields.hpp"
#include "mamori/kernel/time.hpp"
#include "mamori/kernel/trace_hash.hpp"

namespace mamori {

/// Must an input be fed by a connection? The system table refuses a mandatory one that is not.
enum class Need : std::uint8_t { kMandatory, kOptional };

/// Type-free part of an output, for the executive and the table.
class OutPortBase {
  public:
    OutPortBase(const OutPortBase&) = delete;
    OutPortBase& operator=(const OutPortBase&) = delete;

    const char* get_name() const noexcept { return name_; }
    /// Number of publications so far (wraps at 2^32).
    std::uint32_t get_sequence() const noexcept { return sequence_; }
    /// True when a value was written since the last publication.
    bool is_staged() const noexcept { return is_staged_; }

    /// Makes the staged value the published one. For the executive, at the close of the window.
    /// @param[in] now instant of publication. @return true when there was one.
    bool publish(Instant now) noexcept;
    /// Throws the staged value away: its window overran. What was published before stays.
    void discard() noexcept { is_staged_ = false; }
    /// Adds the published value, its sequence and instant.
    void hash_into(TraceHash& hash) const noexcept;

  protected:
    using CopyStaged = void (*)(OutPortBase&) noexcept;
    using HashPublished = void (*)(const OutPortBase&, TraceHash&) noexcept;

    constexpr OutPortBase(const char* name, CopyStaged copy, HashPublished hash) noexcept
        : name_(name), copy_staged_(copy), hash_published_(hash) {}
    ~OutPortBase() = default;

    const char* name_;
    CopyStaged copy_staged_;
    HashPublished hash_published_;
    Instant published_at_{};
    std::uint64_t revision_{0U};            ///< writes so far
    std::uint64_t published_revision_{0U};  ///< of them, the one that is published
    std::uint32_t sequence_{0U};
    bool is_staged_{false};
};

/// Type-free part of an input.
class InPortBase {
  public:
    InPortBase(const InPortBase&) = delete;
    InPortBase& operator=(const InPortBase&) = delete;

    const char* get_name() const noexcept { return name_; }
    /// False until the first value has arrived.
    bool has_value() const noexcept { return has_value_; }
    /// True when the value arrived since the last cycle in which its owner was Active or in Error and came
    /// through its first pass within the budget. A value that the owner had no chance to use stays new.
    bool is_new() const noexcept { return is_new_; }
    /// Time since the value was published, or handed on within the window; without meaning before
    /// has_value(). @param[in] now start of the window, as in ContextHandle::now.
    Duration calc_age(Instant now) const noexcept { return now - published_at_; }
    /// For the executive, after the owner's cycle.
    void mark_read() noexcept { is_new_ = false; }

  protected:
    constexpr explicit InPortBase(const char* name) noexcept : name_(name) {}
    ~InPortBase() = default;

    const char* name_;
    Instant published_at_{};
    std::uint64_t revision_{0U};  ///< write of the source that is held here
    bool has_value_{false};
    bool is_new_{false};
};

/// Output of type T. The value is a trivially copyable payload with a field list (or a plain number).
///
/// Thread safety: written by its component, published by the executive of the same core.
/// Time: O(sizeof(T)). Memory: two T.
template <typename T>
class OutPort final : public OutPortBase {
    static_assert(is_payload<T>(),
                  "a payload needs MAMORI_FIELDS(Type, field, ...) and must be trivially copyable");

  public:
    using Payload = T;

    /// @param[in] name port name with static storage.
    constexpr explicit OutPort(const char* name) noexcept
        : OutPortBase(name, &copy_staged, &hash_published) {}

    /// Stages a value for the close of the window; a second write in one cycle replaces the first.
    void write(const T& value) noexcept {
        staged_ = value;
        ++revision_;
        is_staged_ = true;
    }

    /// Last published value; a value-initialised T before the first publication.
    const T& get_published() const noexcept { return published_; }

  private:
    template <typename U, Need kNeed>
    friend class InPort;

    static void copy_staged(OutPortBase& base) noexcept {
        OutPort& self = static_cast<OutPort&>(base);
        self.published_ = self.staged_;
    }
    static void hash_published(const OutPortBase& base, TraceHash& hash) noexcept {
        hash.add(static_cast<const OutPort&>(base).published_);
    }

    T staged_{};
    T published_{};
};

/// Input of type T.
///
/// Thread safety: read by its component, filled by the executive of the same core.
/// Time: O(sizeof(T)). Memory: one T.
template <typename T, Need kNeed = Need::kMandatory>
class InPort final : public InPortBase {
    static_assert(is_payload<T>(),
                  "a payload needs MAMORI_FIELDS(Type, field, ...) and must be trivially copyable");

  public:
    using Payload = T;
    static constexpr bool kIsMandatory = kNeed == Need::kMandatory;

    /// @param[in] name port name with static storage.
    constexpr explicit InPort(const char* name) noexcept : InPortBase(name) {}

    /// Latched value; a value-initialised T while has_value() is false.
    const T& read() const noexcept { return value_; }

    /// Takes what `source` has published, when it is newer than what is held. For the executive, at the
    /// opening of the window.
    void latch(const OutPort<T>& source) noexcept {
        if (source.published_revision_ > revision_) {
            take(source.published_, source.published_revision_, source.published_at_);
        }
    }

    /// Takes what `source` has staged in this very window, ahead of its publication. For the executive.
    /// @param[in] now start of the window.
    void hand_on(const OutPort<T>& source, Instant now) noexcept {
        if (source.is_staged_ && source.revision_ > revision_) {
            take(source.staged_, source.revision_, now);
        }
    }

  private:
    void take(const T& value, std::uint64_t revision, Instant published_at) noexcept {
        value_ = value;
        revision_ = revision;
        published_at_ = published_at;
        has_value_ = true;
        is_new_ = true;
    }

    T value_{};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_DATA_PORT_HPP
