// SPDX-License-Identifier: Apache-2.0
/// @file
/// A precompiled header needs a target with a source; its content is <gtest/gtest.h> (MamoriTargets.cmake).
