#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "base/arena.h"

/* Read by the address sanitizer, where there is one: an allocation that is too large fails, as it does elsewhere. */
__attribute__((visibility("default"))) const char *__asan_default_options(void);
const char *__asan_default_options(void) { return "allocator_may_return_null=1"; }

static void arrays_are_zeroed_aligned_and_apart(void **state) {
    (void)state;
    kiln_arena arena = {0};
    enum { COUNT = 3000 };
    static unsigned char *arrays[COUNT];
    static size_t sizes[COUNT];
    size_t total = 0;
    for (size_t i = 0; i < COUNT; i++) {
        sizes[i] = i % 97 == 0 ? 100000 + i : i % 11 == 0 ? 30000 : (i * 37) % 500;
        arrays[i] = arena_array(&arena, sizes[i], 1);
        assert_non_null(arrays[i]);
        assert_int_equal((uintptr_t)arrays[i] % 64, 0);
        for (size_t k = 0; k < sizes[i]; k++) assert_int_equal(arrays[i][k], 0);
        memset(arrays[i], (int)(i % 255 + 1), sizes[i]);
        total += sizes[i];
    }
    for (size_t i = 0; i < COUNT; i++) /* nobody wrote into anybody's */
        for (size_t k = 0; k < sizes[i]; k++) assert_int_equal(arrays[i][k], i % 255 + 1);
    assert_true(arena.bytes >= total && arena.bytes <= total + COUNT * 64);
    arena_free(&arena);
    assert_true(!arena.blocks && !arena.bytes);
    arena_free(&arena); /* an empty one may be freed */
}

static void sizes_that_overflow_are_refused(void **state) {
    (void)state;
    kiln_arena arena = {0};
    assert_null(arena_array(&arena, SIZE_MAX, 2));
    assert_null(arena_array(&arena, SIZE_MAX, 1));
    assert_null(arena_array(&arena, SIZE_MAX / 2 + 1, 2));
    assert_null(arena_array(&arena, (size_t)1 << 62, 1)); /* no overflow, but no such memory */
    assert_null(arena_copy(&arena, "", SIZE_MAX, 3));
    assert_null(array_alloc(SIZE_MAX, 2));
    assert_null(aligned_array(SIZE_MAX, 2));
    assert_null(aligned_array(SIZE_MAX - 10, 1));
    assert_non_null(arena_array(&arena, 10, 10)); /* it still works */
    arena_free(&arena);
    size_t result = 7;
    assert_true(size_mul(3, 5, &result) && result == 15);
    assert_true(size_add(SIZE_MAX - 1, 1, &result) && result == SIZE_MAX);
    assert_false(size_mul(SIZE_MAX, 2, &result));
    assert_false(size_add(SIZE_MAX, 1, &result));
}

static void nothing_is_something(void **state) {
    (void)state;
    kiln_arena arena = {0};
    void *a = arena_array(&arena, 0, 8), *b = arena_array(&arena, 8, 0);
    assert_true(a && b && a != b);
    assert_non_null(arena_copy(&arena, NULL, 0, 1));
    assert_string_equal(arena_string(&arena, NULL), "");
    assert_string_equal(arena_string(&arena, "kiln"), "kiln");
    const int values[3] = {1, 2, 3};
    assert_memory_equal(arena_copy(&arena, values, 3, sizeof(int)), values, sizeof values);
    arena_free(&arena);
    void *nothing = array_alloc(0, 0);
    assert_non_null(nothing);
    free(nothing);
    nothing = aligned_array(0, 4);
    assert_non_null(nothing);
    free(nothing);
}

static void a_failed_resize_keeps_the_array(void **state) {
    (void)state;
    void *array = array_alloc(2, 4);
    memcpy(array, "abcdefg", 8);
    assert_false(array_resize(&array, SIZE_MAX, 2));
    assert_string_equal(array, "abcdefg");
    assert_true(array_resize(&array, 100, 4));
    assert_string_equal(array, "abcdefg");
    assert_true(array_resize(&array, 0, 4));
    free(array);
}

static void big_arrays_lie_on_huge_pages(void **state) {
    (void)state;
    unsigned char *big = aligned_array(5 << 20, 1), *small = aligned_array(100, 1);
    assert_int_equal((uintptr_t)big % (2 << 20), 0);
    assert_int_equal((uintptr_t)small % 64, 0);
    assert_true(big[0] == 0 && big[(5 << 20) - 1] == 0);
    free(big);
    free(small);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_are_zeroed_aligned_and_apart), cmocka_unit_test(sizes_that_overflow_are_refused),
        cmocka_unit_test(nothing_is_something),                cmocka_unit_test(a_failed_resize_keeps_the_array),
        cmocka_unit_test(big_arrays_lie_on_huge_pages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
