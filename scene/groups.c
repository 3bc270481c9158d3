#include "scene/groups.h"

#include <stdlib.h>
#include <string.h>

#include "base/murmur.h"

/* Names as they come, found again by hash. */
typedef struct gathering {
    kiln_arena arena;
    const char **names;
    uint32_t count, slots; /* slots: a power of two */
    uint32_t *table;       /* 1 + name; 0: free */
} gathering;

enum { NAME_MAX_BYTES = 200 };

void light_group_clean(char *name) {
    size_t length = strlen(name);
    if (length > NAME_MAX_BYTES) {
        length = NAME_MAX_BYTES;
        while (length && ((unsigned char)name[length] & 0xc0) == 0x80) length--; /* UTF-8: not into a character */
        name[length] = '\0';
    }
    for (char *c = name; *c; c++)
        if (*c == '.' || *c == ',' || *c == ':' || (unsigned char)*c < ' ' || *c == 0x7f) *c = '_';
}

static const char *group_name(kiln_arena *arena, const char *name, const char *prefix, uint32_t handle) {
    name = scene_name(arena, name, prefix, handle);
    char *text = name ? arena_string(arena, name) : NULL;
    if (text) light_group_clean(text);
    return text;
}

/* name NULL: memory is exhausted. */
static bool add(gathering *g, const char *name, uint32_t *group) {
    if (!name) return false;
    uint32_t slot = murmur3_32(name, strlen(name), 0) & (g->slots - 1);
    while (g->table[slot] && strcmp(g->names[g->table[slot] - 1], name) != 0) slot = (slot + 1) & (g->slots - 1);
    if (!g->table[slot]) {
        g->names[g->count] = name;
        g->table[slot] = ++g->count;
    }
    *group = g->table[slot] - 1;
    return true;
}

static bool shines(const kiln_material *m) {
    const kiln_param3 *p = m->layers & KILN_LAYER_UNLIT ? &m->base_color : &m->emission;
    return p->value[0] > 0 || p->value[1] > 0 || p->value[2] > 0;
}

/* Materials that some mesh wears; 0, the default one, does not shine. */
static void mark_worn(const kiln_scene *s, bool *worn) {
    for (uint32_t i = 0; i < s->mesh_count; i++) {
        const kiln_mesh *m = &s->meshes[i];
        for (uint32_t f = 0; f < m->face_count; f++) {
            worn[mesh_face_material(m, f)] = true;
            if (!m->face_materials) break;
        }
    }
}

static bool gather(const kiln_scene *s, gathering *g, light_groups *groups, bool *worn) {
    bool done = true;
    mark_worn(s, worn);
    for (uint32_t i = 1; done && i <= s->light_count; i++)
        done = add(g, group_name(&g->arena, scene_light(s, i)->name, "light_", i), &groups->of_light[i]);
    for (uint32_t i = 1; done && i <= s->material_count; i++) {
        const kiln_material *m = scene_material(s, i);
        if (!worn[i] || !shines(m)) continue;
        done = add(g, group_name(&g->arena, m->name, "material_", i), &groups->of_material[i]);
    }
    return done && add(g, "environment", &groups->of_environment);
}

/* Pointers and texts in one allocation. */
static bool keep_names(const gathering *g, light_groups *groups) {
    size_t bytes = g->count * sizeof *g->names;
    for (uint32_t i = 0; i < g->count; i++) bytes += strlen(g->names[i]) + 1;
    groups->names = array_alloc(bytes, 1);
    char *to = groups->names ? (char *)(groups->names + g->count) : NULL;
    for (uint32_t i = 0; to && i < g->count; i++) {
        size_t size = strlen(g->names[i]) + 1;
        groups->names[i] = memcpy(to, g->names[i], size);
        to += size;
    }
    groups->count = g->count;
    return to != NULL;
}

bool light_groups_make(const kiln_scene *s, light_groups *groups, kiln_report *report) {
    *groups = (light_groups){.of_light = array_alloc((size_t)s->light_count + 1, sizeof(uint32_t)),
                             .of_material = array_alloc((size_t)s->material_count + 1, sizeof(uint32_t))};
    gathering g = {.slots = 16};
    size_t most = (size_t)s->light_count + s->material_count + 1;
    while (g.slots < 2 * most) g.slots *= 2;
    g.names = ARENA_ARRAY(&g.arena, const char *, most);
    g.table = ARENA_ARRAY(&g.arena, uint32_t, g.slots);
    bool *worn = ARENA_ARRAY(&g.arena, bool, (size_t)s->material_count + 1);
    bool done = groups->of_light && groups->of_material && g.names && g.table && worn && gather(s, &g, groups, worn) &&
                keep_names(&g, groups);
    arena_free(&g.arena);
    if (done) return true;
    light_groups_free(groups);
    return report_no_memory(report, "naming groups of light");
}

void light_groups_free(light_groups *g) {
    free(g->names);
    free(g->of_light);
    free(g->of_material);
    *g = (light_groups){0};
}

bool kiln_scene_light_groups(const kiln_scene *s, const char *const **names, uint32_t *count, kiln_report *report) {
    light_groups g;
    *names = NULL;
    *count = 0;
    if (!light_groups_make(s, &g, report)) return false;
    *names = g.names;
    *count = g.count;
    g.names = NULL;
    light_groups_free(&g);
    return true;
}
