/* Which part of a film each light of a scene belongs to. */
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "render/context.h"
#include "scene/groups.h"

static bool is_group(const light_groups *g, const char *name) {
    for (uint32_t i = 0; i < g->count; i++)
        if (strcmp(g->names[i], name) == 0) return true;
    return false;
}

enum { NAMES_SHOWN = 20 };

static bool refuse(const light_groups *g, const char *name, kiln_report *report) {
    kiln_where where = where_root("lightgroup");
    kiln_text known = {0};
    for (uint32_t i = 0; i < g->count && i < NAMES_SHOWN; i++) text_format(&known, "%s%s", i ? ", " : "", g->names[i]);
    report_error(report, KILN_CODE_USAGE, &where, NULL, "the scene has no light '%s'; it has %s%s", name,
                 known.data ? known.data : "none", g->count > NAMES_SHOWN ? ", ..." : "");
    text_free(&known);
    return false;
}

static uint8_t part_of(const kiln_film *f, const char *group) {
    for (uint32_t i = 0; i < f->parts.count; i++)
        if (f->parts.items[i].light && strcmp(f->parts.items[i].light, group) == 0) return (uint8_t)i;
    return PART_NONE;
}

static bool plan_lights(const kiln_scene *s, const light_groups *g, kiln_film *f, path_parts_plan *plan,
                        kiln_report *report) {
    plan->of_light = array_alloc((size_t)s->light_count + 1, 1);
    plan->of_material = array_alloc((size_t)s->material_count + 1, 1);
    if (!plan->of_light || !plan->of_material) return report_no_memory(report, "starting the render");
    for (uint32_t i = 0; i < f->parts.count; i++)
        if (f->parts.items[i].light && !is_group(g, f->parts.items[i].light))
            return refuse(g, f->parts.items[i].light, report);
    f->parts.every_light = true;
    for (uint32_t i = 0; i < g->count; i++) f->parts.every_light &= part_of(f, g->names[i]) != PART_NONE;
    for (uint32_t i = 0; i <= s->light_count; i++) plan->of_light[i] = part_of(f, g->names[g->of_light[i]]);
    for (uint32_t i = 0; i <= s->material_count; i++) plan->of_material[i] = part_of(f, g->names[g->of_material[i]]);
    plan->of_environment = part_of(f, g->names[g->of_environment]);
    return true;
}

bool context_plan_parts(const kiln_renderer *r, kiln_film *f, path_parts_plan *plan, kiln_report *report) {
    _Static_assert(KILN_LIGHT_GROUPS_MAX + KILN_LOBE_COUNT + PATH_BOUNCES < PART_NONE, "a part fits in a byte");
    light_groups groups;
    *plan = (path_parts_plan){.count = f->parts.count};
    if (!plan->count) return true;
    memset(plan->lobe, PART_NONE, sizeof plan->lobe);
    memset(plan->bounce, PART_NONE, sizeof plan->bounce);
    for (uint32_t i = 0; i < f->parts.count; i++) {
        const film_part *part = &f->parts.items[i];
        if (part->lobe < KILN_LOBE_COUNT) plan->lobe[part->lobe] = (uint8_t)i;
        if (part->bounce < PATH_BOUNCES) plan->bounce[part->bounce] = (uint8_t)i;
    }
    if (!light_groups_make(r->scene, &groups, report)) return false;
    bool done = plan_lights(r->scene, &groups, f, plan, report);
    light_groups_free(&groups);
    return done;
}

void context_free_parts(path_parts_plan *plan) {
    free(plan->of_light);
    free(plan->of_material);
}
