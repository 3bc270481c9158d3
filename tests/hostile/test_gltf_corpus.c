/* Bad files that other projects collected: what kiln says of each is kept in tests/data/gltf/bad.outcomes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "kiln/import.h"
#include "tests/assets.h"
#include "tests/golden/dump.h"
#include "tests/golden/golden.h"

/* "ok", or its messages. */
static void describe(const char *path, kiln_text *out) {
    kiln_report *report = kiln_report_create();
    kiln_scene *scene;
    if (kiln_import(path, NULL, &scene, report)) {
        kiln_scene_commit(scene, report);
        kiln_scene_destroy(scene);
    }
    if (!kiln_report_size(report)) text_append(out, "ok\n");
    dump_report(report, strlen(path), out);
    assert_int_equal(kiln_report_exit_code(report), kiln_report_count(report, KILN_ERROR) ? 3 : 0);
    kiln_report_destroy(report);
}

static void says_what_it_said(void **state) {
    (void)state;
    const char *root = assets_or_skip();
    static const char *const suffixes[] = {".gltf", ".glb", NULL};
    char folder[4200];
    snprintf(folder, sizeof folder, "%s/bad", root);
    assert_true(golden_matches_files("gltf/bad.outcomes", folder, suffixes, describe));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(says_what_it_said)};
    return cmocka_run_group_tests_name("gltf corpus", tests, NULL, NULL);
}
