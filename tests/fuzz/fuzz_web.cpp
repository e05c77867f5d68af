#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "app/web_request.hpp"
#include "app/web_state.hpp"
#include "hal/expect.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace hitchview;
using nlohmann::json;

constexpr std::array<const char*, 7> kChannels{
    "PANORAMA",        "PANORAMA_STATUS",  "PANORAMA_EVENT", "HITCH_ANGLE",
    "PANORAMA_HEALTH", "PANORAMA_OVERLAY", "PREVIEW_FRONT"};
constexpr hal::Instant kNow = std::chrono::seconds(1000);

void TellAll(const app::WebState& state) {
    app::WebState::Cursor cursor;
    const std::string news = state.News(cursor, kNow);
    HV_EXPECT(news.find('\n') == std::string::npos);
    HV_EXPECT(json::accept(news));
    HV_EXPECT(state.overlay_serial() == 0 || json::accept(state.overlay()));
    (void)state.pictures().PreviewsAfter(0, kNow);
}

void AskWith(std::string_view text) {
    (void)app::TargetOf(text);
    (void)app::IsOwnHost(text);
    (void)app::SerialOf(text);
    HV_EXPECT(!app::IsRecordingName(text) || text.find('/') == std::string_view::npos);
    constexpr std::uint64_t kSize = 1000;
    const app::WebRangeAnswer answer = app::AnswerRange(text, kSize);
    HV_EXPECT(answer.kind != app::WebRangeKind::kPart ||
              (answer.range.count > 0 && answer.range.first < kSize &&
               answer.range.count <= kSize - answer.range.first));
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    app::WebState state{app::WebChannels{}};
    state.Take(kChannels.at(data[0] % kChannels.size()), {data + 1, size - 1}, kNow);
    TellAll(state);
    AskWith({reinterpret_cast<const char*>(data), size});
    return 0;
}
