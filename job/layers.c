#include "job/layers.h"

#include <stdlib.h>
#include <string.h>

#include "scene/groups.h"

static const char *const aov_names[KILN_AOV_COUNT] = {
#define AOV_NAME(id, name, channels, text) name,
    KILN_AOVS(AOV_NAME)
#undef AOV_NAME
};
static const char *const matte_names[KILN_MATTE_COUNT] = {
#define MATTE_NAME(id, name, layer, text) name,
    KILN_MATTES(MATTE_NAME)
#undef MATTE_NAME
};
static const char *const matte_layers[KILN_MATTE_COUNT] = {
#define MATTE_LAYER(id, name, layer, text) layer,
    KILN_MATTES(MATTE_LAYER)
#undef MATTE_LAYER
};

/* Adds the bit of a name, or for "*" all. */
static bool add_bit(const char *const *names, uint32_t count, const char *name, uint32_t *bits) {
    bool all = strcmp(name, "*") == 0, found = all;
    for (uint32_t i = 0; i < count; i++)
        if (all || strcmp(names[i], name) == 0) *bits |= 1u << i, found = true;
    return found;
}

static bool add_light(job_layers *l, char *name, kiln_arena *arena) {
    light_group_clean(name); /* whoever reads a name in the file may type it as it is */
    l->every_light |= strcmp(name, "*") == 0;
    for (uint32_t i = 0; i < l->lights.count; i++)
        if (strcmp(l->lights.items[i], name) == 0) return true;
    if (!*name || strcmp(name, "*") == 0) return *name;
    const char **items = ARENA_ARRAY(arena, const char *, (size_t)l->lights.count + 1);
    if (!items) return false;
    if (l->lights.count) memcpy(items, l->lights.items, l->lights.count * sizeof *items);
    items[l->lights.count++] = name;
    l->lights.items = items;
    return true;
}

static const char light_prefix[] = "lightgroup:";

static bool add(job_layers *l, char *name, kiln_arena *arena) {
    const char *lobe = text_after(name, "lobe:"), *light = text_after(name, light_prefix), *matte = text_after(name, "cryptomatte:");
    if (lobe) return add_bit(kiln_lobe_names(), KILN_LOBE_COUNT, lobe, &l->lobes);
    if (light) return add_light(l, name + strlen(light_prefix), arena);
    if (matte || strcmp(name, "cryptomatte") == 0)
        return add_bit(matte_names, KILN_MATTE_COUNT, matte ? matte : "*", &l->mattes);
    bool emission = strcmp(name, "emission") == 0, direct = strcmp(name, "direct") == 0,
         indirect = strcmp(name, "indirect") == 0;
    l->emission |= emission, l->direct |= direct, l->indirect |= indirect;
    return emission || direct || indirect ||
           (strcmp(name, "*") != 0 && add_bit(aov_names, KILN_AOV_COUNT, name, &l->aovs));
}

static bool parse(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row;
    job_layers layers = {0};
    char *name = arena_string(arena, text);
    for (char *next; name && *name; name = next) {
        size_t length = strcspn(name, ",");
        next = name + length + (name[length] != '\0');
        name[length] = '\0';
        if (!add(&layers, name, arena)) return false;
    }
    *(job_layers *)field = layers;
    return name != NULL;
}

static void print_name(kiln_text *out, size_t start, const char *prefix, const char *name) {
    text_format(out, "%s%s%s", out->length > start ? "," : "", prefix, name);
}

static void print_bits(kiln_text *out, size_t start, const char *prefix, const char *const *names, uint32_t count,
                       uint32_t bits) {
    if (*prefix && bits == (1u << count) - 1) print_name(out, start, prefix, "*");
    else
        for (uint32_t i = 0; i < count; i++)
            if (bits >> i & 1) print_name(out, start, prefix, names[i]);
}

static void print(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    const job_layers *l = field;
    size_t start = out->length;
    print_bits(out, start, "", aov_names, KILN_AOV_COUNT, l->aovs);
    if (l->emission) print_name(out, start, "", "emission");
    if (l->direct) print_name(out, start, "", "direct");
    if (l->indirect) print_name(out, start, "", "indirect");
    print_bits(out, start, "lobe:", kiln_lobe_names(), KILN_LOBE_COUNT, l->lobes);
    if (l->every_light) print_name(out, start, "lightgroup:", "*");
    for (uint32_t i = 0; i < l->lights.count; i++) print_name(out, start, "lightgroup:", l->lights.items[i]);
    print_bits(out, start, "cryptomatte:", matte_names, KILN_MATTE_COUNT, l->mattes);
}

const option_kind option_layers = {parse, print, false, false};

bool layers_any(const job_layers *l) {
    return l->aovs || l->mattes || l->lobes || l->emission || l->direct || l->indirect || l->every_light ||
           l->lights.count;
}

/* Offsets while the text grows, pointers when it is there. */
typedef struct parts { kiln_text text; uint32_t count; } parts;

static void add_part(parts *p, const char *prefix, const char *name) {
    text_append(&p->text, prefix);
    text_append_bytes(&p->text, name, strlen(name) + 1);
    p->count++;
}

/* One allocation: the pointers, then what they point at. */
static bool finish(parts *p, const char *const **names, uint32_t *count) {
    size_t pointers = p->count * sizeof **names;
    const char **all = p->text.failed ? NULL : array_alloc(pointers + p->text.length + 1, 1);
    char *to = all ? (char *)(all + p->count) : NULL;
    if (to && p->text.length) memcpy(to, p->text.data, p->text.length);
    for (uint32_t i = 0; to && i < p->count; i++, to += strlen(to) + 1) all[i] = to;
    text_free(&p->text);
    *names = all;
    *count = all ? p->count : 0;
    return all != NULL;
}

enum { LIGHTS_SHOWN = 20 };

/* Before anything is built: a name that the scene does not have. */
static bool check_lights(const job_layers *l, const char *const *groups, uint32_t count, kiln_report *report) {
    for (uint32_t i = 0; i < l->lights.count; i++) {
        const char *name = l->lights.items[i], *near;
        uint32_t k = 0;
        while (k < count && strcmp(groups[k], name) != 0) k++;
        if (k < count) continue;
        kiln_where where = where_root("--aov");
        kiln_text remedy = {0};
        if ((near = text_nearest(name, groups, count))) text_format(&remedy, "did you mean '%s'? ", near);
        text_append(&remedy, "give one of: *");
        for (k = 0; k < count && k < LIGHTS_SHOWN; k++) text_format(&remedy, ", %s", groups[k]);
        if (count > LIGHTS_SHOWN) text_append(&remedy, ", ...");
        report_error(report, KILN_CODE_USAGE, &where, remedy.data, "the scene has no light 'lightgroup:%s'", name);
        text_free(&remedy);
        return false;
    }
    return true;
}

static void add_parts(const job_layers *l, const char *const *groups, uint32_t group_count, parts *p) {
    if (l->emission) add_part(p, "", "emission");
    if (l->direct) add_part(p, "", "direct");
    if (l->indirect) add_part(p, "", "indirect");
    for (uint32_t i = 0; i < KILN_LOBE_COUNT; i++)
        if (l->lobes >> i & 1) add_part(p, "lobe:", kiln_lobe_names()[i]);
    for (uint32_t i = 0; l->every_light && i < group_count; i++) add_part(p, "lightgroup:", groups[i]);
    for (uint32_t i = 0; !l->every_light && i < l->lights.count; i++) add_part(p, "lightgroup:", l->lights.items[i]);
}

bool layers_parts(const job_layers *l, const kiln_scene *scene, const char *const **names, uint32_t *count,
                  kiln_report *report) {
    parts p = {0};
    const char *const *groups;
    uint32_t group_count;
    *names = NULL;
    *count = 0;
    if (!kiln_scene_light_groups(scene, &groups, &group_count, report)) return false;
    bool done = check_lights(l, groups, group_count, report);
    if (done) {
        add_parts(l, groups, group_count, &p);
        done = finish(&p, names, count) || report_no_memory(report, "making the film");
    }
    free((void *)groups);
    return done;
}

void layers_name_part(const kiln_film_part_info *part, kiln_text *out) {
    const char *light = text_after(part->name, "lightgroup:"), *lobe = text_after(part->name, "lobe:");
    if (part->rest) text_format(out, "rest_%.*s", (int)strcspn(part->name, ":"), part->name);
    else if (light) text_format(out, "lightgroup_%s", light);
    else text_append(out, lobe ? lobe : part->name);
}

const char *layers_name_matte(kiln_matte matte) { return matte_layers[matte]; }

static void list(kiln_text *out, const char *name) { text_append_bytes(out, name, strlen(name) + 1); }

void layers_list(const job_layers *l, const kiln_film *film, kiln_text *out) {
    for (int i = 0; i < KILN_AOV_COUNT; i++)
        if (l->aovs >> i & 1) list(out, aov_names[i]);
    for (uint32_t i = 0, n = kiln_film_part_count(film); i < n; i++) {
        kiln_film_part_info part = kiln_film_describe_part(film, i);
        layers_name_part(&part, out);
        text_append_bytes(out, "", 1);
    }
    for (int i = 0; i < KILN_MATTE_COUNT; i++)
        if (l->mattes >> i & 1) list(out, matte_layers[i]);
    text_append_bytes(out, "", 1);
}
