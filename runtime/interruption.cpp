#include "runtime/interruption.h"

#include "format/result.h"
#include "format/temporary_file.h"

#include <atomic>
#include <csignal>
#include <string_view>
#include <unistd.h>

namespace
{
std::atomic<int> noted{0};
static_assert(std::atomic<int>::is_always_lock_free); // as a handler may use it

void note(int signal)
{
    int none = 0;
    if (noted.compare_exchange_strong(none, signal))
        alarm(kPatienceSeconds);
}

/// A step of work may take minutes on a slow device, or a share not answer.
void loseStep(int)
{
    removeOpenTemporaryFiles();
    constexpr std::string_view kMessage = "ended by a signal before the step at work was done\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage.data(), kMessage.size());
    _exit(128 + noted);
}
/// What is mapped is read as memory, without a call that could fail.
void loseFile(int)
{
    removeOpenTemporaryFiles();
    constexpr std::string_view kMessage =
        "error: a file that was opened cannot be read any more: its disk or share is gone, or "
        "something has cut it short\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage.data(), kMessage.size());
    _exit(int(ExitCode::kIo));
}
} // namespace

void noteInterruptions()
{
    struct sigaction action = {};
    action.sa_handler = loseStep;
    sigaction(SIGALRM, &action, nullptr);
    action.sa_handler = loseFile;
    sigaction(SIGBUS, &action, nullptr);
    action.sa_handler = note;
    action.sa_flags = int(SA_RESETHAND | SA_RESTART); // the driver's system calls go on
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    {
        struct sigaction before = {};
        if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) // nohup and the like ask for that
            sigaction(signal, &action, nullptr);
    }
}

int interruption()
{
    return noted;
}
