#include "app/receive_buffer.hpp"

#include <algorithm>

namespace hitchview::app {

ReceiveBufferVerdict JudgeReceiveBuffer(int image_bytes, std::optional<int> granted_bytes,
                                        bool cut) {
    ReceiveBufferVerdict verdict{.granted_bytes = granted_bytes.value_or(0),
                                 .budget_bytes = image_bytes};
    const bool fits =
        !granted_bytes || image_bytes <= std::max(*granted_bytes, kUsualBufferImageBytes);
    if (fits) return verdict;
    verdict.warning = hal::EventText("net.core.rmem_max is ")
                          .AppendNumber(*granted_bytes)
                          .Append(", panoramas of ")
                          .AppendNumber(image_bytes)
                          .Append(" bytes get lost: sysctl -w net.core.rmem_max=16777216");
    if (!cut) return verdict;
    verdict.budget_bytes = kUsualBufferImageBytes;
    verdict.warning.Append("; cut to ").AppendNumber(kUsualBufferImageBytes).Append(" till then");
    return verdict;
}

}  // namespace hitchview::app
