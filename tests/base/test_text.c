#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <locale.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

static void text_grows(void **state) {
    (void)state;
    kiln_text text = {0};
    for (int i = 0; i < 1000; i++) text_format(&text, "%d,", i);
    text_append(&text, "end");
    text_append_bytes(&text, "\0x", 2);
    assert_int_equal(text.length, 10 * 2 + 90 * 3 + 900 * 4 + 3 + 2);
    assert_memory_equal(text.data, "0,1,2,", 6);
    assert_memory_equal(text.data + text.length - 5, "end\0x", 6);
    text_free(&text);
    assert_true(!text.data && !text.length && !text.capacity);
}

static void taking_leaves_it_empty(void **state) {
    (void)state;
    kiln_text text = {0};
    char *empty = text_take(&text);
    assert_string_equal(empty, "");
    text_append(&text, "kiln");
    char *taken = text_take(&text);
    assert_string_equal(taken, "kiln");
    assert_null(text.data);
    free(empty);
    free(taken);
}

/* Run once in "C" and, where such a locale is installed, once where the decimal point is a comma. */
static void check_numbers(void) {
    kiln_text text = {0};
    double value = 0;
    text_format(&text, "%.3f %g", 1234.5, 0.25);
    assert_string_equal(text.data, "1234.500 0.25");
    assert_true(text_to_double("1234.5", &value) && value == 1234.5);
    assert_false(text_to_double("1234,5", &value));
    text_free(&text);
}

static void numbers_do_not_depend_on_the_locale(void **state) {
    (void)state;
    static const char *const commas[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_AT.UTF-8"};
    check_numbers();
    for (size_t i = 0; i < sizeof commas / sizeof commas[0]; i++) {
        if (!setlocale(LC_ALL, commas[i])) continue;
        check_numbers();
        assert_int_equal(strtod("0,5", NULL) == 0.5, 1); /* the caller's locale is still in force */
        break;
    }
    setlocale(LC_ALL, "C");
}

static void doubles_are_read_whole(void **state) {
    (void)state;
    static const char *const bad[] = {"", " 1", "\t1", "\n1", "\r1", "1 ", "1x", "x", "--1", "1e", "1e999", "-1e999",
                                      "nan", "inf", "-inf", "infinity", "1.5.2", "."};
    double value = 7;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        if (text_to_double(bad[i], &value)) fail_msg("\"%s\" reads as %g", bad[i], value);
    assert_true(value == 7);
    assert_true(text_to_double("-0.5", &value) && value == -0.5);
    assert_true(text_to_double("+1e3", &value) && value == 1000);
    assert_true(text_to_double(".5", &value) && value == 0.5);
    assert_true(text_to_double("5.", &value) && value == 5);
    assert_true(text_to_double("1e-999", &value) && value == 0);
    assert_true(text_to_double("0.1", &value) && value == 0.1);
}

static void integers_are_read_whole(void **state) {
    (void)state;
    static const char *const bad[] = {"", " 1", "-1", "+1", "1.0", "1e3", "0x10", "18446744073709551616", "1 ", "a"};
    uint64_t value = 7;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        if (text_to_uint64(bad[i], &value)) fail_msg("\"%s\" reads as %llu", bad[i], (unsigned long long)value);
    assert_true(value == 7);
    assert_true(text_to_uint64("18446744073709551615", &value) && value == UINT64_MAX);
    assert_true(text_to_uint64("007", &value) && value == 7);
    assert_true(text_to_uint64("0", &value) && value == 0);
}

static void the_nearest_word_is_found(void **state) {
    (void)state;
    static const char *const words[] = {"render", "inspect", "study", "spp", "size", "seed"};
    char long_word[100];
    memset(long_word, 'a', sizeof long_word);
    long_word[99] = '\0';
    assert_string_equal(text_nearest("rendr", words, 6), "render");
    assert_string_equal(text_nearest("insepct", words, 6), "inspect");
    assert_string_equal(text_nearest("sp", words, 6), "spp");
    assert_string_equal(text_nearest("seed", words, 6), "seed");
    assert_null(text_nearest("banana", words, 6));
    assert_null(text_nearest("", words, 6));
    assert_null(text_nearest("x", words, 6));
    assert_null(text_nearest(long_word, words, 6));
    assert_null(text_nearest("render", words, 0));
}

static void prefixes_are_taken_off(void **state) {
    (void)state;
    assert_string_equal(text_after("lobe:sheen", "lobe:"), "sheen");
    assert_string_equal(text_after("lobe:", "lobe:"), "");
    assert_string_equal(text_after("lobe", ""), "lobe");
    assert_null(text_after("lobe", "lobe:"));
    assert_null(text_after("a lobe:", "lobe:"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_grows),
        cmocka_unit_test(taking_leaves_it_empty),
        cmocka_unit_test(numbers_do_not_depend_on_the_locale),
        cmocka_unit_test(doubles_are_read_whole),
        cmocka_unit_test(integers_are_read_whole),
        cmocka_unit_test(the_nearest_word_is_found),
        cmocka_unit_test(prefixes_are_taken_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
