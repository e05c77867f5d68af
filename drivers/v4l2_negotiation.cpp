#include "drivers/v4l2_negotiation.hpp"

#include <algorithm>
#include <string_view>
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

constexpr V4l2Failure kOtherFormat{hal::Error::kUnsupported, "it gives another format", 0};

V4l2Refusal WrongWish(std::string words) {
    return {.words = std::move(words), .is_wish_wrong = true};
}

/// An input or a value that the device does not have is refused each time.
V4l2Refusal RefusalOf(const V4l2Failure& failure) {
    const std::string_view call = failure.call;
    const int number = failure.error_number;
    const bool ours = call == "VIDIOC_S_INPUT" || call == "VIDIOC_S_EXT_CTRLS";
    return {.words = ToString(failure),
            .failure = failure,
            .is_wish_wrong = ours && (number == EINVAL || number == ERANGE || number == EACCES)};
}

}  // namespace

hal::Result<V4l2Granted, V4l2Refusal> V4l2Negotiation::Agree() {
    const V4l2Size& size = options_.wish.size;
    if (size.width_px <= 0 || size.height_px <= 0 || size.width_px % 2 != 0 ||
        size.height_px % 2 != 0) {
        return WrongWish("size is " + SizeText(size) + ", must be even");
    }
    if (const auto connected = Connect(); !connected) return RefusalOf(connected.error());
    identity_ = device_.identity();
    if (const auto chosen = Choose(); !chosen) return chosen.error();
    const auto granted = Configure();
    if (!granted) return RefusalOf(granted.error());
    if (const auto checked = Check(granted.value()); !checked)
        return V4l2Refusal{.words = checked.error(), .failure = kOtherFormat};
    first_ = granted.value();
    met_ = true;
    return first_;
}

V4l2Granted V4l2Negotiation::Expect(std::span<const V4l2Negotiation* const> others) {
    const V4l2Negotiation* const like = MostLike(others);
    pixel_format_ = FindV4l2PixelFormat(options_.wish.format);
    if (pixel_format_ == nullptr)
        pixel_format_ = like != nullptr ? like->pixel_format_ : &V4l2PixelFormats().front();
    const std::uint32_t fourcc = pixel_format_->fourcc;
    const bool same = like != nullptr && like->pixel_format_ == pixel_format_;
    first_.layout = {.fourcc = fourcc,
                     .width_px = options_.wish.size.width_px,
                     .height_px = options_.wish.size.height_px,
                     .memory_planes = pixel_format_->memory_planes,
                     .range = same ? like->first_.layout.range : RangeOf(fourcc, 0, 0)};
    first_.rate_hz = options_.wish.rate_hz;
    for (const V4l2ControlWish& wish : options_.controls) {
        const V4l2ControlValue* value = nullptr;
        for (const V4l2Negotiation* const other : others)
            if (value == nullptr) value = other->FindValue(wish);
        controls_known_ = controls_known_ && value != nullptr;
        if (value != nullptr) control_values_.push_back(*value);
    }
    return first_;
}

/// Of those whose format tells something about ours.
const V4l2Negotiation* V4l2Negotiation::MostLike(
    std::span<const V4l2Negotiation* const> others) const {
    const auto likeness = [this](const V4l2Negotiation* other) {
        const V4l2Wish& there = other->options_.wish;
        const bool same_size = there.size.width_px == options_.wish.size.width_px &&
                               there.size.height_px == options_.wish.size.height_px;
        const bool same_format = other->pixel_format_->name == options_.wish.format;
        return 4 * int{same_format} + 2 * int{same_size} +
               int{there.format == options_.wish.format};
    };
    const auto most = std::ranges::max_element(others, {}, likeness);
    return most == others.end() ? nullptr : *most;
}

const V4l2ControlValue* V4l2Negotiation::FindValue(const V4l2ControlWish& wish) const {
    const std::size_t mirrors = control_values_.size() - options_.controls.size();
    for (std::size_t i = 0; i < options_.controls.size(); ++i) {
        const V4l2ControlWish& own = options_.controls[i];
        if (own.control == wish.control && own.value == wish.value)
            return &control_values_[mirrors + i];
    }
    return nullptr;
}

hal::Result<Done, V4l2Refusal> V4l2Negotiation::Choose() {
    const V4l2Wish& wish = options_.wish;
    const auto chosen = ChooseFormat(ListOffers(device_, wish.size), wish);
    if (!chosen) {
        const bool known = wish.format == "best" || FindV4l2PixelFormat(wish.format) != nullptr;
        return V4l2Refusal{
            .words = chosen.error(), .failure = kOtherFormat, .is_wish_wrong = !known};
    }
    pixel_format_ = chosen.value();
    const auto menus = options_.controls.empty() ? V4l2Menus::kLeftOut : V4l2Menus::kListed;
    const std::vector<V4l2Control> controls = ListControls(device_, menus);
    auto settings = PlanSettings(controls, options_.orientation, options_.controls);
    if (!settings) return WrongWish(settings.error());
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
    for (const V4l2ControlValue& value : std::span(mirrors_.values).first(mirrors_.count)) {
        if (const auto set = SetControl(device_, value); !set) return set.error();
    }
    for (const V4l2ControlValue& value : control_values_) {
        if (const auto set = SetControl(device_, value); !set) return set.error();
    }
    const std::optional<double>& told_hz = maybe_rate_hz.value();
    return V4l2Granted{layout.value(), told_hz.value_or(options_.wish.rate_hz), told_hz.has_value(),
                       has_exposure_ ? ReadExposure(device_) : std::nullopt};
}

V4l2Result<V4l2Granted> V4l2Negotiation::AgreeAgain() {
    if (const auto connected = Connect(); !connected) return connected.error();
    if (!met_) {
        if (const auto met = Meet(); !met) return met.error();
    } else if (!IsSameDevice()) {
        return V4l2Failure{hal::Error::kUnsupported, "another device is there", 0};
    }
    const auto granted = Configure();
    if (!granted) return granted;
    if (IsSameFormat(granted.value())) {
        met_ = true;
        return granted;
    }
    if (met_) return kOtherFormat;
    return V4l2Failure{hal::Error::kUnsupported,
                       "it gives another format than the cameras that were there at the start; it "
                       "will be taken in when the program starts again",
                       0};
}

/// Learns of a device that comes for the first time what the others do not tell.
V4l2Result<Done> V4l2Negotiation::Meet() {
    if (!controls_known_) {
        return V4l2Failure{hal::Error::kUnsupported,
                           "no other camera has the same controls; it will be taken in when the "
                           "program starts again",
                           0};
    }
    const auto mirrors = AskMirrors(device_, options_.orientation);
    if (!mirrors) return mirrors.error();
    mirrors_ = mirrors.value();
    has_exposure_ = AskExposure(device_);
    identity_ = device_.identity();
    return Done{};
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
