#include "app/calib_sheet_plan.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "calib/tag_family.hpp"

namespace hitchview::app {
namespace {

using calib::Board;
using calib::Pattern;
using Eigen::Vector2d;

constexpr double kPrinterMargin_mm = 5;
constexpr double kFooter_mm = 12;  ///< for measuring bar and description

std::optional<Vector2d> PaperSize_mm(const std::string& paper) {
    struct Named {
        std::string_view name;
        Vector2d size_mm;
    };
    static const std::array<Named, 5> kPapers{{{"a4", {297, 210}},
                                               {"a3", {420, 297}},
                                               {"a2", {594, 420}},
                                               {"a1", {841, 594}},
                                               {"a0", {1189, 841}}}};
    for (const Named& named : kPapers) {
        if (paper == named.name) return named.size_mm;
    }
    Vector2d size_mm;
    const char* end = paper.data() + paper.size();
    const auto width = std::from_chars(paper.data(), end, size_mm.x());
    if (width.ec != std::errc{} || width.ptr == end || *width.ptr != 'x') return std::nullopt;
    const auto height = std::from_chars(width.ptr + 1, end, size_mm.y());
    const bool sound = height.ec == std::errc{} && height.ptr == end && size_mm.minCoeff() >= 120 &&
                       size_mm.maxCoeff() <= 5000;
    return sound ? std::optional(size_mm) : std::nullopt;
}

/// Usual sizes of tags: they leave white enough, and bits as large as can be.
double TagShare(Pattern pattern) {
    switch (pattern) {
        case Pattern::kCheckerboard:
            return 0;
        case Pattern::kCharuco:
            return 0.7;
        case Pattern::kTags:
            return 0.77;
    }
    return 0;
}

Board Described(const SheetRequest& request, int columns, int rows, double square_m) {
    const double tag_m = request.tag_m.value_or(TagShare(request.pattern) * square_m);
    return {.columns = columns,
            .rows = rows,
            .square_m = square_m,
            .pattern = request.pattern,
            .tag_m = request.pattern == Pattern::kCheckerboard ? 0 : tag_m,
            .first_tag = request.pattern == Pattern::kCheckerboard ? 0 : request.first_tag};
}

/// White beside and above the pattern.
double Rim_mm(const Board& board) {
    return std::max(kPrinterMargin_mm, 1000 * calib::WhiteMargin_m(board));
}

/// Paper that a board needs.
Vector2d Needed_mm(const Board& board) {
    const double rim_mm = Rim_mm(board);
    return 1000 * calib::PatternArea(board).size_m() +
           Vector2d(2 * rim_mm, 2 * rim_mm + kFooter_mm);
}

bool Fits(const Board& board, const Vector2d& paper_mm) {
    return (Needed_mm(board).array() <= paper_mm.array() + 1e-6).all();
}

/// Squares with which a board of so many fits, in steps of a tenth of a millimetre.
double LargestSquare_m(const SheetRequest& request, int columns, int rows,
                       const Vector2d& paper_mm) {
    int tenths_mm = static_cast<int>(10 * paper_mm.maxCoeff());
    SheetRequest scaled = request;
    const auto fits = [&](int tenths) {
        const double square_m = 1e-4 * tenths;
        if (request.tag_m && request.square_m)
            scaled.tag_m = *request.tag_m / *request.square_m * square_m;
        return Fits(Described(scaled, columns, rows, square_m), paper_mm);
    };
    while (tenths_mm > 1 && !fits(tenths_mm)) --tenths_mm;
    return 1e-4 * tenths_mm;
}

/// As many rows as fit; those of a checkerboard are even where its columns are odd, so that it does
/// not look the same when turned.
int RowsThatFit(const SheetRequest& request, int columns, double square_m,
                const Vector2d& paper_mm) {
    int rows = request.pattern == Pattern::kTags ? 20 : 50;
    const int fewest = request.pattern == Pattern::kTags ? 1 : 3;
    const auto good = [&] {
        return Fits(Described(request, columns, rows, square_m), paper_mm) &&
               (request.pattern != Pattern::kCheckerboard || rows % 2 != columns % 2);
    };
    while (rows > fewest && !good()) --rows;
    return rows;
}

int ColumnsThatFit(const SheetRequest& request, double square_m, const Vector2d& paper_mm) {
    int columns = request.pattern == Pattern::kTags ? 20 : 50;
    const int fewest = request.pattern == Pattern::kTags ? 1 : 3;
    while (columns > fewest && !Fits(Described(request, columns, 1, square_m), paper_mm)) --columns;
    return columns;
}

Board Chosen(const SheetRequest& request, const Vector2d& paper_mm) {
    const int usual = request.pattern == Pattern::kTags ? 6 : 9;
    const int columns = request.columns.value_or(
        request.square_m ? ColumnsThatFit(request, *request.square_m, paper_mm) : usual);
    const double largest_m = LargestSquare_m(request, columns, request.rows.value_or(1), paper_mm);
    const double square_m =
        request.square_m.value_or(std::max(0.001, std::floor(1000 * largest_m) / 1000));
    const int rows = request.rows.value_or(RowsThatFit(request, columns, square_m, paper_mm));
    return Described(request, columns, rows, square_m);
}

std::string Misfit(const SheetRequest& request, const Board& board, const Vector2d& paper_mm) {
    const Vector2d needed_mm = Needed_mm(board);
    char text[300];
    std::snprintf(
        text, sizeof text,
        "%s needs paper of %.0fx%.0f mm with its white rim and the measuring bar, --paper "
        "is %.0fx%.0f mm: --square-m may be at most %.4f, or choose larger paper or fewer "
        "columns and rows",
        Describe(board).c_str(), std::ceil(needed_mm.x()), std::ceil(needed_mm.y()), paper_mm.x(),
        paper_mm.y(), LargestSquare_m(request, board.columns, board.rows, paper_mm));
    return text;
}

/// What is wrong with the numbers; empty if nothing is.
std::string Unsound(const Board& board) {
    const bool grid = board.pattern == Pattern::kTags;
    const int fewest = grid ? 1 : 3;
    const int most = grid ? 20 : 50;
    if (std::min(board.columns, board.rows) < fewest || std::max(board.columns, board.rows) > most)
        return "--columns and --rows must be " + std::to_string(fewest) + " to " +
               std::to_string(most);
    if (!(board.square_m >= 0.001 && board.square_m <= 2)) return "--square-m must be 0.001 to 2";
    if (board.tags() == 0) return "";
    if (!(board.tag_m >= 0.3 * board.square_m && board.tag_m <= 0.9 * board.square_m))
        return "--tag-m must be 0.3 to 0.9 of --square-m";
    if (board.first_tag < 0 || board.first_tag + board.tags() > calib::kTags)
        return "--first-tag must be 0 to " + std::to_string(calib::kTags - board.tags()) + " for " +
               std::to_string(board.tags()) + " tags";
    return "";
}

}  // namespace

hal::Checked<SheetPlan> PlanSheet(const SheetRequest& request) {
    const auto paper_mm = PaperSize_mm(request.paper);
    if (!paper_mm)
        return "--paper is " + request.paper +
               ", must be a4, a3, a2, a1, a0 or WIDTHxHEIGHT in mm, 120 to 5000";
    const Board board = Chosen(request, *paper_mm);
    if (std::string why = Unsound(board); !why.empty()) return why;
    if (!Fits(board, *paper_mm)) return Misfit(request, board, *paper_mm);
    const Vector2d size_mm = 1000 * calib::PatternArea(board).size_m();
    SheetPlan plan{.board = board, .paper_mm = *paper_mm};
    plan.pattern_mm = (*paper_mm - Vector2d(0, kFooter_mm) - size_mm) / 2;
    plan.footer_mm = {2 * kPrinterMargin_mm, paper_mm->y() - kPrinterMargin_mm - 4};
    return plan;
}

}  // namespace hitchview::app
