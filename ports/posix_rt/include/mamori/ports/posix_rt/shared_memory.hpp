// SPDX-License-Identifier: Apache-2.0
/// @file
/// Memory that a safety process shares with a process of less trust: one side writes, the other can only
/// read, and neither can take the memory away from the other.
///
/// @satisfies SWR-PRT-012      Design: docs/design/posix_rt.md#shared-memory
#ifndef MAMORI_PORTS_POSIX_RT_SHARED_MEMORY_HPP
#define MAMORI_PORTS_POSIX_RT_SHARED_MEMORY_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"

namespace mamori::ports::posix_rt {

/// What this process does with the memory; the other one does the other.
enum class SharedAccess : std::uint8_t { kRead, kWrite };

/// Why a memory was not created or adopted.
enum class SharedMemoryError : std::uint8_t {
    kNone,
    kCannotCreate,   ///< the system has no anonymous files, or too many are open
    kCannotReserve,  ///< there is not so much memory
    kCannotSeal,     ///< the system does not know the seals: older than Linux 5.1
    kCannotReopen,   ///< there is no /proc through which a descriptor for reading is had
    kNoMemory,       ///< the descriptor is none of a memory that can be shared
    kWrongSize,      ///< the memory has another size than the one that was agreed
    kNotSealed,      ///< its size could be changed while it is used
    kCannotMap,      ///< the system refuses the mapping, for writing in a memory that is only to be read too
};

/// A sentence for the user; never nullptr.
const char* describe(SharedMemoryError error) noexcept;

/// Owner of one mapping. The process that creates the memory is the one that is trusted; the other adopts it.
///
/// Thread safety: none. Time: the calls wait for the system; call them before the first deadline begins.
/// Memory: the mapping, `size` bytes rounded up to pages.
class SharedMemory final {
  public:
    SharedMemory() noexcept = default;
    ~SharedMemory() { close(); }
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;

    /// Creates a memory of zeros, whose size nobody can change any more.
    /// @param[in] name   for the list of mappings of the process, not nullptr; need not be unique.
    /// @param[in] size   [byte], from 1 on.
    /// @param[in] access kRead: only whoever adopts it can write, and this process not even by mistake.
    /// kWrite:
    ///                   nobody but this process can write.
    /// @return kOk; kBadParameter (name or size); kPreconditionNotMet (open already); kOutOfResources
    ///         (kCannotReserve, kCannotMap); kError (every other cause): get_error() and get_system_error()
    ///         tell it.
    Status create(const char* name, std::size_t size, SharedAccess access) noexcept;

    /// Maps a memory that another process created, and closes the descriptor, which is needed no more; after
    /// a refusal it is still open. @param[in] descriptor as handed over. @param[in] size as created.
    /// @return kOk; kBadParameter (size 0); kPreconditionNotMet (open already); kOutOfResources (kCannotMap);
    ///         kError (every other cause).
    Status adopt(int descriptor, std::size_t size, SharedAccess access) noexcept;

    /// Ends the mapping; without one it does nothing.
    void close() noexcept;

    bool is_open() const noexcept { return data_ != nullptr; }
    /// The bytes; empty while closed. Valid until close().
    Span<const std::byte> get_region() const noexcept { return {data_, size_}; }
    /// The same to write; empty with SharedAccess::kRead.
    Span<std::byte> get_writable_region() const noexcept {
        return {is_writable_ ? data_ : nullptr, is_writable_ ? size_ : 0U};
    }
    /// What is handed over to the process that adopts the memory; -1 while closed, or where it was adopted.
    int get_descriptor() const noexcept { return file_; }

    /// Cause of the last call that failed; kNone before it, and after one that did not.
    SharedMemoryError get_error() const noexcept { return error_; }
    /// `errno` behind it; 0 where the system had no objection.
    int get_system_error() const noexcept { return system_error_; }

  private:
    Status conclude(SharedMemoryError error) noexcept;
    SharedMemoryError fill(int file, std::size_t size, SharedAccess access) noexcept;
    SharedMemoryError map(int file, std::size_t size, SharedAccess access) noexcept;
    SharedMemoryError map_to_read(int file, std::size_t size) noexcept;
    SharedMemoryError examine(int file, std::size_t size) noexcept;

    std::byte* data_{nullptr};
    std::size_t size_{0U};
    int file_{-1};
    int system_error_{0};
    bool is_writable_{false};
    SharedMemoryError error_{SharedMemoryError::kNone};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_SHARED_MEMORY_HPP
