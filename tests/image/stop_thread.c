// Stops one thread of another process until this program ends: how a pipeline that hangs looks from outside.
//
//   stop_thread TID
#include <stdio.h>
#include <stdlib.h>
#include <sys/ptrace.h>
#include <unistd.h>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const pid_t thread = atoi(argv[1]);
    if (ptrace(PTRACE_SEIZE, thread, 0, 0) != 0 || ptrace(PTRACE_INTERRUPT, thread, 0, 0) != 0) {
        perror("stop_thread");
        return 1;
    }
    pause();
    return 0;
}
