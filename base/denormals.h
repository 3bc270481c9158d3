/* base/denormals.h: denormal floats as zeros, in and out, for the calling thread: Embree asks for it.
 *
 * Only where there is SSE. Elsewhere they stay, and pictures may differ in what is next to nothing. */
#ifndef KILN_BASE_DENORMALS_H
#define KILN_BASE_DENORMALS_H

#if defined(__SSE__)
#include <xmmintrin.h>

/* Returns what denormals_restore takes. */
static inline unsigned denormals_flush(void) {
    const unsigned zeros = 0x8040; /* results, arguments */
    unsigned before = _mm_getcsr();
    _mm_setcsr(before | zeros);
    return before;
}
static inline void denormals_restore(unsigned before) { _mm_setcsr(before); }
#else
static inline unsigned denormals_flush(void) { return 0; }
static inline void denormals_restore(unsigned before) { (void)before; }
#endif

#endif
