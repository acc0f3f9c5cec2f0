// SPDX-License-Identifier: Apache-2.0
/// @file
/// A value with the instant at which it was sent. The instant is protected with it, so the receiving port
/// sees a delay on the whole way; without it the way is the last connection, since a transport in between
/// hands on as new whatever it hands on.
///
/// @satisfies SWR-E2E-034      Design: docs/design/e2e.md#ports
#ifndef MAMORI_SAFETY_E2E_STAMPED_HPP
#define MAMORI_SAFETY_E2E_STAMPED_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/kernel/payload/fields.hpp"

namespace mamori::safety {

/// Value of a message whose two ends share a time line, as those of one system and its partitions do.
template <typename T>
struct Stamped {
    std::int64_t sent_at_ns{0};  ///< ContextHandle::now of the cycle that sent it [ns]
    T value{};
};

namespace detail {

template <typename T>
inline constexpr bool kIsStamped = false;
template <typename T>
inline constexpr bool kIsStamped<Stamped<T>> = true;

/// Instant from which the age of a value counts.
/// @param[in] payload      encoding of a T: a stamp is its first field.
/// @param[in] published_at of the message, by the port.
template <typename T>
constexpr Instant read_origin(Span<const std::byte> payload, ByteOrder order, Instant published_at) noexcept {
    if constexpr (kIsStamped<T>) {
        // Every pattern of eight bytes is an integer.
        static_cast<void>(decode(payload.subspan(0U, sizeof(std::int64_t)), order, published_at.ns));
    }
    return published_at;
}

}  // namespace detail

}  // namespace mamori::safety

/// Fields of every stamped type.
template <typename T>
struct mamori::Fields<mamori::safety::Stamped<T>> {
    static constexpr bool kDeclared = true;
    template <typename Self, typename Call>
    static constexpr decltype(auto) apply(Self& self, Call&& call) noexcept {
        return call(self.sent_at_ns, self.value);
    }
};

#endif  // MAMORI_SAFETY_E2E_STAMPED_HPP
