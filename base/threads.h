/* base/threads.h: one pool of threads, one budget. */
#ifndef KILN_BASE_THREADS_H
#define KILN_BASE_THREADS_H

#include "base/report.h"

/* Cores that this process may run on: the affinity mask and the control group's quota are obeyed. */
uint32_t threads_available(void);

/* Calls work(context, item, thread) once for every item < count, on up to `threads` threads (0: all available; the
 * caller is thread 0), items handed out in order. Returns when all are done. work must not fail loudly: it keeps its
 * own results. When threads cannot be started, those that could do the work. */
void threads_for(uint32_t threads, size_t count, void (*work)(void *context, size_t item, uint32_t thread),
                 void *context);

#endif
