#pragma once

#include <cstdio>
#include <cstdlib>

/// Stops the process when `condition` is false: our own bug, never the world's doing.
/// The service manager restarts the process; the line on stderr says where.
#define HV_EXPECT(condition)                                                            \
    do {                                                                                \
        if (!(condition)) {                                                             \
            std::fprintf(stderr, "%s:%d: expectation failed: %s\n", __FILE__, __LINE__, \
                         #condition);                                                   \
            std::abort();                                                               \
        }                                                                               \
    } while (false)
