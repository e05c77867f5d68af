#pragma once

#include <turbojpeg.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace hitchview::tests {

using Bytes = std::vector<std::uint8_t>;

/// A colourful JPEG; `sampling`: TJSAMP_...
inline Bytes JpegPicture(int width, int height, int sampling, int seed) {
    Bytes rgb;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            rgb.push_back(static_cast<std::uint8_t>(128 + 100 * std::sin(0.3 * x + seed)));
            rgb.push_back(static_cast<std::uint8_t>(128 + 100 * std::sin(0.2 * y)));
            rgb.push_back(static_cast<std::uint8_t>((x * 7 + y * 3) & 255));
        }
    }
    tjhandle compressor = tjInitCompress();
    unsigned char* jpeg = nullptr;
    unsigned long size = 0;
    tjCompress2(compressor, rgb.data(), width, 0, height, TJPF_RGB, &jpeg, &size, sampling, 90, 0);
    Bytes bytes(jpeg, jpeg + size);
    tjFree(jpeg);
    tjDestroy(compressor);
    return bytes;
}

struct JpegPlanes {
    std::array<Bytes, 3> samples;
    std::array<int, 3> width{};
    std::array<int, 3> height{};
};

/// TurboJPEG's own decoding into planes.
inline JpegPlanes ReferencePlanes(const Bytes& jpeg) {
    tjhandle decompressor = tjInitDecompress();
    int width = 0;
    int height = 0;
    int sampling = 0;
    int colours = 0;
    tjDecompressHeader3(decompressor, jpeg.data(), jpeg.size(), &width, &height, &sampling,
                        &colours);
    JpegPlanes planes;
    std::array<unsigned char*, 3> starts{};
    for (std::size_t i = 0; i < 3; ++i) {
        planes.width[i] = tjPlaneWidth(static_cast<int>(i), width, sampling);
        planes.height[i] = tjPlaneHeight(static_cast<int>(i), height, sampling);
        planes.samples[i].resize(static_cast<std::size_t>(planes.width[i] * planes.height[i]));
        starts[i] = planes.samples[i].data();
    }
    tjDecompressToYUVPlanes(decompressor, jpeg.data(), jpeg.size(), starts.data(), width, nullptr,
                            height, 0);
    tjDestroy(decompressor);
    return planes;
}

/// As many Motion JPEG cameras send it: without its DHT segments.
inline Bytes WithoutHuffmanTables(const Bytes& jpeg) {
    Bytes bare(jpeg.begin(), jpeg.begin() + 2);
    std::size_t i = 2;
    while (jpeg[i + 1] != 0xDA) {
        const std::size_t bytes = 2U + jpeg[i + 2] * 256U + jpeg[i + 3];
        if (jpeg[i + 1] != 0xC4) {
            for (std::size_t k = 0; k < bytes; ++k) bare.push_back(jpeg[i + k]);
        }
        i += bytes;
    }
    bare.insert(bare.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(i), jpeg.end());
    return bare;
}

}  // namespace hitchview::tests
