#include "fmath_loops.h"

#include "base/fmath.h"

#define FMATH_LOOP(name, expression)                                                                                   \
    void loop_##name(float *restrict result, const float *restrict x, const float *restrict y, int count) {            \
        for (int i = 0; i < count; i++) {                                                                              \
            float a = x[i], b = y[i];                                                                                  \
            (void)b;                                                                                                   \
            result[i] = expression;                                                                                    \
        }                                                                                                              \
    }
FMATH_LOOPS(FMATH_LOOP)
