// Which of Highway's targets are compiled. SSSE3 is left out: every processor of the last fifteen years that has it has
// SSE4 too, and each target costs compile time and code size. Under a sanitizer a kernel file takes minutes; there the
// baseline and AVX2 must do, which come from the same template as all others.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BOXWOOD_UNDER_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define BOXWOOD_UNDER_SANITIZER
#endif
#endif

#ifdef BOXWOOD_UNDER_SANITIZER
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL)
#else
#define HWY_DISABLED_TARGETS HWY_SSSE3
#endif
