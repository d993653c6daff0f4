// How much of a test's work is done where code runs ten to a hundred times slower than users meet it.
#pragma once

#include <cstddef>
#include <vector>

namespace boxwood::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kInstrumented = true;
#elif defined(__has_feature)
inline constexpr bool kInstrumented = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kInstrumented = false;
#endif

/// `count`, or one `part`-th of it under a sanitizer: what is wrong with memory shows on the first rays or never.
constexpr std::size_t effort(std::size_t count, std::size_t part) {
  return kInstrumented ? count / part : count;
}

/// The numbers of threads that must give what no threads give; under a sanitizer only the largest.
inline std::vector<int> thread_counts() {
  return kInstrumented ? std::vector{8} : std::vector{1, 2, 8};
}

}  // namespace boxwood::test
