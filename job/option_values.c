/* Values that only one option has. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "job/effects.h"
#include "job/options.h"

/* Takes the text up to `end` (or the end of all); false when it is longer than anything that could be valid. */
static bool take(const char **text, char end, char part[64]) {
    const char *stop = strchr(*text, end);
    size_t length = stop ? (size_t)(stop - *text) : strlen(*text);
    if (length >= 64) return false;
    memcpy(part, *text, length);
    part[length] = '\0';
    *text += length + (stop != NULL);
    return true;
}

static bool take_uint32(const char **text, char end, uint32_t *value) {
    char part[64];
    uint64_t wide;
    if (!take(text, end, part) || !text_to_uint64(part, &wide) || wide > UINT32_MAX) return false;
    *value = (uint32_t)wide;
    return true;
}

static bool parse_size(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    uint32_t size[2];
    if (!strchr(text, 'x') || !take_uint32(&text, 'x', &size[0]) || !take_uint32(&text, '\0', &size[1])) return false;
    if (size[0] < 1 || size[1] < 1 || size[0] > 65536 || size[1] > 65536) return false;
    memcpy(field, size, sizeof size);
    return true;
}

static void print_size(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    const uint32_t *size = field;
    text_format(out, "%ux%u", size[0], size[1]);
}

static bool parse_crop(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    uint32_t crop[4];
    for (int i = 0; i < 4; i++)
        if (!take_uint32(&text, i < 3 ? ',' : '\0', &crop[i])) return false;
    if (crop[0] >= crop[2] || crop[1] >= crop[3]) return false;
    memcpy(field, crop, sizeof crop);
    return true;
}

static void print_crop(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    const uint32_t *c = field;
    text_format(out, "%u,%u,%u,%u", c[0], c[1], c[2], c[3]);
}

static bool parse_percent(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    char part[64];
    double percent;
    bool signed_ = strchr(text, '%') != NULL;
    if (!take(&text, '%', part) || (signed_ && *text) || !text_to_double(part, &percent)) return false;
    if (!(percent >= 0 && percent <= 100)) return false;
    *(double *)field = percent;
    return true;
}

static void print_percent(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    option_print_number(*(const double *)field, out);
    text_append(out, "%");
}

static const struct { const char *name; double seconds; } units[] = {{"ms", 0.001}, {"s", 1}, {"m", 60}, {"h", 3600}};

static bool parse_duration(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    double total = 0;
    if (text_to_double(text, &total)) text = ""; /* a bare number is seconds */
    while (*text) {
        char part[64];
        size_t length = strspn(text, "0123456789.");
        double number, unit = 0;
        if (length == 0 || length >= sizeof part) return false;
        memcpy(part, text, length);
        part[length] = '\0';
        text += length;
        size_t letters = strcspn(text, "0123456789.");
        for (size_t i = 0; i < sizeof units / sizeof *units; i++)
            if (strlen(units[i].name) == letters && strncmp(text, units[i].name, letters) == 0) unit = units[i].seconds;
        if (unit == 0 || !text_to_double(part, &number)) return false;
        total += number * unit;
        text += letters;
    }
    if (!(total > 0 && isfinite(total))) return false;
    *(double *)field = total;
    return true;
}

static void print_duration(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    option_print_number(*(const double *)field, out);
}

static const struct {
    const char *name;
    kiln_pixel_filter kind;
    double width;
} filters[] = {{"box", KILN_PIXEL_BOX, 1},
               {"gaussian", KILN_PIXEL_GAUSSIAN, 3},
               {"blackman-harris", KILN_PIXEL_BLACKMAN_HARRIS, 1.5}};

static bool parse_filter(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    char name[64];
    bool sized = strchr(text, ':') != NULL;
    if (!take(&text, ':', name)) return false;
    for (size_t i = 0; i < sizeof filters / sizeof *filters; i++) {
        if (strcmp(name, filters[i].name) != 0) continue;
        job_filter f = {filters[i].kind, filters[i].width};
        if (sized && (!text_to_double(text, &f.width) || !(f.width > 0 && f.width <= 16))) return false;
        *(job_filter *)field = f;
        return true;
    }
    return false;
}

static void print_filter(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    const job_filter *f = field;
    for (size_t i = 0; i < sizeof filters / sizeof *filters; i++)
        if (filters[i].kind == f->kind) text_format(out, "%s:", filters[i].name);
    option_print_number(f->width, out);
}

/* What throughput guarantees when no number is given: the first bounces carry most of the light. */
enum { ROULETTE_MIN = 3 };

static bool parse_roulette(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    char name[64];
    bool more = strchr(text, ':') != NULL;
    kiln_roulette r = {0};
    if (!take(&text, ':', name)) return false;
    if (strcmp(name, "auto") == 0 && !more) r.kind = KILN_ROULETTE_AUTO;
    else if (strcmp(name, "off") == 0 && !more) r.kind = KILN_ROULETTE_OFF;
    else if (strcmp(name, "fixed") == 0 && text_to_double(text, &r.p) && r.p > 0 && r.p <= 1)
        r.kind = KILN_ROULETTE_FIXED;
    else if (strcmp(name, "throughput") == 0) {
        r.kind = KILN_ROULETTE_THROUGHPUT;
        r.min_depth = ROULETTE_MIN;
        if (more && (!take_uint32(&text, '\0', &r.min_depth) || r.min_depth > 65535)) return false;
    } else return false;
    *(kiln_roulette *)field = r;
    return true;
}

static void print_roulette(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    const kiln_roulette *r = field;
    switch (r->kind) {
    case KILN_ROULETTE_AUTO: text_append(out, "auto"); break;
    case KILN_ROULETTE_OFF: text_append(out, "off"); break;
    case KILN_ROULETTE_FIXED:
        text_append(out, "fixed:");
        option_print_number(r->p, out);
        break;
    case KILN_ROULETTE_THROUGHPUT: text_format(out, "throughput:%u", r->min_depth); break;
    }
}

static bool parse_orbit(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    char azimuth[64];
    job_orbit o;
    if (!take(&text, ',', azimuth) || !text_to_double(azimuth, &o.azimuth_deg) ||
        !text_to_double(text, &o.elevation_deg))
        return false;
    if (!(fabs(o.azimuth_deg) <= 1e6 && fabs(o.elevation_deg) <= 90)) return false;
    *(job_orbit *)field = o;
    return true;
}

static void print_orbit(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    const job_orbit *o = field;
    option_print_number(o->azimuth_deg, out);
    text_append(out, ",");
    option_print_number(o->elevation_deg, out);
}

static bool parse_focus(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    double distance = 0;
    if (strcmp(text, "auto") != 0 && (!text_to_double(text, &distance) || !(distance > 0))) return false;
    *(double *)field = distance;
    return true;
}

static void print_focus(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    double distance = *(const double *)field;
    if (distance > 0) option_print_number(distance, out);
    else text_append(out, "auto");
}

static bool parse_background(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    job_background b = {0};
    if (strcmp(text, "env") == 0) b.kind = KILN_BACKGROUND_ENVIRONMENT;
    else if (strcmp(text, "transparent") == 0) b.kind = KILN_BACKGROUND_TRANSPARENT;
    else {
        if (text[0] != '#' || strlen(text) != 7 || strspn(text + 1, "0123456789abcdefABCDEF") != 6) return false;
        unsigned long rgb = strtoul(text + 1, NULL, 16);
        b.kind = KILN_BACKGROUND_COLOR;
        for (int k = 0; k < 3; k++) b.rgb[k] = (uint8_t)(rgb >> (16 - 8 * k) & 0xff);
    }
    *(job_background *)field = b;
    return true;
}

static void print_background(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    const job_background *b = field;
    if (b->kind == KILN_BACKGROUND_COLOR) text_format(out, "#%02x%02x%02x", b->rgb[0], b->rgb[1], b->rgb[2]);
    else text_append(out, b->kind == KILN_BACKGROUND_TRANSPARENT ? "transparent" : "env");
}

static bool parse_subdivide(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    job_subdivision s = {KILN_SUBDIVIDE_AUTO, 0};
    if (strcmp(text, "off") == 0) s.mode = KILN_SUBDIVIDE_OFF;
    else if (strcmp(text, "auto") != 0) {
        s.mode = KILN_SUBDIVIDE_LEVEL;
        if (!take_uint32(&text, '\0', &s.level) || s.level < 1 || s.level > 6) return false;
    }
    *(job_subdivision *)field = s;
    return true;
}

static void print_subdivide(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    const job_subdivision *s = field;
    if (s->mode == KILN_SUBDIVIDE_LEVEL) text_format(out, "%u", s->level);
    else text_append(out, s->mode == KILN_SUBDIVIDE_OFF ? "off" : "auto");
}

static bool parse_effects(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    kiln_text problem = {0};
    kiln_effects wish;
    bool done = effects_parse(text, &wish, &problem);
    if (done) *(kiln_effects *)field = wish;
    text_free(&problem);
    return done;
}

void option_explain_effects(const char *text, kiln_text *remedy) {
    kiln_effects wish;
    (void)effects_parse(text, &wish, remedy);
}

static void print_effects(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    effects_print(field, out);
}

const option_kind option_size = {parse_size, print_size, false, false};
const option_kind option_crop = {parse_crop, print_crop, false, false};
const option_kind option_percent = {parse_percent, print_percent, false, false};
const option_kind option_duration = {parse_duration, print_duration, false, false};
const option_kind option_filter = {parse_filter, print_filter, false, false};
const option_kind option_roulette = {parse_roulette, print_roulette, false, false};
const option_kind option_orbit = {parse_orbit, print_orbit, false, false};
const option_kind option_focus = {parse_focus, print_focus, false, false};
const option_kind option_background = {parse_background, print_background, false, false};
const option_kind option_subdivide = {parse_subdivide, print_subdivide, false, false};
const option_kind option_effects = {parse_effects, print_effects, false, false};
