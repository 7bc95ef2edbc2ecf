#include "runtime/interruption.h"

#include <atomic>
#include <csignal>

namespace
{
std::atomic<int> noted{0};
static_assert(std::atomic<int>::is_always_lock_free); // as a handler may use it

void note(int signal)
{
    int none = 0;
    noted.compare_exchange_strong(none, signal);
}
} // namespace

void noteInterruptions()
{
    struct sigaction action = {};
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
