#include "drivers/v4l2_probe.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

namespace hitchview::drivers {
namespace {

namespace fs = std::filesystem;

std::optional<int> NumberOf(const fs::path& node) {
    constexpr std::string_view kPrefix = "video";
    const std::string name = node.filename().string();
    if (!name.starts_with(kPrefix)) return std::nullopt;
    const char* const end = name.data() + name.size();
    int number = 0;
    const auto [stop, error] = std::from_chars(name.data() + kPrefix.size(), end, number);
    if (error != std::errc{} || stop != end) return std::nullopt;
    return number;
}

std::vector<int> Numbers() {
    std::vector<int> numbers;
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator("/dev", ignored)) {
        if (const auto maybe_number = NumberOf(entry.path())) numbers.push_back(*maybe_number);
    }
    std::ranges::sort(numbers);
    return numbers;
}

std::vector<std::string> LinksTo(const std::string& path, const std::vector<std::string>& folders) {
    std::vector<std::string> links;
    std::error_code ignored;
    for (const std::string& folder : folders) {
        const auto first = static_cast<std::ptrdiff_t>(links.size());
        for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
            if (fs::canonical(entry.path(), ignored) == path) links.push_back(entry.path());
        }
        std::sort(links.begin() + first, links.end());
    }
    return links;
}

/// What the kernel calls a device, told to those too who may not open it.
std::string NameOf(int number) {
    std::string name;
    std::getline(std::ifstream("/sys/class/video4linux/video" + std::to_string(number) + "/name"),
                 name);
    return name;
}

/// One buffer, asked for and given back: only a buffer tells of the stamps.
void AskForStamps(const V4l2Device& device, V4l2DeviceReport& report) {
    v4l2_requestbuffers request{};
    request.count = 1;
    request.type = device.buffer_type();
    request.memory = V4L2_MEMORY_MMAP;
    if (const auto asked = device.Call(VIDIOC_REQBUFS, "VIDIOC_REQBUFS", request); !asked) {
        report.busy = asked.error().error_number == EBUSY;
        return;
    }
    std::array<v4l2_plane, VIDEO_MAX_PLANES> planes{};
    v4l2_buffer buffer{};
    buffer.type = request.type;
    buffer.memory = V4L2_MEMORY_MMAP;
    if (device.multi_planar()) {
        buffer.m.planes = planes.data();
        buffer.length = VIDEO_MAX_PLANES;
    }
    report.stamps_known = device.Call(VIDIOC_QUERYBUF, "VIDIOC_QUERYBUF", buffer).ok();
    if (report.stamps_known) report.stamps = StampSourceOf(buffer.flags);
    request.count = 0;
    static_cast<void>(device.Call(VIDIOC_REQBUFS, "VIDIOC_REQBUFS", request).ok());
}

void Describe(const V4l2Device& device, V4l2Size wanted, V4l2DeviceReport& report) {
    const V4l2Identity& identity = device.identity();
    report.driver = FieldText(identity.driver);
    report.card = FieldText(identity.card);
    report.bus = FieldText(identity.bus);
    report.multi_planar = device.multi_planar();
    report.offers = ListOffers(device, wanted);
    report.controls = ListControls(device, V4l2Menus::kListed);
    report.inputs = ListInputs(device);
    AskForStamps(device, report);
}

hal::Checked<hal::Done> CheckInput(const std::vector<std::string>& inputs, int wanted) {
    if (wanted < static_cast<int>(inputs.size())) return hal::Done{};
    std::string there;
    for (std::size_t i = 0; i < inputs.size(); ++i)
        there += (i == 0 ? "" : ", ") + std::to_string(i) + " (" + inputs[i] + ")";
    return "input " + std::to_string(wanted) + " is not there; the device has " +
           (there.empty() ? "none" : there);
}

}  // namespace

std::vector<std::string> V4l2LinkFolders() {
    return {"/dev/v4l/by-path", "/dev/v4l/by-id", "/dev/hitchview"};
}

std::vector<V4l2DeviceReport> ProbeV4l2Devices(const std::vector<std::string>& link_folders,
                                               V4l2Kernel& kernel, V4l2Size wanted) {
    std::vector<V4l2DeviceReport> reports;
    for (const int number : Numbers()) {
        V4l2DeviceReport report;
        report.path = "/dev/video" + std::to_string(number);
        V4l2Device device(kernel);
        const auto opened = device.Open(report.path.c_str());
        if (!opened && opened.error().error == hal::Error::kUnsupported) continue;
        report.links = LinksTo(report.path, link_folders);
        if (opened) {
            Describe(device, wanted, report);
        } else {
            report.card = NameOf(number);
            report.refusal = ToString(opened.error());
            report.refusal_number = opened.error().error_number;
        }
        reports.push_back(std::move(report));
    }
    return reports;
}

hal::Checked<hal::Done> CheckSettings(const V4l2DeviceReport& report,
                                      const V4l2CameraOptions& options) {
    if (const auto input = CheckInput(report.inputs, options.input); !input) return input.error();
    const auto settings = PlanSettings(report.controls, options.orientation, options.controls);
    if (!settings) return settings.error();
    return hal::Done{};
}

}  // namespace hitchview::drivers
