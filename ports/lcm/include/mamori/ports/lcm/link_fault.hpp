// SPDX-License-Identifier: Apache-2.0
/// @file
/// Why a transport could not be opened, and what helps.
///
/// @satisfies SWR-LCM-010      Design: docs/design/lcm.md#transports
#ifndef MAMORI_PORTS_LCM_LINK_FAULT_HPP
#define MAMORI_PORTS_LCM_LINK_FAULT_HPP

#include <cstdint>

namespace mamori::ports::lcm {

enum class LinkFault : std::uint8_t {
    kNone,
    kUnsupported,  ///< built without liblcm
    kUrl,          ///< LCM does not open the URL, or multicast has no route
    kChannel,      ///< name of a channel
    kSubscribe,    ///< LCM does not receive, or too many channels
    kAddress,      ///< not an IPv4 address in digits
    kSocket,       ///< the socket cannot be opened or bound
    kDevice,       ///< the serial device cannot be opened
    kLine,         ///< the device is not a serial line, or does not know the speed
    kThread,       ///< the receiving thread cannot be started
};

/// What is wrong and how to correct it, for logs; never nullptr.
constexpr const char* get_advice(LinkFault fault) noexcept {
    switch (fault) {
        case LinkFault::kNone:
            return "the transport is open";
        case LinkFault::kUnsupported:
            return "Mamori was built without liblcm; install liblcm-dev, then configure and build again";
        case LinkFault::kUrl:
            return "LCM cannot open the URL; use for example udpm://239.255.76.67:7667?ttl=0, and give "
                   "multicast "
                   "a route: ip route add 224.0.0.0/4 dev lo";
        case LinkFault::kChannel:
            return "invalid channel; use 1 to 63 letters, digits or the characters _ - / :";
        case LinkFault::kSubscribe:
            return "LCM cannot receive: its self test failed, or a link has more than 16 channels; allow "
                   "multicast in the firewall, or use a second link";
        case LinkFault::kAddress:
            return "invalid address; use an IPv4 address in digits, for example 127.0.0.1";
        case LinkFault::kSocket:
            return "the UDP port cannot be opened; use a free port and an address of this host";
        case LinkFault::kDevice:
            return "the serial device cannot be opened; check its path, and that the user is in its group";
        case LinkFault::kLine:
            return "not a serial line of this speed; use a terminal device and 9600 to 921600 bit/s";
        case LinkFault::kThread:
            return "the receiving thread cannot be started; raise the limit of threads or of memory";
    }
    return "invalid fault";  // only a corrupted value gets here
}

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_LINK_FAULT_HPP
