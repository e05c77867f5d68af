#pragma once

#include <array>

namespace hitchview::app {

/// A figure of one view as the published method's table of stabilisation results has it: its
/// average over nine views of seven cases. All three: [0, 1], 1 is best. The recordings are not
/// public, so that only the definition is comparable, not the scene.
struct PaperFigure {
    const char* name;
    const char* key;  ///< in units.<unit>.paper of `Evaluate`
    double value;
};

inline constexpr std::array<PaperFigure, 3> kPaperFigures{{{"Cropping", "cropping", 0.9828},
                                                           {"Distortion", "distortion", 0.9805},
                                                           {"Stability", "stability", 0.9121}}};

/// Stitching scores, px, of the same publication: the three cases of its table of stitching
/// results, recordings of Guo et al. Lower is better.
inline constexpr double kPaperStitchingBestPx = 0.859;
inline constexpr double kPaperStitchingWorstPx = 0.952;

}  // namespace hitchview::app
