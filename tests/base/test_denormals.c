/* base/denormals.h: denormals are zeros in between, where the machine can do that; afterwards all is as before. */
#include "base/denormals.h"

#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static float halved(float x) {
    volatile float value = x, half = value * 0.5f; /* here and now */
    return half;
}

static void denormals_are_zeros_in_between(void **state) {
    (void)state;
    assert_true(halved(FLT_MIN) > 0);
    unsigned before = denormals_flush();
    float result = halved(FLT_MIN);
    denormals_restore(before);
#if defined(__SSE__)
    assert_true(result == 0);
#else
    assert_true(result == FLT_MIN * 0.5f);
#endif
    assert_true(halved(FLT_MIN) > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(denormals_are_zeros_in_between)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
