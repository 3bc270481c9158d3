#include "cli/json_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void append_grouped(kiln_text *out, double count) {
    char digits[32];
    long long value = llrint(count);
    size_t length = 0;
    do digits[length++] = (char)('0' + value % 10);
    while ((value /= 10) > 0 && length < sizeof digits);
    for (size_t i = length; i-- > 0;) {
        text_append_bytes(out, &digits[i], 1);
        if (i && i % 3 == 0) text_append(out, ",");
    }
}

void append_bytes(kiln_text *out, double bytes) {
    static const char *const units[] = {"bytes", "kB", "MB", "GB", "TB"};
    size_t unit = 0;
    for (; bytes >= 1000 && unit < 4; bytes /= 1000) unit++;
    text_format(out, unit && bytes < 100 ? "%.1f %s" : "%.0f %s", bytes, units[unit]);
}

static int by_share(const void *a, const void *b) {
    double x = number_in(*(const json_t *const *)a, "share"), y = number_in(*(const json_t *const *)b, "share");
    return (x < y) - (x > y);
}

void append_stages(kiln_text *out, const json_t *stages, double least) {
    const json_t *rows[64], *stage;
    size_t count = 0, i;
    json_array_foreach(stages, i, stage)
        if (count < sizeof rows / sizeof *rows && number_in(stage, "share") >= least) rows[count++] = stage;
    qsort(rows, count, sizeof *rows, by_share);
    for (i = 0; i < count; i++)
        text_format(out, "%s%s %.0f%%", i ? ", " : "", text_in(rows[i], "name"), 100 * number_in(rows[i], "share"));
}

void append_vector(kiln_text *out, const json_t *numbers) {
    const json_t *number;
    size_t i;
    text_append(out, "(");
    json_array_foreach(numbers, i, number) text_format(out, "%s%.4g", i ? ", " : "", json_number_value(number));
    text_append(out, ")");
}

static bool is_continuation(char c) { return ((unsigned char)c & 0xc0) == 0x80; } /* of a UTF-8 character */

size_t name_width(const char *name) {
    size_t width = 0;
    for (; *name; name++) width += !is_continuation(*name);
    return width;
}

void append_name(kiln_text *out, const char *name, size_t width) {
    for (const char *c = name; *c; c++) text_append_bytes(out, (unsigned char)*c < 32 || *c == 127 ? "?" : c, 1);
    for (size_t w = name_width(name); w < width; w++) text_append(out, " ");
}
