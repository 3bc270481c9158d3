/* base/kernel.h: functions that must be inlined into the loop that calls them, or it would not vectorise. */
#ifndef KILN_BASE_KERNEL_H
#define KILN_BASE_KERNEL_H

#define KERNEL static inline __attribute__((always_inline))

#endif
