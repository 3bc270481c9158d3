#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/job/support.h"

/* Option, what is given, what is printed of it (NULL: the same). */
static const struct { const char *name, *given, *printed;
} values[] = {
    {"output", "a b.png", NULL},
    {"size", "640x480", NULL},
    {"size", "1x65536", NULL},
    {"crop", "0,1,20,30", NULL},
    {"aov", "normal,albedo", "albedo,normal"},
    {"aov", "samples,error,depth", "depth,samples,error"},
    {"aov", "uv,position,material,object", "position,uv,object,material"},
    {"aov", "lightgroup:b,lobe:specular,indirect,emission,lightgroup:a,lightgroup:b,lobe:diffuse",
     "emission,indirect,lobe:diffuse,lobe:specular,lightgroup:b,lightgroup:a"},
    {"aov", "lobe:*,lightgroup:*,cryptomatte", "lobe:*,lightgroup:*,cryptomatte:*"},
    {"aov", "cryptomatte:asset,cryptomatte:object", "cryptomatte:object,cryptomatte:asset"},
    {"aov", "lightgroup:a name of sixty letters and more that no fixed length can hold", NULL},
    {"spp", "1", NULL},
    {"spp", "16777216", NULL},
    {"noise", "1.5%", NULL},
    {"noise", "3", "3%"},
    {"noise", "0", "0%"},
    {"noise", "0.1%", NULL},
    {"noise", "7%", NULL},
    {"budget", "90", NULL},
    {"budget", "1h30m", "5400"},
    {"budget", "1.5m", "90"},
    {"budget", "500ms", "0.5"},
    {"budget", "2s", "2"},
    {"budget", "1e7", "1e+07"},
    {"adaptive", "on", NULL},
    {"seed", "18446744073709551615", NULL},
    {"threads", "7", NULL},
    {"max-depth", "0", NULL},
    {"filter", "box:1", NULL},
    {"filter", "gaussian", "gaussian:3"},
    {"filter", "blackman-harris", "blackman-harris:1.5"},
    {"estimator", "nee", NULL},
    {"roulette", "auto", NULL},
    {"roulette", "off", NULL},
    {"roulette", "fixed:0.95", NULL},
    {"roulette", "throughput", "throughput:3"},
    {"roulette", "throughput:0", NULL},
    {"sampler", "independent", NULL},
    {"light-sampling", "tree", NULL},
    {"light-sampling", "uniform", NULL},
    {"effects", "auto,-many-lights", NULL},
    {"texture-filter", "mip", NULL},
    {"camera", "Kamera 1", NULL},
    {"orbit", "-40,20.5", NULL},
    {"fov", "35", NULL},
    {"frame-fit", "0.9", NULL},
    {"aperture", "2.8", NULL},
    {"aperture", "0", NULL},
    {"focus", "auto", NULL},
    {"focus", "1.25", NULL},
    {"blades", "6", NULL},
    {"env", "hall.hdr", NULL},
    {"env-rotate", "-90", NULL},
    {"env-intensity", "1e-3", "0.001"},
    {"background", "env", NULL},
    {"background", "transparent", NULL},
    {"background", "#A0b1C2", "#a0b1c2"},
    {"subdivide", "auto", NULL},
    {"subdivide", "off", NULL},
    {"subdivide", "3", NULL},
    {"scheme", "catmull-clark", NULL},
    {"crease-angle", "40", NULL},
    {"exposure", "-1", NULL},
    {"display", "sRGB", NULL},
    {"view", "Raw", NULL},
    {"look", "a, -b", NULL},
    {"ocio", "c.ocio", NULL},
    {"working-space", "ACEScg", NULL},
    {"effects", "auto", NULL},
    {"effects", "all,-alpha", NULL},
    {"effects", "-sheen,+thin-lens,-alpha", "auto,+thin-lens,-alpha,-sheen"},
    {"embree-config", "isa=avx2", NULL},
    {"embree-config", "ISA=SSE4.2,hugepages=1 verbose=2", NULL},
    {"allow-outside", "true", NULL},
    {"stats", "s.json", NULL},
    {"strict", "true", NULL},
    {"strict", "false", NULL},
    {"embree", "true", NULL},
    {"growth", "pixels,triangles:1e6", NULL},
    {"metric", "flip", NULL},
    {"threshold", "0.01", NULL},
    {"preset", "roulette", NULL},
    {"reference", "reference.exr", NULL},
};

static void print_value(const fixture *f, const char *name, kiln_text *out) {
    const option_row *row = option_find(&job_option_table, name);
    assert_non_null(row);
    option_print(row, &f->options, row->kind->repeats ? f->options.outputs.count - 1 : 0, out);
}

/* What is printed reads back, and prints the same. */
static void values_go_round(void **state) {
    fixture *f = *state;
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        kiln_text first = {0}, second = {0};
        give(f, values[i].name, values[i].given);
        print_value(f, values[i].name, &first);
        assert_string_equal(first.data, values[i].printed ? values[i].printed : values[i].given);
        give(f, values[i].name, first.data);
        print_value(f, values[i].name, &second);
        assert_string_equal(first.data, second.data);
        text_free(&first);
        text_free(&second);
    }
}

static void every_option_has_a_case_and_a_default_that_parses(void **state) {
    fixture *f = *state;
    for (size_t i = 0; i < job_option_table.count; i++) {
        const option_row *row = &job_option_table.rows[i];
        bool covered = false;
        for (size_t k = 0; k < sizeof values / sizeof *values; k++)
            covered = covered || strcmp(values[k].name, row->name) == 0;
        if (!covered) fail_msg("no case for --%s", row->name);
        assert_non_null(row->help);
        assert_non_null(row->domain);
        assert_true(!row->argument == row->kind->is_switch);
        if (!row->fallback) continue;
        kiln_text text = {0};
        print_value(f, row->name, &text);
        assert_string_equal(text.data, row->fallback); /* as --help says it */
        text_free(&text);
    }
    assert_true(f->options.given == 0);
}

static const struct { const char *name, *value;
} refused[] = {
    {"output", ""},
    {"size", "640"},
    {"size", "0x4"},
    {"size", "4x65537"},
    {"size", "4x4x4"},
    {"size", "-4x4"},
    {"size", " 4x4"},
    {"size", ""},
    {"crop", "0,0,0,4"},
    {"crop", "0,0,4"},
    {"crop", "4,0,1,4"},
    {"crop", "0,0,4,4,"},
    {"spp", "0"},
    {"spp", "1e3"},
    {"spp", "16777217"},
    {"spp", "-1"},
    {"noise", "-1%"},
    {"noise", "101"},
    {"noise", "1%%"},
    {"noise", "nan"},
    {"noise", ""},
    {"budget", "0"},
    {"budget", "-5s"},
    {"budget", "5x"},
    {"budget", ""},
    {"budget", "1h30"},
    {"budget", "s"},
    {"budget", "inf"},
    {"seed", "-1"},
    {"seed", "18446744073709551616"},
    {"threads", "0"},
    {"max-depth", "65536"},
    {"filter", "box:0"},
    {"filter", "box:17"},
    {"filter", "sinc"},
    {"filter", "box:"},
    {"estimator", "MIS"},
    {"roulette", "fixed"},
    {"roulette", "fixed:0"},
    {"roulette", "fixed:1.1"},
    {"roulette", "throughput:-1"},
    {"roulette", "auto:1"},
    {"sampler", "halton"},
    {"light-sampling", "bvh"},
    {"texture-filter", "linear"},
    {"orbit", "30"},
    {"orbit", "0,91"},
    {"orbit", "nan,0"},
    {"fov", "0"},
    {"fov", "180"},
    {"frame-fit", "0"},
    {"aperture", "-1"},
    {"focus", "0"},
    {"focus", "-3"},
    {"blades", "65"},
    {"env-rotate", "x"},
    {"env-intensity", "-1"},
    {"background", "#12345"},
    {"effects", ""},
    {"effects", "none"},
    {"effects", "alpha"},
    {"effects", "-alpha,auto"},
    {"effects", "-alpha,"},
    {"effects", "+alpha,-alpha"},
    {"effects", "-mirrors"},
    {"embree-config", "foo=bar"},
    {"embree-config", "isa=avx9"},
    {"embree-config", "isa=avx2,max_isa=sse5"},
    {"embree-config", "isa"},
    {"embree-config", "isa="},
    {"embree-config", "=avx2"},
    {"embree-config", ",isa=avx2"},
    {"allow-outside", "yes"},
    {"background", "#1234567"},
    {"background", "white"},
    {"subdivide", "0"},
    {"subdivide", "7"},
    {"subdivide", "on"},
    {"scheme", "none"},
    {"crease-angle", "181"},
    {"exposure", "65"},
    {"exposure", "1,5"},
    {"aov", "albdo"},
    {"aov", "*"},
    {"aov", "lobe:"},
    {"aov", "lobe:shiny"},
    {"aov", "lightgroup:"},
    {"aov", "cryptomatte:thing"},
    {"strict", "yes"},
    {"aov", "albedo,,normal"},
};

static void other_values_are_refused_and_change_nothing(void **state) {
    fixture *f = *state;
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        size_t errors = kiln_report_count(f->report, KILN_ERROR);
        if (job_options_set(&f->options, refused[i].name, refused[i].value, NULL, f->report))
            fail_msg("--%s '%s' was taken", refused[i].name, refused[i].value);
        assert_int_equal(kiln_report_count(f->report, KILN_ERROR), errors + 1);
    }
    assert_int_equal(kiln_report_exit_code(f->report), 2);
    assert_true(f->options.given == 0);
    assert_true(f->options.fov_deg == 0 && f->options.spp == 0 && f->options.blades == 0);
}

static void unknown_names_are_answered(void **state) {
    fixture *f = *state;
    assert_false(job_options_set(&f->options, "nois", "1", NULL, f->report));
    assert_true(says(f->report, "did you mean noise?"));
    assert_false(job_options_set(&f->options, "estimator", "mos", NULL, f->report));
    assert_true(says(f->report, "did you mean mis?"));
}

static void unknown_effects_are_answered(void **state) {
    fixture *f = *state;
    assert_false(job_options_set(&f->options, "effects", "-clearcaot", NULL, f->report));
    assert_true(says(f->report, "no effect 'clearcaot' (did you mean 'clearcoat'?); there are thin-lens, motion,"));
}

static void giving_a_rule_replaces_all_defaults(void **state) {
    fixture *f = *state;
    job_rules rules;
    assert_done(f, job_rules_choose(&f->options, &rules, f->report));
    assert_true(rules.spp == 1024 && rules.noise == 0.03 && rules.budget_seconds == 0);
    give(f, "budget", "10s");
    assert_done(f, job_rules_choose(&f->options, &rules, f->report));
    assert_true(rules.spp == 0 && rules.noise == 0 && rules.budget_seconds == 10);
    give(f, "noise", "0");
    assert_done(f, job_rules_choose(&f->options, &rules, f->report));
    assert_true(rules.noise == 0);
}

static void without_any_rule_there_is_no_render(void **state) {
    fixture *f = *state;
    job_rules rules;
    give(f, "noise", "0");
    assert_false(job_rules_choose(&f->options, &rules, f->report));
    assert_true(says(f->report, "no rule"));
}

static void commands_are_written_for_a_shell(void **state) {
    fixture *f = *state;
    kiln_text text = {0};
    give(f, "output", "it's.png");
    give(f, "output", "b.exr");
    give(f, "size", "8x8");
    give(f, "strict", "true");
    option_print_command(&job_option_table, &f->options, f->options.given, &text);
    assert_string_equal(text.data, " --output 'it'\\''s.png' --output b.exr --size 8x8 --strict");
    text_free(&text);
}

static void numbers_are_as_short_as_they_can_be(void **state) {
    (void)state;
    const struct { double value; const char *text; } rows[] = {
        {0.1, "0.1"}, {1.0 / 3, "0.3333333333333333"}, {-2, "-2"}, {1e300, "1e+300"}, {0, "0"}, {0.03, "0.03"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        kiln_text text = {0};
        option_print_number(rows[i].value, &text);
        assert_string_equal(text.data, rows[i].text);
        text_free(&text);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {JOB_TEST(values_go_round),
                                       JOB_TEST(every_option_has_a_case_and_a_default_that_parses),
                                       JOB_TEST(other_values_are_refused_and_change_nothing),
                                       JOB_TEST(unknown_names_are_answered),
                                       JOB_TEST(unknown_effects_are_answered),
                                       JOB_TEST(giving_a_rule_replaces_all_defaults),
                                       JOB_TEST(without_any_rule_there_is_no_render),
                                       JOB_TEST(commands_are_written_for_a_shell),
                                       cmocka_unit_test(numbers_are_as_short_as_they_can_be)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
