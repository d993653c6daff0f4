// Which of Highway's targets are compiled. SSSE3 is left out: every processor of the last fifteen years that has it has
// SSE4 too, and each target costs compile time and code size. Under a sanitizer a kernel file takes minutes; there, and
// where BOXWOOD_FEW_TARGETS is defined, the baseline and AVX2 must do, which come from the same template as all others.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BOXWOOD_FEW_TARGETS
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define BOXWOOD_FEW_TARGETS
#endif
#endif

#ifdef BOXWOOD_FEW_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL)
#else
#define HWY_DISABLED_TARGETS HWY_SSSE3
#endif
