#include "drivers/v4l2_negotiation.hpp"

#include <utility>

namespace hitchview::drivers {
namespace {

using hal::Checked;
using hal::Done;

/// What else is wrong with it.
std::string FaultText(const V4l2Layout& layout) {
    if (layout.interlaced) return " interlaced";
    if (HoldsLines(layout)) return "";
    return " in lines of " + std::to_string(layout.planes[0].line_bytes) + " bytes";
}

std::string FormatText(std::uint32_t fourcc, V4l2Size size, double rate_hz) {
    return FourccText(fourcc) + " " + SizeText(size) + " at " + RateText(rate_hz) + " Hz";
}

}  // namespace

Checked<V4l2Granted> V4l2Negotiation::Agree() {
    const V4l2Size& size = options_.wish.size;
    if (size.width_px <= 0 || size.height_px <= 0 || size.width_px % 2 != 0 ||
        size.height_px % 2 != 0) {
        return "size is " + SizeText(size) + ", must be even";
    }
    if (const auto connected = Connect(); !connected) return ToString(connected.error());
    identity_ = device_.identity();
    if (const auto chosen = Choose(); !chosen) return chosen.error();
    const auto granted = Configure();
    if (!granted) return ToString(granted.error());
    if (const auto checked = Check(granted.value()); !checked) return checked.error();
    first_ = granted.value();
    return first_;
}

Checked<Done> V4l2Negotiation::Choose() {
    const auto chosen = ChooseFormat(ListOffers(device_, options_.wish.size), options_.wish);
    if (!chosen) return chosen.error();
    pixel_format_ = chosen.value();
    const auto menus = options_.controls.empty() ? V4l2Menus::kLeftOut : V4l2Menus::kListed;
    const std::vector<V4l2Control> controls = ListControls(device_, menus);
    auto settings = PlanSettings(controls, options_.orientation, options_.controls);
    if (!settings) return settings.error();
    control_values_ = std::move(settings.value());
    has_exposure_ = HasExposure(controls);
    return Done{};
}

Checked<Done> V4l2Negotiation::Check(const V4l2Granted& granted) const {
    const V4l2Layout& layout = granted.layout;
    const V4l2Wish& wish = options_.wish;
    const bool same = layout.fourcc == pixel_format_->fourcc &&
                      layout.width_px == wish.size.width_px &&
                      layout.height_px == wish.size.height_px && !layout.interlaced &&
                      layout.memory_planes == pixel_format_->memory_planes && HoldsLines(layout);
    if (same && SameRate(granted.rate_hz, wish.rate_hz)) return Done{};
    return "wanted " + FormatText(pixel_format_->fourcc, wish.size, wish.rate_hz) + ", got " +
           FormatText(layout.fourcc, {layout.width_px, layout.height_px}, granted.rate_hz) +
           FaultText(layout) + "; offered: " + OffersText(ListOffers(device_, wish.size));
}

V4l2Result<Done> V4l2Negotiation::Connect() {
    if (const auto opened = device_.Open(options_.path.c_str()); !opened) return opened.error();
    const auto input = SelectInput(device_, options_.input);
    if (!input) return input.error();
    input_ = input.value();
    if (input_.has_timings) {
        if (const auto followed = FollowTimings(device_); !followed) return followed.error();
    }
    if (!input_.may_change) return Done{};
    const auto subscribed = SubscribeSourceChange(device_);
    input_.may_change = subscribed.ok();  // not every driver tells
    return Done{};
}

V4l2Result<V4l2Granted> V4l2Negotiation::Configure() {
    const V4l2Size& size = options_.wish.size;
    const auto layout = SetFormat(
        device_, {pixel_format_->fourcc, size.width_px, size.height_px, options_.line_bytes});
    if (!layout) return layout.error();
    const auto maybe_rate_hz = SetRate(device_, options_.wish.rate_hz);
    if (!maybe_rate_hz) return maybe_rate_hz.error();
    for (const V4l2ControlValue& value : control_values_) {
        if (const auto set = SetControl(device_, value); !set) return set.error();
    }
    const std::optional<double>& told_hz = maybe_rate_hz.value();
    return V4l2Granted{layout.value(), told_hz.value_or(options_.wish.rate_hz), told_hz.has_value(),
                       has_exposure_ ? ReadExposure(device_) : std::nullopt};
}

V4l2Result<V4l2Granted> V4l2Negotiation::AgreeAgain() {
    if (const auto connected = Connect(); !connected) return connected.error();
    if (!IsSameDevice()) {
        return V4l2Failure{hal::Error::kUnsupported, "another device is there", 0};
    }
    const auto granted = Configure();
    if (!granted || IsSameFormat(granted.value())) return granted;
    return V4l2Failure{hal::Error::kUnsupported, "it gives another format", 0};
}

bool V4l2Negotiation::IsSameDevice() const {
    V4l2Identity there = device_.identity();
    const bool numbered = options_.path.starts_with("/dev/video");
    if (!numbered) there.bus = identity_.bus;
    return there == identity_;
}

bool V4l2Negotiation::IsSameFormat(const V4l2Granted& granted) const {
    V4l2Layout there = granted.layout;
    there.planes = first_.layout.planes;  // frames carry the length of their lines
    return there == first_.layout && HoldsLines(granted.layout) &&
           SameRate(granted.rate_hz, first_.rate_hz);
}

}  // namespace hitchview::drivers
