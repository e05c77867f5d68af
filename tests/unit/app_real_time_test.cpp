#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/real_time.hpp"
#include "app/resources.hpp"
#include "tests/support/heap_calls.hpp"

namespace hitchview::app {
namespace {

/// These steps last until the process ends: each test has one of its own.
template <typename Work>
int ExitCodeOf(Work&& work) {
    const pid_t child = fork();
    if (child == 0) _exit(work() ? 0 : 1);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class RealTimeTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer has memory of its own";
    }
};

TEST_F(RealTimeTest, MemoryThatWasMadeResidentFaultsNoMore) {
    EXPECT_EQ(ExitCodeOf([] {
                  constexpr std::size_t kBytes = 8 << 20;
                  void* const taken = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE,
                                           MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
                  const auto prefaulted = PrefaultMemory();
                  if (!prefaulted) return prefaulted.error().find("5.14") != std::string::npos;
                  auto* const bytes = static_cast<volatile char*>(taken);
                  const std::uint64_t before = ReadResources().minor_faults;
                  for (std::size_t i = 0; i < kBytes; i += 4096) bytes[i] = 1;
                  return ReadResources().minor_faults < before + 20;
              }),
              0);
}

TEST_F(RealTimeTest, TheHeapThatWasGivenBackIsTakenAgainWithoutAFault) {
    EXPECT_EQ(ExitCodeOf([] {
                  const auto use = [] {
                      std::vector<char> memory(20 << 20, 1);
                      return memory[12345] == 1;
                  };
                  if (!KeepHeap() || !use()) return false;
                  const std::uint64_t before = ReadResources().minor_faults;
                  return use() && ReadResources().minor_faults < before + 20;
              }),
              0);
}

TEST_F(RealTimeTest, RequiredLockedMemoryThatIsRefusedIsAnErrorThatSaysWhatHelps) {
    using Lock = RealTimeConfig::LockMemory;
    EXPECT_EQ(ExitCodeOf([] {
                  const rlimit none{};
                  setrlimit(RLIMIT_MEMLOCK, &none);
                  // Root may lock without a limit.
                  if (geteuid() == 0 && setuid(65534) != 0) return true;
                  const auto required = PrepareRealTime({.lock_memory = Lock::kRequired});
                  return !required &&
                         required.error().find("LimitMEMLOCK=infinity") != std::string::npos &&
                         PrepareRealTime({.lock_memory = Lock::kTry}).ok() &&
                         PrepareRealTime({.lock_memory = Lock::kNever}).ok();
              }),
              0);
}

TEST_F(RealTimeTest, ResidentMemoryGrowsWithWhatIsUsed) {
    const std::uint64_t before = ReadResources().rss_bytes.value();
    std::vector<char> memory(32 << 20, 1);
    EXPECT_GT(ReadResources().rss_bytes.value() + memory[0], before + (24 << 20));
}

}  // namespace
}  // namespace hitchview::app
