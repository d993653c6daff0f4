// Under the leak sanitizer only: assimp 5.2 loses what it had allocated when it gives up on a malformed file. Nothing
// of ours can reach that memory; our own leaks are still reported.
#if defined(__SANITIZE_ADDRESS__)
#define BOXWOOD_SUPPRESS_LEAKS
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define BOXWOOD_SUPPRESS_LEAKS
#endif
#endif

#if defined(BOXWOOD_SUPPRESS_LEAKS)
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libassimp\n";
}
#endif
