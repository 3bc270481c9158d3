#include "tests/scene/support.h"

#include <math.h>

#include "scene/transfer.h"

/* IEC 61966-2-1, evaluated in double by hand: 0.5 → ((0.555)/1.055)^2.4. */
static void srgb_matches_the_standard(void **state) {
    (void)state;
    assert_true(transfer_decode(KILN_TRANSFER_SRGB, 0) == 0 && transfer_decode(KILN_TRANSFER_SRGB, 1) == 1);
    assert_true(fabsf(transfer_decode(KILN_TRANSFER_SRGB, 0.5f) - 0.21404114f) < 1e-7f);
    assert_true(fabsf(transfer_decode(KILN_TRANSFER_SRGB, 0.04f) - 0.04f / 12.92f) < 1e-9f);
    assert_true(transfer_decode(KILN_TRANSFER_SRGB, -0.5f) == -transfer_decode(KILN_TRANSFER_SRGB, 0.5f));
    assert_true(transfer_decode(KILN_TRANSFER_DATA, 0.3f) == 0.3f && transfer_decode(KILN_TRANSFER_LINEAR, 7) == 7);
}

static void tables_follow_the_curves(void **state) {
    (void)state;
    kiln_decoding d;
    transfer_rec709(&d);
    assert_true(d.present);
    for (int t = 0; t < KILN_TRANSFER_COUNT; t++) {
        for (int i = 1; i < 256; i++) assert_true(d.curve[t][i] > d.curve[t][i - 1]);
        assert_true(d.curve[t][0] == 0 && d.curve[t][255] == 1);
        for (int k = 0; k < 9; k++) assert_true(d.matrix[t][k] == (k % 4 ? 0.0f : 1.0f));
    }
    assert_true(fabsf(d.curve[KILN_TRANSFER_SRGB][188] - 0.50288647f) < 1e-6f); /* 188/255: half of white */
    assert_true(d.curve[KILN_TRANSFER_DATA][51] == 0.2f);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(srgb_matches_the_standard),
                                       cmocka_unit_test(tables_follow_the_curves)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
