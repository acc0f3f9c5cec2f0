// SPDX-License-Identifier: Apache-2.0
/// @file
/// Common part of ports and parameters: the name and the link in a list of the component. Each registers with
/// its component at construction. Therefore, the table check finds one that `Ports<...>` or `Parameters<...>`
/// omits.
///
/// @satisfies SWR-KRN-045, SWR-PAR-020      Design: docs/design/kernel.md#components
#ifndef MAMORI_KERNEL_MEMBER_HPP
#define MAMORI_KERNEL_MEMBER_HPP

#include <array>
#include <cstddef>
#include <cstdint>

namespace mamori {

/// Replaces the owner of a port or parameter that belongs to no component, for example in a test of a driver.
struct NoOwner {};
inline constexpr NoOwner kNoOwner{};

/// A component has one list for each kind.
enum class MemberKind : std::uint8_t { kPort, kParameter };

class Member;

/// Lists of the ports and of the parameters that were constructed with a component.
class MemberOwner {
  public:
    /// The member that was constructed last; nullptr: none. Member::get_next() returns the others.
    constexpr const Member* get_first(MemberKind kind) const noexcept {
        const Member* const first = first_[static_cast<std::size_t>(kind)];
        return first;
    }

  protected:
    constexpr MemberOwner() noexcept = default;
    ~MemberOwner() = default;

  private:
    friend class Member;
    std::array<const Member*, 2U> first_{};
};

/// Thread safety: reading from anywhere. Time: O(1). Memory: no heap.
class Member {
  public:
    Member(const Member&) = delete;
    Member& operator=(const Member&) = delete;

    /// Name given at construction, with static storage. The table check rejects nullptr and an empty name.
    constexpr const char* get_name() const noexcept { return name_; }
    /// The member of this kind that was constructed with the same component before this one; nullptr: this is
    /// the first.
    constexpr const Member* get_next() const noexcept { return next_; }

  protected:
    /// @param[in] owner component that has this member; the member must not be destroyed before it.
    /// @param[in] name  static storage, not nullptr.
    constexpr Member(MemberOwner& owner, MemberKind kind, const char* name) noexcept
        : name_(name), next_(owner.get_first(kind)) {
        owner.first_[static_cast<std::size_t>(kind)] = this;
    }
    constexpr Member(NoOwner, MemberKind, const char* name) noexcept : name_(name) {}
    ~Member() = default;

  private:
    const char* name_;
    const Member* next_{nullptr};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_MEMBER_HPP
