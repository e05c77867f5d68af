#include <linux/can.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include "app/can_field.hpp"
#include "app/candump_writer.hpp"
#include "app/hitch_angle_decoder.hpp"
#include "drivers/candump_can_bus.hpp"
#include "drivers/socketcan_message.hpp"
#include "drivers/socketcan_time.hpp"
#include "hal/expect.hpp"
#include "tests/fuzz/fuzz_bytes.hpp"
#include "tests/fuzz/fuzz_complaint.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace hitchview;
using hal::CanFrame;
using hal::CanFrameKind;
using hal::HitchAngleQuality;
using tests::FuzzBytes;
using Bytes = std::span<const std::uint8_t>;

void ExpectFrame(const CanFrame& frame) {
    HV_EXPECT(frame.id <= (frame.extended ? 0x1fffffffU : 0x7ffU));
    HV_EXPECT(frame.size_bytes <= (frame.fd ? 64 : 8));
    HV_EXPECT(frame.fd_flags <= (frame.fd ? 15 : 0));
    const std::size_t used = frame.kind == CanFrameKind::kRemote ? 0 : frame.size_bytes;
    HV_EXPECT(std::all_of(frame.data.begin() + used, frame.data.end(),
                          [](std::uint8_t byte) { return byte == 0; }));
}

/// Moments of three frames with the same stamps, a while apart, under a clock that is set.
void ExpectMoments(drivers::SocketCanStamps stamps, int step_s) {
    hal::Instant last = std::chrono::hours(1);
    stamps.wall_now = std::chrono::seconds(1'700'000'000);
    stamps.now = last;
    drivers::SocketCanTime time(stamps.wall_now, stamps.now);
    for (int i = 0; i < 3; ++i) {
        stamps.now += std::chrono::milliseconds(700);
        stamps.wall_now += std::chrono::seconds(step_s);
        const hal::Instant received_at = time.ReceivedAt(stamps);
        HV_EXPECT(received_at >= last && received_at <= stamps.now);
        last = received_at;
    }
}

bool Holds(Bytes bytes, std::uint32_t number) {
    return memmem(bytes.data(), bytes.size(), &number, sizeof number) != nullptr;
}

void ReceiveFromKernel(FuzzBytes bytes) {
    drivers::SocketCanMessage message;
    const int step_s = bytes.TakeIn(-3600, 3600);
    const Bytes frame = bytes.TakeBytes(bytes.Take<std::uint8_t>());
    const int error = message.Take(frame, bytes.rest());
    HV_EXPECT((error == 0) == (frame.size() == CAN_MTU || frame.size() == CANFD_MTU));
    if (const auto dropped = message.dropped()) HV_EXPECT(Holds(bytes.rest(), *dropped));
    ExpectMoments(message.stamps(), step_s);
    if (error != 0) return;
    ExpectFrame(message.frame());
    HV_EXPECT(message.IsError() == (message.frame().kind == CanFrameKind::kError));
    HV_EXPECT(!message.IsError() || message.error_classes() == message.frame().id);
}

CanFrame NextOf(hal::CanBus& bus) {
    auto frame = bus.WaitFrame(std::chrono::milliseconds(1));
    HV_EXPECT(frame.ok());
    return *frame;
}

/// Written as a line of its own and read again it is the same, but for the time.
void ExpectSameWhenWritten(CanFrame frame, std::string& line) {
    frame.epoch = frame.received_at = hal::Instant(0);
    line = app::CandumpLine("can0").Format(frame);
    auto again = drivers::CandumpCanBus::Parse(line, "line", hal::Instant(0),
                                               drivers::CandumpCanBus::Kinds::kAll);
    HV_EXPECT(again.ok() && NextOf(**again) == frame);
}

void ReadCandump(std::string_view text) {
    constexpr auto kKinds = drivers::CandumpCanBus::Kinds::kAll;
    auto bus =
        drivers::CandumpCanBus::Parse(std::string(text), "log", std::chrono::hours(1), kKinds);
    const int lines = tests::LinesOf(text);
    if (!bus) return tests::ExpectComplaint(bus.error(), "log", lines);
    const auto& counts = (*bus)->log_counts();
    const std::uint64_t frames = counts.data + counts.remote + counts.error;
    HV_EXPECT(frames <= static_cast<std::uint64_t>(lines));
    std::string line;
    for (std::uint64_t i = 0; i < frames; ++i) {
        const CanFrame frame = NextOf(**bus);
        ExpectFrame(frame);
        ExpectSameWhenWritten(frame, line);
    }
    HV_EXPECT((*bus)->WaitFrame(std::chrono::milliseconds(1)).error() == hal::Error::kEndOfStream);
    HV_EXPECT((*bus)->counts().delivered == frames && (*bus)->counts().errors == counts.error);
}

app::CanField TakeField(FuzzBytes& bytes) {
    return {
        .start_bit = bytes.TakeIn(0, 511),
        .length_bits = bytes.TakeIn(1, 32),
        .byte_order = bytes.TakeFlag() ? app::CanByteOrder::kMotorola : app::CanByteOrder::kIntel,
        .is_signed = bytes.TakeFlag()};
}

/// Within what HitchAngleSignal allows.
app::HitchAngleSignal TakeSignal(FuzzBytes& bytes) {
    const app::CanField field = TakeField(bytes);
    app::HitchAngleSignal signal{.id = 1,
                                 .start_bit = field.start_bit,
                                 .length_bits = field.length_bits,
                                 .byte_order = field.byte_order,
                                 .is_signed = field.is_signed,
                                 .factor_deg = bytes.TakeIn(-1000.0, 1000.0),
                                 .offset_deg = bytes.TakeIn(-100'000.0, 100'000.0)};
    signal.min_deg = bytes.TakeIn(-360.0, 360.0);
    signal.max_deg = bytes.TakeIn(signal.min_deg, 360.0);
    signal.j1939 = bytes.TakeFlag();
    signal.max_rate_deg_s = bytes.TakeIn(0.0, 10'000.0);
    signal.max_age = std::chrono::milliseconds(bytes.TakeIn(0, 60'000));
    if (bytes.TakeFlag()) signal.codes = {{bytes.Take<std::int8_t>()}, {bytes.Take<std::int8_t>()}};
    if (bytes.TakeFlag()) signal.status = {TakeField(bytes), {bytes.Take<std::int8_t>()}, {1}};
    if (bytes.TakeFlag()) signal.multiplexor = {TakeField(bytes), bytes.Take<std::int8_t>()};
    return signal;
}

CanFrame TakeFrame(FuzzBytes& bytes) {
    CanFrame frame{.id = 1};
    const Bytes data = bytes.TakeBytes(static_cast<std::size_t>(bytes.TakeIn(0, 64)));
    frame.size_bytes = static_cast<std::uint8_t>(data.size());
    std::ranges::copy(data, frame.data.begin());
    return frame;
}

/// The value bit by bit, as the numbering of DBC files has it.
std::optional<std::int64_t> SlowRawValue(const app::CanField& field, Bytes data) {
    const bool motorola = field.byte_order == app::CanByteOrder::kMotorola;
    std::int64_t raw = 0;
    for (int i = 0, at = field.start_bit; i < field.length_bits; ++i) {
        if (at / 8 >= std::ssize(data)) return std::nullopt;
        const std::int64_t bit = data[static_cast<std::size_t>(at / 8)] >> (at % 8) & 1;
        const int weight = motorola ? field.length_bits - 1 - i : i;
        const bool is_sign = field.is_signed && weight == field.length_bits - 1;
        raw += (is_sign ? -bit : bit) * (std::int64_t{1} << weight);
        at += !motorola ? 1 : at % 8 == 0 ? 15 : -1;
    }
    return raw;
}

void ExpectAngle(const app::HitchAngleSignal& signal, const hal::HitchAngle& angle) {
    HV_EXPECT(std::isfinite(angle.angle_rad));
    HV_EXPECT(angle.quality == HitchAngleQuality::kValid || angle.angle_rad == 0);
    if (angle.quality != HitchAngleQuality::kValid) return;
    const double degrees = angle.angle_rad * 180 / std::numbers::pi;
    const double slack = 1e-9 + 2e-6 * std::abs(signal.factor_deg);
    HV_EXPECT(degrees >= signal.min_deg - slack && degrees <= signal.max_deg + slack);
}

void DecodeAngles(FuzzBytes bytes) {
    const app::HitchAngleSignal signal = TakeSignal(bytes);
    app::HitchAngleMonitor monitor(signal);
    hal::Instant now{};
    for (int i = 0; i < 3 && !bytes.empty(); ++i) {
        now += std::chrono::milliseconds(bytes.TakeIn(0, 1000));
        if (const auto stale = monitor.Stale(now)) ExpectAngle(signal, *stale);
        CanFrame frame = TakeFrame(bytes);
        frame.received_at = now;
        const Bytes data = Bytes(frame.data).first(frame.size_bytes);
        HV_EXPECT(app::RawValue(signal.field(), data) == SlowRawValue(signal.field(), data));
        if (const auto angle = monitor.Decode(frame)) ExpectAngle(signal, *angle);
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    FuzzBytes bytes({data, size});
    switch (bytes.Take<std::uint8_t>()) {
        case 'k':
            ReceiveFromKernel(bytes);
            break;
        case 'l':
            ReadCandump(tests::TextOf(bytes.rest()));
            break;
        default:
            DecodeAngles(bytes);
    }
    return 0;
}
