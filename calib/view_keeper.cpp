#include "calib/view_keeper.hpp"

#include <algorithm>
#include <cstdio>
#include <set>

namespace hitchview::calib {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kFewestCorners = 8;

constexpr std::array<Tilt, 4> kSides{Tilt::kLeftAway, Tilt::kRightAway, Tilt::kTopAway,
                                     Tilt::kBottomAway};

const char* SideName(Tilt tilt) {
    switch (tilt) {
        case Tilt::kFacing:
            break;
        case Tilt::kLeftAway:
            return "left";
        case Tilt::kRightAway:
            return "right";
        case Tilt::kTopAway:
            return "upper";
        case Tilt::kBottomAway:
            return "lower";
    }
    return "";
}

/// Mean distance between the corners that both show; a large number if they share too few.
double Apart_px(const SeenCorners& a, const SeenCorners& b) {
    constexpr double kUnlike_px = 1e6;
    double sum_px = 0;
    std::size_t both = 0;
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
        if (a[i].index == b[j].index) {
            sum_px += (a[i++].at_px - b[j++].at_px).norm();
            ++both;
        } else {
            a[i].index < b[j].index ? ++i : ++j;
        }
    }
    return both < kFewestCorners / 2 ? kUnlike_px : sum_px / static_cast<double>(both);
}

std::string Counted(const char* what, int have, int need) {
    char text[120];
    std::snprintf(text, sizeof text, "%s: %d of %d", what, have, need);
    return text;
}

}  // namespace

ViewKeeper::ViewKeeper(const Board& board, const Vector2d& picture_px, const ViewGoals& goals)
    : board_(board), picture_px_(picture_px), goals_(goals) {}

ViewKeeper::Answer ViewKeeper::Judge(const SeenCorners& corners,
                                     const std::optional<CornerLook>& look) {
    const auto pose = RoughPose(board_, corners, picture_px_);
    if (corners.size() < kFewestCorners || !look || !pose) {
        last_.clear();
        return {.advice = "show the board"};
    }
    const bool moves = Moves(corners);
    last_ = corners;
    if (std::string flaw = Flaw(*look); !flaw.empty()) return {.advice = std::move(flaw)};
    if (moves) return {.advice = "hold still"};
    const View view{corners, *pose};
    if (!IsNew(view) || !AddsSomething(view)) return {.advice = NextNeed()};
    Keep(view);
    return {.keep = true, .advice = NextNeed()};
}

std::size_t ViewKeeper::CellOf(const Vector2d& at_px) const {
    const int column = static_cast<int>(at_px.x() / picture_px_.x() * kColumns);
    const int row = static_cast<int>(at_px.y() / picture_px_.y() * kRows);
    return static_cast<std::size_t>(std::clamp(row, 0, kRows - 1) * kColumns +
                                    std::clamp(column, 0, kColumns - 1));
}

std::string ViewKeeper::Flaw(const CornerLook& look) const {
    constexpr double kLeastContrast = 40;
    constexpr double kBurnt = 253;
    constexpr double kDim = 70;
    if (look.white_grey >= kBurnt) return "too bright: less light on the board";
    if (look.white_grey < kDim || look.white_grey - look.dark_grey < kLeastContrast)
        return "too dark: more light on the board";
    if (look.blur_px > goals_.most_blur_px) return "blurred: hold still, or nearer to the focus";
    return "";
}

/// The first picture of a board is taken for still only where motion does not matter.
bool ViewKeeper::Moves(const SeenCorners& corners) const {
    if (goals_.most_motion_px <= 0) return false;
    return Apart_px(last_, corners) > goals_.most_motion_px * picture_px_.x() / 1280;
}

bool ViewKeeper::IsNew(const View& view) const {
    constexpr double kAnotherPlace = 0.04;  // of the picture's width
    return std::ranges::all_of(kept_, [&](const View& kept) {
        return kept.pose.tilt != view.pose.tilt ||
               Apart_px(kept.corners, view.corners) > kAnotherPlace * picture_px_.x();
    });
}

bool ViewKeeper::AddsSomething(const View& view) const {
    if (views() < goals_.views) return true;
    const bool covers = std::ranges::any_of(
        view.corners, [&](const SeenCorner& corner) { return cells_[CellOf(corner.at_px)] == 0; });
    const bool tilts = view.pose.tilt != Tilt::kFacing && tilted(view.pose.tilt) < goals_.tilted;
    const bool nears = view.pose.size >= goals_.near_size && near_ < goals_.near;
    const bool fars = view.pose.size <= goals_.far_size && far_ < goals_.far;
    return covers || tilts || nears || fars;
}

void ViewKeeper::Keep(const View& view) {
    std::set<std::size_t> touched;
    for (const SeenCorner& corner : view.corners) touched.insert(CellOf(corner.at_px));
    for (const std::size_t cell : touched) ++cells_[cell];
    ++tilts_[static_cast<std::size_t>(view.pose.tilt)];
    near_ += view.pose.size >= goals_.near_size ? 1 : 0;
    far_ += view.pose.size <= goals_.far_size ? 1 : 0;
    kept_.push_back(view);
}

double ViewKeeper::covered() const {
    const auto seen = std::ranges::count_if(cells_, [](int views) { return views > 0; });
    return static_cast<double>(seen) / static_cast<double>(cells_.size());
}

/// The ninth of the picture that lacks most, or empty.
std::string ViewKeeper::NextPlace() const {
    if (covered() >= goals_.covered) return "";
    std::array<int, 9> lacking{};
    for (int cell = 0; cell < kColumns * kRows; ++cell) {
        const int ninth = cell / kColumns * 3 / kRows * 3 + cell % kColumns * 3 / kColumns;
        if (cells_[static_cast<std::size_t>(cell)] == 0) ++lacking[static_cast<std::size_t>(ninth)];
    }
    const auto most = std::ranges::max_element(lacking) - lacking.begin();
    static const std::array<const char*, 9> kPlaces{
        "upper left corner", "upper edge", "upper right corner",
        "left edge",         "middle",     "right edge",
        "lower left corner", "lower edge", "lower right corner"};
    return std::string("hold it into the ") + kPlaces[static_cast<std::size_t>(most)];
}

std::string ViewKeeper::NextNeed() const {
    if (enough()) return "enough";
    if (std::string place = NextPlace(); !place.empty()) return place;
    for (const Tilt side : kSides) {
        if (tilted(side) < goals_.tilted)
            return std::string("tilt it: its ") + SideName(side) + " side away from the camera";
    }
    if (near_ < goals_.near) return "nearer";
    if (far_ < goals_.far) return "farther away";
    return "hold it somewhere else";
}

std::vector<std::string> ViewKeeper::missing() const {
    std::vector<std::string> missing;
    if (views() < goals_.views) missing.push_back(Counted("views", views(), goals_.views));
    if (covered() < goals_.covered)
        missing.push_back(Counted("percent of the picture covered",
                                  static_cast<int>(100 * covered()),
                                  static_cast<int>(100 * goals_.covered)));
    for (const Tilt side : kSides) {
        const std::string what = std::string(SideName(side)) + " side tilted away";
        if (tilted(side) < goals_.tilted)
            missing.push_back(Counted(what.c_str(), tilted(side), goals_.tilted));
    }
    if (near_ < goals_.near) missing.push_back(Counted("near", near_, goals_.near));
    if (far_ < goals_.far) missing.push_back(Counted("far", far_, goals_.far));
    return missing;
}

}  // namespace hitchview::calib
