#include "drivers/v4l2_offers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hitchview::drivers {
namespace {

constexpr std::uint32_t kMostFormats = 256;
constexpr std::uint32_t kMostListed = 64;  // of each other kind

double Hertz(const v4l2_fract& interval) {
    return interval.numerator == 0 ? 0
                                   : static_cast<double>(interval.denominator) / interval.numerator;
}

std::vector<V4l2Rates> ListRates(const V4l2Device& device, std::uint32_t fourcc, V4l2Size size) {
    std::vector<V4l2Rates> rates;
    v4l2_frmivalenum interval{};
    interval.pixel_format = fourcc;
    interval.width = static_cast<std::uint32_t>(size.width_px);
    interval.height = static_cast<std::uint32_t>(size.height_px);
    for (; interval.index < kMostListed; ++interval.index) {
        if (!device.Call(VIDIOC_ENUM_FRAMEINTERVALS, "VIDIOC_ENUM_FRAMEINTERVALS", interval)) break;
        if (interval.type != V4L2_FRMIVAL_TYPE_DISCRETE) {
            rates.push_back({Hertz(interval.stepwise.max), Hertz(interval.stepwise.min)});
            break;
        }
        rates.push_back({Hertz(interval.discrete), Hertz(interval.discrete)});
    }
    return rates;
}

V4l2Sizes SizesOf(const v4l2_frmsizeenum& size) {
    // Larger than any picture, and safe to calculate with.
    static constexpr std::uint32_t kMost_px = 1U << 20;
    const auto px = [](std::uint32_t value) { return static_cast<int>(std::min(value, kMost_px)); };
    if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
        const int width = px(size.discrete.width);
        const int height = px(size.discrete.height);
        return {width, width, 1, height, height, 1, {}};
    }
    const v4l2_frmsize_stepwise& range = size.stepwise;
    return {px(range.min_width),
            px(range.max_width),
            std::max(1, px(range.step_width)),
            px(range.min_height),
            px(range.max_height),
            std::max(1, px(range.step_height)),
            {}};
}

bool Contains(const V4l2Sizes& sizes, V4l2Size size) {
    return size.width_px >= sizes.min_width_px && size.width_px <= sizes.max_width_px &&
           size.height_px >= sizes.min_height_px && size.height_px <= sizes.max_height_px &&
           (size.width_px - sizes.min_width_px) % sizes.step_width_px == 0 &&
           (size.height_px - sizes.min_height_px) % sizes.step_height_px == 0;
}

std::vector<V4l2Sizes> ListSizes(const V4l2Device& device, std::uint32_t fourcc, V4l2Size wanted) {
    std::vector<V4l2Sizes> list;
    v4l2_frmsizeenum size{};
    size.pixel_format = fourcc;
    for (; size.index < kMostListed; ++size.index) {
        if (!device.Call(VIDIOC_ENUM_FRAMESIZES, "VIDIOC_ENUM_FRAMESIZES", size)) break;
        V4l2Sizes sizes = SizesOf(size);
        const V4l2Size largest{sizes.max_width_px, sizes.max_height_px};
        sizes.rates = ListRates(device, fourcc, Contains(sizes, wanted) ? wanted : largest);
        list.push_back(std::move(sizes));
        if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE) break;
    }
    return list;
}

bool Has(const std::vector<V4l2Rates>& rates, double rate_hz) {
    return rates.empty() || std::ranges::any_of(rates, [&](const V4l2Rates& range) {
               return SameRate(range.slowest_hz, rate_hz) || SameRate(range.fastest_hz, rate_hz) ||
                      (range.slowest_hz < rate_hz && rate_hz < range.fastest_hz);
           });
}

bool Has(const V4l2FormatOffer& offer, const V4l2Wish& wish) {
    return offer.sizes.empty() || std::ranges::any_of(offer.sizes, [&](const V4l2Sizes& sizes) {
               return Contains(sizes, wish.size) && Has(sizes.rates, wish.rate_hz);
           });
}

std::string SizesText(const V4l2Sizes& sizes) {
    std::string text = SizeText({sizes.min_width_px, sizes.min_height_px});
    if (sizes.max_width_px != sizes.min_width_px || sizes.max_height_px != sizes.min_height_px) {
        text += ".." + SizeText({sizes.max_width_px, sizes.max_height_px});
    }
    const char* separator = " at ";
    for (const V4l2Rates& rates : sizes.rates) {
        text += separator + RateText(rates.slowest_hz);
        if (rates.fastest_hz != rates.slowest_hz) text += ".." + RateText(rates.fastest_hz);
        separator = ", ";
    }
    return sizes.rates.empty() ? text : text + " Hz";
}

std::string WishText(const V4l2Wish& wish) {
    return SizeText(wish.size) + " at " + RateText(wish.rate_hz) + " Hz as " + wish.format;
}

std::string FormatNames() {
    std::string names = "best";
    for (const V4l2PixelFormat& format : V4l2PixelFormats())
        names += std::string(", ") + format.name;
    return names;
}

}  // namespace

bool SameRate(double a_hz, double b_hz) {
    return std::abs(a_hz - b_hz) <= 0.01 * std::max(a_hz, b_hz);
}

std::string SizeText(V4l2Size size) {
    return std::to_string(size.width_px) + "x" + std::to_string(size.height_px);
}

std::string RateText(double rate_hz) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.4g", rate_hz);
    return text.data();
}

std::vector<V4l2FormatOffer> ListOffers(const V4l2Device& device, V4l2Size wanted) {
    std::vector<V4l2FormatOffer> offers;
    v4l2_fmtdesc format{};
    format.type = device.buffer_type();
    for (; format.index < kMostFormats; ++format.index) {
        if (!device.Call(VIDIOC_ENUM_FMT, "VIDIOC_ENUM_FMT", format)) break;
        const auto* text = reinterpret_cast<const char*>(format.description);
        V4l2FormatOffer offer{format.pixelformat, FieldText({text, sizeof format.description}), {}};
        // Of a format that we do not take, neither sizes nor rates matter.
        if (FindV4l2PixelFormat(offer.fourcc) != nullptr) {
            offer.sizes = ListSizes(device, offer.fourcc, wanted);
        }
        offers.push_back(std::move(offer));
    }
    return offers;
}

std::vector<std::string> ListInputs(const V4l2Device& device) {
    std::vector<std::string> inputs;
    v4l2_input input{};
    for (; input.index < kMostListed; ++input.index) {
        if (!device.Call(VIDIOC_ENUMINPUT, "VIDIOC_ENUMINPUT", input)) break;
        const auto* text = reinterpret_cast<const char*>(input.name);
        inputs.push_back(FieldText({text, sizeof input.name}));
    }
    return inputs;
}

std::string OffersText(const std::vector<V4l2FormatOffer>& offers) {
    std::string text;
    for (const V4l2FormatOffer& offer : offers) {
        if (FindV4l2PixelFormat(offer.fourcc) == nullptr) continue;
        text += (text.empty() ? "" : "; ") + FourccText(offer.fourcc);
        const char* separator = " ";
        for (const V4l2Sizes& sizes : offer.sizes) {
            text += separator + SizesText(sizes);
            separator = " or ";
        }
    }
    return text.empty() ? "no format that is taken here" : text;
}

hal::Checked<const V4l2PixelFormat*> ChooseFormat(const std::vector<V4l2FormatOffer>& offers,
                                                  const V4l2Wish& wish) {
    const bool best = wish.format == "best";
    if (!best && FindV4l2PixelFormat(wish.format) == nullptr) {
        return "format is " + wish.format + ", must be one of " + FormatNames();
    }
    for (const V4l2PixelFormat& format : V4l2PixelFormats()) {
        if (!best && format.name != wish.format) continue;
        const auto offered = std::ranges::find(offers, format.fourcc, &V4l2FormatOffer::fourcc);
        if (offered != offers.end() && Has(*offered, wish)) return &format;
    }
    return "wanted " + WishText(wish) + "; offered: " + OffersText(offers);
}

}  // namespace hitchview::drivers
