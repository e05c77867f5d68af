// The least a display unit does, in C++: newest panorama only, its age, NO IMAGE when none comes.
//   lcm-gen -x bot_core_image_t.lcm bot_core_image_metadata_t.lcm
//   c++ -std=c++17 subscriber.cpp -llcm -o subscriber
//   ./subscriber 'udpm://239.255.76.67:7667?ttl=1&recv_buf_size=16777216' [PICTURES]
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <string>

#include "bot_core/image_t.hpp"

struct Display {
    long pictures = 0;

    void OnImage(const lcm::ReceiveBuffer*, const std::string&, const bot_core::image_t* image) {
        using namespace std::chrono;
        // Capture time against this clock: keep both set by NTP or PTP.
        const auto now_us = duration_cast<microseconds>(system_clock::now().time_since_epoch());
        const double age_ms = static_cast<double>(now_us.count() - image->utime) / 1000;
        if (age_ms > 500) {
            std::printf("NO IMAGE: the picture is %.0f ms old\n", age_ms);
            return;
        }
        for (const auto& property : image->metadata) {
            const std::string value(property.value.begin(), property.value.end());
            std::printf("%s %s  ", property.key.c_str(), value.c_str());
        }
        std::printf("%dx%d age %.1f ms\n", image->width, image->height, age_ms);
        std::ofstream("newest.jpg", std::ios::binary)
            .write(reinterpret_cast<const char*>(image->data.data()), image->size);
        ++pictures;
    }
};

int main(int argc, char** argv) {
    const long wanted = argc > 2 ? std::atol(argv[2]) : 0;
    lcm::LCM lcm(argc > 1 ? argv[1] : "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=16777216");
    if (!lcm.good()) return 1;
    Display display;
    // Or pictures queue up and grow old.
    lcm.subscribe("PANORAMA", &Display::OnImage, &display)->setQueueCapacity(1);
    while (wanted == 0 || display.pictures < wanted) {
        const int handled = lcm.handleTimeout(500);
        if (handled < 0) return 1;
        if (handled == 0) std::printf("NO IMAGE: none came\n");
        std::fflush(stdout);
    }
}
