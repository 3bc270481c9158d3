/* What parts of the beauty a film holds, and how they become floats. */
#include <stdlib.h>
#include <string.h>

#include "base/report.h"
#include "base/text.h"
#include "render/film/film.h"

static const char *const lobe_names[KILN_LOBE_COUNT] = {
#define LOBE_NAME(id, name, text) name,
    KILN_LOBES(LOBE_NAME)
#undef LOBE_NAME
};
const char *const *kiln_lobe_names(void) { return lobe_names; }

static const char *const bounce_names[PATH_BOUNCES] = {"emission", "direct", "indirect"};
static const char lobe_prefix[] = "lobe:", light_prefix[] = "lightgroup:";
static const char *const rest_names[KILN_DIVISION_COUNT] = {
    [KILN_DIVISION_BOUNCE] = "bounce:*", [KILN_DIVISION_LOBE] = "lobe:*", [KILN_DIVISION_LIGHT] = "lightgroup:*"};

static uint32_t find(const char *const *names, uint32_t count, const char *name) {
    uint32_t i = 0;
    while (i < count && strcmp(names[i], name) != 0) i++;
    return i;
}

/* A name without its sums; divisions 0: it is none. */
static film_part parse(const char *name) {
    film_part part = {.name = name, .lobe = KILN_LOBE_COUNT, .bounce = PATH_BOUNCES};
    const char *lobe = text_after(name, lobe_prefix);
    part.light = text_after(name, light_prefix);
    if (part.light) part.divisions = *part.light ? 1u << KILN_DIVISION_LIGHT : 0;
    else if (lobe) part.lobe = find(lobe_names, KILN_LOBE_COUNT, lobe);
    else part.bounce = find(bounce_names, PATH_BOUNCES, name);
    if (part.lobe < KILN_LOBE_COUNT) part.divisions = 1u << KILN_DIVISION_LOBE;
    if (part.bounce < PATH_BOUNCES) part.divisions = 1u << KILN_DIVISION_BOUNCE;
    if (part.lobe == KILN_LOBE_EMISSION || part.bounce == BOUNCE_EMISSION) {
        part.name = bounce_names[BOUNCE_EMISSION];
        part.lobe = KILN_LOBE_EMISSION;
        part.bounce = BOUNCE_EMISSION;
    }
    return part;
}

static bool refuse(const char *name, kiln_report *report) {
    kiln_where where = where_root("film");
    kiln_text known = {0};
    text_append(&known, "direct, indirect, emission, lightgroup:NAME");
    for (int i = 0; i < KILN_LOBE_COUNT; i++) text_format(&known, ", lobe:%s", lobe_names[i]);
    report_error(report, KILN_CODE_USAGE, &where, known.data, "there is no part '%s' of the picture", name);
    text_free(&known);
    return false;
}

/* Adds it, or its division to what is there. */
static bool add(kiln_film *f, film_part part, kiln_report *report) {
    film_parts *p = &f->parts;
    uint32_t i = 0, lights = 0;
    for (; i < p->count && strcmp(p->items[i].name, part.name) != 0; i++) lights += p->items[i].light != NULL;
    if (i < p->count) {
        p->items[i].divisions |= part.divisions;
        return true;
    }
    if (part.light && lights == KILN_LIGHT_GROUPS_MAX) {
        kiln_where where = where_root("film");
        return report_error(report, KILN_CODE_LIMIT, &where, "name those that matter: the others are one part",
                            "more than %d groups of light are asked for", KILN_LIGHT_GROUPS_MAX);
    }
    part.name = arena_string(&p->arena, part.name);
    if (!part.name) return report_no_memory(report, "making the film");
    part.light = text_after(part.name, light_prefix);
    memmove(p->items + 1, p->items, part.bounce == BOUNCE_EMISSION ? p->count * sizeof *p->items : 0);
    p->items[part.bounce == BOUNCE_EMISSION ? 0 : p->count] = part;
    p->count++;
    return true;
}

bool film_make_parts(kiln_film *f, const kiln_film_desc *d, kiln_report *report) {
    film_parts *p = &f->parts;
    p->items = ARENA_ARRAY(&p->arena, film_part, d->part_count);
    const char **names = ARENA_ARRAY(&p->arena, const char *, d->part_count);
    if (!p->items || !names) return report_no_memory(report, "making the film");
    for (uint32_t i = 0; i < d->part_count; i++) {
        film_part part = parse(d->parts[i]);
        if (!part.divisions) return refuse(d->parts[i], report);
        if (!add(f, part, report)) return false;
        if (!(names[i] = arena_string(&p->arena, d->parts[i]))) return report_no_memory(report, "making the film");
    }
    f->desc.parts = names;
    return true;
}

bool film_allocate_parts(kiln_film *f) {
    for (uint32_t i = 0; i < f->parts.count; i++) {
        f->parts.items[i].sums = aligned_array((size_t)f->width * f->height, sizeof(fixed[3]));
        if (!f->parts.items[i].sums) return false;
    }
    return true;
}

void film_free_parts(kiln_film *f) {
    for (uint32_t i = 0; i < f->parts.count; i++) free(f->parts.items[i].sums);
    arena_free(&f->parts.arena);
}

uint64_t film_part_bytes(const kiln_film_desc *d) { return (uint64_t)d->part_count * sizeof(fixed[3]); }

/* What the division leaves is a part too, unless it is there completely. */
static bool has_rest(const kiln_film *f, int division) {
    static const uint32_t complete[KILN_DIVISION_COUNT] = {
        [KILN_DIVISION_BOUNCE] = PATH_BOUNCES, [KILN_DIVISION_LOBE] = KILN_LOBE_COUNT,
        [KILN_DIVISION_LIGHT] = UINT32_MAX};
    uint32_t held = 0;
    for (uint32_t i = 0; i < f->parts.count; i++) held += f->parts.items[i].divisions >> division & 1;
    return held && held < complete[division] && !(division == KILN_DIVISION_LIGHT && f->parts.every_light);
}

uint32_t kiln_film_part_count(const kiln_film *f) {
    uint32_t count = f->parts.count;
    for (int d = 0; d < KILN_DIVISION_COUNT; d++) count += has_rest(f, d);
    return count;
}

kiln_film_part_info kiln_film_describe_part(const kiln_film *f, uint32_t index) {
    if (index < f->parts.count)
        return (kiln_film_part_info){f->parts.items[index].name, f->parts.items[index].divisions, false};
    index -= f->parts.count;
    for (int d = 0; d < KILN_DIVISION_COUNT; d++)
        if (has_rest(f, d) && index-- == 0) return (kiln_film_part_info){rest_names[d], 1u << d, true};
    return (kiln_film_part_info){0};
}

/* Multiples of the beauty's last digit: what the parts up to and with this one sum to, rounded, less the same without
 * it. All but the last digit cancels, and as no sum has more digits than the beauty, none is ever rounded. */
static float share(fixed before, fixed with, fixed all, uint32_t samples) {
    int exponent;
    float beauty = (float)(fixed_to_double(all) / samples);
    if (!(beauty > 0)) return 0;
    (void)frexpf(beauty, &exponent);
    double digit = ldexp(1, exponent - 24 > -149 ? exponent - 24 : -149);
    double to = rint(fixed_to_double(with) / samples / digit), from = rint(fixed_to_double(before) / samples / digit);
    return (float)((to - from) * digit);
}

void kiln_film_part(const kiln_film *f, uint32_t index, float *rgb) {
    kiln_film_part_info info = kiln_film_describe_part(f, index);
    int division = 0;
    while (!(info.divisions >> division & 1)) division++;
    for (size_t i = 0; i < (size_t)f->width * f->height; i++)
        for (size_t k = 0; k < 3; k++) {
            fixed all = 0, before = 0;
            for (uint32_t r = 0; r < KILN_REPLICATES; r++) all += f->pixels[i].sum[r][k];
            for (uint32_t p = 0; p < index && p < f->parts.count; p++)
                if (f->parts.items[p].divisions >> division & 1) before += f->parts.items[p].sums[i][k];
            fixed with = info.rest ? all : before + f->parts.items[index].sums[i][k];
            rgb[3 * i + k] = f->counts[i] ? share(before, with, all, f->counts[i]) : 0.0f;
        }
}
