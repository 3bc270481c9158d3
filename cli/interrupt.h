/* cli/interrupt.h: Ctrl-C and SIGTERM: the first asks to stop and write what there is, the second quits at once
 * and leaves no half-written file. */
#ifndef KILN_CLI_INTERRUPT_H
#define KILN_CLI_INTERRUPT_H

#include <stdbool.h>

/* Signals end the process at once until something worth writing exists. */
void interrupt_install(void);
void interrupt_arm(bool armed);
const volatile int *interrupt_flag(void);

#endif
