// A rig as the page sees it, without cameras: sends every message of one over LCM, 30 panoramas a
// second. Commands, one a line, on its input:
//   lose N | back N   camera N shows no data
//   event TEXT        an event with this text
//   rename N TEXT     camera N is called so
//   stop | go         everything
//   mute              pictures only
// Ends with its input.

#include <lcm/lcm.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <string>
#include <thread>

#include "tests/support/rig_messages.hpp"

namespace hitchview::tests {
namespace {

constexpr int kWidth_px = 2048;
constexpr int kHeight_px = 360;
constexpr int kPictures = 30;

MessageBytes JpegOf(const cv::Mat& picture) {
    MessageBytes jpeg;
    cv::imencode(".jpg", picture, jpeg, {cv::IMWRITE_JPEG_QUALITY, 80});
    return jpeg;
}

/// Sky, hills and a road whose marks move with `phase`, [0, 1).
cv::Mat Scene(cv::Size size_px, double phase, double hue) {
    cv::Mat picture(size_px, CV_8UC3);
    for (int y = 0; y < size_px.height; ++y) {
        for (int x = 0; x < size_px.width; ++x) {
            const double u = double(x) / size_px.width;
            const double v = double(y) / size_px.height;
            const double hill = 0.48 - 0.07 * std::sin(9 * u + hue) - 0.03 * std::sin(31 * u);
            const bool mark = v > 0.72 && v < 0.76 && std::fmod(u * 12 + phase + hue, 1.0) < 0.5;
            const cv::Vec3b sky(static_cast<uchar>(235 - 90 * v), static_cast<uchar>(190 - 60 * v),
                                static_cast<uchar>(150 - 40 * v));
            const cv::Vec3b land(70, static_cast<uchar>(120 - 60 * v), 80);
            const cv::Vec3b road(96, 92, 90);
            picture.at<cv::Vec3b>(y, x) = mark       ? cv::Vec3b(240, 245, 245)
                                          : v > 0.6  ? road
                                          : v > hill ? land
                                                     : sky;
        }
    }
    return picture;
}

class Rig {
 public:
    explicit Rig(lcm_t* lcm) : lcm_(lcm) {
        for (int i = 0; i < kPictures; ++i) {
            const double phase = double(i) / kPictures;
            panoramas_.push_back(JpegOf(Scene({kWidth_px, kHeight_px}, phase, 0)));
            previews_.push_back(JpegOf(Scene({192, 108}, phase, 1)));
        }
    }

    /// Picks up a command; false at the end of the input.
    bool Command() {
        std::string line;
        if (!std::getline(std::cin, line)) return false;
        std::istringstream words(line);
        std::string verb;
        words >> verb;
        if (verb == "lose" || verb == "back") {
            unsigned camera = 0;
            words >> camera;
            Change(camera, verb == "lose");
        }
        if (verb == "rename") {
            std::size_t camera = 0;
            words >> camera >> std::ws;
            std::getline(words, names_.at(camera));
        }
        if (verb == "event")
            Send("PANORAMA_EVENT", EventBytes(events_++, 40, "rig", line.substr(6)));
        if (verb == "stop" || verb == "go") sending_ = verb == "go";
        if (verb == "mute") pictures_ = false;
        if (verb == "go") pictures_ = true;
        return true;
    }

    void Step() {
        ++frame_;
        if (!sending_) return;
        const std::int64_t now_ns =
            std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
        const double t = frame_ / 30.0;
        if (pictures_)
            Send("PANORAMA", ImageBytes(panoramas_[frame_ % kPictures], kWidth_px, kHeight_px,
                                        frame_, now_ns, missing_));
        Send("PANORAMA_STATUS", StatusBytes(frame_, now_ns, missing_,
                                            19 + 2 * std::sin(7 * t) + (frame_ % 97 == 0 ? 14 : 0),
                                            0.3 * std::sin(t / 4) + 0.01 * std::sin(11 * t)));
        Send("HITCH_ANGLE", HitchAngleBytes(frame_, 0.3 * std::sin(t / 4)));
        if (frame_ % 15 == 0) SendPreviews(now_ns);
        if (frame_ % 6 == 0)
            Send("PANORAMA_OVERLAY", OverlayBytes(frame_, kWidth_px, kHeight_px, t));
        if (frame_ % 30 == 0) Send("PANORAMA_HEALTH", HealthBytes(frame_ / 30, {names_, missing_}));
    }

 private:
    void Change(unsigned camera, bool lost) {
        const unsigned bit = 1U << camera;
        missing_ = lost ? missing_ | bit : missing_ & ~bit;
        Send("PANORAMA_EVENT", EventBytes(events_++, lost ? 1 : 2, names_.at(camera),
                                          lost ? "no frame for 100 ms" : "after 2.1 s"));
    }

    void SendPreviews(std::int64_t now_ns) {
        for (std::size_t i = 0; i < names_.size(); ++i) {
            if ((missing_ >> i & 1U) != 0) continue;
            std::string channel = "PREVIEW_";
            for (const char c : names_[i])
                channel += c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
            Send(channel,
                 ImageBytes(previews_[(frame_ + 4 * i) % kPictures], 192, 108, frame_, now_ns));
        }
    }

    void Send(const std::string& channel, const MessageBytes& message) {
        lcm_publish(lcm_, channel.c_str(), message.data(), static_cast<unsigned>(message.size()));
    }

    lcm_t* lcm_;
    std::vector<std::string> names_{"tractor_front",      "tractor_left",       "tractor_right",
                                    "trailer_left_front", "trailer_left_rear",  "trailer_rear",
                                    "trailer_right_rear", "trailer_right_front"};
    std::vector<MessageBytes> panoramas_{};
    std::vector<MessageBytes> previews_{};
    std::uint32_t frame_ = 0;
    std::uint32_t events_ = 0;
    std::uint32_t missing_ = 0;
    bool sending_ = true;
    bool pictures_ = true;
};

}  // namespace
}  // namespace hitchview::tests

int main() {
    using Clock = std::chrono::steady_clock;
    lcm_t* const lcm = lcm_create("udpm://239.255.76.67:7667?ttl=0");
    if (lcm == nullptr) return 3;
    hitchview::tests::Rig rig(lcm);
    std::cin.sync_with_stdio(false);
    auto next = Clock::now();
    bool open = true;
    while (open) {
        next += std::chrono::microseconds(33'333);
        std::this_thread::sleep_until(next);
        pollfd input{STDIN_FILENO, POLLIN, 0};
        while (open && (poll(&input, 1, 0) > 0 || std::cin.rdbuf()->in_avail() > 0)) {
            open = rig.Command();
        }
        rig.Step();
    }
    lcm_destroy(lcm);
    return 0;
}
