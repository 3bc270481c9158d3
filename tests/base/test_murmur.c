#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "base/murmur.h"

/* The verification value of Appleby's own test suite: keys {}, {0}, {0, 1}, … hashed with seed 256 − length, and the
 * hashes hashed. */
static void as_the_reference_verifies(void **state) {
    (void)state;
    uint8_t key[256], hashes[4 * 256];
    for (uint32_t i = 0; i < 256; i++) {
        key[i] = (uint8_t)i;
        uint32_t h = murmur3_32(key, i, 256 - i);
        for (int k = 0; k < 4; k++) hashes[4 * i + (uint32_t)k] = (uint8_t)(h >> 8 * k);
    }
    assert_int_equal(murmur3_32(hashes, sizeof hashes, 0), 0xb0f57ee3);
}

static void known_values(void **state) {
    (void)state;
    assert_int_equal(murmur3_32("", 0, 0), 0);
    assert_int_equal(murmur3_32("hello", 5, 0), 0x248bfa47);
    assert_int_equal(murmur3_32("bunny", 5, 0), 0x13851a76); /* Cryptomatte specification, example of a manifest */
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(as_the_reference_verifies), cmocka_unit_test(known_values)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
