#include "app/calib_sheet.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <memory>

namespace hitchview::app {
namespace {

constexpr double kPointsPerMm = 72 / 25.4;

/// One path, filled once: between squares that touch no hair of white can appear.
void DrawPattern(cairo_t* cairo, const SheetPlan& plan) {
    const Eigen::Vector2d origin_mm =
        plan.pattern_mm - 1000 * calib::PatternArea(plan.board).from_m;
    for (const calib::BoardRectangle& dark : calib::DarkRectangles(plan.board)) {
        const Eigen::Vector2d from = origin_mm + 1000 * dark.from_m;
        const Eigen::Vector2d size = 1000 * dark.size_m();
        cairo_rectangle(cairo, from.x(), from.y(), size.x(), size.y());
    }
    cairo_fill(cairo);
}

void DrawBar(cairo_t* cairo, const Eigen::Vector2d& from_mm) {
    constexpr double kThick_mm = 1;
    constexpr double kEnd_mm = 3;
    constexpr double kEndThick_mm = 0.2;
    cairo_rectangle(cairo, from_mm.x(), from_mm.y(), kMeasuringBar_mm, kThick_mm);
    cairo_rectangle(cairo, from_mm.x(), from_mm.y() - kEnd_mm / 2, kEndThick_mm, kEnd_mm);
    cairo_rectangle(cairo, from_mm.x() + kMeasuringBar_mm - kEndThick_mm, from_mm.y() - kEnd_mm / 2,
                    kEndThick_mm, kEnd_mm);
    cairo_fill(cairo);
}

/// An arrow that points to the top of the sheet.
void DrawTopMark(cairo_t* cairo, const Eigen::Vector2d& at_mm) {
    cairo_move_to(cairo, at_mm.x(), at_mm.y() - 3);
    cairo_line_to(cairo, at_mm.x() + 1.5, at_mm.y());
    cairo_line_to(cairo, at_mm.x() - 1.5, at_mm.y());
    cairo_close_path(cairo);
    cairo_fill(cairo);
}

void Write(cairo_t* cairo, double x_mm, double y_mm, const std::string& text) {
    cairo_move_to(cairo, x_mm, y_mm);
    cairo_show_text(cairo, text.c_str());
    cairo_new_path(cairo);
}

/// On narrow paper the words are as large as they can be.
void DrawWords(cairo_t* cairo, const SheetPlan& plan) {
    const Eigen::Vector2d at = plan.footer_mm;
    const std::string bar = "This bar is 100 mm. If it is not, print again at 100 %.";
    const std::string board = Describe(plan.board);
    cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, 2.8);
    Write(cairo, at.x(), at.y() - 2.2, bar);
    const double left_mm = at.x() + kMeasuringBar_mm + 6;
    cairo_text_extents_t extents;
    cairo_text_extents(cairo, board.c_str(), &extents);
    const double room_mm = plan.paper_mm.x() - left_mm - 12;
    if (extents.x_advance > room_mm) cairo_set_font_size(cairo, 2.8 * room_mm / extents.x_advance);
    Write(cairo, left_mm + 8, at.y() + 1, "top");
    Write(cairo, left_mm + 8, at.y() - 2.2, board);
    DrawTopMark(cairo, {left_mm + 3, at.y() + 1});
}

struct Destroy {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
};
using Surface = std::unique_ptr<cairo_surface_t, Destroy>;

cairo_status_t Append(void* text, const unsigned char* data, unsigned length) {
    static_cast<std::string*>(text)->append(data, data + length);
    return CAIRO_STATUS_SUCCESS;
}

Surface NewPdf(const SheetPlan& plan, std::string& file) {
    const Eigen::Vector2d points = kPointsPerMm * plan.paper_mm;
    return Surface(cairo_pdf_surface_create_for_stream(Append, &file, points.x(), points.y()));
}

Surface NewSvg(const SheetPlan& plan, std::string& file) {
    Surface surface(
        cairo_svg_surface_create_for_stream(Append, &file, plan.paper_mm.x(), plan.paper_mm.y()));
    cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_MM);
    return surface;
}

}  // namespace

void DrawSheet(cairo_t* cairo, const SheetPlan& plan) {
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    cairo_set_source_rgb(cairo, 0, 0, 0);
    DrawPattern(cairo, plan);
    DrawBar(cairo, plan.footer_mm);
    DrawWords(cairo, plan);
}

hal::Checked<SheetFileContent> SheetFile(const SheetPlan& plan, SheetFormat format) {
    SheetFileContent file;
    const bool pdf = format == SheetFormat::kPdf;
    const Surface surface = pdf ? NewPdf(plan, file.bytes) : NewSvg(plan, file.bytes);
    {
        const std::unique_ptr<cairo_t, Destroy> cairo(cairo_create(surface.get()));
        if (pdf) cairo_scale(cairo.get(), kPointsPerMm, kPointsPerMm);
        DrawSheet(cairo.get(), plan);
    }
    cairo_surface_finish(surface.get());
    const cairo_status_t status = cairo_surface_status(surface.get());
    if (status != CAIRO_STATUS_SUCCESS)
        return std::string("the sheet cannot be drawn: ") + cairo_status_to_string(status);
    return file;
}

}  // namespace hitchview::app
