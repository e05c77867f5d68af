#pragma once

namespace hitchview::drivers {

/// Where one is who goes from 0 to `turn` > 0, back to 0 and so on, after `way` >= 0.
template <typename T>
constexpr T ForthAndBack(T way, T turn) {
    const T along = way % (2 * turn);
    return along <= turn ? along : 2 * turn - along;
}

}  // namespace hitchview::drivers
