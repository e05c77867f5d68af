#include "app/calib_capture_source.hpp"

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "app/board.hpp"
#include "app/file_pattern.hpp"
#include "app/log_pictures.hpp"
#include "calib/board_pattern.hpp"
#include "drivers/simulated_sheet.hpp"

namespace hitchview::app {
namespace {

class Pictures final : public CaptureSource {
 public:
    Pictures(std::vector<std::string> files, const std::string& camera)
        : files_(std::move(files)), cameras_{camera} {}

    [[nodiscard]] const std::vector<std::string>& cameras() const override { return cameras_; }
    [[nodiscard]] std::string failure() const override { return failure_; }
    std::optional<std::vector<cv::Mat1b>> Next() override {
        if (next_ == files_.size()) return std::nullopt;
        const std::string& file = files_[next_++];
        const cv::Mat1b grey =
            cv::imread(file, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
        if (grey.empty()) {
            failure_ = file + ": is no picture that can be read";
            return std::nullopt;
        }
        return std::vector{grey};
    }

 private:
    std::vector<std::string> files_;
    std::vector<std::string> cameras_;
    std::size_t next_ = 0;
    std::string failure_;
};

class Video final : public CaptureSource {
 public:
    Video(const std::string& file, const std::string& camera) : film_(file), cameras_{camera} {}

    [[nodiscard]] bool is_open() const { return film_.isOpened(); }
    [[nodiscard]] const std::vector<std::string>& cameras() const override { return cameras_; }
    std::optional<std::vector<cv::Mat1b>> Next() override {
        cv::Mat colour;
        if (!film_.read(colour)) return std::nullopt;
        cv::Mat1b grey;
        cv::cvtColor(colour, grey, cv::COLOR_BGR2GRAY);
        return std::vector{grey};
    }

 private:
    cv::VideoCapture film_;
    std::vector<std::string> cameras_;
};

class Log final : public CaptureSource {
 public:
    Log(std::vector<std::filesystem::path> files, const std::string& camera)
        : pictures_(std::move(files), camera), cameras_{camera} {}

    [[nodiscard]] const std::vector<std::string>& cameras() const override { return cameras_; }
    [[nodiscard]] std::string failure() const override { return pictures_.failure(); }
    std::optional<std::vector<cv::Mat1b>> Next() override {
        const auto colour = pictures_.Next();
        if (!colour) return std::nullopt;
        cv::Mat1b grey;
        cv::cvtColor(*colour, grey, cv::COLOR_BGR2GRAY);
        return std::vector{grey};
    }

 private:
    LogPictures pictures_;
    std::vector<std::string> cameras_;
};

/// A copy of the frame's luma, in full range.
cv::Mat1b GreyOf(const hal::FrameView& view) {
    const hal::FrameFormat& format = view.format;
    const hal::Plane& plane = view.planes[0];
    const bool uyvy = format.pixel_format == hal::PixelFormat::kUyvy;
    const bool packed = uyvy || format.pixel_format == hal::PixelFormat::kYuyv;
    // OpenCV has no header for pixels that may not be written; they are only read.
    const cv::Mat samples(format.height_px, format.width_px, packed ? CV_8UC2 : CV_8UC1,
                          const_cast<std::uint8_t*>(plane.data),
                          static_cast<std::size_t>(plane.stride_bytes));
    cv::Mat1b grey;
    if (packed) {
        cv::extractChannel(samples, grey, uyvy ? 1 : 0);
    } else {
        samples.copyTo(grey);
    }
    if (format.range == hal::Range::kLimited)
        grey.convertTo(grey, CV_8U, 255.0 / 219, -16 * 255.0 / 219);
    return grey;
}

/// The board as it is printed, with its white margin.
drivers::SheetOptions SheetOf(const calib::Board& board) {
    const calib::BoardRectangle area = calib::PatternArea(board);
    const Eigen::Vector2d margin_m = Eigen::Vector2d::Constant(calib::WhiteMargin_m(board));
    drivers::SheetOptions sheet{.paper = {area.from_m - margin_m, area.to_m + margin_m}};
    for (const calib::BoardRectangle& dark : calib::DarkRectangles(board))
        sheet.dark.push_back({dark.from_m, dark.to_m});
    return sheet;
}

class Rig final : public CaptureSource {
 public:
    struct Place {
        algo::Unit unit;
        std::size_t index;
    };

    Rig(std::unique_ptr<Board> board, std::vector<std::string> cameras, std::vector<Place> places)
        : board_(std::move(board)), cameras_(std::move(cameras)), places_(std::move(places)) {}

    [[nodiscard]] const std::vector<std::string>& cameras() const override { return cameras_; }
    [[nodiscard]] std::string failure() const override { return failure_; }
    std::optional<std::vector<cv::Mat1b>> Next() override {
        const auto set = board_->sets().WaitSet();
        if (!set) {
            if (set.error() != hal::Error::kEndOfStream) failure_ = "a camera of the rig failed";
            return std::nullopt;
        }
        std::vector<cv::Mat1b> pictures;
        for (const Place& place : places_) {
            const hal::FrameLease& lease = set.value().leases[place.unit][place.index];
            pictures.push_back(lease ? GreyOf(lease.view()) : cv::Mat1b());
        }
        return pictures;
    }

 private:
    std::unique_ptr<Board> board_;
    std::vector<std::string> cameras_;
    std::vector<Place> places_;
    std::string failure_;
};

}  // namespace

hal::Checked<std::unique_ptr<CaptureSource>> OpenPictures(const std::string& pattern,
                                                          const std::string& camera) {
    std::vector<std::string> files = FilesLike(pattern);
    if (files.empty()) return "no file is named " + pattern;
    return std::unique_ptr<CaptureSource>(std::make_unique<Pictures>(std::move(files), camera));
}

hal::Checked<std::unique_ptr<CaptureSource>> OpenVideo(const std::string& file,
                                                       const std::string& camera) {
    auto video = std::make_unique<Video>(file, camera);
    if (!video->is_open()) return file + ": is no film that can be read";
    return std::unique_ptr<CaptureSource>(std::move(video));
}

hal::Checked<std::unique_ptr<CaptureSource>> OpenLog(const std::string& log,
                                                     const std::string& camera) {
    auto files = LogFiles({log});
    if (!files) return files.error();
    return std::unique_ptr<CaptureSource>(std::make_unique<Log>(std::move(files.value()), camera));
}

hal::Checked<std::unique_ptr<CaptureSource>> OpenRig(const std::string& file,
                                                     const std::string& only,
                                                     const calib::Board& held) {
    const auto config = LoadRigConfig(file);
    if (!config) return config.error();
    std::vector<std::string> cameras;
    std::vector<Rig::Place> places;
    for (const algo::Unit unit : {algo::Unit::kTractor, algo::Unit::kTrailer}) {
        const auto& of_unit = config.value().units[unit].cameras;
        for (std::size_t i = 0; i < of_unit.size(); ++i) {
            if (!only.empty() && of_unit[i].name != only) continue;
            cameras.push_back(of_unit[i].name);
            places.push_back({unit, i});
        }
    }
    if (cameras.empty()) return file + ": has no camera " + only;
    const drivers::SheetOptions sheet = SheetOf(held);
    auto board = Board::Open(config.value(), {.held_sheet = &sheet});
    if (!board) return board.error();
    return std::unique_ptr<CaptureSource>(
        std::make_unique<Rig>(std::move(board.value()), std::move(cameras), std::move(places)));
}

}  // namespace hitchview::app
