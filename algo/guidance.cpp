#include "algo/guidance.hpp"

#include "algo/feature_mask.hpp"

namespace hitchview::algo {

using Eigen::Vector2d;
using Eigen::Vector2f;

Guidance::Guidance(const Projection& canvas, const PerUnit<Side>& sides,
                   const VertexField& discrepancy, Overlap overlap, int& candidates)
    : canvas_(canvas),
      mesh_(canvas),
      sides_(sides),
      M_view_canvas_{{sides[Unit::kTractor].M_canvas_view.inverse(),
                      sides[Unit::kTrailer].M_canvas_view.inverse()}},
      discrepancy_(discrepancy),
      overlap_(overlap),
      candidates_(candidates) {}

bool Guidance::Expect(Unit unit, const Vector2f& pixel, Vector2f& other) const {
    const Side& here = sides_[unit];
    const Side& there = sides_[Other(unit)];
    const Vector2d canvas_px =
        canvas_.Pixel(here.M_canvas_view * here.view.Ray(here.analysis->ToView(pixel)));
    if (!InOverlap(canvas_px)) return false;
    const Vector2d e = Sample(mesh_, discrepancy_, canvas_px);
    const Vector2d shown =
        unit == Unit::kTractor ? Vector2d(canvas_px + e) : Vector2d(canvas_px - e);
    other = there.analysis->ToAnalysis(
        there.view.Pixel(M_view_canvas_[Other(unit)] * canvas_.Ray(shown)));
    if (!Allows(there.analysis->mask(), other)) return false;
    ++candidates_;
    return true;
}

bool Guidance::InOverlap(const Vector2d& canvas_px) const {
    if (!canvas_.IsRing()) return overlap_ == Overlap::kRight;
    return (canvas_px.x() < canvas_.Centre().x()) == (overlap_ == Overlap::kLeft);
}

}  // namespace hitchview::algo
