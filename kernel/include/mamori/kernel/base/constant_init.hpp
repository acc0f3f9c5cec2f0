// SPDX-License-Identifier: Apache-2.0
/// @file
/// Macro for the declaration of a static object: compile error unless the object is constant-initialised.
/// Without the macro, C++17 silently constructs such an object at program start.
///
///     MAMORI_CONSTINIT SpeedMonitor monitor;
///
/// @satisfies SWR-PAR-004      Design: docs/design/parameters.md#refusal-at-compile-time
/// C++20 has a keyword for this purpose (constinit). Before C++20, g++ and clang use different spellings.
#ifndef MAMORI_KERNEL_CONSTANT_INIT_HPP
#define MAMORI_KERNEL_CONSTANT_INIT_HPP

#if defined(__clang__)
#define MAMORI_CONSTINIT [[clang::require_constant_initialization]]
#else
#define MAMORI_CONSTINIT __constinit
#endif

#endif  // MAMORI_KERNEL_CONSTANT_INIT_HPP
