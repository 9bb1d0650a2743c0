#pragma once

#include <gtest/gtest.h>

/// Ends a test that takes many minutes under sanitizers, where other tests run the same code on
/// less: what it asserts is for the release build. At the start of a test.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VOQCAL_LEAVE_TO_RELEASE() GTEST_SKIP() << "left to the release build"
#else
#define VOQCAL_LEAVE_TO_RELEASE() static_cast<void>(0)
#endif
