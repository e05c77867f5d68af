#pragma once

/// HV_MULTIVERSION before a function's definition: it is compiled for the x86-64 baseline and for
/// AVX2, and the loader takes what the processor has. For loops whose results are the same
/// whatever the width of a vector: integers, or floats each by itself. What such a function calls
/// must be inlined into it.
/// Empty where there is no GNU indirect function, and under sanitizers, which run before it.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(HITCHVIEW_SANITIZED)
#define HV_MULTIVERSION __attribute__((target_clones("avx2", "default")))
#else
#define HV_MULTIVERSION
#endif
