#include "tests/importers/gltf/support.h"

#include <sys/stat.h>
#include <unistd.h>

#include "importers/gltf/uri.h"

/* root/secret.bin, root/asset/a.bin, root/asset/sub/b c.bin, and links. */
static char root[] = "/tmp/kiln-uri-XXXXXX";
static char folder[64];

static void put(const char *name, const char *text) {
    char path[160];
    snprintf(path, sizeof path, "%s/%s", root, name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void in_root(char path[160], const char *name) { snprintf(path, 160, "%s/%s", root, name); }

static int set_up(void **state) {
    (void)state;
    char path[160], target[160];
    if (!mkdtemp(root)) return -1;
    snprintf(folder, sizeof folder, "%s/asset", root);
    mkdir(folder, 0700);
    in_root(path, "asset/sub");
    mkdir(path, 0700);
    in_root(path, "asset2");
    mkdir(path, 0700);
    put("secret.bin", "s");
    put("asset/a.bin", "a");
    put("asset/100%.bin", "p");
    put("asset/sub/b c.bin", "b");
    put("asset/\xE2\x9D\xA4.bin", "h");
    put("asset2/x.bin", "x");
    in_root(target, "secret.bin");
    in_root(path, "asset/link.bin");
    if (symlink(target, path)) return -1;
    in_root(path, "asset/up");
    if (symlink("..", path)) return -1;
    in_root(path, "asset/side.bin");
    if (symlink("../asset2/x.bin", path)) return -1;
    in_root(path, "asset/inner.bin");
    return symlink("a.bin", path);
}

static int tear_down(void **state) {
    (void)state;
    static const char *const names[] = {"secret.bin", "asset/a.bin", "asset/100%.bin", "asset/sub/b c.bin",
                                        "asset/\xE2\x9D\xA4.bin", "asset2/x.bin", "asset/side.bin", "asset/link.bin", "asset/up",
                                        "asset/inner.bin"};
    char path[160];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        in_root(path, names[i]);
        unlink(path);
    }
    in_root(path, "asset/sub");
    rmdir(path);
    in_root(path, "asset2");
    rmdir(path);
    rmdir(folder);
    return rmdir(root);
}

static void leads_to_with(bool allow_outside, const char *uri, const char *name) {
    kiln_report *report = kiln_report_create();
    kiln_where where = where_root("a.gltf");
    char *path = uri_resolve(uri, folder, allow_outside, &where, report);
    if (!path) print_report(report);
    assert_non_null(path);
    char expected[160], *real;
    in_root(expected, name);
    real = realpath(expected, NULL);
    assert_string_equal(path, real);
    free(real);
    free(path);
    kiln_report_destroy(report);
}

static void leads_to(const char *uri, const char *name) { leads_to_with(false, uri, name); }

static void refused(const char *uri, kiln_code code, const char *what) {
    kiln_report *report = kiln_report_create();
    kiln_where where = where_root("a.gltf");
    char *path = uri_resolve(uri, folder, false, &where, report);
    if (path) print_message("%s leads to %s\n", uri, path);
    assert_null(path);
    assert_message(report, KILN_ERROR, code, "a.gltf", what);
    kiln_report_destroy(report);
}

static void finds_files_inside(void **state) {
    (void)state;
    leads_to("a.bin", "asset/a.bin");
    leads_to("./a.bin", "asset/a.bin");
    leads_to("sub/b%20c.bin", "asset/sub/b c.bin");
    leads_to("sub/b c.bin", "asset/sub/b c.bin");
    leads_to("sub\\b c.bin", "asset/sub/b c.bin"); /* as Windows writes it */
    leads_to("%E2%9D%A4.bin", "asset/\xE2\x9D\xA4.bin");
    leads_to("\xE2\x9D\xA4.bin", "asset/\xE2\x9D\xA4.bin");
    leads_to("sub/../a.bin", "asset/a.bin");
    leads_to("100%.bin", "asset/100%.bin");
    leads_to("100%25.bin", "asset/100%.bin");
    leads_to("inner.bin", "asset/a.bin");
}

static void stays_inside(void **state) {
    (void)state;
    char absolute[200];
    snprintf(absolute, sizeof absolute, "%s/secret.bin", root);
    refused("../secret.bin", KILN_CODE_PATH_OUTSIDE, "leaves the asset's folder");
    refused("%2e%2e/secret.bin", KILN_CODE_PATH_OUTSIDE, "leaves the asset's folder");
    refused("%2E%2E%2Fsecret.bin", KILN_CODE_PATH_OUTSIDE, "leaves the asset's folder");
    refused("..\\secret.bin", KILN_CODE_PATH_OUTSIDE, "leaves the asset's folder");
    refused("sub/../../secret.bin", KILN_CODE_PATH_OUTSIDE, "leaves the asset's folder");
    refused("nowhere/../../secret.bin", KILN_CODE_PATH_OUTSIDE, "leaves the asset's folder");
    refused("..", KILN_CODE_PATH_OUTSIDE, "leaves the asset's folder");
    refused("../asset2/x.bin", KILN_CODE_PATH_OUTSIDE, "leaves the asset's folder");
    refused(absolute, KILN_CODE_PATH_OUTSIDE, "absolute path");
    refused("%2Fetc/passwd", KILN_CODE_PATH_OUTSIDE, "absolute path");
    refused("\\\\server\\share", KILN_CODE_PATH_OUTSIDE, "absolute path");
    refused("file:///etc/passwd", KILN_CODE_PATH_OUTSIDE, "scheme");
    refused("http://host/a.bin", KILN_CODE_PATH_OUTSIDE, "scheme");
    refused("C:\\a.bin", KILN_CODE_PATH_OUTSIDE, "scheme");
    refused("file%3A///etc/passwd", KILN_CODE_PATH_OUTSIDE, "scheme");
    refused("link.bin", KILN_CODE_PATH_OUTSIDE, "symbolic link");
    refused("side.bin", KILN_CODE_PATH_OUTSIDE, "symbolic link"); /* to a folder whose name begins alike */
    refused("up/secret.bin", KILN_CODE_PATH_OUTSIDE, "symbolic link");
    refused("a.bin%00.png", KILN_CODE_PATH_OUTSIDE, "zero byte");
}

static void says_what_is_missing(void **state) {
    (void)state;
    refused("b.bin", KILN_CODE_FILE_MISSING, "b.bin does not exist");
    refused("a.bin/b", KILN_CODE_FILE_MISSING, "does not exist");
    refused("~/a.bin", KILN_CODE_FILE_MISSING, "does not exist");
    refused("$HOME", KILN_CODE_FILE_MISSING, "does not exist");
    refused("", KILN_CODE_REFERENCE, "empty");
    char *long_name = calloc(1, 20001);
    memset(long_name, 'a', 20000);
    refused(long_name, KILN_CODE_FILE_UNREADABLE, "cannot be read");
    free(long_name);
}

/* For assets that are trusted. A scheme stays one, and what does not exist is missing. */
static void leaves_the_folder_where_that_is_allowed(void **state) {
    (void)state;
    char absolute[160];
    in_root(absolute, "secret.bin");
    static const struct { const char *uri, *name; } rows[] = {{"a.bin", "asset/a.bin"},
                                                              {"../secret.bin", "secret.bin"},
                                                              {"..%2Fasset2/x.bin", "asset2/x.bin"},
                                                              {"..\\asset2\\x.bin", "asset2/x.bin"},
                                                              {"link.bin", "secret.bin"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) leads_to_with(true, rows[i].uri, rows[i].name);
    leads_to_with(true, absolute, "secret.bin");
    kiln_where where = where_root("a.gltf");
    const char *const bad[] = {"file:///etc/passwd", "../missing.bin", ""};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        kiln_report *report = kiln_report_create();
        assert_null(uri_resolve(bad[i], folder, true, &where, report));
        assert_int_equal(kiln_report_exit_code(report), 3);
        kiln_report_destroy(report);
    }
}

/* The way out is named where there is one. */
static void says_how_to_leave_the_folder(void **state) {
    (void)state;
    const char *const uris[] = {"../secret.bin", "/secret.bin", "link.bin"};
    for (size_t i = 0; i < sizeof uris / sizeof *uris; i++) {
        kiln_report *report = kiln_report_create();
        kiln_where where = where_root("a.gltf");
        assert_null(uri_resolve(uris[i], folder, false, &where, report));
        assert_non_null(strstr(kiln_report_message(report, 0).remedy, "--allow-outside"));
        kiln_report_destroy(report);
    }
}

static void needs_a_folder(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    kiln_where where = where_root("standard input");
    for (int allow = 0; allow < 2; allow++) {
        assert_null(uri_resolve("a.bin", NULL, allow, &where, report));
        assert_message(report, KILN_ERROR, KILN_CODE_PATH_OUTSIDE, "standard input", "no folder");
    }
    kiln_report_destroy(report);
}

static void decodes_data_uris(void **state) {
    (void)state;
    static const struct { const char *uri, *bytes; } good[] = {
        {"data:application/octet-stream;base64,AAEC/w==", "\0\1\2\xFF"},
        {"data:;base64,TWE=", "Ma"},
        {"data:;base64,TWE", "Ma"}, /* without padding */
        {"DATA:image/x-odd;charset=x;BASE64,TWFu", "Man"},
        {"data:,a%20b", "a b"},
        {"data:;base64,", ""},
    };
    const size_t sizes[] = {4, 2, 2, 3, 3, 0};
    kiln_where where = where_root("a.gltf");
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        kiln_report *report = kiln_report_create();
        kiln_bytes bytes;
        assert_true(uri_is_data(good[i].uri, strlen(good[i].uri)));
        assert_true(uri_decode_data(good[i].uri, strlen(good[i].uri), &bytes, &where, report));
        assert_int_equal(bytes.size, sizes[i]);
        assert_memory_equal(bytes.data, good[i].bytes, sizes[i]);
        file_free(&bytes);
        kiln_report_destroy(report);
    }
    static const char *const bad[] = {"data:;base64", "data:;base64,A", "data:;base64,AA=A", "data:;base64,A*AA", "data:;base64,AA AA"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        kiln_report *report = kiln_report_create();
        kiln_bytes bytes;
        assert_false(uri_decode_data(bad[i], strlen(bad[i]), &bytes, &where, report));
        assert_int_equal(kiln_report_exit_code(report), 3);
        kiln_report_destroy(report);
    }
}

static void round_trips_base64(void **state) {
    (void)state;
    unsigned char bytes[64];
    kiln_where where = where_root("a.gltf");
    for (size_t i = 0; i < sizeof bytes; i++) bytes[i] = (unsigned char)(i * 37 + 11);
    for (size_t size = 0; size <= sizeof bytes; size++) {
        char *uri = data_uri(bytes, size);
        kiln_report *report = kiln_report_create();
        kiln_bytes decoded;
        assert_true(uri_decode_data(uri, strlen(uri), &decoded, &where, report));
        assert_int_equal(decoded.size, size);
        assert_memory_equal(decoded.data, bytes, size);
        file_free(&decoded);
        kiln_report_destroy(report);
        free(uri);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_files_inside), cmocka_unit_test(stays_inside),      cmocka_unit_test(says_what_is_missing),
        cmocka_unit_test(leaves_the_folder_where_that_is_allowed), cmocka_unit_test(says_how_to_leave_the_folder),
        cmocka_unit_test(needs_a_folder),     cmocka_unit_test(decodes_data_uris), cmocka_unit_test(round_trips_base64),
    };
    return cmocka_run_group_tests_name("uri", tests, set_up, tear_down);
}
