#include "tests/importers/gltf/support.h"

#include "importers/gltf/json.h"

static kiln_report *report;

static int set_up(void **state) {
    (void)state;
    report = kiln_report_create();
    return report ? 0 : -1;
}
static int tear_down(void **state) {
    (void)state;
    kiln_report_destroy(report);
    return 0;
}

static bool check(const char *text, size_t size) {
    kiln_where file = where_root("a.gltf");
    uint64_t values;
    /* Without room behind the end, so that reading over it is found. */
    char *exact = malloc(size ? size : 1);
    assert_non_null(exact);
    memcpy(exact, text, size);
    bool ok = json_check(exact, size, &values, &file, report);
    free(exact);
    return ok;
}

static void good(const char *text) {
    if (!check(text, strlen(text))) {
        print_message("refused: %s\n", text);
        print_report(report);
        fail();
    }
}

static void bad(const char *text, const char *where, const char *what) {
    kiln_report_clear(report);
    if (check(text, strlen(text))) {
        print_message("accepted: %s\n", text);
        fail();
    }
    assert_int_equal(kiln_report_size(report), 1);
    kiln_message m = kiln_report_message(report, 0);
    if (!strstr(m.where, where) || !strstr(m.what, what)) {
        print_message("%s: %s: %s\n", text, m.where, m.what);
        fail();
    }
}

static void accepts_json(void **state) {
    (void)state;
    good("{}");
    good(" [ ] ");
    good("{\"a\": [1, -2, 0, 0.5, 1e5, 1E-5, 1.5e+3, -0.0], \"b\": {\"c\": null}, \"d\": true, \"e\": false}");
    good("\"\\\"\\\\\\/\\b\\f\\n\\r\\t\\u00e9\\uD83D\\uDE00\"");
    good("\"\xC3\xA9 \xE2\x9D\xA4 \xF0\x9F\x98\x80 \xF4\x8F\xBF\xBF\"");
    good("1e308");
    good("1e-999"); /* rounds to 0 */
}

static void refuses_what_is_not(void **state) {
    (void)state;
    bad("", "line 1, column 1", "ends too early");
    bad("{", "line 1, column 2", "ends too early");
    bad("{\"a\"", "line 1, column 5", "ends too early");
    bad("{\"a\": 1,}", "line 1, column 9", "string is expected");
    bad("{\"a\" 1}", "column 6", "':' is expected");
    bad("[1 2]", "column 4", "',' or ']'");
    bad("[1,\n 2,\n x]", "line 3, column 2", "no JSON value");
    bad("{} {}", "column 4", "follows the end");
    bad("[NaN]", "column 2", "NaN");
    bad("[-Infinity]", "column 3", "Infinity");
    bad("[nul]", "column 2", "no JSON value");
    bad("[01]", "column 3", "',' or ']'");
    bad("[1.]", "column 4", "decimal point");
    bad("[1e]", "column 4", "exponent");
    bad("[.5]", "column 2", "no JSON value");
    bad("[+1]", "column 2", "no JSON value");
    bad("['a']", "column 2", "no JSON value");
    bad("[1e999]", "column 2", "too large");
    bad("\"abc", "column 5", "ends too early");
    bad("\"a\nb\"", "column 3", "control character");
    bad("\"\\x\"", "column 3", "escape");
    bad("\"\\u12g4\"", "column 3", "hexadecimal");
    bad("\"\\u12", "column 3", "hexadecimal");
}

static void refuses_bad_utf8(void **state) {
    (void)state;
    bad("\"\x80\"", "column 2", "UTF-8");             /* a continuation alone */
    bad("\"\xC0\x80\"", "column 2", "UTF-8");         /* overlong */
    bad("\"\xE0\x80\x80\"", "column 2", "UTF-8");
    bad("\"\xED\xA0\x80\"", "column 2", "UTF-8");     /* a surrogate */
    bad("\"\xF4\x90\x80\x80\"", "column 2", "UTF-8"); /* beyond U+10FFFF */
    bad("\"\xE2\x9D\"", "column 2", "UTF-8");         /* cut short */
    bad("\"\xFF\"", "column 2", "UTF-8");
    bad("\"\xE2\x9D", "column 2", "UTF-8");           /* cut by the end of the file */
}

static char *nested(size_t depth, char open, const char *between) {
    kiln_text text = {0};
    for (size_t i = 0; i < depth; i++) {
        text_append_bytes(&text, &open, 1);
        if (open == '{') text_append(&text, between);
    }
    return text_take(&text);
}

static void bounds_nesting(void **state) {
    (void)state;
    char *deep = nested(200000, '[', "");
    bad(deep, "column 129", "128 levels");
    free(deep);
    deep = nested(200000, '{', "\"a\":");
    bad(deep, "", "128 levels");
    free(deep);
    kiln_text text = {0};
    for (int i = 0; i < JSON_DEPTH_MAX; i++) text_append(&text, "[");
    for (int i = 0; i < JSON_DEPTH_MAX; i++) text_append(&text, "]");
    good(text.data);
    text_free(&text);
}

static void counts_values(void **state) {
    (void)state;
    const char *text = "{\"a\": [1, 2, {}], \"b\": \"c\"}";
    kiln_where file = where_root("a.gltf");
    uint64_t values;
    assert_true(json_check(text, strlen(text), &values, &file, report));
    assert_int_equal(values, 6);
}

static void every_prefix_is_refused(void **state) {
    (void)state;
    const char *text = "{\"a\": [1.5e3, true, null, \"x\\u00e9\xC3\xA9\"], \"b\": {\"c\": []}}";
    for (size_t size = 0; size < strlen(text); size++) {
        kiln_report_clear(report);
        assert_false(check(text, size));
    }
    good(text);
}

static void walks_members(void **state) {
    (void)state;
    json_value root = json_root(" { \"a\" : [ 1 , [2, 3] , \"x,]\" ] , \"b\\\"\" : {} , \"c\" : -4.5 } "), key, value;
    const char *keys[] = {"\"a\"", "\"b\\\"\"", "\"c\""}, *values[] = {"[ 1 , [2, 3] , \"x,]\" ]", "{}", "-4.5"};
    json_cursor cursor = json_open(root);
    for (int i = 0; i < 3; i++) {
        assert_true(json_next(&cursor, &key, &value));
        assert_int_equal(key.end - key.at, strlen(keys[i]));
        assert_memory_equal(key.at, keys[i], strlen(keys[i]));
        assert_int_equal(value.end - value.at, strlen(values[i]));
        assert_memory_equal(value.at, values[i], strlen(values[i]));
    }
    assert_false(json_next(&cursor, &key, &value));
    assert_true(json_member(root, "c", &value));
    assert_int_equal(json_kind_of(value.at), JSON_NUMBER);
    assert_false(json_member(root, "d", &value));
    assert_true(json_member(root, "a", &value));
    size_t count = 0;
    for (cursor = json_open(value); json_next(&cursor, NULL, &value);) count++;
    assert_int_equal(count, 3);
    assert_false(json_member(json_root("[1]"), "a", &value));
}

static void decodes_strings(void **state) {
    (void)state;
    kiln_arena arena = {0};
    assert_string_equal(json_text(json_root("\"a\\/b\\n\\u0041\\u00e9\\u2764\\uD83D\\uDE00\""), &arena),
                        "a/b\nA\xC3\xA9\xE2\x9D\xA4\xF0\x9F\x98\x80");
    assert_string_equal(json_text(json_root("\"\\uD83D!\\uDE00\""), &arena), "\xEF\xBF\xBD!\xEF\xBF\xBD");
    assert_string_equal(json_text(json_root("\"\\uD83D\\u0041\""), &arena), "\xEF\xBF\xBD" "A");
    assert_string_equal(json_text(json_root("\"\""), &arena), "");
    arena_free(&arena);
}

static void reads_integers(void **state) {
    (void)state;
    uint64_t value;
    assert_true(json_whole(json_root("[0]"), &value) == false);
    const char *good_ones[] = {"0 ", "42 ", "9007199254740992 "}, *bad_ones[] = {"-1 ", "1.0 ", "1e2 ", "9007199254740993 ",
                                                                                  "99999999999999999999999 "};
    const uint64_t expected[] = {0, 42, (uint64_t)1 << 53};
    for (int i = 0; i < 3; i++) {
        assert_true(json_whole(json_root(good_ones[i]), &value));
        assert_int_equal(value, expected[i]);
    }
    for (int i = 0; i < 5; i++) assert_false(json_whole(json_root(bad_ones[i]), &value));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(accepts_json, set_up, tear_down),
        cmocka_unit_test_setup_teardown(refuses_what_is_not, set_up, tear_down),
        cmocka_unit_test_setup_teardown(refuses_bad_utf8, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bounds_nesting, set_up, tear_down),
        cmocka_unit_test_setup_teardown(counts_values, set_up, tear_down),
        cmocka_unit_test_setup_teardown(every_prefix_is_refused, set_up, tear_down),
        cmocka_unit_test(walks_members),
        cmocka_unit_test(decodes_strings),
        cmocka_unit_test(reads_integers),
    };
    return cmocka_run_group_tests_name("json", tests, NULL, NULL);
}
