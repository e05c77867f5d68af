#include "app/html_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace hitchview::app {

std::string Escaped(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            case '\'':
                escaped += "&#39;";
                break;
            default:
                // Control characters may stand in no document.
                escaped += static_cast<unsigned char>(c) < ' ' && c != '\n' ? '?' : c;
        }
    }
    return escaped;
}

std::string Number(double value, int decimals) {
    std::array<char, 64> text{};
    const double half_digit = 0.5 * std::pow(10, -decimals);
    std::snprintf(text.data(), text.size(), "%.*f", decimals,
                  std::abs(value) < half_digit ? 0.0 : value);
    return text.data();
}

std::string Base64(std::span<const std::uint8_t> bytes) {
    constexpr const char* kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k) {
            text += k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
        }
    }
    return text;
}

std::string Figure(const cv::Mat& picture, const std::string& caption) {
    std::vector<std::uint8_t> jpeg;
    cv::imencode(".jpg", picture, jpeg, {cv::IMWRITE_JPEG_QUALITY, 85});
    const std::string width = std::to_string(picture.cols);
    const std::string height = std::to_string(picture.rows);
    return "<figure style=\"width:" + width + "px\"><img alt=\"" + Escaped(caption) +
           "\" width=\"" + width + "\" height=\"" + height + "\" src=\"data:image/jpeg;base64," +
           Base64(jpeg) + "\"/><figcaption>" + Escaped(caption) + "</figcaption></figure>";
}

}  // namespace hitchview::app
