#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/board.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// Where pictures of a board come from: one camera or several. Thread: one.
class CaptureSource {
 public:
    virtual ~CaptureSource() = default;
    /// Of its cameras.
    [[nodiscard]] virtual const std::vector<std::string>& cameras() const = 0;
    /// A grey picture of each camera from one moment, empty where it gave none; nothing where the
    /// source is over or failed.
    virtual std::optional<std::vector<cv::Mat1b>> Next() = 0;
    /// Why it ended before its end; empty if it did not.
    [[nodiscard]] virtual std::string failure() const { return ""; }
};

/// Pictures that a pattern of the shell names, in the order of their names, as one camera.
hal::Checked<std::unique_ptr<CaptureSource>> OpenPictures(const std::string& pattern,
                                                          const std::string& camera);
/// A film, as one camera.
hal::Checked<std::unique_ptr<CaptureSource>> OpenVideo(const std::string& file,
                                                       const std::string& camera);
/// One camera of a recording: an LCM log, or a folder of its segments.
hal::Checked<std::unique_ptr<CaptureSource>> OpenLog(const std::string& log,
                                                     const std::string& camera);
/// The cameras of a rig file: real, recorded or simulated. `only`: one of them; empty: all. Before
/// simulated ones somebody holds `board`.
hal::Checked<std::unique_ptr<CaptureSource>> OpenRig(const std::string& file,
                                                     const std::string& only,
                                                     const calib::Board& board);

}  // namespace hitchview::app
