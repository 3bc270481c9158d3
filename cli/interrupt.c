#include "cli/interrupt.h"

#include <signal.h>
#include <stddef.h>
#include <unistd.h>

#include "base/file.h"

enum { EXIT_INTERRUPTED = 130 };

static volatile int requested, armed;

static void handle(int signal) {
    (void)signal;
    if (armed && !requested) {
        requested = 1;
        return;
    }
    file_remove_temporaries();
    _exit(EXIT_INTERRUPTED);
}

/* A signal that the caller had ignored (nohup, jobs in the background) stays ignored. */
static void listen_to(int signal) {
    struct sigaction before, action = {.sa_handler = handle, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    if (sigaction(signal, NULL, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(signal, &action, NULL);
}

void interrupt_install(void) {
    listen_to(SIGINT);
    listen_to(SIGTERM);
}

void interrupt_arm(bool on) { armed = on; }
const volatile int *interrupt_flag(void) { return &requested; }
