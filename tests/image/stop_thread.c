// Stops one thread of another process until it is killed: how a pipeline that hangs looks from outside.
//
//   stop_thread TID
#include <stdio.h>
#include <stdlib.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const pid_t thread = atoi(argv[1]);
    if (ptrace(PTRACE_SEIZE, thread, 0, 0) != 0 || ptrace(PTRACE_INTERRUPT, thread, 0, 0) != 0) {
        perror("stop_thread");
        return 1;
    }
    // A traced thread that is killed is gone only once its tracer has taken note.
    int status = 0;
    while (waitpid(thread, &status, __WALL) == thread && !WIFEXITED(status) && !WIFSIGNALED(status)) {
    }
    return 0;
}
