/* render/path/stage_surroundings.c: a direction of the environment, for the lanes that chose it.
 *
 * The tables and texels of a picture do not fit the caches, and one lane reads four places of them, each found by the one
 * before. So every step is a loop of its own, which tells the caches what the next one reads. */
#include "render/light/environment.h"
#include "render/path/stages.h"

static bool is_chosen(const path_scratch *x, uint32_t i) { return x->light_kind[i] == LIGHT_ENVIRONMENT; }

/* Lanes of other lights take the first texel, which nobody looks at. */
static void pick_rows(const environment *e, path_scratch *x, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        environment_choice p = {0};
        if (is_chosen(x, i)) environment_pick_row(e, x->u_light_y[i], x->u_fine[i], &p);
        x->row[i] = p.row, x->down_texel[i] = p.down;
        __builtin_prefetch(environment_guide(e, p.row, x->u_light_x[i]));
    }
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t *guide = environment_guide(e, x->row[i], x->u_light_x[i]);
        __builtin_prefetch(e->texel_cdf + (size_t)x->row[i] * ((size_t)e->width + 1) + *guide);
    }
}

static void pick_columns(const environment *e, path_scratch *x, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        environment_choice p = {.row = x->row[i], .down = x->down_texel[i]};
        if (is_chosen(x, i)) environment_pick_column(e, x->u_light_x[i], x->u_fine[i], &p);
        x->column[i] = p.column, x->across_texel[i] = p.across;
        environment_prefetch(e, (int32_t)p.row, (int32_t)p.column, p.down >= 0.5f);
    }
}

static void turn(const environment *e, path_scratch *x, uint32_t n) {
    float width = (float)e->width, height = (float)e->height, rotation = e->rotation_turns;
    LANE_LOOP (uint32_t i = 0; i < n; i++) {
        environment_choice p = {x->row[i], x->column[i], x->across_texel[i], x->down_texel[i]};
        vec3 turned = environment_turn(width, height, rotation, &p);
        vec2 place = environment_turned_place(turned);
        int chosen = x->light_kind[i] == LIGHT_ENVIRONMENT;
        x->qx[i] = chosen ? turned.x : x->qx[i];
        x->qy[i] = chosen ? turned.y : x->qy[i];
        x->qz[i] = chosen ? turned.z : x->qz[i];
        x->tx[i] = place.x, x->ty[i] = place.y;
    }
}

void STAGE(surroundings)(const path_context *c, batch *b) {
    const environment *e = &c->world->lights.environment;
    path_scratch *x = &b->scratch;
    pick_rows(e, x, b->n);
    pick_columns(e, x, b->n);
    turn(e, x, b->n);
    for (uint32_t i = 0; i < b->n; i++) {
        if (!is_chosen(x, i)) continue;
        vec3 radiance = environment_look_up(e, (vec2){x->tx[i], x->ty[i]}).radiance;
        x->rr[i] = radiance.x, x->rg[i] = radiance.y, x->rb[i] = radiance.z;
        x->light_area[i] = environment_density(e, x->row[i], x->column[i]);
    }
}
