// Clients of `hitchview web` that take every picture they can get: web_clients PORT COUNT
// On SIGTERM, prints how many pictures a second each of them got, and ends.

#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "tests/support/web_client.hpp"

namespace hitchview::tests {
namespace {

/// A page that is open: its picture on this connection, its state on another.
class Page {
 public:
    Page(int port, const std::atomic<bool>& stop)
        : picture_([this, port, &stop] { TakePictures(port, stop); }),
          state_([port, &stop] { TakeState(port, stop); }) {}

    [[nodiscard]] int pictures() const { return pictures_; }

 private:
    void TakePictures(int port, const std::atomic<bool>& stop) {
        WebClient client(port);
        std::string serial = "0";
        while (!stop) {
            auto answer = client.Get("/panorama.jpg?after=" + serial);
            if (!answer) break;
            serial = answer->headers["x-serial"];
            if (answer->status == 200) ++pictures_;
        }
    }

    static void TakeState(int port, const std::atomic<bool>& stop) {
        WebClient client(port);
        client.Ask("/events");
        while (!stop && client.TakeThrough("\n\n")) {
        }
    }

    std::atomic<int> pictures_ = 0;
    std::jthread picture_;
    std::jthread state_;
};

}  // namespace
}  // namespace hitchview::tests

namespace {

std::atomic<bool> stop = false;

}  // namespace

int main(int argc, char** argv) {
    using hitchview::tests::Page;
    using Clock = std::chrono::steady_clock;
    if (argc != 3) return 2;
    std::signal(SIGTERM, [](int) { stop = true; });
    // Clients run on other machines: here they give way to everything.
    setpriority(PRIO_PROCESS, 0, 19);
    const auto start = Clock::now();
    std::vector<std::unique_ptr<Page>> pages;
    for (int i = 0; i < std::atoi(argv[2]); ++i) {
        pages.push_back(std::make_unique<Page>(std::atoi(argv[1]), stop));
    }
    while (!stop) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    std::vector<double> rates;
    for (const auto& page : pages) rates.push_back(page->pictures() / seconds);
    std::ranges::sort(rates);
    std::printf("%zu pages, pictures a second: least %.1f, middle %.1f, most %.1f\n", rates.size(),
                rates.front(), rates[rates.size() / 2], rates.back());
    return 0;
}
