// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <limits>

namespace mamori::ports::posix_rt {
namespace {

/// No process can shrink the memory, which would raise SIGBUS in a reader beyond the new end.
constexpr int kSizeSeals = F_SEAL_SHRINK | F_SEAL_GROW;

}  // namespace

const char* describe(SharedMemoryError error) noexcept {
    switch (error) {
        case SharedMemoryError::kNone:
            return "is open";
        case SharedMemoryError::kCannotCreate:
            return "cannot be created: the system has no anonymous files, or too many files are open";
        case SharedMemoryError::kCannotReserve:
            return "cannot be allocated: make it smaller, or provide more memory";
        case SharedMemoryError::kCannotSeal:
            return "cannot be sealed: use Linux 5.1 or later";
        case SharedMemoryError::kCannotReopen:
            return "cannot be opened for reading only: mount /proc";
        case SharedMemoryError::kNoMemory:
            return "is not shareable memory: pass the descriptor of a SharedMemory";
        case SharedMemoryError::kWrongSize:
            return "has another size: build both programs from the same messages";
        case SharedMemoryError::kNotSealed:
            return "could change its size during use: create it as a SharedMemory";
        case SharedMemoryError::kCannotMap:
            return "cannot be mapped: it is read-only, or the limits of the process are too small";
    }
    return "failed for an unknown reason";  // reached with a corrupted value only
}

Status SharedMemory::create(const char* name, std::size_t size, SharedAccess access) noexcept {
    if (is_open()) {
        return Status::kPreconditionNotMet;
    }
    if (name == nullptr || size == 0U || size > static_cast<std::size_t>(std::numeric_limits<off_t>::max())) {
        return Status::kBadParameter;
    }
    system_error_ = 0;
    const int file = ::memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (file < 0) {
        system_error_ = errno;
        return conclude(SharedMemoryError::kCannotCreate);
    }
    const SharedMemoryError error = fill(file, size, access);
    if (error == SharedMemoryError::kNone) {
        file_ = file;
    } else {
        close();
        static_cast<void>(::close(file));
    }
    return conclude(error);
}

Status SharedMemory::adopt(int descriptor, std::size_t size, SharedAccess access) noexcept {
    if (is_open()) {
        return Status::kPreconditionNotMet;
    }
    if (size == 0U) {
        return Status::kBadParameter;
    }
    system_error_ = 0;
    SharedMemoryError error = examine(descriptor, size);
    if (error == SharedMemoryError::kNone) {
        error = map(descriptor, size, access);
    }
    if (error == SharedMemoryError::kNone) {
        static_cast<void>(::close(descriptor));
    }
    return conclude(error);
}

void SharedMemory::close() noexcept {
    if (data_ != nullptr) {
        static_cast<void>(::munmap(data_, size_));
    }
    if (file_ >= 0) {
        static_cast<void>(::close(file_));
    }
    data_ = nullptr;
    size_ = 0U;
    file_ = -1;
    is_writable_ = false;
}

Status SharedMemory::conclude(SharedMemoryError error) noexcept {
    error_ = error;
    switch (error) {
        case SharedMemoryError::kNone:
            return Status::kOk;
        case SharedMemoryError::kCannotReserve:
        case SharedMemoryError::kCannotMap:
            return Status::kOutOfResources;
        case SharedMemoryError::kCannotCreate:
        case SharedMemoryError::kCannotSeal:
        case SharedMemoryError::kCannotReopen:
        case SharedMemoryError::kNoMemory:
        case SharedMemoryError::kWrongSize:
        case SharedMemoryError::kNotSealed:
            break;
    }
    return Status::kError;
}

/// Allocates the pages of the new file, maps it and seals it against all access that is not required.
SharedMemoryError SharedMemory::fill(int file, std::size_t size, SharedAccess access) noexcept {
    const int refusal = ::posix_fallocate(file, 0, static_cast<off_t>(size));
    if (refusal != 0) {
        system_error_ = refusal;
        return SharedMemoryError::kCannotReserve;
    }
    const bool is_writer = access == SharedAccess::kWrite;
    const SharedMemoryError error = is_writer ? map(file, size, access) : map_to_read(file, size);
    if (error != SharedMemoryError::kNone) {
        return error;
    }
    // The existing mapping of the writer stays writable. New writable mappings are impossible.
    const int seals = kSizeSeals | F_SEAL_SEAL | (is_writer ? F_SEAL_FUTURE_WRITE : 0);
    if (::fcntl(file, F_ADD_SEALS, seals) != 0) {
        system_error_ = errno;
        return SharedMemoryError::kCannotSeal;
    }
    return SharedMemoryError::kNone;
}

/// Uses a read-only descriptor, so that mprotect() cannot make the mapping writable.
SharedMemoryError SharedMemory::map_to_read(int file, std::size_t size) noexcept {
    constexpr char kFolder[] = "/proc/self/fd/";
    std::array<char, sizeof(kFolder) + std::numeric_limits<int>::digits10 + 2U> path{};
    __builtin_memcpy(path.data(), kFolder, sizeof(kFolder));
    char* const end = path.data() + path.size() - 1U;
    static_cast<void>(std::to_chars(path.data() + sizeof(kFolder) - 1U, end, file));
    const int reading = ::open(path.data(), O_RDONLY | O_CLOEXEC);
    if (reading < 0) {
        system_error_ = errno;
        return SharedMemoryError::kCannotReopen;
    }
    const SharedMemoryError error = map(reading, size, SharedAccess::kRead);
    static_cast<void>(::close(reading));
    return error;
}

SharedMemoryError SharedMemory::map(int file, std::size_t size, SharedAccess access) noexcept {
    is_writable_ = access == SharedAccess::kWrite;
    const int protection = is_writable_ ? PROT_READ | PROT_WRITE : PROT_READ;
    void* const memory = ::mmap(nullptr, size, protection, MAP_SHARED | MAP_POPULATE, file, 0);
    if (memory == MAP_FAILED) {
        system_error_ = errno;
        is_writable_ = false;
        return SharedMemoryError::kCannotMap;
    }
    data_ = static_cast<std::byte*>(memory);
    size_ = size;
    return SharedMemoryError::kNone;
}

SharedMemoryError SharedMemory::examine(int file, std::size_t size) noexcept {
    struct stat facts{};
    const int seals = ::fcntl(file, F_GET_SEALS);
    if (seals < 0 || ::fstat(file, &facts) != 0) {
        system_error_ = errno;
        return SharedMemoryError::kNoMemory;
    }
    if (facts.st_size != static_cast<off_t>(size)) {
        return SharedMemoryError::kWrongSize;
    }
    return (seals & kSizeSeals) == kSizeSeals ? SharedMemoryError::kNone : SharedMemoryError::kNotSealed;
}

}  // namespace mamori::ports::posix_rt
