/* job/machine.h: what kiln runs on. */
#ifndef KILN_JOB_MACHINE_H
#define KILN_JOB_MACHINE_H

#include <stdint.h>

#include "base/text.h"

uint64_t machine_memory(void);    /* bytes of the machine; 0: unknown */
uint64_t machine_peak_memory(void); /* resident bytes of this process, at most so far */
void machine_forget_peak(void);     /* starts anew, where the system can (Linux) */

void machine_cpu_model(kiln_text *);    /* "AMD EPYC 9554"; "" when unknown */
void machine_cpu_features(kiln_text *); /* "sse4.2 avx avx2 fma": those that matter to kiln */

/* Every library with its version, kiln first. The texts are borrowed for the call. */
void machine_versions(void (*each)(void *user, const char *name, const char *version), void *user);

#endif
