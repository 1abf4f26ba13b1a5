#include "interrupt.h"

#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <ctime>
#include <thread>

#include "kinequad/core/error.h"
#include "output_folder.h"

namespace kinequad::app {
namespace {

std::atomic<bool> interrupted{false};

sigset_t interrupt_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    return signals;
}

/// Waits for signals in a thread of its own, where, unlike in a signal handler, any call is
/// allowed.
void wait_for_interrupts() {
    const sigset_t signals = interrupt_signals();
    int signal = 0;
    while (sigwait(&signals, &signal) != 0) {
    }
    interrupted = true;
    // A large matrix is factored in one piece and cannot be asked to stop.
    const timespec patience{.tv_sec = 0, .tv_nsec = 800'000'000};
    sigtimedwait(&signals, nullptr, &patience);
    OutputFolder::remove_unfinished();
    _exit(static_cast<int>(ExitCode::cancelled));
}

}  // namespace

const std::atomic<bool>& watch_interrupts() {
    const sigset_t signals = interrupt_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread(wait_for_interrupts).detach();
    return interrupted;
}

}  // namespace kinequad::app
