#include "tests/color/support.h"

#include <unistd.h>

static void refuse(const char *config, const char *working, kiln_code code, const char *where, const char *what,
                   const char *remedy) {
    const kiln_color_options options = {config, working};
    kiln_report *report = kiln_report_create();
    kiln_color *color = (kiln_color *)&options;
    assert_false(kiln_color_create(&options, &color, report));
    assert_null(color);
    assert_message(report, code, where, what, remedy);
    kiln_report_destroy(report);
}

static bool listed(const kiln_color *color, const char *(*list)(const kiln_color *, size_t), const char *name) {
    const char *entry;
    for (size_t i = 0; (entry = list(color, i)); i++)
        if (strcmp(entry, name) == 0) return true;
    return false;
}

static void embedded_config_lists_its_names(void **state) {
    (void)state;
    assert_int_equal(unsetenv("OCIO"), 0);
    kiln_color *color = color_of(NULL, NULL);
    assert_string_equal(kiln_color_describe(color), "embedded kiln config, working space lin_rec709");
    const char *const spaces[] = {"ACES2065-1",  "ACEScg",         "lin_rec709", "lin_p3d65",
                                  "CIE-XYZ-D65", "sRGB - Texture", "Raw"};
    for (size_t i = 0; i < sizeof spaces / sizeof *spaces; i++) assert_true(listed(color, kiln_color_space, spaces[i]));
    const char *const displays[] = {"sRGB", "Rec.1886", "Display P3"};
    const char *const views[] = {"Khronos PBR Neutral", "ACES 1.0 - SDR Video", "Un-tone-mapped", "Raw"};
    for (size_t d = 0; d < 3; d++) {
        assert_string_equal(kiln_color_display(color, d), displays[d]);
        for (size_t v = 0; v < 4; v++) assert_string_equal(kiln_color_view(color, displays[d], v), views[v]);
        assert_null(kiln_color_view(color, displays[d], 4));
    }
    assert_null(kiln_color_display(color, 3));
    assert_null(kiln_color_view(color, "nowhere", 0));
    assert_null(kiln_color_look(color, 0));
    kiln_color_destroy(color);
    kiln_color_destroy(NULL);
}

static void environment_names_a_config(void **state) {
    (void)state;
    setenv("OCIO", "", 1); /* set but empty is not set */
    kiln_color *color = color_of(NULL, NULL);
    assert_string_equal(kiln_color_describe(color), "embedded kiln config, working space lin_rec709");
    kiln_color_destroy(color);
    setenv("OCIO", DATA "studio.ocio", 1);
    color = color_of(NULL, "rendering space");
    assert_string_equal(kiln_color_describe(color),
                        "config test-studio, " DATA "studio.ocio ($OCIO), working space rendering space");
    assert_true(listed(color, kiln_color_look, "warm") && listed(color, kiln_color_look, "dark"));
    kiln_color_destroy(color);
    setenv("OCIO", "/nowhere/config.ocio", 1);
    refuse(NULL, NULL, KILN_CODE_FILE_MISSING, "/nowhere/config.ocio ($OCIO)", "does not exist", "check the path");
    color = color_of(DATA "old.ocio", NULL); /* a config that is asked for goes first */
    kiln_color_destroy(color);
    unsetenv("OCIO");
}

static void broken_configs(void **state) {
    (void)state;
    refuse(DATA "missing.ocio", NULL, KILN_CODE_FILE_MISSING, "missing.ocio", "does not exist", "check the path");
    refuse(KILN_TEST_DATA, NULL, KILN_CODE_FILE_UNREADABLE, KILN_TEST_DATA, "Is a directory", "check the path");
    refuse(DATA "garbage.ocio", NULL, KILN_CODE_COLOR_CONFIG, "garbage.ocio", "yaml-cpp: error at line 2", "repair");
    refuse(DATA "luts/sh010/invert.spi1d", NULL, KILN_CODE_COLOR_CONFIG, "invert.spi1d", "", "repair");
    refuse(DATA "too_new.ocio", NULL, KILN_CODE_COLOR_CONFIG, "too_new.ocio", "needs OpenColorIO 2.99 or newer",
           "use an older release");
    refuse(DATA "unknown_rec709.ocio", NULL, KILN_CODE_COLOR_CONFIG, "unknown_rec709.ocio", "linear Rec.709",
           "aces_interchange");
}

/* OpenColorIO 2.1 would follow these until the stack ends. */
static void endless_definitions(void **state) {
    (void)state;
    static const char head[] = "ocio_profile_version: 2\n"
                               "roles: {default: lin_rec709}\n"
                               "file_rules:\n  - !<Rule> {name: Default, colorspace: default}\n"
                               "displays:\n  S:\n    - !<View> {name: V, colorspace: c0, looks: grade}\n"
                               "looks:\n  - !<Look> {name: grade, process_space: c0}\n"
                               "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n";
    static const char row[] = "  - !<ColorSpace> {name: c%d, from_scene_reference: "
                              "!<ColorSpaceTransform> {src: lin_rec709, dst: c%d}}\n";
    char path[] = "endless-XXXXXX";
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    /* A space defined by itself; two by each other; a chain that ends, but after 1,000. */
    const int lengths[] = {1, 2, 1000};
    for (size_t i = 0; i < 3; i++) {
        FILE *file = fopen(path, "w");
        assert_non_null(file);
        fputs(head, file);
        for (int k = 0; k < lengths[i]; k++)
            fprintf(file, row, k, i < 2 ? (k + 1) % lengths[i] : k + 1);
        fclose(file);
        refuse(path, NULL, KILN_CODE_COLOR_CONFIG, path, "is defined by itself, or through too many others", "repair");
    }
    close(fd);
    unlink(path);
}

static void unknown_working_spaces(void **state) {
    (void)state;
    refuse(NULL, "ACESg", KILN_CODE_COLOR, "embedded kiln config",
           "colour space \"ACESg\" does not exist; there are: \"ACES2065-1\", \"ACEScg\", \"lin_rec709\"",
           "did you mean \"ACEScg\"?");
    refuse(NULL, "something else", KILN_CODE_COLOR, "", "does not exist", "choose one of them");
    refuse(NULL, "sRGB - Texture", KILN_CODE_COLOR, "", "sRGB - Texture is not scene-linear", "scene-linear");
    refuse(NULL, "Raw", KILN_CODE_COLOR, "", "Raw is not scene-linear", "scene-linear");
    refuse(NULL, "srgb_display", KILN_CODE_COLOR, "", "srgb_display is not scene-linear", "scene-linear");
    refuse(DATA "studio.ocio", "curved", KILN_CODE_COLOR, "studio.ocio", "curved is not scene-linear", "scene-linear");
    refuse(DATA "studio.ocio", "nothing", KILN_CODE_COLOR, "studio.ocio", "nothing is not scene-linear", "choose");
    refuse(DATA "studio.ocio", "rendering", KILN_CODE_COLOR, "studio.ocio",
           "there are: \"ap0\", \"rendering space\"", "choose one of them");
    /* Without aces_interchange there is no way to a space that the config does not have. */
    refuse(DATA "old.ocio", "lin_p3d65", KILN_CODE_COLOR, "old.ocio", "\"lin_p3d65\" does not exist", "");
}

static void refuse_view(const kiln_color *color, kiln_view_options options, kiln_code code, const char *where,
                        const char *what, const char *remedy) {
    kiln_report *report = kiln_report_create();
    kiln_view *view;
    assert_false(kiln_view_create(color, &options, &view, report));
    assert_null(view);
    assert_message(report, code, where, what, remedy);
    kiln_report_destroy(report);
}

static void unknown_displays_views_and_looks(void **state) {
    (void)state;
    kiln_color *color = color_of(NULL, NULL);
    refuse_view(color, (kiln_view_options){.display = "sRBG"}, KILN_CODE_COLOR, "embedded kiln config",
                "display \"sRBG\" does not exist; there are: \"sRGB\", \"Rec.1886\", \"Display P3\"", "");
    refuse_view(color, (kiln_view_options){.display = "DisplayP3"}, KILN_CODE_COLOR, "", "",
                "did you mean \"Display P3\"?");
    refuse_view(color, (kiln_view_options){.view = "Khronos PBR"}, KILN_CODE_COLOR, "",
                "view \"Khronos PBR\" does not exist; there are: \"Khronos PBR Neutral\", \"ACES 1.0 - SDR Video\"",
                "choose one of them");
    refuse_view(color, (kiln_view_options){.look = "warm"}, KILN_CODE_COLOR, "",
                "look \"warm\" does not exist; there is none", "choose another config");
    const double bad[] = {NAN, INFINITY, 65, -65};
    for (size_t i = 0; i < 4; i++)
        refuse_view(color, (kiln_view_options){.exposure = bad[i]}, KILN_CODE_USAGE, "", "stops is not between",
                    "--exposure");
    kiln_color_destroy(color);
    color = color_of(DATA "studio.ocio", NULL);
    refuse_view(color, (kiln_view_options){.look = "dark, -warn"}, KILN_CODE_COLOR, "studio.ocio",
                "look \"warn\" does not exist; there are: \"warm\", \"dark\"", "did you mean \"warm\"?");
    refuse_view(color, (kiln_view_options){.view = "Lost"}, KILN_CODE_COLOR_CONFIG, "studio.ocio", "lost.spi1d",
                "search_path");
    kiln_color_destroy(color);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(embedded_config_lists_its_names),
        cmocka_unit_test(environment_names_a_config),
        cmocka_unit_test(broken_configs),
        cmocka_unit_test(endless_definitions),
        cmocka_unit_test(unknown_working_spaces),
        cmocka_unit_test(unknown_displays_views_and_looks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
