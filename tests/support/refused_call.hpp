#pragma once

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <thread>

namespace hitchview::tests {

/// A system call that the kernel refuses when one of its arguments has this value.
struct RefusedCall {
    std::uint32_t number = 0;    ///< __NR_...
    std::uint32_t argument = 0;  ///< from 0
    std::uint32_t value = 0;     ///< its low 32 bits
    std::uint16_t error = 0;     ///< errno
};

/// Lets the kernel refuse it to this thread from now on; false where it has no such filters.
inline bool RefuseToThisThread(const RefusedCall& call) {
    const auto value_at =
        static_cast<std::uint32_t>(offsetof(seccomp_data, args) + 8 * call.argument);
    std::array<sock_filter, 6> filter{{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call.number, 0, 3),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, value_at),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call.value, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | call.error),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    }};
    const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// Does something on a thread to which the call is refused, as the sandbox of a service refuses it
/// (systemd's RestrictAddressFamilies= and SystemCallFilter=). False, and nothing is done, where
/// this kernel has no such filters.
template <typename Attempt>
bool WhileRefused(const RefusedCall& call, const Attempt& attempt) {
    bool refused = false;
    std::thread([&] {
        refused = RefuseToThisThread(call);
        if (refused) attempt();
    }).join();
    return refused;
}

}  // namespace hitchview::tests
