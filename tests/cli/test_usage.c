#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "tests/cli/run.h"

#define SCENE PAIR("unlit_a")

static void wrong_usage_is_one_line_and_exit_code_2(void **state) {
    const place *p = *state;
    assert_refused(p, 2, "no command", "NOTHING=");
    assert_refused(p, 2, "did you mean render?", "rendr", "a.glb");
    assert_refused(p, 2, "kiln render a.glb", "a.glb");
    assert_refused(p, 2, "needs a scene", "render");
    assert_refused(p, 2, "takes one SCENE", "render", "a.glb", "b.glb");
    assert_refused(p, 2, "takes no argument", "version", "a");
    assert_refused(p, 2, "did you mean --size?", "render", SCENE, "--sise", "4x4");
    assert_refused(p, 2, "'kiln render --help'", "render", SCENE, "--zzzzzzzz");
    assert_refused(p, 2, "unknown option '-x'", "render", SCENE, "-x");
    assert_refused(p, 2, "needs a value", "render", SCENE, "--size");
    assert_refused(p, 2, "needs a value", "render", SCENE, "--size", "--spp", "4");
    assert_refused(p, 2, "needs a value", "render", SCENE, "-o");
    assert_refused(p, 2, "--size: '4' is not", "render", SCENE, "--size=4");
    assert_refused(p, 2, "did you mean mis?", "render", SCENE, "--estimator", "mi");
    assert_refused(p, 2, "KILN_THREADS: 'many'", "KILN_THREADS=many", "render", SCENE);
    assert_refused(p, 2, "no rule", "render", SCENE, "--noise", "0");
    assert_refused(p, 2, "--crop: 0,0,99,4", "render", SCENE, "--size", "8x8", "--crop", "0,0,99,4");
    assert_refused(p, 2, "standard output", "render", SCENE, "--json", "-o", "-");
    assert_refused(p, 2, "'isa=avx9' is not", "render", SCENE, "--embree-config", "isa=avx9");
    assert_refused(p, 2, "view \"Filmic\" does not exist", "render", SCENE, "--view", "Filmic");
    assert_refused(p, 2, "display \"CRT\" does not exist", "render", SCENE, "--display", "CRT");
    assert_refused(p, 2, "no camera 'Z'", "render", SCENE, "--camera", "Z");
    assert_refused(p, 2, "look \"nope\" does not exist; there is none; choose another", "render", SCENE, "--look", "nope");
}

/* Options of the contract that do not exist yet are unknown like any other. */
static void nothing_is_promised_that_is_not_there(void **state) {
    const char *const names[] = {"--shutter", "--at",           "--frames",         "--fps",     "--animation",
                                 "--variant", "--ground",       "--caustics",       "--checkpoint",
                                 "--resume",  "--denoise",      "--clamp-indirect", "--replay",  "--usd-python",
                                 "--sandbox"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        assert_refused(*state, 2, "unknown option", "render", SCENE, names[i], "1");
}

/* A command refuses what it would not look at. */
static void options_belong_to_commands(void **state) {
    const place *p = *state;
    static const struct { const char *option; bool inspects, informs; } rows[] = {
        {"--output=a.png", false, false}, {"--stats=s.json", false, false},   {"--spp=1", false, false},
        {"--exposure=1", false, false},   {"--background=env", false, false}, {"--embree-config=isa=avx2", false, false},
        {"--strict", true, false},        {"--size=8x8", true, false},        {"--orbit=0,0", true, false},
        {"--threads=1", true, true},      {"--view=Raw", false, true},        {"--ocio=", false, true}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (rows[i].inspects) assert_runs(p, "inspect", SCENE, rows[i].option);
        else assert_refused(p, 2, "unknown option", "inspect", SCENE, rows[i].option);
        if (rows[i].informs) assert_runs(p, "info", rows[i].option);
        else assert_refused(p, 2, "unknown option", "info", rows[i].option);
    }
    result r = run(p, "info", "--help");
    assert_null(strstr(r.out, "--exposure"));
    assert_null(strstr(r.out, "--stats"));
    result_free(&r);
}

/* Every spelling of an option means the same; a value may begin with a minus. */
static void options_have_several_spellings(void **state) {
    const place *p = *state;
    assert_runs(p, "render", SCENE, "--size", "8x8", "--spp", "1", "--exposure", "-1", "-o", "a.png");
    assert_runs(p, "render", "--size=8x8", "--spp=1", "--exposure=-1", "-ob.png", "-q", "--", SCENE);
    assert_true(same_bytes(p, "a.png", "b.png"));
}

static void the_command_line_goes_before_the_environment(void **state) {
    assert_runs(*state, "KILN_THREADS=1", "render", SCENE, "--size", "8x8", "--spp", "1", "--threads", "2", "--stats",
                "s.json");
    size_t size;
    char *stats = (char *)read_file(*state, "s.json", &size);
    assert_non_null(strstr(stats, "\"threads\": 2"));
    free(stats);
    assert_runs(*state, "KILN_THREADS=1", "render", SCENE, "--size", "8x8", "--spp", "1", "--stats", "s.json");
    stats = (char *)read_file(*state, "s.json", &size);
    assert_non_null(strstr(stats, "\"threads\": 1"));
    free(stats);
}

static void help_is_on_standard_output(void **state) {
    const place *p = *state;
    const char *const calls[][3] = {{"help"},
                                    {"--help"},
                                    {"-h"},
                                    {"help", "render"},
                                    {"render", "--help"},
                                    {"render", "-h"},
                                    {"inspect", "--help"},
                                    {"info", "--help"},
                                    {"help", "--help"},
                                    {"version", "-h"}};
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
        result r = run_list(p, calls[i]);
        assert_int_equal(r.code, 0);
        assert_true(r.out_size > 100 || strcmp(calls[i][0], "help") == 0 || strcmp(calls[i][0], "version") == 0);
        assert_int_equal(r.err_size, 0);
        assert_non_null(strstr(r.out, "kiln"));
        result_free(&r);
    }
    result r = run(p, "render", "--help", "--nonsense");
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.out, "Examples"));
    assert_non_null(strstr(r.out, "-o, --output FILE"));
    result_free(&r);
}

static void what_cannot_be_printed_is_an_error(void **state) {
    const char *const calls[][3] = {{"help"}, {"--help"}, {"help", "render"}, {"render", "--help"}, {"version"}, {"info"}};
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
        result r = run(*state, calls[i][0], ">/dev/full", calls[i][1]);
        assert_int_equal(r.code, 1);
        assert_non_null(strstr(r.err, "error: standard output: it cannot be written: No space left"));
        result_free(&r);
    }
}

/* No line of help is wider than 100 characters. */
static void help_fits_a_terminal(void **state) {
    result r = run(*state, "render", "--help");
    size_t width = 0;
    for (const char *c = r.out; *c; c++) {
        width = *c == '\n' ? 0 : width + 1;
        assert_true(width <= 100);
    }
    result_free(&r);
}

static void the_version_is_told(void **state) {
    const char *const calls[] = {"version", "--version"};
    for (int i = 0; i < 2; i++) {
        result r = run(*state, calls[i]);
        assert_int_equal(r.code, 0);
        assert_int_equal(strncmp(r.out, "kiln ", 5), 0);
        assert_int_equal(r.err_size, 0);
        result_free(&r);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {CLI_TEST(wrong_usage_is_one_line_and_exit_code_2),
                                       CLI_TEST(nothing_is_promised_that_is_not_there),
                                       CLI_TEST(options_belong_to_commands),
                                       CLI_TEST(options_have_several_spellings),
                                       CLI_TEST(the_command_line_goes_before_the_environment),
                                       CLI_TEST(help_is_on_standard_output),
                                       CLI_TEST(what_cannot_be_printed_is_an_error),
                                       CLI_TEST(help_fits_a_terminal),
                                       CLI_TEST(the_version_is_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
