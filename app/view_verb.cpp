#include "app/view_verb.hpp"

#include <cstdio>
#include <cstdlib>
#include <opencv2/highgui.hpp>
#include <opencv2/imgcodecs.hpp>

#include "app/display.hpp"
#include "drivers/lcm_subscriber.hpp"

namespace hitchview::app {
namespace {

using drivers::LcmSubscriber;
using std::chrono::milliseconds;

enum ExitCode { kDone = 0, kNoPictures = 1, kWrongUse = 2, kMachineFailed = 3 };

constexpr char kWindow[] = "Hitchview";
/// How often a picture that has become too old is noticed.
constexpr milliseconds kPoll{50};

hal::Instant Now() {
    return std::chrono::steady_clock::now().time_since_epoch();
}

int Fail(ExitCode code, const std::string& reason) {
    std::fprintf(stderr, "hitchview view: %s\n", reason.c_str());
    return code;
}

class Window {
 public:
    Window() { cv::namedWindow(kWindow, cv::WINDOW_NORMAL | cv::WINDOW_KEEPRATIO); }
    ~Window() { cv::destroyAllWindows(); }
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// False when the user has had enough.
    bool Show(const cv::Mat& picture) {
        constexpr int kEscape = 27;
        cv::imshow(kWindow, picture);
        const int key = cv::waitKey(1);
        return key != kEscape && key != 'q' &&
               cv::getWindowProperty(kWindow, cv::WND_PROP_VISIBLE) > 0;
    }
};

/// One run of the verb. `window` is null when the picture goes to a file.
class Viewer {
 public:
    Viewer(const ViewOptions& options, LcmSubscriber& subscriber, Window* window)
        : options_(options), subscriber_(subscriber), window_(window), display_(options.max_age) {
        if (options.frames || !options.save.empty())
            maybe_frames_left_ = options.frames.value_or(1);
    }

    int Run() {
        last_picture_at_ = Now();
        while (!maybe_frames_left_ || *maybe_frames_left_ > 0) {
            if (!TakePicture()) return Fail(kMachineFailed, "LCM stopped receiving");
            if (window_ != nullptr && !window_->Show(display_.Shown(Now()))) return kDone;
            if (maybe_frames_left_ && Now() - last_picture_at_ > options_.wait) {
                if (!options_.save.empty()) Save(Now());
                return Fail(kNoPictures, "no picture on channel " + options_.channel + " of " +
                                             options_.url + " for " +
                                             std::to_string(options_.wait.count()) + " ms");
            }
        }
        return options_.save.empty() ? int(kDone) : Save(last_picture_at_);
    }

 private:
    /// False when nothing can come any more.
    bool TakePicture() {
        const auto image = subscriber_.WaitImage(kPoll);
        display_.SetCameraNames(subscriber_.camera_names());
        if (!image) return NoteMissing(image.error());
        if (!display_.Update(image.value(), Now())) return true;
        last_picture_at_ = Now();
        if (maybe_frames_left_) --*maybe_frames_left_;
        return true;
    }

    bool NoteMissing(hal::Error error) {
        if (error != hal::Error::kTimeout) display_.NoteDamaged();
        return error != hal::Error::kFailed;
    }

    int Save(hal::Instant shown_at) const {
        if (cv::imwrite(options_.save, display_.Shown(shown_at))) return kDone;
        return Fail(kMachineFailed, "cannot write " + options_.save);
    }

    const ViewOptions& options_;
    LcmSubscriber& subscriber_;
    Window* window_;
    Display display_;
    std::optional<int> maybe_frames_left_;
    hal::Instant last_picture_at_{};
};

template <typename Value>
bool IsIn(Value value, long lowest, long highest) {
    return value >= lowest && value <= highest;
}

hal::Checked<hal::Done> Check(const ViewOptions& options) {
    if (!IsIn(options.max_age.count(), 50, 10'000)) {
        return "max_age is " + std::to_string(options.max_age.count()) + " ms, must be 50 to 10000";
    }
    if (!IsIn(options.frames.value_or(1), 1, 1'000'000)) {
        return "frames is " + std::to_string(*options.frames) + ", must be 1 to 1000000";
    }
    if (!IsIn(options.wait.count(), 100, 600'000)) {
        return "wait is " + std::to_string(options.wait.count()) + " ms, must be 100 to 600000";
    }
    if (!options.save.empty() && !cv::haveImageWriter(options.save)) {
        return "save is '" + options.save + "', must end in .png or .jpg";
    }
    return hal::Done{};
}

bool HaveScreen() {
    return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

int View(const ViewOptions& options, LcmSubscriber& subscriber) try {
    if (!options.save.empty()) return Viewer(options, subscriber, nullptr).Run();
    if (!HaveScreen())
        return Fail(kMachineFailed, "no display to open a window on; use --save FILE");
    Window window;
    return Viewer(options, subscriber, &window).Run();
} catch (const cv::Exception& exception) {
    return Fail(kMachineFailed, exception.what());
}

}  // namespace

int ViewVerb(const ViewOptions& options) {
    if (const auto checked = Check(options); !checked) return Fail(kWrongUse, checked.error());
    if (const auto url = drivers::CheckLcmUrl(options.url); !url) {
        return Fail(kWrongUse, url.error());
    }
    if (const auto name = drivers::CheckLcmChannel("channel", options.channel); !name) {
        return Fail(kWrongUse, name.error());
    }
    if (const auto name = drivers::CheckLcmChannel("health_channel", options.health_channel);
        !name) {
        return Fail(kWrongUse, name.error());
    }
    const auto subscriber = LcmSubscriber::Create(
        {.url = options.url, .channel = options.channel, .health_channel = options.health_channel});
    if (!subscriber) return Fail(kMachineFailed, subscriber.error());
    return View(options, *subscriber.value());
}

}  // namespace hitchview::app
