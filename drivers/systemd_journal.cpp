#include "drivers/systemd_journal.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>

namespace hitchview::drivers {
namespace {

using hal::EventCode;

/// Every field of an event at its longest.
using Entry = hal::FixedText<2048>;

/// As the kernel writes it: "8:1234".
bool IsStderr(const std::string& stream) {
    struct stat file {};
    if (fstat(STDERR_FILENO, &file) != 0) return false;
    return stream == std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino);
}

bool IsSocket(const char* path) {
    struct stat file {};
    return stat(path, &file) == 0 && S_ISSOCK(file.st_mode);
}

/// A value of several lines has its length before it, little endian, in place of '='.
void AppendField(std::string_view name, std::string_view value, Entry& entry) {
    entry.Append(name);
    if (value.find('\n') == std::string_view::npos) {
        entry.Append("=");
    } else {
        std::array<char, 9> length{'\n'};
        for (std::size_t i = 0; i < 8; ++i)
            length.at(1 + i) = static_cast<char>(std::uint64_t{value.size()} >> (8 * i) & 0xFF);
        entry.Append({length.data(), length.size()});
    }
    entry.Append(value).Append("\n");
}

/// Of the family of the code: the lowest numbers of camera, seam, calibration, timing, recording.
std::string_view MessageId(EventCode code) {
    constexpr int kCodesOfFamily = 20;
    constexpr std::array<std::string_view, 5> kIds{
        "1a40b6adaa2b407d99fa96cc61589a43", "910c2eb42edc4cee8bfc00f7501eb431",
        "a2c0eb86e5d84a3e8a53a64024453088", "0707d3559902427ab66305e0647df4f4",
        "854e9e2e04574eb6b1f1e316dec1ec83"};
    return kIds.at(static_cast<std::size_t>(code) / kCodesOfFamily);
}

/// syslog's.
std::string_view PriorityOf(EventCode code) {
    constexpr std::string_view kError = "3";
    constexpr std::string_view kWarning = "4";
    constexpr std::string_view kInformation = "6";
    switch (code) {
        case EventCode::kRecordingFailed:
            return kError;
        case EventCode::kCameraLost:
        case EventCode::kCameraLate:
        case EventCode::kCameraDisordered:
        case EventCode::kCameraBlack:
        case EventCode::kCameraBlinded:
        case EventCode::kCameraFrozen:
        case EventCode::kCameraStuck:
        case EventCode::kCameraBlurred:
        case EventCode::kCameraDirty:
        case EventCode::kCalibrationMismatch:
        case EventCode::kDeadlineMissed:
        case EventCode::kPanoramasDropped:
        case EventCode::kReceiveBufferSmall:
        case EventCode::kRecordingDropped:
            return kWarning;
        case EventCode::kCameraBack:
        case EventCode::kSeamLocked:
        case EventCode::kSeamCoast:
        case EventCode::kSeamReacquire:
        case EventCode::kSeamNoOverlap:
        case EventCode::kDeadlineKept:
        case EventCode::kRecordingStarted:
        case EventCode::kRecordingStopped:
            return kInformation;
    }
    return kInformation;
}

bool IsOfCamera(EventCode code) {
    constexpr std::int16_t kFirstOfSeams = 20;
    return static_cast<std::int16_t>(code) < kFirstOfSeams;
}

/// "camera rear: lost: silent"
hal::FixedText<288> MessageOf(const hal::Event& event) {
    hal::FixedText<288> message;
    if (IsOfCamera(event.code)) message.Append("camera ");
    if (!event.subject.view().empty()) message.Append(event.subject.view()).Append(": ");
    return message.Append(event.text.view());
}

}  // namespace

std::unique_ptr<hal::EventLog> SystemdJournal::Open(const char* stream, const char* socket) {
    if (stream == nullptr || !IsSocket(socket)) return nullptr;
    auto opened = SystemdSocket::Open(socket);
    if (!opened) return nullptr;
    return std::unique_ptr<hal::EventLog>(new SystemdJournal(std::move(*opened), IsStderr(stream)));
}

void SystemdJournal::DoAdd(const hal::Event& event) {
    const auto number = static_cast<std::int64_t>(event.code);
    Entry entry;
    AppendField("MESSAGE", MessageOf(event).view(), entry);
    AppendField("MESSAGE_ID", MessageId(event.code), entry);
    AppendField("PRIORITY", PriorityOf(event.code), entry);
    AppendField("SYSLOG_IDENTIFIER", "hitchview", entry);
    AppendField("HITCHVIEW_EVENT", ToString(event.code), entry);
    AppendField("HITCHVIEW_CODE", hal::FixedText<8>().AppendNumber(number).view(), entry);
    if (const auto subject = event.subject.view(); !subject.empty()) {
        AppendField("HITCHVIEW_SUBJECT", subject, entry);
        if (IsOfCamera(event.code)) AppendField("CAMERA", subject, entry);
    }
    socket_.Send(entry.view());
}

}  // namespace hitchview::drivers
