// SPDX-License-Identifier: Apache-2.0
/// @file
/// A word in front of a static object that makes the compiler refuse it unless it is a constant of the
/// program image. Without it C++17 would quietly construct such an object while the program starts.
///
///     MAMORI_CONSTINIT SpeedMonitor monitor;
///
/// @satisfies SWR-PAR-004      Design: docs/design/parameters.md#refusal-at-compile-time
/// The language has the word since C++20; g++ and clang spell it differently before.
#ifndef MAMORI_KERNEL_CONSTANT_INIT_HPP
#define MAMORI_KERNEL_CONSTANT_INIT_HPP

#if defined(__clang__)
#define MAMORI_CONSTINIT [[clang::require_constant_initialization]]
#else
#define MAMORI_CONSTINIT __constinit
#endif

#endif  // MAMORI_KERNEL_CONSTANT_INIT_HPP
