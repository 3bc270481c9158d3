/* One plain loop per function of base/fmath.h: what the compiler must vectorise, and what must equal single calls. */
#ifndef KILN_TESTS_FMATH_LOOPS_H
#define KILN_TESTS_FMATH_LOOPS_H

#define FMATH_LOOPS(X)                                                                                                 \
    X(min, fm_min(a, b))                                                                                               \
    X(clamp, fm_clamp(a, -1.0f, b))                                                                                    \
    X(lerp, fm_lerp(a, b, 0.25f))                                                                                      \
    X(select, fm_select(a < b, a, 2.0f))                                                                               \
    X(floor, fm_floor(a))                                                                                              \
    X(sin, fm_sin(a))                                                                                                  \
    X(cos, fm_cos(a))                                                                                                  \
    X(sincos, fm_sincos(a).sin * fm_sincos(a).cos)                                                                     \
    X(sincos_2pi, fm_sincos_2pi(a).sin * fm_sincos_2pi(a).cos)                                                         \
    X(exp, fm_exp(a))                                                                                                  \
    X(exp2, fm_exp2(a))                                                                                                \
    X(log, fm_log(a))                                                                                                  \
    X(log2, fm_log2(a))                                                                                                \
    X(pow, fm_pow(a, b))                                                                                               \
    X(atan2, fm_atan2(a, b))                                                                                           \
    X(acos, fm_acos(a))                                                                                                \
    X(mixed, fm_select(fm_log(a) < fm_acos(b), fm_exp(b), fm_sincos(a).cos))

#define FMATH_LOOP(name, expression)                                                                                   \
    void loop_##name(float *restrict result, const float *restrict x, const float *restrict y, int count);
FMATH_LOOPS(FMATH_LOOP)
#undef FMATH_LOOP

#endif
