/* tests/color/support.h: shared by the tests of color/. */
#ifndef KILN_TESTS_COLOR_SUPPORT_H
#define KILN_TESTS_COLOR_SUPPORT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "kiln/color.h"

#define DATA KILN_TEST_DATA "/color/"

static inline kiln_color *color_of(const char *config, const char *working_space) {
    const kiln_color_options options = {config, working_space};
    kiln_report *report = kiln_report_create();
    kiln_color *color;
    if (!kiln_color_create(&options, &color, report)) fail_msg("%s", kiln_report_message(report, 0).what);
    assert_int_equal(kiln_report_size(report), 0);
    kiln_report_destroy(report);
    return color;
}

static inline kiln_view *view_of(const kiln_color *color, const char *display, const char *view, const char *look,
                                 double exposure) {
    const kiln_view_options options = {display, view, look, exposure};
    kiln_report *report = kiln_report_create();
    kiln_view *result;
    if (!kiln_view_create(color, &options, &result, report)) fail_msg("%s", kiln_report_message(report, 0).what);
    kiln_report_destroy(report);
    return result;
}

/* The first message of a failure: its code and parts of its texts. */
static inline void assert_message(kiln_report *report, kiln_code code, const char *where, const char *what,
                                  const char *remedy) {
    assert_int_equal(kiln_report_size(report), 1);
    kiln_message m = kiln_report_message(report, 0);
    if (m.code != code || !strstr(m.where, where) || !strstr(m.what, what) || !strstr(m.remedy, remedy))
        fail_msg("%s: %s: %s [%s]", kiln_code_name(m.code), m.where, m.what, m.remedy);
    kiln_report_clear(report);
}

/* IEC 61966-2-1 */
static inline double srgb_encode(double x) {
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}
static inline double srgb_decode(double v) {
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

#endif
