#include "calib/tag_family.hpp"

#include <apriltag/tag36h11.h>

#include <memory>

namespace hitchview::calib {
namespace {

struct DestroyFamily {
    void operator()(apriltag_family_t* family) const { tag36h11_destroy(family); }
};
using Family = std::unique_ptr<apriltag_family_t, DestroyFamily>;

}  // namespace

TagModules DarkModules(int number) {
    static const Family family(tag36h11_create());
    TagModules dark;
    dark.fill(true);
    const std::uint64_t code = family->codes[number];
    for (std::uint32_t bit = 0; bit < family->nbits; ++bit) {
        const std::uint32_t module = family->bit_y[bit] * kTagModules + family->bit_x[bit];
        dark[module] = (code >> (family->nbits - 1 - bit) & 1U) == 0;
    }
    return dark;
}

}  // namespace hitchview::calib
