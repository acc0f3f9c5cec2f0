// SPDX-License-Identifier: Apache-2.0
/// @file
/// Memory that a safety process shares with an untrusted process. One side writes, the other can only read.
/// Neither side can remove or shrink the memory of the other.
///
/// @satisfies SWR-PRT-012      Design: docs/design/posix_rt.md#shared-memory
#ifndef MAMORI_PORTS_POSIX_RT_SHARED_MEMORY_HPP
#define MAMORI_PORTS_POSIX_RT_SHARED_MEMORY_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"

namespace mamori::ports::posix_rt {

/// Access of this process. The other process has the opposite access.
enum class SharedAccess : std::uint8_t { kRead, kWrite };

/// Cause of a failed create() or adopt().
enum class SharedMemoryError : std::uint8_t {
    kNone,
    kCannotCreate,   ///< no anonymous files (memfd), or too many open files
    kCannotReserve,  ///< not enough memory
    kCannotSeal,     ///< seals are not supported: Linux is older than 5.1
    kCannotReopen,   ///< no /proc, which is necessary for a read-only descriptor
    kNoMemory,       ///< the descriptor does not refer to sealable memory
    kWrongSize,      ///< the memory has an unexpected size
    kNotSealed,      ///< the size of the memory could be changed during use
    kCannotMap,      ///< the system rejects the mapping, for example write access to read-only memory
};

/// Message for the user; never nullptr.
const char* describe(SharedMemoryError error) noexcept;

/// Owner of one mapping. The trusted process creates the memory; the other process adopts it.
///
/// Thread safety: none. Time: the calls wait for the system; call them before the first deadline begins.
/// Memory: the mapping, `size` bytes rounded up to pages.
class SharedMemory final {
  public:
    SharedMemory() noexcept = default;
    ~SharedMemory() { close(); }
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;

    /// Creates zero-filled memory of a permanently fixed size.
    /// @param[in] name name in the list of mappings of the process, not nullptr; need not be unique.
    /// @param[in] size [byte], from 1.
    /// @param[in] access kRead: only the adopting process can write; this process cannot. kWrite: only this
    ///            process can write.
    /// @return kOk; kBadParameter (name or size); kPreconditionNotMet (open already); kOutOfResources
    ///         (kCannotReserve, kCannotMap); kError (every other cause). get_error() and get_system_error()
    ///         return the cause.
    Status create(const char* name, std::size_t size, SharedAccess access) noexcept;

    /// Maps memory that another process created. Closes the descriptor on success; it stays open on failure.
    /// @param[in] descriptor inherited descriptor. @param[in] size as for create().
    /// @return kOk; kBadParameter (size 0); kPreconditionNotMet (open already); kOutOfResources (kCannotMap);
    ///         kError (every other cause).
    Status adopt(int descriptor, std::size_t size, SharedAccess access) noexcept;

    /// Ends the mapping. Without a mapping, the call has no effect.
    void close() noexcept;

    bool is_open() const noexcept { return data_ != nullptr; }
    /// The bytes of the memory; empty while closed. Valid until close().
    Span<const std::byte> get_region() const noexcept { return {data_, size_}; }
    /// The writable bytes of the memory; empty with SharedAccess::kRead.
    Span<std::byte> get_writable_region() const noexcept {
        return {is_writable_ ? data_ : nullptr, is_writable_ ? size_ : 0U};
    }
    /// Descriptor for the process that adopts the memory; -1 while closed, or if this process adopted the
    /// memory.
    int get_descriptor() const noexcept { return file_; }

    /// Cause of the failure of the last call; kNone if it succeeded or there was none.
    SharedMemoryError get_error() const noexcept { return error_; }
    /// `errno` of this failure; 0 if no system call failed.
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
