// Which of Highway's targets are compiled. SSSE3 is left out: every processor of the last fifteen years that has it has
// SSE4 too, and each target costs compile time and code size.
#pragma once

#define HWY_DISABLED_TARGETS HWY_SSSE3
