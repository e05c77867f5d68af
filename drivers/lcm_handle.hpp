#pragma once

#include <lcm/lcm.h>

#include <memory>

namespace hitchview::drivers {

struct LcmDeleter {
    void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
};
using LcmHandle = std::unique_ptr<lcm_t, LcmDeleter>;

}  // namespace hitchview::drivers
