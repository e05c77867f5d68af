#include "app/doctor_route.hpp"

#include <arpa/inet.h>

#include <bit>
#include <cstdint>
#include <sstream>

namespace hitchview::app {
namespace {

/// A line of /proc/net/route; addresses as they lie in memory.
struct Route {
    std::string interface {};
    std::uint32_t destination = 0;
    std::uint32_t mask = 0;
    std::uint32_t metric = 0;
    bool is_read = false;
};

Route ReadRoute(const std::string& line) {
    Route route;
    std::istringstream words(line);
    std::string gateway;
    std::string flags;
    std::string references;
    std::string use;
    words >> route.interface >> std::hex >> route.destination >> gateway >> flags >> references >>
        use >> std::dec >> route.metric >> std::hex >> route.mask;
    route.is_read = !words.fail();
    return route;
}

/// The kernel takes the narrowest, and of these the one of the least metric.
bool IsBefore(const Route& route, const Route& other) {
    const int width = std::popcount(route.mask);
    const int other_width = std::popcount(other.mask);
    return width != other_width ? width > other_width : route.metric < other.metric;
}

}  // namespace

std::string MulticastInterface(const DoctorMachine& machine) {
    const std::uint32_t group = inet_addr("239.255.76.67");
    std::istringstream lines(ReadText(machine.At("/proc/net/route")).value_or(""));
    Route best;
    for (std::string line; std::getline(lines, line);) {
        Route route = ReadRoute(line);
        const bool matches = route.is_read && (group & route.mask) == route.destination;
        if (matches && (!best.is_read || IsBefore(route, best))) best = std::move(route);
    }
    return best.interface;
}

}  // namespace hitchview::app
