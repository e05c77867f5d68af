#pragma once

#include <array>
#include <optional>

#include "algo/picture_look.hpp"
#include "app/camera_judge.hpp"
#include "app/config.hpp"

namespace hitchview::app {

/// Finds what is wrong with pictures. Brightness and repetition are of one picture alone; whether
/// detail is missing is judged against what the rig's other cameras see in the same part of their
/// pictures at that time, so that fog, night or snow are no fault of a camera, and against what the
/// camera itself usually makes of that: no judgement with fewer than kLeastCameras that see
/// something. Thread: one.
class PictureSigns {
 public:
    static constexpr std::size_t kLeastCameras = 3;

    /// Before each set.
    void Begin();
    /// The picture of one camera in the set.
    void Add(std::size_t camera, const algo::CameraFrame& picture);
    /// After the last one: adds what the pictures show to the signs of their cameras.
    void Finish(std::array<CameraSigns, kMaxCameras>& signs);
    /// After the last one.
    [[nodiscard]] bool SeemsRepeated(std::size_t camera) const {
        return cameras_[camera].present && cameras_[camera].seems_repeated;
    }
    void Reset() { *this = PictureSigns(); }

 private:
    using Cells = std::array<float, algo::PictureLook::kCells>;

    /// How much of what the cameras see in one part of their pictures this one has there.
    struct Habit {
        [[nodiscard]] float Expects(float usual) const;
        void Learn(float detail, float usual);

        float log_share = 0;
        int sets = 0;  ///< that it was learnt from, up to as many as it is of
    };

    struct Part {
        Habit habit;
        bool lost = false;  ///< its detail
    };

    struct Camera {
        bool present = false;   ///< in this set
        bool compared = false;  ///< with the others: it shows something new
        bool dirty = false;     ///< as judged last
        algo::PictureLook look;
        std::uint64_t print_before = 0;
        std::optional<std::uint64_t> whole_print_before;  ///< where the samples were equal, too
        bool seems_repeated = false;                      ///< its samples are as before
        bool repeated = false;                            ///< all of it is
        float sharpness = 0;                              ///< of the sharpest parts
        Cells recent{};  ///< detail of each part, the most of the last moments
        std::array<Part, algo::PictureLook::kCells> parts{};
    };

    static bool Repeats(Camera& camera, const algo::CameraFrame& picture);
    static bool IsDirty(Camera& camera, const Cells& usual);
    [[nodiscard]] std::size_t Compared() const;
    [[nodiscard]] bool EnoughAreClean() const;
    template <typename Value>
    [[nodiscard]] float Median(const Value& value_of) const;
    void FindBlurred(std::array<CameraSigns, kMaxCameras>& signs);
    void FindDirty(std::array<CameraSigns, kMaxCameras>& signs);

    std::array<Camera, kMaxCameras> cameras_;
};

}  // namespace hitchview::app
